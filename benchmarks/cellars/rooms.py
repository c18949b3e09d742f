"""Draws rooms of two and three stacks, runs them with barrelstack, and states their bodies for another engine.

Every room is a folder: `room.toml`, the records, the answer of barrelstack, and `case.json` with the bodies at rest and
the contact laws, in the form of `crates/space/examples/cases.rs`. All values are in SI units.
"""

import csv
import json
import math
import random
import re
import resource
import subprocess

import numpy as np
import tomllib

# Part (s) of the processed record of Napa College that shakes the rooms.
STRONG = (3.0, 16.0)
# Time (s) over which the ends of that part are tapered.
TAPER = 0.5
# Simulated time (s) of a room.
DURATION = 14.0
SAMPLE = 0.005
# Constants of `crates/stack/src/assemble`: radius of bars (m), and distance (m) of the ends of beams from their lines.
BAR_RADIUS, TUBE_CORNER, CHIME_RADIUS = 0.015, 0.012, 0.01
# Footprint (m) of a stack, across and along its barrels.
FOOTPRINT = (1.499, 0.945)
# Seats as in MuJoCo: as good as no elastic stick, and a damper that acts in both directions.
ALIKE = ("law='kelvin-voigt'", "friction.tangential_stiffness_ratio=100", "friction.tangential_damping_ratio=20")


def draw(seed, count):
    """Returns the parameters of rooms; every fifth is shaken by a pulse."""
    random_numbers = random.Random(seed)
    uniform = random_numbers.uniform
    rooms = []
    for number in range(1, count + 1):
        stacks = random_numbers.choice([2, 3])
        room = {
            "number": number,
            "across": random_numbers.random() < 0.7,
            "spacing": round(math.exp(uniform(math.log(0.03), math.log(0.6))), 3),
            "levels": random_numbers.choices([2, 3, 4, 5], weights=[35, 30, 20, 15], k=stacks),
            "friction": round(uniform(0.25, 0.45), 3),
            "factor": round(uniform(0.6, 1.6), 3),
            "pulse": None,
        }
        pulse = {"peak": uniform(0.5, 1.0), "period": uniform(0.9, 1.6), "azimuth": uniform(0.0, 180.0)}
        if number % 5 == 0:
            room |= {"pulse": {key: round(value, 3) for key, value in pulse.items()}, "factor": 1.0}
        rooms.append(room)
    return rooms


def strong_part(program, folder):
    """Returns the accelerations (m/s²) of the strong part of Napa College, east, north and up, which end at rest."""
    whole = folder / "napa-college.txt"
    if not whole.exists():
        call(program, folder, ["motion", "process", "napa-college-2014", "--chain", "default", "--output", whole.name])
    samples = np.array([[float(x) for x in line.split()] for line in whole.read_text().splitlines() if line[0] != "#"])
    first, last = (round(time / SAMPLE) for time in STRONG)
    part = samples[first : last + 1].copy()
    ramp = 0.5 - 0.5 * np.cos(np.pi * np.arange(round(TAPER / SAMPLE)) / round(TAPER / SAMPLE))
    part[: len(ramp)] *= ramp[:, None]
    part[-len(ramp) :] *= ramp[::-1, None]
    window = np.sin(np.pi * np.arange(len(part)) / (len(part) - 1)) ** 2
    return part - np.outer(window / np.trapezoid(window), np.trapezoid(part, axis=0))


def pulse_of(peak, period, azimuth):
    """Returns a pulse of Mavroeidis and Papageorgiou (2003) of two cycles, east and north, as accelerations (m/s²)."""
    gamma, start = 2.0, 1.0
    times = SAMPLE * np.arange(round((start + gamma * period + 1.0) / SAMPLE) + 1)
    at = times - start - 0.5 * gamma * period
    rate = 2.0 * math.pi / period
    velocity = 0.5 * peak * (1.0 + np.cos(rate * at / gamma)) * np.sin(rate * at)
    velocity[np.abs(at) > 0.5 * gamma * period] = 0.0
    acceleration = np.gradient(velocity, SAMPLE)
    acceleration -= np.trapezoid(acceleration) / len(acceleration)
    turn = math.radians(azimuth)
    return np.outer(acceleration, [math.sin(turn), math.cos(turn)])


def write_record(path, samples):
    """Writes accelerations in the plain text form of barrelstack."""
    names = ["E az=90", "N az=0", "Up vertical"][: samples.shape[1]]
    head = ["# barrelstack motion 1", "# stage: corrected", "# unit: m/s2", f"# time_step: {SAMPLE}"]
    lines = [" ".join(repr(float(x)) for x in row) for row in samples]
    path.write_text("\n".join([*head, f"# channels: {', '.join(names)}", *lines]) + "\n")


def velocities(samples, times):
    """Returns velocities (m/s) at times (s), from accelerations that are linear between samples."""
    sums = np.vstack([np.zeros(3), np.cumsum(0.5 * SAMPLE * (samples[1:] + samples[:-1]), axis=0)])
    at = np.minimum((times / SAMPLE + 1e-9).astype(int), len(samples) - 2)
    within = np.minimum(times - SAMPLE * at, SAMPLE)[:, None]
    slope = (samples[at + 1] - samples[at]) / SAMPLE
    return sums[at] + within * (samples[at] + 0.5 * within * slope)


def common_tables(room, seed, moves=True):
    """Returns the tables that a room and its stacks share, as TOML."""
    vertical = "" if room["pulse"] else '\nvertical = "Up"'
    motion = f'record = "motion.txt"\nprocessing = "none"\ncomponent = "E"{vertical}\nscale.factor = {room["factor"]}'
    return f"""[motion]
{motion if moves else "none = true"}
[interface.barrel-rack.friction]
coefficient = {room["friction"]}
[imperfections]
variants = 1
until = "rest"
seed = {seed}
[unknowns]
drawn = false
[record]
frame_rate = "{20 if moves else 1} Hz"
"""


def write_room(folder, room, moves=True, duration=DURATION):
    """Writes the file of a room, whose stacks stand in a row across or along their barrels."""
    text = f"""schema = 1
kind = "cellar"
extends = "demo-napa"
title = "Room {room["number"]}"
[room]
length = "30 m"
width = "30 m"
walls = false
"""
    for at, levels in enumerate(room["levels"]):
        place = [12.0, 12.0]
        axis = 0 if room["across"] else 1
        place[axis] += at * (FOOTPRINT[axis] + room["spacing"])
        text += f'[[block]]\nfirst = ["{place[0]:.6f} m", "{place[1]:.6f} m"]\nlevels = {levels}\n'
    text += f'[run]\nduration = "{duration} s"\n' + common_tables(room, room["number"], moves)
    (folder / "room.toml").write_text(text)


def call(program, folder, arguments):
    """Runs barrelstack in a folder and returns its output."""
    done = subprocess.run([program, *arguments], cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode:
        raise RuntimeError(f"{folder}: {done.stderr}")
    return done.stdout


def run_room(program, folder, name, changes=()):
    """Runs a room with barrelstack and returns its answer, with the processor time (s)."""
    kept = folder / f"{name}.json"
    if not kept.exists():
        sets = [part for change in changes for part in ("--set", change)]
        before = children_time()
        output = call(program, folder, ["run", "room.toml", "--variants", "1", "--quiet", "--json", *sets])
        answer = json.loads(output) | {"seconds": children_time() - before}
        kept.write_text(json.dumps(answer))
    return json.loads(kept.read_text())


def children_time():
    """Returns the processor time (s) of all finished child processes."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def fnv1a(text):
    """Returns the 64-bit FNV-1a hash of a text."""
    value = 0xCBF29CE484222325
    for byte in text.encode():
        value = ((value ^ byte) * 0x100000001B3) % 2**64
    return value


def run_alone(program, folder, room, stack, levels, moves=False, duration=0.002):
    """Runs a stack of a room by itself, with the imperfections that it has in the room; returns the output folder."""
    mixed = fnv1a(f"{room['number']} {stack}")
    seed = (mixed >> 32) ^ (mixed & 0xFFFFFFFF)
    out = folder / f"{'moved' if moves else 'alone'}-{stack}"
    if not (out / "summary.json").exists():
        text = 'schema = 1\nextends = "demo-napa"\n[stack]\nview = "spatial"\n'
        text += f'levels = {levels}\n[run]\nduration = "{duration} s"\n' + common_tables(room, seed, moves)
        (folder / "alone.toml").write_text(text)
        choices = ["--variant", "1", "--no-remedy", "--quiet", "--overwrite"]
        call(program, folder, ["run", "alone.toml", *choices, "--out", out.name])
    return out


def number_of(text):
    """Returns the number of a quantity that is written in SI units, such as `"0.945 m"`."""
    return float(str(text).split()[0])


def revolved(half, outer, inner):
    """Returns volume, axial and transverse second moments of a body of revolution, by Simpson's rule."""
    x = np.linspace(0.0, half, 201)
    weight = np.array([1.0] + [4.0, 2.0] * 99 + [4.0, 1.0]) * (half / 200.0) * (2.0 / 3.0)
    out, within = outer(x) ** 2, inner(x) ** 2
    area, second = math.pi * (out - within), math.pi * (out**2 - within**2)
    return np.array([weight @ area, weight @ (0.5 * second), weight @ (0.25 * second + area * x**2)])


def barrel_inertia(barrel, mass):
    """Returns the axial and transverse moments of inertia (kg·m²) of a barrel full of wine with a mass (kg).

    The formulas are those of `crates/stack/src/scenario/barrel.rs`.
    """
    length, bilge, head, wall = (
        barrel[key] for key in ("length", "bilge_diameter", "head_diameter", "stave_thickness")
    )

    def outer(x):
        return 0.5 * (bilge - (bilge - head) * np.clip(2.0 * x / length, -1.0, 1.0) ** 2)

    def inner(x):
        return np.maximum(outer(x) - wall, 0.0)

    def none(x):
        return 0.0 * x

    low, high = 0.0, 0.5 * length - wall
    if revolved(high, inner, none)[0] <= barrel["capacity"]:
        low = high
    else:
        for _ in range(60):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if revolved(middle, inner, none)[0] < barrel["capacity"] else (low, middle)
    room = 0.5 * (low + high)
    square = float(inner(room)) ** 2
    lid, place = square * math.pi * wall, room + 0.5 * wall
    of_lid = np.array([1.0, 0.5 * square, 0.25 * square + wall**2 / 12.0 + place**2])
    wood = revolved(0.5 * length, outer, inner) + 2.0 * lid * of_lid
    wine = revolved(room, inner, none)
    wine *= (mass - barrel["empty_mass"]) / wine[0]
    wood *= barrel["empty_mass"] / wood[0]
    lag = wine[2] - wine[1]
    # Half a Stokes layer at 1 Hz turns with the wood.
    layer = math.sqrt(1.6e-6 / math.pi)
    around = [2.0 * math.pi * float(inner(x)) ** 3 for x in (room, 0.5 * room, 0.0)]
    staves = room / 3.0 * (around[0] + 4.0 * around[1] + around[2])
    density = (mass - barrel["empty_mass"]) / revolved(room, inner, none)[0]
    turning = density * 0.5 * layer * (staves + math.pi * square**2)
    return wood[1] + turning, wood[2] + lag**2 / wine[2]


def homogeneous(solid, mass):
    """Returns the axial and transverse moments of inertia (kg·m²) of a homogeneous barrel."""
    half, arc = solid["half_length"] + solid["rounding"], solid["stave_radius"] + solid["rounding"]

    def outer(x):
        chime = solid["head_radius"] + np.sqrt(
            np.maximum(solid["rounding"] ** 2 - (x - solid["half_length"]) ** 2, 0.0)
        )
        return np.where(x < solid["half_length"], np.sqrt(arc**2 - x**2) - solid["stave_offset"], chime)

    volume, axial, transverse = revolved(half, outer, lambda x: 0.0 * x)
    return mass * axial / volume, mass * transverse / volume


def barrel_solid(barrel):
    """Returns the core of a barrel and the rounding around it, as in `crates/dynamics/src/solid/barrel.rs`."""
    half, rise = 0.5 * barrel["length"], 0.5 * (barrel["bilge_diameter"] - barrel["head_diameter"])
    arc = (half * half + rise * rise) / (2.0 * rise)
    core, inside = arc - CHIME_RADIUS, half - CHIME_RADIUS
    offset = arc - 0.5 * barrel["bilge_diameter"]
    return {
        "kind": "barrel",
        "half_length": inside,
        "head_radius": math.sqrt(core**2 - inside**2) - offset,
        "stave_radius": core,
        "stave_offset": offset,
        "rounding": CHIME_RADIUS,
        "center": [0.0, 0.0, 0.0],
        "matrix": np.eye(3).tolist(),
    }


ALONG_X = np.eye(3)
ALONG_Y = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
UPRIGHT = np.array([[0.0, 0.0, -1.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]])


def rack_tubes(rack, solid):
    """Returns the tubes of a rack as in `crates/space/src/rack.rs`, each with its role."""

    def around(distance):
        arc = solid["stave_radius"] + solid["rounding"] + distance
        return math.sqrt(arc**2 - rack["rail_half_spacing"] ** 2) - solid["stave_offset"]

    beam, half = 0.5 * rack["beam_height"], 0.5 * rack["width"] - TUBE_CORNER
    axis = rack["clearance"] + around(0.0)
    away, tubes = around(BAR_RADIUS), []
    for side in (-1.0, 1.0):
        y = side * rack["rail_half_spacing"]
        tubes.append(("beam", half, beam, np.array([0.0, y, beam]), ALONG_X))
        for column in (0, 1):
            for support in (-1.0, 1.0):
                top = axis - math.cos(rack["angle"]) * away
                foot = min(rack["beam_height"], top)
                x = (column - 0.5) * rack["pitch"] + support * math.sin(rack["angle"]) * away
                center = np.array([x, y, 0.5 * (top + foot)])
                tubes.append((column, 0.5 * (top - foot), BAR_RADIUS, center, UPRIGHT))
    for side in (-1.0, 1.0):
        center = np.array([side * half, 0.0, rack["beam_height"]])
        tubes.append((None, rack["rail_half_spacing"], BAR_RADIUS, center, ALONG_Y))
    return tubes


def rack_bulk(tubes, mass):
    """Returns the center of mass (m) and the principal moments of inertia (kg·m²) of a rack of thin-walled tubes."""
    weights = np.array([(2.0 * half + radius) * radius for _, half, radius, _, _ in tubes])
    masses = mass * weights / weights.sum()
    center = sum(m * tube[3] for m, tube in zip(masses, tubes)) / mass
    second = np.zeros((3, 3))
    for m, (_, half, radius, place, turn) in zip(masses, tubes):
        own = m * np.diag([half**2 / 3.0, 0.5 * radius**2, 0.5 * radius**2])
        arm = place - center
        second += turn @ own @ turn.T + m * np.outer(arm, arm)
    assert np.abs(second - np.diag(np.diag(second))).max() < 1e-12
    x, y, z = np.diag(second)
    return center, [y + z, z + x, x + y]


def speed_gap_damping(stiffness, restitution, mass):
    """Returns the damping (N·s/m) that gives a restitution, as in `crates/dynamics/src/contact/restitution.rs`."""
    low, high = 0.0, 1.0
    for _ in range(200):
        zeta = 0.5 * (low + high)
        found = math.exp(-zeta * math.acos(zeta) / math.sqrt(1.0 - zeta * zeta))
        low, high = (zeta, high) if found > restitution else (low, zeta)
    return 2.0 * low * math.sqrt(stiffness * mass)


def law_of(stated):
    """Returns a contact law in the form of the example `cases`."""
    stiffness = number_of(stated["stiffness"])
    if stated["law"] == "speed-gap":
        damping = speed_gap_damping(stiffness, stated["restitution"], number_of(stated["reference_mass"]))
        normal = {"kind": "speed-gap", "stiffness": stiffness, "damping": damping}
    else:
        assert stated["law"] == "rebound"
        normal = {"kind": "rebound", "stiffness": stiffness, "restitution": stated["restitution"]}
    return {"normal": normal, "friction": stated["friction"]["coefficient"]}


LAWS = (
    "rack-ground",
    "barrel-rack",
    "barrel-barrel",
    "barrel-ground",
    "fallen-barrel-rack",
    "fallen-rack-ground",
    "fallen-rack-rack",
)


def stack_bodies(out, name, at):
    """Returns the bodies of a stack at rest with their pairs of solids, and the scenario, from the output of a run.

    Masses follow from the vertical forces at rest, since every body is in equilibrium.
    """
    scenario = tomllib.loads((out / "scenario.toml").read_text())
    summary = json.loads((out / "summary.json").read_text())
    with (out / "frames.csv").open() as file:
        rows = csv.reader(file)
        columns, first = next(rows), next(rows)
    state = dict(zip([column.removesuffix(" (m)") for column in columns], first))
    gravity = number_of(scenario["run"]["gravity"])
    stack = scenario["stack"]
    barrel = {key: number_of(value) for key, value in stack["barrel"].items() if key not in ("base", "fill")}
    assert stack["barrel"]["fill"] == "full-fluid" and stack["rack"]["base"] == "two-barrel"
    kept = ("width", "pitch", "rail_half_spacing", "clearance", "beam_height")
    rack = {key: number_of(stack["rack"][key]) for key in kept}
    rack["angle"] = number_of(stack["rack"]["cradle"]["angle"])
    solid, bodies = barrel_solid(barrel), []
    tubes = rack_tubes(rack, solid)
    names = [body["name"] for body in summary["bodies"]]
    carried = {own: 0.0 for own in names}
    for force in summary["interfaces"]:
        upper, lower = re.fullmatch(r"(\S+) on (\S+)", force["name"]).groups()
        carried[upper] += force["at_rest"]
        if lower != "ground":
            carried[lower] -= force["at_rest"]
    for own in names:
        mass = carried[own] / gravity
        place = [float(state[f"{own}_{axis}"]) for axis in "xyz"]
        body = {
            "name": f"{name}/{own}",
            "mass": mass,
            "position": [place[0] + at[0], place[1] + at[1], place[2]],
            "quaternion": [float(state[f"{own}_q{part}"]) for part in "wxyz"],
            "carrier": None,
            "supports": [],
        }
        level = int(own[1:].split(".")[0])
        if own[0] == "B":
            axial, across = barrel_inertia(barrel, mass)
            size = 0.5 * barrel["section_diameter"]
            body |= {"kind": "barrel", "inertia": [axial, across, across], "solids": [solid], "size": size}
            body["carrier"] = names.index(f"R{level}")
        else:
            center, inertia = rack_bulk(tubes, mass)
            solids = [
                {
                    "kind": "capsule",
                    "half_length": half,
                    "radius": radius,
                    "center": (middle - center).tolist(),
                    "matrix": turn.tolist(),
                }
                for _, half, radius, middle, turn in tubes
            ]
            body |= {"kind": "rack", "inertia": inertia, "solids": solids, "size": 0.5 * rack["width"]}
            body["supports"] = [i for i, other in enumerate(names) if other.startswith(f"B{level - 1}.")]
        bodies.append(body)
    friction = scenario["interface"]["barrel-rack"]["friction"]["coefficient"]
    bearing = 0.5 * (rack["width"] - rack["pitch"])
    reach = [
        bearing + 0.5 * barrel["section_diameter"] * math.sin(math.atan(friction)),
        0.5 * barrel["length"] - rack["rail_half_spacing"],
    ]
    return bodies, seats(bodies, tubes), scenario, reach


def seats(bodies, tubes):
    """Returns all pairs of solids of a stack, each with its law; bodies count from 0, and the ground is -1."""
    pairs = []

    def meet(a, b, law):
        for tube in range(len(bodies[a]["solids"])):
            for surface in range(1 if b < 0 else len(bodies[b]["solids"])):
                pairs.append([a, tube, b, surface, LAWS.index(law(tube))])

    def on_ground(a):
        def law(tube):
            if bodies[a]["kind"] == "barrel":
                return "barrel-ground"
            stands = tubes[tube][0] == "beam" and not bodies[a]["supports"]
            return "rack-ground" if stands else "fallen-rack-ground"

        return law

    def on_rack(rack, barrel):
        column = (
            [i for i, body in enumerate(bodies) if body["carrier"] == rack].index(barrel)
            if (bodies[barrel]["carrier"] == rack)
            else None
        )
        below = barrel in bodies[rack]["supports"]

        def law(tube):
            role = tubes[tube][0]
            carries = column is not None and role == column
            return "barrel-rack" if carries or (below and role == "beam") else "fallen-barrel-rack"

        return law

    for a in range(len(bodies)):
        meet(a, -1, on_ground(a))
        for b in range(a + 1, len(bodies)):
            kinds = bodies[a]["kind"], bodies[b]["kind"]
            if kinds == ("rack", "barrel"):
                meet(a, b, on_rack(a, b))
            elif kinds == ("barrel", "rack"):
                meet(b, a, on_rack(b, a))
            else:
                meet(a, b, lambda _, kinds=kinds: "barrel-barrel" if kinds[0] == "barrel" else "fallen-rack-rack")
    return pairs


def case_of(program, folder, room, answer):
    """Returns the bodies, laws and pairs of a room at rest, with one sub-case for each stack."""
    kept = folder / "case.json"
    if not kept.exists():
        ground = {"name": "ground", "kind": "ground", "solids": []}
        bodies, pairs, stacks = [ground], [], []
        for stack, levels in zip(answer["stacks"], room["levels"]):
            out = run_alone(program, folder, room, stack["name"], levels)
            own, joined, scenario, reach = stack_bodies(out, stack["name"], stack["at"])
            first = len(bodies)
            moved = [
                body
                | {
                    "carrier": None if body["carrier"] is None else body["carrier"] + 1,
                    "supports": [support + 1 for support in body["supports"]],
                }
                for body in own
            ]
            stacks.append(
                {
                    "name": stack["name"],
                    "first": first,
                    "bodies": [ground, *moved],
                    "reach": reach,
                    "thresholds": {key: number_of(value) for key, value in scenario["outcome"].items()},
                }
            )
            bodies.extend(own)
            pairs.extend([a + first, tube, b + first if b >= 0 else 0, of, law] for a, tube, b, of, law in joined)
        interfaces = [law_of(scenario["interface"][name]) for name in LAWS]
        case = {
            "number": room["number"],
            "gravity": number_of(scenario["run"]["gravity"]),
            "interfaces": interfaces,
            "bodies": bodies,
            "pairs": pairs,
            "stacks": stacks,
        }
        kept.write_text(json.dumps(case))
    return json.loads(kept.read_text())
