"""Runs the cases of `cargo run --example cases` in MuJoCo, with the same geometry, and compares the verdicts.

    python3 validation/mujoco/compare.py "three levels, half the motion=cases/three" "four levels=cases/four"

Results are kept next to the cases, and are not computed again; `--set step=0.00025` changes a setting.
Computations are in the frame of the ground, where the acceleration of the ground is subtracted from gravity.
Lengths are in m, masses in kg, times in s.
"""

import argparse
import json
import math
import time
from multiprocessing import Pool
from pathlib import Path

try:
    import mujoco
    import numpy as np
except ImportError as missing:
    raise SystemExit(f"{missing}; run `pip install mujoco==4.0.0 numpy`") from None

SETTINGS = {
    # Time step (s).
    "step": 5e-4,
    # Impedance of constraints, MuJoCo's `d`; small values give springs and dampers of the stated constants.
    "impedance": 0.05,
    # Ratio of the impedances of friction and normal force: sticking friction is a stiff damper.
    "impratio": 1e5,
    "noslip": 0,
    "iterations": 100,
    "tolerance": 1e-10,
    # Time without motion before the record starts (s).
    "settle": 1.0,
    # Time without the record (s), to measure creep; 0 to run the record.
    "creep_time": 0.0,
    # Numbers of vertices of a barrel: around its axis, along its stave, and over the rounding of each chime.
    "around": 180,
    "along": 61,
    "chime": 4,
    # Damping of seats, relative to the value that dissipates as much in an oscillation as ours.
    "damping": 1.0,
}
# Impact speed (m/s) at which the linear spring is as deep as our law of power 3/2.
IMPACT_SPEED = 2.0
# Interval between two checks of lost seats (s).
LOOK = 2e-3


def barrel_profile(solid, along, over):
    """Returns the axial positions and radii of the vertices of a barrel, from one head to the other."""
    half, head = solid["half_length"], solid["head_radius"]
    arc, offset, rounding = solid["stave_radius"], solid["stave_offset"], solid["rounding"]
    # The normal of the stave where the chime begins.
    end = math.atan2(half, head + offset)
    stave = np.linspace(-end, end, along)
    x = (arc + rounding) * np.sin(stave)
    r = (arc + rounding) * np.cos(stave) - offset
    chime = np.linspace(end, 0.5 * math.pi, over + 1)[1:]
    right_x, right_r = half + rounding * np.sin(chime), head + rounding * np.cos(chime)
    return (
        np.concatenate([-right_x[::-1], x, right_x]),
        np.concatenate([right_r[::-1], r, right_r]),
    )


def barrel_vertices(solid, settings):
    """Returns the vertices of a barrel about `x`, placed so that facets err as much outward as inward."""
    x, r = barrel_profile(solid, settings["along"], settings["chime"])
    around = settings["around"]
    r = r / math.sqrt(math.cos(math.pi / around))
    angles = 2.0 * math.pi * np.arange(around) / around
    ring = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    vertices = [np.column_stack([np.full(around, at), radius * ring]) for at, radius in zip(x, r)]
    return np.concatenate(vertices)


def quaternion(matrix):
    """Returns the quaternion of a rotation."""
    result = np.zeros(4)
    mujoco.mju_mat2Quat(result, np.asarray(matrix, dtype=float).ravel())
    return result


# Rotates the axis `z` of MuJoCo's capsules to our `x`.
Z_TO_X = np.array([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]])


def spring_and_damper(law, mass, settings):
    """Returns stiffness (N/m) and damping (N s/m) of a spring and a damper that represent one of our laws.

    The damper acts in both directions. Our damper of seats acts on approach only, so half of it in both
    directions dissipates as much in an oscillation. Our impact law is a spring of power 3/2 with a restitution;
    here it is a linear spring that is as deep at IMPACT_SPEED, with the damping of that restitution.
    """
    if law["kind"] == "speed-gap":
        return law["stiffness"], settings["damping"] * 0.5 * law["damping"]
    if law["kind"] == "kelvin-voigt":
        return law["stiffness"], law["damping"]
    if law["kind"] == "rebound":
        energy = 0.5 * mass * IMPACT_SPEED**2
        depth = (energy / (0.4 * law["stiffness"])) ** 0.4
        stiffness = 2.0 * energy / depth**2
        swing = math.log(law["restitution"]) ** 2
        ratio = math.sqrt(swing / (math.pi**2 + swing))
        return stiffness, 2.0 * ratio * math.sqrt(stiffness * mass)
    raise ValueError(f"no law {law['kind']}")


def describe(case, settings):
    """Describes the model of a case: bodies, solids and contact pairs."""
    spec = mujoco.MjSpec()
    option = spec.option
    option.timestep = settings["step"]
    option.gravity = [0.0, 0.0, -case["gravity"]]
    option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
    option.solver = mujoco.mjtSolver.mjSOL_NEWTON
    option.integrator = mujoco.mjtIntegrator.mjINT_EULER
    option.impratio = settings["impratio"]
    option.iterations = settings["iterations"]
    option.tolerance = settings["tolerance"]
    option.ccd_tolerance = 1e-9
    option.ccd_iterations = 100
    # One point per contact, as in our program; and MuJoCo must not reset a state that is not finite.
    option.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_MULTICCD | mujoco.mjtDisableBit.mjDSBL_AUTORESET)
    option.noslip_iterations = settings["noslip"]
    bodies = case["bodies"]
    names = {}
    barrel = next(s for b in bodies for s in b["solids"] if s["kind"] == "barrel")
    mesh = spec.add_mesh(name="barrel")
    mesh.uservert = barrel_vertices(barrel, settings).ravel()
    mesh.inertia = mujoco.mjtMeshInertia.mjMESH_INERTIA_CONVEX
    for number, body in enumerate(bodies):
        if body["kind"] == "ground":
            floor = spec.worldbody.add_geom(
                name="floor", type=mujoco.mjtGeom.mjGEOM_PLANE, size=[0, 0, 1], contype=0, conaffinity=0
            )
            names[number, 0] = floor.name
            continue
        own = spec.worldbody.add_body(name=body["name"], pos=body["position"], quat=body["quaternion"])
        own.add_freejoint()
        own.explicitinertial = True
        own.mass, own.inertia = body["mass"], body["inertia"]
        own.ipos, own.iquat = [0, 0, 0], [1, 0, 0, 0]
        for place, solid in enumerate(body["solids"]):
            turned = np.array(solid["matrix"])
            common = {"name": f"{body['name']}/{place}", "pos": solid["center"], "contype": 0, "conaffinity": 0}
            if solid["kind"] == "capsule":
                own.add_geom(
                    type=mujoco.mjtGeom.mjGEOM_CAPSULE,
                    size=[solid["radius"], solid["half_length"], 0],
                    quat=quaternion(turned @ Z_TO_X),
                    **common,
                )
            else:
                own.add_geom(
                    type=mujoco.mjtGeom.mjGEOM_MESH, meshname="barrel", quat=quaternion(turned), **common
                )
            names[number, place] = common["name"]
    d = settings["impedance"]
    for a, tube, b, surface, interface in case["pairs"]:
        law = case["interfaces"][interface]
        # The inverse mass that MuJoCo uses at a contact of two free bodies; that of the ground is zero.
        inverse = sum(0.0 if bodies[i]["kind"] == "ground" else 1.0 / bodies[i]["mass"] for i in (a, b))
        stiffness, damping = spring_and_damper(law["normal"], 1.0 / inverse, settings)
        # Sticking friction is a damper of `damping * inverse / d`, which must be stable in a step.
        own = max(d, 2.0 * damping * inverse * settings["step"])
        scale = (1.0 - own) * inverse
        friction = law["friction"]
        spec.add_pair(
            geomname1=names[a, tube],
            geomname2=names[b, surface],
            condim=3,
            friction=[friction, friction, 0, 0, 0],
            solref=[-stiffness * scale, -damping * scale],
            solimp=[own, own, 0.001, 0.5, 2],
            margin=0.0,
            gap=0.0,
        )
    return spec


def build(case, settings):
    """Builds the model of a case."""
    return describe(case, settings).compile()


class Fates:
    """Losses of seat and falls, by the rules of `crates/space/src/fate.rs`."""

    def __init__(self, case, places, turns):
        self.case, self.rest, self.upright = case, places.copy(), turns.copy()
        self.bodies = case["bodies"]
        self.fell = {}
        self.collapse = None
        self.peak_displacement = 0.0

    def seen_from(self, frame, body, places, turns):
        """Returns the displacement of a body in the frame of another."""
        arm = turns[frame].T @ (places[body] - places[frame])
        return self.upright[frame] @ arm - (self.rest[body] - self.rest[frame])

    def slips(self, i, places, turns):
        """Returns the displacements of a body on each of its supports."""
        body = self.bodies[i]
        if body["carrier"] is not None:
            return np.array([self.seen_from(body["carrier"], i, places, turns)])
        if not body["supports"]:
            return np.array([places[i] - self.rest[i]])
        return np.array([-self.seen_from(i, b, places, turns) for b in body["supports"]])

    def up(self, i, turns):
        """Returns the direction in a body that pointed up at rest."""
        return turns[i] @ self.upright[i][2]

    def lost(self, i, places, turns):
        """Returns how a body has left its seat; None if it has not."""
        body, limits = self.bodies[i], self.case["thresholds"]
        slips = self.slips(i, places, turns)
        mean = slips.mean(axis=0)
        if body["kind"] == "barrel":
            if mean @ mean > (limits["seat_loss_ratio"] * body["size"]) ** 2:
                return "displaced"
        else:
            across, along = (limits["rack_slide_ratio"] * reach for reach in self.case["reach"])
            if body["supports"]:
                if np.abs(slips[:, 1]).max() > along or abs(mean[0]) > across:
                    return "slid"
            below = self.bodies[body["supports"][0]]["carrier"] if body["supports"] else None
            under = np.array([0.0, 0.0, 1.0]) if below is None else self.up(below, turns)
            most = limits["overturning_angle" if below is None else "rocking_angle"]
            if math.acos(min(1.0, max(-1.0, self.up(i, turns) @ under))) > most:
                return "tilted"
        return "dropped" if i in self.fell else None

    def observe(self, now, places, turns):
        """Updates losses of seat and falls from a state."""
        moved = places - self.rest
        for i in range(1, len(self.bodies)):
            if -moved[i][2] > self.case["thresholds"]["fall_drop"]:
                self.fell.setdefault(i, now)
        if self.collapse is None:
            self.peak_displacement = max(self.peak_displacement, np.hypot(moved[1:, 0], moved[1:, 1]).max())
            for i in range(1, len(self.bodies)):
                how = self.lost(i, places, turns)
                if how:
                    self.collapse = (now, i, how)
                    break

    def barrels_fallen(self):
        """Returns the times at which barrels fell, in order."""
        return sorted(at for i, at in self.fell.items() if self.bodies[i]["kind"] == "barrel")


def ground_acceleration(motion, step, end):
    """Returns the ground acceleration in every step, such that the velocity is exact at the ends of steps."""
    velocity = np.array(motion["velocity"])
    known = motion["step"] * np.arange(len(velocity))
    times = step * np.arange(round(end / step) + 1)
    at = np.stack([np.interp(times, known, velocity[:, axis]) for axis in range(3)], axis=1)
    return np.diff(at, axis=0) / step


def lost_numbers(data):
    """Returns whether MuJoCo has reported a state that is not finite."""
    bad = (mujoco.mjtWarning.mjWARN_BADQPOS, mujoco.mjtWarning.mjWARN_BADQVEL, mujoco.mjtWarning.mjWARN_BADQACC)
    return any(data.warning[int(which)].number for which in bad)


def run(case, motion, settings):
    """Runs a case."""
    model = build(case, settings)
    data = mujoco.MjData(model)
    step = settings["step"]
    down = np.array([0.0, 0.0, -case["gravity"]])
    if settings["creep_time"] > 0.0:
        pushes = np.zeros((round(settings["creep_time"] / step), 3))
    else:
        pushes = ground_acceleration(motion, step, case["end_time"])
    places, turns = data.xpos, data.xmat.reshape(-1, 3, 3)
    start = time.process_time()
    for _ in range(round(settings["settle"] / step)):
        mujoco.mj_step(model, data)
    fates = Fates(case, places, turns)
    first_state = places.copy()
    look = max(1, round(LOOK / step))
    iterations = 0
    for at, push in enumerate(pushes):
        model.opt.gravity[:] = down - push
        mujoco.mj_step(model, data)
        if at % look:
            continue
        iterations = max(iterations, int(data.solver_niter[0]))
        fates.observe(at * step, places, turns)
        if fates.collapse and at * step > fates.collapse[0] + case["after_collapse"]:
            break
        if lost_numbers(data):
            break
    seconds = time.process_time() - start
    fallen = fates.barrels_fallen()
    collapse = fates.collapse
    return {
        "number": case["number"],
        "kind": "invalid" if lost_numbers(data) else "collapse" if collapse else "stable",
        "time": collapse and collapse[0],
        "first": collapse and case["bodies"][collapse[1]]["name"],
        "how": collapse and collapse[2],
        "first_fall": fallen[0] if fallen else None,
        "fallen": len(fallen),
        "peak_displacement": float(fates.peak_displacement),
        "drift": float(np.abs(places - first_state)[1:].max()),
        "settled_by": float(np.linalg.norm(fates.rest[1:] - [b["position"] for b in case["bodies"][1:]], axis=1).max()),
        "most_iterations": iterations,
        "end_time": at * step,
        "seconds": seconds,
    }


def run_file(task):
    """Runs the case of a file."""
    path, settings = task
    with open(path) as file:
        case = json.load(file)
    with open(path.parent / case["motion"]) as file:
        motion = json.load(file)
    return run(case, motion, settings)


def results(folder, numbers, settings, processes):
    """Returns the cases of a folder with their results in MuJoCo; runs those that are missing."""
    changed = [f"{key}-{value:g}" for key, value in settings.items() if value != SETTINGS[key]]
    kept = folder / ("_".join(["mujoco", *changed]) + ".jsonl")
    done = {}
    if kept.exists():
        done = {one["number"]: one for one in map(json.loads, kept.read_text().splitlines())}
    paths = {int(path.stem): path for path in sorted(folder.glob("[0-9]*.json"))}
    paths = {number: path for number, path in paths.items() if not numbers or number in numbers}
    missing = [(path, settings) for number, path in paths.items() if number not in done]
    with Pool(processes) as pool, kept.open("a") as file:
        for one in pool.imap_unordered(run_file, missing):
            done[one["number"]] = one
            print(json.dumps(one), file=file, flush=True)
    cases = {number: json.loads(path.read_text()) for number, path in paths.items()}
    return [(number, case, done[number]) for number, case in cases.items()]


def wilson(count, of, z=1.959964):
    """Returns Wilson's 95 % interval of a share."""
    share = count / of
    middle = (share + z * z / (2 * of)) / (1 + z * z / of)
    half = z / (1 + z * z / of) * math.sqrt(share * (1 - share) / of + z * z / (4 * of * of))
    return middle - half, middle + half


def mcnemar(one, other):
    """Returns the probability (two-sided, exact) that cases that differ are split so unevenly by chance."""
    many = one + other
    tail = sum(math.comb(many, k) for k in range(min(one, other) + 1)) / 2.0**many
    return min(1.0, 2.0 * tail)


def two_shares(one, other, of):
    """Returns the probability (two-sided) that two shares differ so much by chance, for independent cases."""
    pooled = (one + other) / (2 * of)
    if pooled in (0.0, 1.0):
        return 1.0
    z = (one - other) / of / math.sqrt(2.0 * pooled * (1.0 - pooled) / of)
    return math.erfc(abs(z) / math.sqrt(2.0))


def fell(one):
    """Returns whether a case fell."""
    return one["kind"] == "collapse"


def summarized(many, of):
    """Formats a share with its interval."""
    low, high = wilson(many, of)
    return f"{many} of {of}, {100 * many / of:.0f} % ({100 * low:.0f} to {100 * high:.0f})"


def middle(values, digits=1):
    """Formats a median."""
    return f"{np.median(values):.{digits}f}" if len(values) else "-"


def alone(of_one):
    """Summarizes the cases of one engine."""
    fallen = [one for one in of_one if fell(one)]
    firsts = [one["first"] for one in fallen]
    counts = sorted(((firsts.count(first), first) for first in set(firsts)), reverse=True)
    pace = sum(one["seconds"] for one in of_one) / sum(one["end_time"] for one in of_one)
    return (
        f"{summarized(len(fallen), len(of_one))}; first {', '.join(f'{first} {count}' for count, first in counts)}; "
        f"seat lost at {middle([one['time'] for one in fallen])} s, {middle([one['fallen'] for one in fallen], 0)} "
        f"barrels fall (medians); {1e3 * pace:.0f} ms for a second"
    )


def beside(pairs):
    """Prints a comparison of the cases of two engines."""
    both = [(a, b) for _, a, b in pairs if fell(a) and fell(b)]
    ours = [number for number, a, b in pairs if fell(a) and not fell(b)]
    theirs = [number for number, a, b in pairs if fell(b) and not fell(a)]
    many = len(both), len(ours), len(theirs), len(pairs) - len(both) - len(ours) - len(theirs)
    print(f"    both {many[0]}, only ours {many[1]} {ours}, only MuJoCo {many[2]} {theirs}, neither {many[3]}")
    shares = two_shares(many[0] + many[1], many[0] + many[2], len(pairs))
    print(f"    probability of such a split by chance (McNemar) {mcnemar(many[1], many[2]):.2g}, of such shares {shares:.2g}")
    if both:
        apart = np.array([b["time"] - a["time"] for a, b in both])
        same = sum(a["first"] == b["first"] for a, b in both)
        level = sum(a["first"][1] == b["first"][1] for a, b in both)
        print(
            f"    of those of both: the same first body in {same}, its level in {level}; MuJoCo later by "
            f"{np.median(apart):+.2f} s in the median, by less than 0.5 s in {sum(np.abs(apart) < 0.5)}; as many "
            f"barrels fall in {sum(a['fallen'] == b['fallen'] for a, b in both)}"
        )


def report(name, found):
    """Prints the results of the cases of a stack."""
    print(name)
    print(f"  MuJoCo: {alone([theirs for _, _, theirs in found])}")
    for title, key in (("as stated", "outcome"), ("with seats as in MuJoCo", "alike")):
        pairs = [(number, case[key], theirs) for number, case, theirs in found if key in case]
        if pairs:
            print(f"  ours {title}: {alone([ours for _, ours, _ in pairs])}")
            beside(pairs)
    moved = [theirs["drift"] for _, _, theirs in found if not fell(theirs)]
    apart = 1e3 * max(theirs["settled_by"] for _, _, theirs in found)
    print(
        f"  MuJoCo: rests within {apart:.2f} mm of ours; what stands has moved by "
        f"{middle(1e3 * np.array(moved), 2)} mm in the end (median), {1e3 * max(moved, default=0.0):.2f} at most"
    )


def main():
    """Runs the cases of every folder and prints the results."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("stacks", nargs="+", help="a name and a folder of cases, as `name=folder`")
    parser.add_argument("--set", action="append", default=[], help="a setting, as `step=0.00025`")
    parser.add_argument("--only", default="", help="numbers of cases, as `1,2,3`; all where it is left out")
    parser.add_argument("--processes", type=int, default=1)
    arguments = parser.parse_args()
    settings = dict(SETTINGS)
    for change in arguments.set:
        key, value = change.split("=")
        settings[key] = type(SETTINGS[key])(value)
    numbers = {int(number) for number in arguments.only.split(",") if number}
    for stack in arguments.stacks:
        name, _, folder = stack.rpartition("=")
        found = results(Path(folder), numbers, settings, arguments.processes)
        report(name or folder, found)


if __name__ == "__main__":
    main()
