"""RockBench adapter of MuJoCo: `pip install mujoco`.

Planar bodies get two slides and a hinge. MuJoCo has no coefficient of restitution: a contact that rebounds is a spring
and damper of the ratio that returns it (`solref` negative). A contact of a given stiffness is a very soft constraint.
"""

import json
import math
import sys
import time

import mujoco
import numpy as np


# Damping ratio of contacts that do not rebound, at a given step.
RATIO = 3


def damping_ratio(e):
    """ζ of max(0, k δ + c δ̇) that returns a share e of the speed."""
    low, high = 0.0, 0.999999
    for _ in range(60):
        z = (low + high) / 2
        value = math.exp(-2 * z * math.acos(z) / math.sqrt(1 - z * z))
        low, high = (z, high) if value > e else (low, z)
    return (low + high) / 2


def words(*numbers):
    return " ".join(repr(float(n)) for n in numbers)


def about_y(angle):
    """From x toward z is a turn about -y."""
    return (math.cos(angle / 2), 0, -math.sin(angle / 2), 0)


class Scene:
    def __init__(self, case):
        self.case, self.planar = case, case["space"] == "planar"
        self.free = [b for b in case["bodies"] if not b.get("fixed")]
        step = case.get("step")
        self.accurate = step is not None
        self.soft = all(law["normal"] != "rigid" for law in case["interfaces"])
        assets, bodies, pairs = [], [], []
        self.pairs, self.kinds = [], {}
        geoms = {}
        for body in case["bodies"]:
            name = body["name"]
            geoms[name] = []
            inside = ""
            for i, shape in enumerate(body["shapes"]):
                geom = f"{name}/{i}"
                geoms[name].append(geom)
                self.kinds[geom] = shape["type"]
                inside += self.geom(geom, shape, assets)
            if self.planar:
                x, z = body["position"]
                # Where its hinge is zero, a free body is upright; a fixed one is turned at once.
                pose = (f'pos="{words(x, 0, z)}" quat="{words(*about_y(body["angle"]))}"' if body.get("fixed")
                        else f'pos="{words(x, 0, z)}"')
                joints = (f'<joint name="{name}/x" type="slide" axis="1 0 0"/><joint name="{name}/z" type="slide" axis="0 0 1"/>'
                          f'<joint name="{name}/a" type="hinge" axis="0 -1 0"/>')
                inertia = [body.get("inertia", 1.0)] * 3
            else:
                pose = f'pos="{words(*body["position"])}" quat="{words(*body["orientation"])}"'
                joints = f'<freejoint name="{name}"/>'
                inertia = body.get("inertia", [1, 1, 1])
            if not body.get("fixed"):
                inside += joints
                inside += f'<inertial pos="0 0 0" mass="{words(body["mass"])}" diaginertia="{words(*inertia)}"/>'
            bodies.append(f'<body name="{name}" {pose}>{inside}</body>')
        every = case["bodies"]
        for i, a in enumerate(every):
            for b in every[i + 1:]:
                law = self.between(a["name"], b["name"])
                if a.get("fixed") and b.get("fixed") or law is None:
                    continue
                for g in geoms[a["name"]]:
                    for h in geoms[b["name"]]:
                        mu = law["friction"]
                        grip = f'condim="3" friction="{words(mu, mu, 0.005, 0.0001, 0.0001)}"' if mu > 0 else 'condim="1"'
                        pairs.append(f'<pair geom1="{g}" geom2="{h}" {grip}/>')
                        # A box of the plane touches with four corners in space, where the plane has two.
                        sharp = self.planar and not {self.kinds[g], self.kinds[h]} & {"disc"}
                        self.pairs.append((law, a["name"], b["name"], 0.5 if sharp else 1.0))
        # Defaults as they come: step of 2 ms, pyramidal cone, contacts with a time constant of ten steps.
        option = '<option><flag warmstart="enable"/></option>'
        if self.accurate:
            option = (f'<option timestep="{step!r}" cone="elliptic" impratio="{100 if self.soft else 10}" tolerance="1e-12" iterations="200"/>')
        xml = (f'<mujoco><compiler angle="radian" balanceinertia="true" boundmass="1e-9"/>{option}<asset>{"".join(assets)}</asset>'
               f'<worldbody>{"".join(bodies)}</worldbody><contact>{"".join(pairs)}</contact></mujoco>')
        self.model = mujoco.MjModel.from_xml_string(xml)
        self.data = mujoco.MjData(self.model)
        self.step = self.model.opt.timestep
        self.state_laws()
        self.start()

    def geom(self, name, shape, assets):
        at = shape.get("at", [0, 0])
        place = f'pos="{words(at[0], 0, at[1])}"' if self.planar else f'pos="{words(*shape.get("at", [0, 0, 0]))}"'
        kind = shape["type"]
        if kind == "halfspace":
            look = 'type="plane" size="0 0 1"'
        elif kind in ("disc", "sphere"):
            look = f'type="sphere" size="{words(shape["radius"])}"'
        elif kind == "box":
            size = shape["size"]
            size = (size[0], 1.0, size[1]) if self.planar else size
            look = f'type="box" size="{words(*(s / 2 for s in size))}"'
        elif kind == "cylinder":
            look = f'type="cylinder" size="{words(shape["radius"], shape["length"] / 2)}"'
        elif kind == "polygon":
            points = " ".join(words(x, y, z) for x, z in shape["corners"] for y in (-0.2, 0.2))
            assets.append(f'<mesh name="{name}" vertex="{points}"/>')
            look = f'type="mesh" mesh="{name}"'
        else:
            raise SystemExit(f"no shape {kind}")
        return f'<geom name="{name}" {look} {place} contype="0" conaffinity="0" mass="0"/>'

    def between(self, a, b):
        for law in self.case["interfaces"]:
            for x, y in ((a, b), (b, a)):
                if law["between"][0] in ("*", x) and law["between"][1] in ("*", y):
                    return law
        return None

    def state_laws(self):
        m = self.model
        for i, (law, a, b, share) in enumerate(self.pairs):
            if law["normal"] == "rigid":
                e = law["restitution"]
                if e > 0:
                    frequency = 0.15 / self.step
                    m.pair_solref[i] = [-frequency**2, -2 * damping_ratio(e) * frequency]
                    m.pair_solimp[i] = [0.999, 0.999, 0.001, 0.5, 2]
                elif self.accurate:
                    # A critically damped contact returns a seventh of the speed.
                    m.pair_solref[i] = [10 * self.step, RATIO]
            else:
                weight = share * sum(m.body_invweight0[m.body(n).id, 0] for n in (a, b))
                m.pair_solref[i] = [-law["normal"]["stiffness"] * weight, -law["normal"]["damping"] * weight]
                m.pair_solimp[i] = [0.0001, 0.0001, 0.001, 0.5, 2]

    def start(self):
        m, d = self.model, self.data
        for body in self.free:
            name = body["name"]
            if self.planar:
                d.qpos[m.joint(f"{name}/a").qposadr[0]] = body["angle"]
                for axis, value in zip(("x", "z", "a"), (*body["velocity"], body["spin"])):
                    d.qvel[m.joint(f"{name}/{axis}").dofadr[0]] = value
            else:
                k = m.joint(name).dofadr[0]
                d.qvel[k:k + 3] = body["velocity"]
                turn = np.zeros(9)
                mujoco.mju_quat2Mat(turn, np.array(body["orientation"], float))
                # The spin of a free joint is in the frame of the body.
                d.qvel[k + 3:k + 6] = turn.reshape(3, 3).T @ np.array(body["spin"], float)
        mujoco.mj_forward(m, d)

    def row(self):
        m, d = self.model, self.data
        rows = []
        for body in self.free:
            name = body["name"]
            if self.planar:
                x, z = body["position"]
                k = [m.joint(f"{name}/{axis}") for axis in "xza"]
                q = [float(d.qpos[j.qposadr[0]]) for j in k]
                v = [float(d.qvel[j.dofadr[0]]) for j in k]
                rows.append([x + q[0], z + q[1], q[2], *v])
            else:
                j = m.joint(name)
                q = d.qpos[j.qposadr[0]:j.qposadr[0] + 7]
                v = d.qvel[j.dofadr[0]:j.dofadr[0] + 6]
                turn = np.zeros(9)
                mujoco.mju_quat2Mat(turn, q[3:7])
                spin = turn.reshape(3, 3) @ v[3:6]
                rows.append([float(c) for c in (*q, *v[:3], *spin)])
        return rows

    def forces(self):
        m, d = self.model, self.data
        paired = self.case.get("forces", [])
        found = [0.0] * len(paired)
        if paired:
            force = np.zeros(6)
            for i in range(d.ncon):
                names = {m.body(m.geom_bodyid[g]).name for g in d.contact[i].geom}
                for k, pair in enumerate(paired):
                    if names == set(pair):
                        mujoco.mj_contactForce(m, d, i, force)
                        found[k] += float(force[0])
        return found


def main():
    case = json.load(sys.stdin)
    scene = Scene(case)
    model, data = scene.model, scene.data
    gravity = np.array(case["gravity"] if not scene.planar else [case["gravity"][0], 0, case["gravity"][1]], float)
    ground = case.get("ground")
    if ground:
        knots = np.array(ground["time"])
        columns = np.array(ground["acceleration"], float).T
        if scene.planar:
            columns = np.array([columns[0], 0 * columns[0], columns[1]])
    model.opt.gravity[:] = gravity
    times, states, forces = [0.0], [scene.row()], [scene.forces()]
    steps = round(case["duration"] / scene.step)
    spent = 0.0
    begun = time.process_time()
    for n in range(1, steps + 1):
        if ground:
            # In the frame of the ground: gravity less its acceleration, at the middle of the step.
            t = (n - 0.5) * scene.step
            model.opt.gravity[:] = gravity - [np.interp(t, knots, c) for c in columns]
        mujoco.mj_step(model, data)
        if n * scene.step > len(times) * case["sample"] - scene.step / 2:
            spent += time.process_time() - begun
            times.append(n * scene.step)
            states.append(scene.row())
            forces.append(scene.forces())
            begun = time.process_time()
    spent += time.process_time() - begun
    json.dump({"engine": "MuJoCo", "version": mujoco.__version__, "step": scene.step, "cpu_seconds": spent,
               "bodies": [b["name"] for b in scene.free], "times": times, "states": states, "forces": forces}, sys.stdout)


main()
