"""RockBench adapter for Drake (pip install drake).

Drake has compliant contact alone, in space alone. What is stated by approximation:

- A case in the plane is bodies on planar joints; a disc is a sphere, a box or a polygon a prism.
- A rigid contact is Drake's compliant one. Without `step`: its default stiffness, dissipation
  and time-stepping ("lagged"). With `step`: the SAP solver with a stiffness of 1e8 N/m (of solids:
  1e8 Pa) per kilogram of the case, and a relaxation time of one step.
- Corners of boxes and polygons on half-spaces are spheres of radius zero; so are those of boxes on
  boxes where the contact has a stiffness.
- Rigid contacts among boxes, polygons and cylinders are Drake's hydroelastic ones; with `step`
  those among boxes are of points on the faces beside the corners, since a point at the very corner
  has no face to leave through where boxes of one size stand on one another.
- A cylinder touches a half-space in the one point that Drake finds; in the others it has facets.
- Restitution of one is a contact without dissipation. Drake has no coefficient between zero and
  one, and a damping that returns one needs the mass that acts at the contact: not stated.
- Contacts with a stiffness and a damping are those of the SAP solver: max(0, k (d + tau d')),
  tau = c / k. This is the law of the case. They, and a restitution of one, take this solver at
  the default step too.
- The ground is at rest, and bodies are pushed by -mass * acceleration.
"""
import bisect
import json
import math
import sys
import time
from importlib.metadata import version

import numpy as np
from pydrake.geometry import (AddCompliantHydroelasticProperties, AddContactMaterial, Box,
                              CollisionFilterDeclaration, Convex, Cylinder, GeometrySet, HalfSpace,
                              ProximityProperties, Sphere)
from pydrake.math import RigidTransform, RotationMatrix
from pydrake.common.eigen_geometry import Quaternion
from pydrake.multibody.math import SpatialVelocity
from pydrake.multibody.plant import (AddMultibodyPlant, CoulombFriction, MultibodyPlantConfig)
from pydrake.multibody.tree import PlanarJoint, SpatialInertia, UnitInertia
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import DiagramBuilder

ENGINE = {"engine": "Drake", "version": version("drake")}
INSET = 1e-3  # of points beside the corners of a box, of its smallest size
DEPTH = 1.0  # of prisms that stand for shapes in the plane (m)


def give_up(why):
    json.dump({**ENGINE, "cannot": [{"what": "case", "why": why}]}, sys.stdout)
    sys.exit()


case = json.load(sys.stdin)
planar = case["space"] == "planar"
fine = "step" in case
config = MultibodyPlantConfig()  # 1 ms
step = case.get("step", config.time_step)
soft = any(i["normal"] != "rigid" for i in case["interfaces"])
restitutions = {i.get("restitution", 0) for i in case["interfaces"]}
if any(0 < e < 1 for e in restitutions):
    give_up("a coefficient of restitution")

config.time_step = step
config.adjacent_bodies_collision_filters = False
if soft or fine or 1 in restitutions:
    config.discrete_contact_approximation = "sap"
if fine:
    config.sap_near_rigid_threshold = 1e-3  # no softening of what is stated
builder = DiagramBuilder()
plant, scene = AddMultibodyPlant(config, builder)


def space(v):
    return np.array([v[0], v[1], 0.0]) if planar else np.array(v, dtype=float)


def turn(body):
    if planar:
        return RotationMatrix.MakeZRotation(body["angle"])
    return RotationMatrix(Quaternion(np.array(body["orientation"]) / np.linalg.norm(body["orientation"])))


plant.mutable_gravity_field().set_gravity_vector(space(case["gravity"]))
rigid = 1e8 * sum(b.get("mass", 0) for b in case["bodies"])  # N/m of points, Pa of solids
bodies = [b for b in case["bodies"] if not b.get("fixed")]
links, joints = {}, {}
for b in case["bodies"]:
    if b.get("fixed"):
        links[b["name"]] = (plant.world_body(), RigidTransform(turn(b), space(b["position"])))
        continue
    m = b["mass"]
    moments = [b["inertia"]] * 3 if planar else b["inertia"]
    unit = UnitInertia(*[i / m for i in moments])
    link = plant.AddRigidBody(b["name"], SpatialInertia(m, np.zeros(3), unit))
    links[b["name"]] = (link, RigidTransform())
    if planar:
        joints[b["name"]] = plant.AddJoint(PlanarJoint(
            "joint of " + b["name"], plant.world_frame(), link.body_frame(), damping=[0, 0, 0]))


def law_of(a, b):
    for n, i in enumerate(case["interfaces"]):
        p, q = i["between"]
        if any(x in ("*", a) and y in ("*", b) for x, y in ((p, q), (q, p))):
            return n
    return None


# Contacts: every law has its own copies of the shapes, and filters leave the pairs that are meant.
copies, every = {}, []


def copy(body, k, law, role):
    """The geometry of shape `k` of `body` for a law in a role: `point`, `corners`, `beside`, `hydro`, `rolling`."""
    key = (body["name"], k, law, role)
    if key in copies:
        return copies[key]
    shape, i = body["shapes"][k], case["interfaces"][law]
    properties = ProximityProperties()
    mu = CoulombFriction(i["friction"], i["friction"])
    e = i.get("restitution", 0)
    if i["normal"] != "rigid":
        stiffness, damping = i["normal"]["stiffness"], i["normal"]["damping"]
        # In a pair the stiffnesses are in series, and the times are added.
        AddContactMaterial(properties, point_stiffness=2 * stiffness, friction=mu)
        properties.AddProperty("material", "relaxation_time", damping / stiffness / 2)
    elif e == 1:
        AddContactMaterial(properties, dissipation=0.0, friction=mu)
        properties.AddProperty("material", "relaxation_time", 0.0)
    elif fine:
        AddContactMaterial(properties, point_stiffness=rigid, friction=mu)
        properties.AddProperty("material", "relaxation_time", step / 2)
    else:
        AddContactMaterial(properties, friction=mu)
    size = 0.0
    at = space(shape.get("at", [0, 0, 0]))
    rotation = RotationMatrix()
    kind = shape["type"]
    corners = []
    if kind in ("disc", "sphere"):
        solid, size = Sphere(shape["radius"]), shape["radius"]
    elif kind == "cylinder":
        solid = Cylinder(shape["radius"], shape["length"])
        size = shape["radius"] / (8 if role == "rolling" else 1)  # of the facets
    elif kind == "halfspace":
        solid = HalfSpace()
        if planar:
            rotation = RotationMatrix.MakeXRotation(-math.pi / 2)  # its z to the y of Drake
    elif kind == "box":
        w = list(shape["size"]) + ([DEPTH] if planar else [])
        solid, size = Box(*w), max(w)
        signs = [(-1, -1), (1, -1), (1, 1), (-1, 1)] if planar else [
            (x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
        corners = [space([s * d / 2 for s, d in zip(sign, w)]) for sign in signs]
        if role == "beside":
            inset = INSET * min(shape["size"])
            corners = [space([s * (d / 2 - (inset if axis != face else 0.0))
                              for axis, (s, d) in enumerate(zip(sign, w))])
                       for sign in signs for face in range(len(sign))]
    elif kind == "polygon":
        points = [[x, z, y] for x, z in shape["corners"] for y in (-DEPTH / 2, DEPTH / 2)]
        solid, size = Convex(np.array(points).T, "polygon"), DEPTH
        corners = [space(c) for c in shape["corners"]]
    if role in ("hydro", "rolling"):
        AddCompliantHydroelasticProperties(size, rigid if fine else 1e7, properties)
    link, pose = links[body["name"]]
    made = []
    pieces = [(c, Sphere(0.0)) for c in corners] if role in ("corners", "beside") else [(np.zeros(3), solid)]
    for n, (where, what) in enumerate(pieces):
        place = pose.multiply(RigidTransform(rotation, at + where))
        made.append(plant.RegisterCollisionGeometry(
            link, place, what, "/".join(map(str, key)) + f"/{n}", properties))
    every.extend(made)
    copies[key] = made
    return made


allowed = []
for n, a in enumerate(case["bodies"]):
    for b in case["bodies"][n + 1:]:
        law = law_of(a["name"], b["name"])
        if law is None or a.get("fixed") and b.get("fixed"):
            continue
        stiff = case["interfaces"][law]["normal"] == "rigid"
        for i, s in enumerate(a["shapes"]):
            for j, t in enumerate(b["shapes"]):
                flat = ("box", "polygon")
                p, q = s["type"], t["type"]
                if p in flat and q == "halfspace":
                    roles = [("corners", "point")]
                elif p == "halfspace" and q in flat:
                    roles = [("point", "corners")]
                elif p == q == "box" and stiff and fine:
                    roles = [("beside", "point"), ("point", "beside")]
                elif stiff and "cylinder" in (p, q) and "box" in (p, q):
                    roles = [("rolling", "rolling")]
                elif (p in flat and q in flat or p == q == "cylinder") and stiff:
                    roles = [("hydro", "hydro")]
                elif p in flat and q in flat:
                    roles = [("corners", "point"), ("point", "corners")]
                else:
                    roles = [("point", "point")]
                for r, u in roles:
                    allowed.append((copy(a, i, law, r), copy(b, j, law, u)))
plant.Finalize()
filters = scene.collision_filter_manager()
if every:
    filters.Apply(CollisionFilterDeclaration().ExcludeWithin(GeometrySet(every)))
declaration = CollisionFilterDeclaration()
for a, b in allowed:
    declaration.AllowBetween(GeometrySet(a), GeometrySet(b))
filters.Apply(declaration)

diagram = builder.Build()
simulator = Simulator(diagram)
root = simulator.get_mutable_context()
context = plant.GetMyMutableContextFromRoot(root)
for b in bodies:
    link = links[b["name"]][0]
    if planar:
        joint = joints[b["name"]]
        joint.set_pose(context, b["position"], b["angle"])
        joint.set_translational_velocity(context, b["velocity"])
        joint.set_angular_velocity(context, b["spin"])
    else:
        plant.SetFreeBodyPose(context, link, RigidTransform(turn(b), b["position"]))
        plant.SetFreeBodySpatialVelocity(link, SpatialVelocity(w=b["spin"], v=b["velocity"]), context)
simulator.Initialize()


def state_of(b):
    if planar:
        joint = joints[b["name"]]
        return [*joint.get_translation(context), joint.get_rotation(context),
                *joint.get_translational_velocity(context), joint.get_angular_velocity(context)]
    link = links[b["name"]][0]
    pose = plant.EvalBodyPoseInWorld(context, link)
    velocity = plant.EvalBodySpatialVelocityInWorld(context, link)
    return [*pose.translation(), *pose.rotation().ToQuaternion().wxyz(),
            *velocity.translational(), *velocity.rotational()]


owner = {g: name for (name, _, _, _), made in copies.items() for g in made}
port = plant.get_contact_results_output_port()


def forces():
    sums = {}
    results = port.Eval(context)

    def add(a, b, value):
        pair = frozenset((owner[a], owner[b]))
        sums[pair] = sums.get(pair, 0.0) + value

    for k in range(results.num_point_pair_contacts()):
        info = results.point_pair_contact_info(k)
        pair = info.point_pair()
        add(pair.id_A, pair.id_B, abs(info.contact_force() @ pair.nhat_BA_W))
    for k in range(results.num_hydroelastic_contacts()):
        info = results.hydroelastic_contact_info(k)
        surface = info.contact_surface()
        normal = sum(surface.area(f) * surface.face_normal(f) for f in range(surface.num_faces()))
        add(surface.id_M(), surface.id_N(), abs(info.F_Ac_W().translational() @ normal) / np.linalg.norm(normal))
    return [sums.get(frozenset(p), 0.0) for p in case.get("forces", [])]


ground = case.get("ground")


def acceleration(t):
    times, values = ground["time"], ground["acceleration"]
    k = bisect.bisect_right(times, t)
    if k == 0:
        return np.array(values[0])
    if k == len(times):
        return np.array(values[-1])
    u = (t - times[k - 1]) / (times[k] - times[k - 1])
    return (1 - u) * np.array(values[k - 1]) + u * np.array(values[k])


push = plant.get_applied_generalized_force_input_port()
pull = np.zeros((plant.num_velocities(), 2 if planar else 3))
for b in bodies:
    name = b["name"]
    first = joints[name].velocity_start() if planar else links[name][0].floating_velocities_start_in_v() + 3
    for k in range(pull.shape[1]):
        pull[first + k, k] = -b["mass"]

times, states, pressed = [0.0], [[state_of(b) for b in bodies]], [[0.0] * len(case.get("forces", []))]
cpu = 0.0
n, last = 0, math.ceil(case["duration"] / step - 1e-6)
while n < last:
    target = min(last, max(n + 1, math.ceil(len(times) * case["sample"] / step - 1e-6)))
    begun = time.process_time()
    if ground:
        for k in range(n, target):
            push.FixValue(context, pull @ acceleration((k + 0.5) * step))
            simulator.AdvanceTo((k + 1) * step)
    else:
        simulator.AdvanceTo(target * step)
    cpu += time.process_time() - begun
    n = target
    times.append(n * step)
    states.append([[float(x) for x in state_of(b)] for b in bodies])
    if "forces" in case:
        pressed.append([float(x) for x in forces()])

answer = {**ENGINE, "step": step, "cpu_seconds": cpu, "bodies": [b["name"] for b in bodies],
          "times": times, "states": states, "cannot": []}
if "forces" in case:
    answer["forces"] = pressed
json.dump(answer, sys.stdout)
