"""Runs a room in MuJoCo, with the bodies, laws and motion that `rooms.py` states.

Bodies within a stack touch as `validation/mujoco/compare.py` describes. Bodies of different stacks touch with the laws
of fallen bodies; MuJoCo finds these contacts itself, so that their constants belong to the solids, not to the pairs.
"""

import sys
import time
from pathlib import Path

import mujoco
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "validation" / "mujoco"))
import compare  # noqa: E402

SETTINGS = compare.SETTINGS | {"around": 120, "along": 41, "chime": 3}
# Interval (s) between two checks of lost seats.
LOOK = 4e-3


def describe(case, settings):
    """Describes the model of a room."""
    spec = compare.describe(case, settings)
    laws = case["interfaces"]
    d = settings["impedance"]
    bodies = {body["name"]: body for body in case["bodies"]}
    stack_of = {stack["name"]: number for number, stack in enumerate(case["stacks"])}
    everyone = 2 ** len(stack_of) - 1
    for geom in spec.geoms:
        if geom.name == "floor":
            continue
        name = geom.name.rsplit("/", 1)[0]
        body, bit = bodies[name], 1 << stack_of[name.split("/")[0]]
        geom.contype, geom.conaffinity = bit, everyone - bit
        barrel = body["kind"] == "barrel"
        law = laws[2 if barrel else 6]
        # Of a barrel and a rack, the rack gives the law.
        geom.priority = 0 if barrel else 1
        inverse = 2.0 / body["mass"]
        stiffness, damping = compare.spring_and_damper(law["normal"], 1.0 / inverse, settings)
        own = max(d, 2.0 * damping * inverse * settings["step"])
        scale = (1.0 - own) * inverse
        geom.condim = 3
        geom.friction = [law["friction"], 0.0, 0.0]
        geom.solref = [-stiffness * scale, -damping * scale]
        geom.solimp = [own, own, 0.001, 0.5, 2]
    return spec


class Watch:
    """First loss of seat, and first contact with another stack, of every stack."""

    def __init__(self, case, model, places, turns):
        self.stacks = case["stacks"]
        self.slices, self.fates = [], []
        owner = np.full(len(case["bodies"]), -1)
        for number, stack in enumerate(self.stacks):
            own = slice(stack["first"], stack["first"] + len(stack["bodies"]) - 1)
            owner[own] = number
            self.slices.append(own)
            self.fates.append(compare.Fates(stack, *self.of(own, places, turns)))
        self.owner = owner[model.geom_bodyid]
        self.names = [body["name"] for body in case["bodies"]]
        self.body = model.geom_bodyid
        self.touched = [None] * len(self.stacks)

    def of(self, own, places, turns):
        """Returns the places and rotations of the ground and the bodies of a stack."""
        return np.concatenate([places[:1], places[own]]), np.concatenate([turns[:1], turns[own]])

    def meet(self, now, data):
        """Updates first contacts."""
        contact = data.contact
        if data.ncon == 0:
            return
        pairs = contact.geom
        sides = self.owner[pairs]
        between = (sides[:, 0] != sides[:, 1]) & (sides.min(axis=1) >= 0) & (contact.dist < 0.0)
        for at in np.flatnonzero(between):
            for side in (0, 1):
                stack = sides[at, side]
                if self.touched[stack] is None:
                    ends = [self.names[self.body[pairs[at, end]]] for end in (side, 1 - side)]
                    self.touched[stack] = (now, *ends)

    def look(self, now, places, turns):
        """Updates losses of seat; returns whether all stacks have lost one."""
        for own, fates in zip(self.slices, self.fates):
            if fates.collapse is None:
                fates.observe(now, *self.of(own, places, turns))
        return all(fates.collapse for fates in self.fates)


def pushes_of(velocity, step, end):
    """Returns the ground acceleration in every step, such that the velocity is exact at the ends of steps."""
    times = step * np.arange(round(end / step) + 1)
    return np.diff(velocity(times), axis=0) / step


def run(case, velocity, duration, settings, to_the_end=False):
    """Runs a room; `velocity` returns the velocity of the ground at times (s), and `None` leaves it at rest."""
    model = describe(case, settings).compile()
    data = mujoco.MjData(model)
    step = settings["step"]
    still = np.zeros((round(duration / step), 3))
    pushes = still if velocity is None else pushes_of(velocity, step, duration)
    down = np.array([0.0, 0.0, -case["gravity"]])
    places, turns = data.xpos, data.xmat.reshape(-1, 3, 3)
    start = time.process_time()
    for _ in range(round(settings["settle"] / step)):
        mujoco.mj_step(model, data)
    watch = Watch(case, model, places, turns)
    first = places.copy()
    every = max(1, round(LOOK / step))
    for at, push in enumerate(pushes):
        model.opt.gravity[:] = down - push
        mujoco.mj_step(model, data)
        watch.meet(at * step, data)
        if at % every == 0 and watch.look(at * step, places, turns) and not to_the_end:
            break
    seconds = time.process_time() - start
    stacks = []
    for stack, fates, touch in zip(watch.stacks, watch.fates, watch.touched):
        lost = fates.collapse and fates.collapse[0]
        knocked = lost is not None and touch is not None and touch[0] <= lost
        stacks.append(
            {
                "name": stack["name"],
                "fate": "stands" if lost is None else "knocked-over" if knocked else "falls-by-itself",
                "falls_at": lost,
                "first": lost and stack["bodies"][fates.collapse[1]]["name"],
                "how": lost and fates.collapse[2],
                "touched_at": touch and touch[0],
                "bodies": touch and touch[1:],
            }
        )
    settled = np.array([body["position"] for body in case["bodies"][1:]])
    return {
        "number": case["number"],
        "broken": compare.lost_numbers(data),
        "stacks": stacks,
        "floor_force": floor_force(model, data),
        "drift": float(np.linalg.norm(places[1:] - first[1:], axis=1).max()),
        "settled_by": float(np.linalg.norm(first[1:] - settled, axis=1).max()),
        "end_time": (at + 1) * step,
        "seconds": seconds,
    }


def floor_force(model, data):
    """Returns the vertical force (N) on the floor."""
    total, force = 0.0, np.zeros(6)
    floor = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_GEOM, "floor")
    for at in range(data.ncon):
        contact = data.contact[at]
        if floor in contact.geom:
            mujoco.mj_contactForce(model, data, at, force)
            normal = contact.frame[:3] * (1.0 if contact.geom[0] == floor else -1.0)
            total += float(normal[2] * force[0])
    return total
