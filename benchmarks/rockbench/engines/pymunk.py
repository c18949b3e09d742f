"""RockBench adapter of pymunk (Chipmunk): `pip install pymunk`.

A half-plane is a box of 200 m. Friction and elasticity of a pair are the products of both shapes'. pymunk has no step
of its own; its documentation's examples take 1/60 s.
"""

import json
import math
import sys
import time

import pymunk


def cannot(why):
    json.dump({"engine": "pymunk", "version": pymunk.version, "cannot": [{"what": "case", "why": why}]}, sys.stdout)
    sys.exit()


def between(case, a, b):
    for law in case["interfaces"]:
        for x, y in ((a, b), (b, a)):
            if law["between"][0] in ("*", x) and law["between"][1] in ("*", y):
                return law
    return None


def interpolate(times, values, t):
    if t >= times[-1]:
        return values[-1]
    low, high = 0, len(times) - 1
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (middle, high) if times[middle] <= t else (low, middle)
    share = (t - times[low]) / (times[high] - times[low])
    return [a + share * (b - a) for a, b in zip(values[low], values[high])]


def main():
    case = json.load(sys.stdin)
    if case["space"] != "planar":
        cannot("bodies in space")
    if any(law["normal"] != "rigid" for law in case["interfaces"]):
        cannot("the stiffness of a contact")
    step = case.get("step", 1 / 60)
    space = pymunk.Space()
    if "step" in case:
        space.iterations = 50
        space.collision_slop = 1e-4
        space.collision_bias = 0.0
    names, bodies, moving = {}, {}, {}
    for spec in case["bodies"]:
        fixed = spec.get("fixed", False)
        body = pymunk.Body(body_type=pymunk.Body.STATIC) if fixed else pymunk.Body(spec["mass"], spec["inertia"])
        body.position, body.angle = tuple(spec["position"]), spec.get("angle", 0.0)
        if not fixed:
            body.velocity, body.angular_velocity = tuple(spec["velocity"]), spec["spin"]
            moving[spec["name"]] = body
        shapes = []
        for shape in spec["shapes"]:
            x, z = shape.get("at", (0, 0))
            if shape["type"] == "halfspace":
                corners = [(-100, -20), (100, -20), (100, 0), (-100, 0)]
            elif shape["type"] == "box":
                w, h = (s / 2 for s in shape["size"])
                corners = [(x - w, z - h), (x + w, z - h), (x + w, z + h), (x - w, z + h)]
            elif shape["type"] == "polygon":
                corners = [(x + a, z + b) for a, b in shape["corners"]]
            if shape["type"] == "disc":
                shapes.append(pymunk.Circle(body, shape["radius"], (x, z)))
            else:
                shapes.append(pymunk.Poly(body, corners))
        for shape in shapes:
            names[shape] = spec["name"]
        bodies[spec["name"]] = body
        space.add(body, *shapes)

    def meet(arbiter, space, data):
        a, b = (names[s] for s in arbiter.shapes)
        law = between(case, a, b)
        if law is None:
            arbiter.process_collision = False
            return
        arbiter.friction, arbiter.restitution = law["friction"], law["restitution"]
    wanted = [tuple(sorted(p)) for p in case.get("forces", [])]
    impulses = {}

    def after(arbiter, space, data):
        pair = tuple(sorted(names[s] for s in arbiter.shapes))
        if pair in wanted:
            normal = arbiter.normal
            j = arbiter.total_impulse
            impulses[pair] = impulses.get(pair, 0.0) + abs(j[0] * normal[0] + j[1] * normal[1])
    space.on_collision(pre_solve=meet, post_solve=after)

    def row():
        return [[*b.position, b.angle, *b.velocity, b.angular_velocity] for b in moving.values()]
    ground = case.get("ground")
    times, states, forces, spent = [0.0], [row()], [[0.0] * len(wanted)], 0.0
    for n in range(1, round(case["duration"] / step) + 1):
        shift = interpolate(ground["time"], ground["acceleration"], (n - 0.5) * step) if ground else (0.0, 0.0)
        space.gravity = (case["gravity"][0] - shift[0], case["gravity"][1] - shift[1])
        impulses.clear()
        begun = time.process_time()
        space.step(step)
        spent += time.process_time() - begun
        if n * step > len(times) * case["sample"] - step / 2:
            times.append(n * step)
            states.append(row())
            forces.append([impulses.get(p, 0.0) / step for p in wanted])
    if not all(math.isfinite(v) for s in states[-1] for v in s):
        sys.exit("not finite")
    json.dump({"engine": "pymunk", "version": pymunk.version, "step": step, "cpu_seconds": spent, "bodies": list(moving),
               "times": times, "states": states, "forces": forces}, sys.stdout)


main()
