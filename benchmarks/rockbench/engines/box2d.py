"""RockBench adapter of Box2D v3: `pip install pyb2d3`.

Single precision. A half-plane is a box of 200 m. Friction of a pair is the geometric mean of both shapes'. Step of
1/60 s with four substeps by default; at a given step contacts are as stiff as it resolves, and the slop is 50 µm.
"""

import importlib.metadata
import json
import math
import sys
import time

import numpy as np
import pyb2d3 as b2


def cannot(why):
    json.dump({"engine": "Box2D", "version": version(), "cannot": [{"what": "case", "why": why}]}, sys.stdout)
    sys.exit()


def version():
    return "v3 (pyb2d3 " + importlib.metadata.version("pyb2d3") + ")"


def between(case, a, b):
    for law in case["interfaces"]:
        for x, y in ((a, b), (b, a)):
            if law["between"][0] in ("*", x) and law["between"][1] in ("*", y):
                return law
    return None


def turn(angle):
    """A rotation with exact sine and cosine: those of the engine are approximations, to a milliradian."""
    rotation = b2.make_rot(0.0)
    rotation.c, rotation.s = math.cos(angle), math.sin(angle)
    return rotation


def coefficients(case):
    """A friction for each body, so that the geometric mean is that of the pair."""
    bodies = case["bodies"]
    rows, values, zero = [], [], set()
    for i, a in enumerate(bodies):
        for b in bodies[i + 1:]:
            law = between(case, a["name"], b["name"])
            if law is None or a.get("fixed") and b.get("fixed"):
                continue
            if law["friction"] == 0:
                zero.add(a["name"] if a.get("fixed") or not b.get("fixed") else b["name"])
            else:
                row = [0.0] * len(bodies)
                row[i] += 1
                row[bodies.index(b)] += 1
                rows.append(row)
                values.append(2 * math.log(law["friction"]))
    found = {b["name"]: 1.0 for b in bodies}
    if rows:
        logs = np.linalg.lstsq(np.array(rows), np.array(values), rcond=None)[0]
        if max(abs(np.array(rows) @ logs - values)) > 1e-9:
            cannot("a friction for every pair of bodies")
        found = {b["name"]: math.exp(v) for b, v in zip(bodies, logs)}
    return {name: 0.0 if name in zero else value for name, value in found.items()}


def main():
    case = json.load(sys.stdin)
    if case["space"] != "planar":
        cannot("bodies in space")
    if any(law["normal"] != "rigid" for law in case["interfaces"]):
        cannot("the stiffness of a contact: it is a frequency, one for all contacts")
    step = case.get("step")
    rest = {law["restitution"] for law in case["interfaces"]}
    if len(rest) > 1:
        cannot("a restitution for every pair of bodies")
    friction = coefficients(case)
    settings = {}
    if step is not None:
        b2.set_length_units_per_meter(0.01)
        settings = {"contact_hertz": 30 / 60 / step, "restitution_threshold": 0.0, "maximum_linear_speed": 400.0}
    dt = step or 1 / 60
    world = b2.World(gravity=tuple(case["gravity"]), **settings)
    handles = {}
    for spec in case["bodies"]:
        fixed = spec.get("fixed")
        define = b2.body_def(type=b2.BodyType.STATIC if fixed else b2.BodyType.DYNAMIC, position=tuple(spec["position"]),
                             rotation=turn(spec["angle"]), enable_sleep=False)
        if not fixed:
            define.linear_velocity = tuple(spec["velocity"])
            define.angular_velocity = spec["spin"]
        body = world.create_body_from_def(define)
        material = b2.surface_material(friction=friction[spec["name"]], restitution=max(rest))
        look = b2.shape_def(density=1.0, material=material)
        for shape in spec["shapes"]:
            at = shape.get("at", [0, 0])
            if shape["type"] == "halfspace":
                body.create_polygon_shape(look, b2.box(100, 10, (0, -10), 0.0))
            elif shape["type"] == "disc":
                body.create_circle_shape(look, b2.circle(tuple(at), shape["radius"]))
            elif shape["type"] == "box":
                body.create_polygon_shape(look, b2.box(shape["size"][0] / 2, shape["size"][1] / 2, tuple(at), 0.0))
            elif shape["type"] == "polygon":
                points = np.array(shape["corners"], dtype=np.float32)
                body.create_polygon_shape(look, b2.polygon(points=points))
            else:
                cannot(f"the shape {shape['type']}")
        if not fixed:
            matter = b2.MassData()
            matter.mass, matter.rotational_inertia, matter.center = spec["mass"], spec["inertia"], (0, 0)
            body.mass_data = matter
            handles[spec["name"]] = body

    def row():
        rows = []
        for body in handles.values():
            p, v = body.position, body.linear_velocity
            angle = math.atan2(body.rotation.s, body.rotation.c)
            rows.append([float(p[0]), float(p[1]), angle, float(v[0]), float(v[1]), float(body.angular_velocity)])
        return rows
    ground = case.get("ground")
    if ground:
        knots, columns = ground["time"], np.array(ground["acceleration"]).T
    times, states, spent = [0.0], [row()], 0.0
    for n in range(1, round(case["duration"] / dt) + 1):
        if ground:
            # In the frame of the ground: gravity less its acceleration.
            a = [float(np.interp((n - 0.5) * dt, knots, c)) for c in columns]
            world.gravity = (case["gravity"][0] - a[0], case["gravity"][1] - a[1])
        before = time.process_time()
        world.step(dt, 4)
        spent += time.process_time() - before
        if n * dt > len(times) * case["sample"] - dt / 2:
            times.append(n * dt)
            states.append(row())
    json.dump({"engine": "Box2D", "version": version(), "step": dt, "cpu_seconds": spent, "bodies": list(handles),
               "times": times, "states": states,
               "cannot": [{"what": "forces", "why": "contact forces, through this binding"}]}, sys.stdout)


main()
