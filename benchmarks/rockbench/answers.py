#!/usr/bin/env python3
"""Writes the cases of RockBench with their answers: `python3 answers.py`.

Answers are closed forms, or integrals of the exact equations of motion by the small integrators of this file; no
contact engine takes part. Standard library alone.
"""

import json
import math
import pathlib
from math import acosh, asin, atan2, cos, exp, hypot, pi, sin, sqrt, tan

G = 9.81
FOLDER = pathlib.Path(__file__).parent / "cases"
CASES = []


# ---------------------------------------------------------------- what a case consists of

def floor(angle=0.0, name="floor"):
    """A half-plane whose surface passes through its position; its outward normal is z turned by the angle."""
    return {"name": name, "fixed": True, "position": [0, 0], "angle": angle, "shapes": [{"type": "halfspace"}]}


def body(name, mass, inertia, shapes, at, angle=0.0, velocity=(0, 0), spin=0.0):
    return {"name": name, "mass": mass, "inertia": inertia, "position": list(at), "angle": angle,
            "velocity": list(velocity), "spin": spin, "shapes": shapes}


def box(name, width, height, mass, at, angle=0.0, velocity=(0, 0), spin=0.0):
    return body(name, mass, mass * (width**2 + height**2) / 12, [{"type": "box", "size": [width, height]}],
                at, angle, velocity, spin)


def disc(name, radius, mass, at, velocity=(0, 0), spin=0.0, share=0.5):
    return body(name, mass, share * mass * radius**2, [{"type": "disc", "radius": radius}], at, 0.0, velocity, spin)


def fixed(name, shape, at, angle=0.0):
    return {"name": name, "fixed": True, "position": list(at), "angle": angle, "shapes": [shape]}


def floor3():
    return {"name": "floor", "fixed": True, "position": [0, 0, 0], "orientation": [1, 0, 0, 0],
            "shapes": [{"type": "halfspace"}]}


def body3(name, mass, inertia, shape, at, orientation=(1, 0, 0, 0), velocity=(0, 0, 0), spin=(0, 0, 0)):
    return {"name": name, "mass": mass, "inertia": list(inertia), "position": list(at),
            "orientation": list(orientation), "velocity": list(velocity), "spin": list(spin), "shapes": [shape]}


def box3(name, size, mass, at, **more):
    a, b, c = (s * s for s in size)
    return body3(name, mass, [mass * (b + c) / 12, mass * (a + c) / 12, mass * (a + b) / 12],
                 {"type": "box", "size": list(size)}, at, **more)


def ball3(name, radius, mass, at, **more):
    return body3(name, mass, [0.4 * mass * radius**2] * 3, {"type": "sphere", "radius": radius}, at, **more)


def cylinder3(name, radius, length, mass, at, **more):
    side = mass * (3 * radius**2 + length**2) / 12
    return body3(name, mass, [side, side, mass * radius**2 / 2],
                 {"type": "cylinder", "radius": radius, "length": length}, at, **more)


def everything(friction, restitution=0.0):
    return [{"between": ["*", "*"], "friction": friction, "restitution": restitution, "normal": "rigid"}]


def quantity(name, kind, answer, tolerance, unit, source, **more):
    return {"name": name, "kind": kind, **more, "unit": unit, "answer": answer, "tolerance": tolerance,
            "source": source}


def position(name, of, axis, time, answer, tolerance, source, **more):
    unit = "rad" if axis == "angle" else "m"
    return quantity(name, "position", answer, tolerance, unit, source, body=of, axis=axis, time=time, **more)


def velocity(name, of, axis, time, answer, tolerance, source, **more):
    unit = "rad/s" if axis == "angle" else "m/s"
    return quantity(name, "velocity", answer, tolerance, unit, source, body=of, axis=axis, time=time, **more)


def exceeds(name, of, axis, level, answer, source, **more):
    """A verdict: does the coordinate ever differ from its first value by more than the level?"""
    return quantity(name, "exceeds", answer, 0, "", source, body=of, axis=axis, level=level, **more)


def largest(name, of, axis, between, answer, tolerance, source):
    unit = "rad" if axis == "angle" else "m"
    return quantity(name, "largest", answer, tolerance, unit, source, body=of, axis=axis, between=between)


def force(name, pair, between, answer, tolerance, source):
    return quantity(name, "force", answer, tolerance, "N", source, pair=pair, between=between)


def case(identifier, title, bodies, interfaces, wanted, duration, gravity=None, ground=None, sample=0.01):
    spatial = len(bodies[-1]["position"]) == 3
    gravity = list(gravity) if gravity is not None else ([0, 0, -G] if spatial else [0, -G])
    made = {"format": "rockbench-1", "id": identifier, "category": identifier.split("-")[0], "title": title,
            "space": "spatial" if spatial else "planar", "gravity": gravity, "bodies": bodies,
            "interfaces": interfaces, "duration": duration, "sample": sample}
    if ground:
        made["ground"] = {"time": ground[0], "acceleration": ground[1]}
    pairs = [a["pair"] for a in wanted if a["kind"] == "force"]
    if pairs:
        made["forces"] = [list(p) for p in dict.fromkeys(tuple(p) for p in pairs)]
    made["quantities"] = wanted
    CASES.append(made)


# ---------------------------------------------------------------- small integrators

def runge_kutta(rates, state, start, end, steps):
    """The classical fourth-order method; returns the state at the end."""
    dt = (end - start) / steps
    t = start
    for i in range(steps):
        k1 = rates(t, state)
        k2 = rates(t + dt / 2, [s + dt / 2 * k for s, k in zip(state, k1)])
        k3 = rates(t + dt / 2, [s + dt / 2 * k for s, k in zip(state, k2)])
        k4 = rates(t + dt, [s + dt * k for s, k in zip(state, k3)])
        state = [s + dt / 6 * (a + 2 * b + 2 * c + d) for s, a, b, c, d in zip(state, k1, k2, k3, k4)]
        t = start + (i + 1) * dt
    return state


def table(function, end, step, last):
    """Samples of an acceleration, zero after `end`; linear between them."""
    count = round(end / step)
    times = [round(i * step, 9) for i in range(count + 1)]
    values = [round(function(t), 9) for t in times]
    if last > end:
        times += [round(end + 1e-4, 9), last]
        values += [0.0, 0.0]
    return times, values


def rectangular(acceleration, duration, last):
    return [0.0, duration, duration + 1e-6, last], [acceleration, acceleration, 0.0, 0.0]


def planar_ground(motion):
    return motion[0], [[a, 0] for a in motion[1]]


def interpolate(motion):
    """The acceleration between the samples; to be called with times that grow."""
    times, values = motion
    cell = [0]

    def at(t):
        if t >= times[-1]:
            return values[-1]
        if t < times[cell[0]]:
            cell[0] = 0
        while t > times[cell[0] + 1]:
            cell[0] += 1
        i = cell[0]
        return values[i] + (values[i + 1] - values[i]) * (t - times[i]) / (times[i + 1] - times[i])
    return at


class Rocking:
    """A rigid block that rocks without sliding: exact equation, and Housner's impact (1963)."""

    def __init__(self, half_width, half_height):
        self.alpha = atan2(half_width, half_height)
        self.radius = hypot(half_width, half_height)
        self.p2 = 0.75 * G / self.radius
        self.ratio = 1 - 1.5 * sin(self.alpha)**2

    def run(self, motion, angle, end, dt=2e-4):
        """Returns times, angles (positive about the left corner), rates, and the times of impacts."""
        ground = interpolate(motion) if motion else (lambda t: 0.0)
        alpha, p2 = self.alpha, self.p2

        def rates(side):
            def of(t, s):
                lean = alpha * side - s[0]
                return [s[1], -p2 * (sin(lean) - ground(t) / G * cos(lean))]
            return of
        t, state = 0.0, [angle, 0.0]
        times, angles, speeds, impacts = [0.0], [angle], [0.0], []
        steps = round(end / dt)
        for i in range(steps):
            t, after = i * dt, (i + 1) * dt
            if state == [0.0, 0.0]:
                push = ground(after) / G
                if abs(push) > tan(alpha):
                    side = 1 if push > 0 else -1
                    state = runge_kutta(rates(side), state, t, after, 1)
            else:
                side = 1 if state[0] > 0 or (state[0] == 0 and state[1] > 0) else -1
                new = runge_kutta(rates(side), state, t, after, 1)
                if new[0] * side < 0:
                    # Secant to the instant of the impact, the rest of the step on the other corner.
                    low, high = 0.0, dt
                    for _ in range(40):
                        middle = (low + high) / 2
                        inside = runge_kutta(rates(side), state, t, t + middle, 1)[0] * side > 0
                        low, high = (middle, high) if inside else (low, middle)
                    hit = runge_kutta(rates(side), state, t, t + high, 1)
                    impacts.append(t + high)
                    speed = self.ratio * hit[1]
                    if abs(speed) < 1e-4 and abs(ground(t) / G) < tan(alpha):
                        new = [0.0, 0.0]
                    else:
                        new = runge_kutta(rates(-side), [0.0, speed], t + high, after, 1)
                state = new
            times.append(after)
            angles.append(state[0])
            speeds.append(state[1])
            if abs(state[0]) > 1.5:
                break
        return times, angles, speeds, impacts


def sliding(layers, motion, end, dt=2e-5):
    """Blocks on each other that only slide: masses and friction from below; returns positions relative to the ground
    at the samples of 0.1 s. Friction of a layer holds while it can."""
    ground = interpolate(motion)
    count = len(layers)
    weight = [sum(m for m, _ in layers[i:]) * G for i in range(count)]
    x, v = [0.0] * count, [0.0] * count
    rows = [list(x)]
    steps = round(end / dt)
    every = round(0.1 / dt)
    for n in range(steps):
        base = ground(n * dt + dt / 2)
        # Impulses of the layers by sweeps: each holds its slip to zero within its limit.
        push = [0.0] * count
        free = [v[i] - base * dt for i in range(count)]
        for _ in range(60):
            change = 0.0
            for i in range(count):
                below = 0.0 if i == 0 else free[i - 1]
                slip = free[i] - below
                mass = layers[i][0] if i == 0 else 1 / (1 / layers[i][0] + 1 / layers[i - 1][0])
                limit = layers[i][1] * weight[i] * dt
                wanted = max(-limit, min(limit, push[i] - slip * mass))
                delta, push[i] = wanted - push[i], wanted
                free[i] += delta / layers[i][0]
                if i > 0:
                    free[i - 1] -= delta / layers[i - 1][0]
                change = max(change, abs(delta))
            if change < 1e-13:
                break
        x = [a + dt * (b + c) / 2 for a, b, c in zip(x, v, free)]
        v = free
        if (n + 1) % every == 0:
            rows.append(list(x))
    return rows


def quaternion_of(axis, angle):
    norm = sqrt(sum(a * a for a in axis)) or 1.0
    return [cos(angle / 2)] + [sin(angle / 2) * a / norm for a in axis]


def product(p, q):
    a, b, c, d = p
    e, f, g, h = q
    return [a * e - b * f - c * g - d * h, a * f + b * e + c * h - d * g,
            a * g - b * h + c * e + d * f, a * h + b * g - c * f + d * e]


def turned(q, v):
    w = product(product(q, [0, *v]), [q[0], -q[1], -q[2], -q[3]])
    return w[1:]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def torque_free(inertia, spin, end, steps=20000):
    """Euler's equations with the attitude: body spin and quaternion at the end."""
    def rates(_, s):
        w, q = s[:3], s[3:]
        a, b, c = inertia
        turn = [(b - c) / a * w[1] * w[2], (c - a) / b * w[2] * w[0], (a - b) / c * w[0] * w[1]]
        return turn + [0.5 * r for r in product(q, [0, *w])]
    s = runge_kutta(rates, [*spin, 1, 0, 0, 0], 0.0, end, steps)
    return s[:3], s[3:]


# ---------------------------------------------------------------- free motion

def free():
    shape = [{"type": "disc", "radius": 0.1}]
    throw = body("body", 2.0, 0.01, shape, (0, 1), 0.0, (2, 3), 4.0)
    parabola = "x = v t, z = 1 + 3 t - g t²/2, angle = ω t"
    case("free-throw", "A disc thrown with spin", [throw], everything(0.0), [
        position("x at 1 s", "body", "x", 1.0, 2.0, 0.02, parabola),
        position("z at 1 s", "body", "z", 1.0, 1 + 3 - G / 2, 0.02, parabola),
        position("angle at 1 s", "body", "angle", 1.0, 4.0, 0.02, parabola),
        velocity("vz at 1 s", "body", "z", 1.0, 3 - G, 0.02, parabola)], 1.0)

    spin3 = box3("body", (0.2, 0.4, 0.6), 3.0, (0, 0, 1), velocity=(1, 2, 3), spin=(0, 0, 5))
    case("free-throw-spatial", "A box thrown with a spin about a principal axis", [spin3], everything(0.0), [
        position("y at 1 s", "body", "y", 1.0, 2.0, 0.02, parabola),
        position("z at 1 s", "body", "z", 1.0, 4 - G / 2, 0.02, parabola),
        quantity("attitude at 1 s", "attitude", 0.0, 0.02, "rad", "turned by ω t", body="body", time=1.0,
            reference=quaternion_of((0, 0, 1), 5.0))], 1.0)

    inertia, spin = (2.0, 5.0, 6.0), (0.2, 3.0, 0.1)
    tumbler = body3("body", 1.0, inertia, {"type": "sphere", "radius": 0.5}, (0, 0, 0), spin=spin)
    euler = "Euler's equations, Runge–Kutta of fourth order (agrees with Jacobi's elliptic functions)"
    wanted = []
    for t in (1.0, 2.0, 5.0, 10.0):
        w, q = torque_free(inertia, spin, t)
        wanted.append(quantity(f"middle spin at {t:g} s", "body_spin", w[1], 0.06, "rad/s", euler, body="body", axis="y", time=t))
        if t in (2.0, 10.0):
            wanted.append(quantity(f"attitude at {t:g} s", "attitude", 0.0, 0.05, "rad", euler, body="body", time=t, reference=q))
    energy = 0.5 * sum(i * w * w for i, w in zip(inertia, spin))
    wanted.append(quantity("kinetic energy at 10 s", "kinetic_energy", energy, 0.01 * energy, "J", "conserved", body="body", time=10.0))
    wanted.append(quantity("angular momentum at 10 s, y", "angular_momentum", 15.0, 0.15, "N m s", "conserved", body="body",
                    axis="y", time=10.0))
    case("free-dzhanibekov", "A body that flips: free rotation about its middle axis", [tumbler], everything(0.0), wanted,
         10.0, gravity=(0, 0, 0))

    inertia, spin = (1.0, 1.0, 1.6), (0.5, 0.0, 6.0)
    momentum = [inertia[0] * 0.5, 0.0, 1.6 * 6.0]
    length = sqrt(sum(l * l for l in momentum))
    t = 3.0
    q = product(quaternion_of(momentum, length * t), quaternion_of((0, 0, 1), (6.0 - 9.6) * t))
    axis = turned(q, (0, 0, 1))
    regular = "regular precession at L/I about L, spin (1 - I₃/I₁) ω₃ about the own axis"
    top = body3("body", 1.0, inertia, {"type": "sphere", "radius": 0.3}, (0, 0, 0), spin=spin)
    case("free-symmetric", "Free precession of a symmetric body", [top], everything(0.0), [
        quantity("attitude at 3 s", "attitude", 0.0, 0.05, "rad", regular, body="body", time=t, reference=q),
        quantity("x of its axis at 3 s", "axis", axis[0], 0.005, "", regular, body="body", axis="x", time=t),
        quantity("kinetic energy at 3 s", "kinetic_energy", 0.5 * (0.25 + 1.6 * 36), 0.3, "J", "conserved", body="body", time=t)],
        t, gravity=(0, 0, 0))


# ---------------------------------------------------------------- sliding

def on_slope(angle, distance):
    """A point on a slope that descends to the right, a distance above it."""
    return (sin(angle) * distance, cos(angle) * distance)


def slides():
    angle, mu = 0.5, 0.3
    a = G * (sin(angle) - mu * cos(angle))
    block = box("block", 0.4, 0.2, 10, on_slope(angle, 0.1), -angle)
    case("slide-incline", "A block that slides down a slope of 0.5 rad, μ = 0.3", [floor(-angle), block], everything(mu), [
        quantity("distance at 1 s", "distance", a / 2, 0.01 * a / 2, "m", "a = g (sin θ - μ cos θ)", body="block", time=1.0),
        position("angle at 1 s", "block", "angle", 1.0, -angle, 0.005, "it does not turn")], 1.0)

    angle = 0.25
    block = box("block", 0.4, 0.2, 10, on_slope(angle, 0.1), -angle)
    case("slide-holds", "A block that stays on a slope of 0.25 rad, μ = 0.3", [floor(-angle), block], everything(0.3), [
        quantity("distance at 5 s", "distance", 0.0, 1e-3, "m", "tan θ = 0.255 < μ", body="block", time=5.0)], 5.0)

    block = box("block", 0.4, 0.2, 10, (0, 0.1), velocity=(2, 0))
    case("slide-stops", "A block that slides to a stop, μ = 0.4", [floor(), block], everything(0.4), [
        position("x at 1 s", "block", "x", 1.0, 4 / (2 * 0.4 * G), 0.005, "v²/(2 μ g)"),
        velocity("vx at 0.2 s", "block", "x", 0.2, 2 - 0.4 * G * 0.2, 0.02, "v - μ g t")], 1.0)

    block = box("block", 1.0, 0.2, 10, (0, 0.1))
    motion = rectangular(0.5 * G, 0.4, 2.0)
    u = (0.5 * G * 0.4)**2 / (2 * G * 0.2) * (1 - 0.2 / 0.5)
    case("slide-pulse", "Newmark's block under a rectangular pulse of 0.5 g and 0.4 s, μ = 0.2", [floor(), block],
         everything(0.2), [position("slip at 2 s", "block", "x", 2.0, -u, 0.01 * u,
                                    "Newmark 1965: V²/(2 g N) (1 - N/A)")], 2.0, ground=planar_ground(motion))

    # Half-sine: the ground moves the other way.
    period = 0.8
    w = 2 * pi / period
    motion = table(lambda t: -0.5 * G * sin(w * t), 0.4, 0.001, 2.0)
    t1 = asin(0.4) / w
    A, N, T = 0.5 * G, 0.2 * G, 0.4
    v = A / w * (1 + cos(w * t1)) - N * (T - t1)
    u = A / w * cos(w * t1) * (T - t1) + A / w**2 * sin(w * t1) - N * (T - t1)**2 / 2 + v * v / (2 * N)
    case("slide-half-sine", "Newmark's block under a half-sine of 0.5 g and 0.4 s, μ = 0.2", [floor(), block],
         everything(0.2), [position("slip at 2 s", "block", "x", 2.0, u, 0.01 * u, "Newmark's block, integrated in closed form")],
         2.0, ground=planar_ground(motion))

    motion = table(lambda t: 0.5 * G * sin(2 * pi * t), 5.0, 0.005, 5.0)
    rows = sliding([(10, 0.2)], motion, 5.0)
    slip = "stick and slip of one block, integrated with a step of 0.02 ms"
    case("slide-sine", "A block on ground that shakes at 1 Hz and 0.5 g, μ = 0.2", [floor(), block], everything(0.2), [
        position("slip at 1 s", "block", "x", 1.0, rows[10][0], 0.01, slip),
        position("slip at 5 s", "block", "x", 5.0, rows[50][0], 0.02, slip)], 5.0, ground=planar_ground(motion))

    plank = box("plank", 4.0, 0.1, 3, (0, 0.05))
    rider = box("block", 0.4, 0.2, 2, (-1, 0.2), velocity=(2, 0))
    pairs = [{"between": ["plank", "floor"], "friction": 0.0, "restitution": 0.0, "normal": "rigid"},
             {"between": ["block", "plank"], "friction": 0.3, "restitution": 0.0, "normal": "rigid"}]
    share = "momentum, and the energy lost to friction"
    case("slide-plank", "A block that slides on a plank that slides freely", [floor(), plank, rider], pairs, [
        velocity("vx of the plank at 1 s", "plank", "x", 1.0, 0.8, 0.008, share),
        velocity("vx of the block at 1 s", "block", "x", 1.0, 0.8, 0.008, share),
        position("slip at 1 s", "block", "x", 1.0, -1 + 4 / (2 * 0.3 * G * (1 + 2 / 3)), 0.005, share,
                 relative_to="plank")], 1.0)

    low, high = box("lower", 1.2, 0.2, 20, (0, 0.1)), box("upper", 1.0, 0.2, 10, (0, 0.3))
    motion = rectangular(0.6 * G, 0.3, 2.0)
    rows = sliding([(20, 0.4), (10, 0.2)], motion, 2.0)
    pairs = [{"between": ["lower", "floor"], "friction": 0.4, "restitution": 0.0, "normal": "rigid"},
             {"between": ["upper", "lower"], "friction": 0.2, "restitution": 0.0, "normal": "rigid"}]
    both = "two sliding interfaces, integrated with a step of 0.02 ms"
    case("slide-two", "A block on a block on ground that jerks: both slide", [floor(), low, high], pairs, [
        position("slip of the lower at 2 s", "lower", "x", 2.0, rows[20][0], 0.01, both),
        position("slip of the upper at 2 s", "upper", "x", 2.0, rows[20][1], 0.02, both)], 2.0,
        ground=planar_ground(motion))

    block = box("block", 0.5, 1.0, 10, (0, 0.5))
    motion = rectangular(0.6 * G, 0.2, 1.0)
    u = (0.6 * G * 0.2)**2 / (2 * G * 0.35) * (1 - 0.35 / 0.6)
    case("slide-not-rock", "A block of slenderness 2 that slides and does not rock, μ = 0.35", [floor(), block],
         everything(0.35), [position("slip at 1 s", "block", "x", 1.0, -u, 0.02 * u, "μ < b/h: it slides; Newmark's block"),
                            largest("largest angle", "block", "angle", [0.0, 1.0], 0.0, 0.01, "Shao and Tung 1999: μ < b/h")],
         1.0, ground=planar_ground(motion))

    speed = 2.0
    slab = box3("block", (0.4, 0.4, 0.1), 10, (0, 0, 0.05), velocity=(1.2, 1.6, 0))
    way = speed**2 / (2 * 0.4 * G)
    case("slide-circle", "Friction is a circle and not a square: a slab slides obliquely, μ = 0.4", [floor3(), slab],
         everything(0.4), [position("x at 1 s", "block", "x", 1.0, 0.6 * way, 0.006, "v²/(2 μ g) along its velocity"),
                           position("y at 1 s", "block", "y", 1.0, 0.8 * way, 0.006, "v²/(2 μ g) along its velocity"),
                           quantity("attitude at 1 s", "attitude", 0.0, 0.05, "rad", "it does not turn, but for the higher load in front",
                               body="block", time=1.0, reference=[1, 0, 0, 0])], 1.0)

    tilt, yaw, mu = math.radians(25), math.radians(17), 0.3
    slab = box3("block", (0.6, 0.4, 0.1), 10, (0, 0, 0.05), orientation=quaternion_of((0, 0, 1), yaw))
    way = 0.5 * G * (sin(tilt) - mu * cos(tilt))
    case("slide-diagonal", "A slab that slides down a slope of 25° at an angle to its edges, μ = 0.3", [floor3(), slab],
         everything(mu), [position("x at 1 s", "block", "x", 1.0, way, 0.01 * way, "g (sin θ - μ cos θ) t²/2"),
                          position("y at 1 s", "block", "y", 1.0, 0.0, 0.01 * way, "straight down")],
         1.0, gravity=(G * sin(tilt), 0, -G * cos(tilt)))

    A, w, mu = 5.0, 2 * pi, 0.3
    start = (-0.3786603365, 0.5200785971)
    slab = box3("block", (0.4, 0.4, 0.02), 10, (0, 0, 0.01), velocity=(*start, 0))
    times = [round(i * 0.0025, 6) for i in range(401)]
    circle = times, [[round(A * cos(w * t), 9), round(A * sin(w * t), 9), 0] for t in times]

    def slip(t, s):
        u = hypot(s[2], s[3])
        return [s[2], s[3], -A * cos(w * t) - mu * G * s[2] / u, -A * sin(w * t) - mu * G * s[3] / u]
    at = {t: runge_kutta(slip, [0, 0, *start], 0, t, 4000) for t in (0.2, 0.5, 1.0)}
    steady = "steady slip on a circle, √(A² - (μ g)²)/ω²; Runge–Kutta"
    case("slide-circular-ground", "A slab on ground that moves in a circle", [floor3(), slab], everything(mu), [
        position(f"{axis} at {t:g} s", "block", axis, t, at[t][i], 0.004, steady)
        for t in (0.2, 0.5, 1.0) for i, axis in enumerate("xy")], 1.0, ground=circle)

    mass, a, b, mu = 100.0, 1.473, 0.54, 0.4
    corners = [(sx * a / 2, sy * b / 2) for sx in (1, -1) for sy in (1, -1)]

    def plate(_, s):
        fx = fy = moment = 0.0
        for cx, cy in corners:
            x, y = cx * cos(s[2]) - cy * sin(s[2]), cx * sin(s[2]) + cy * cos(s[2])
            u, v = s[3] - s[5] * y, s[4] + s[5] * x
            n = hypot(u, v) + 1e-6
            px, py = -mu * G / 4 * u / n, -mu * G / 4 * v / n
            fx, fy, moment = fx + px, fy + py, moment + x * py - y * px
        return [s[3], s[4], s[5], fx, fy, moment / ((a * a + b * b) / 12)]
    end = runge_kutta(plate, [0, 0, 0, 1, 0, 2], 0, 0.3, 30000)
    thin = box3("plate", (a, b, 0.004), mass, (0, 0, 0.002), velocity=(1, 0, 0), spin=(0, 0, 2))
    four = "four corners that bear a quarter each, at 0.3 s, just before they stop; Runge–Kutta"
    case("slide-spin", "A plate on its four corners that slides and spins, μ = 0.4", [floor3(), thin], everything(mu), [
        position("x at 0.5 s", "plate", "x", 0.5, 0.170890, 0.003, four + "; stops at 0.30776 s"),
        quantity("yaw at 0.5 s", "yaw", 0.191920, 0.004, "rad", four + "; stops at 0.30776 s", body="plate", time=0.5),
        position("x at 0.3 s", "plate", "x", 0.3, end[0], 0.003, four),
        quantity("yaw at 0.3 s", "yaw", end[2], 0.004, "rad", four, body="plate", time=0.3)], 0.5)


# ---------------------------------------------------------------- rolling

def rolls():
    R, m = 0.35, 100.0
    angle = 0.3
    for name, title, share in (("roll-disc", "A solid disc", 0.5), ("roll-hoop", "A hoop", 1.0),
                               ("roll-barrel", "A barrel whose wine slips (k²/r² = 0.1236)", 0.1236)):
        a = G * sin(angle) / (1 + share)
        wheel = disc("disc", R, m, on_slope(angle, R), share=share)
        source = "a = g sin θ/(1 + k²/r²)"
        case(name, f"{title} that rolls down a slope of 0.3 rad", [floor(-angle), wheel], everything(0.6), [
            quantity("distance at 1 s", "distance", a / 2, 0.01 * a / 2, "m", source, body="disc", time=1.0),
            velocity("spin at 1 s", "disc", "angle", 1.0, -a / R, 0.01 * a / R, source)], 1.0)

    angle, mu = 0.5, 0.1
    a = G * (sin(angle) - mu * cos(angle))
    wheel = disc("disc", R, m, on_slope(angle, R))
    case("roll-slips", "A disc that rolls and slips down a slope of 0.5 rad, μ = 0.1", [floor(-angle), wheel], everything(mu), [
        quantity("distance at 1 s", "distance", a / 2, 0.01 * a / 2, "m", "tan θ > 3 μ: a = g (sin θ - μ cos θ)", body="disc", time=1.0),
        velocity("spin at 1 s", "disc", "angle", 1.0, -2 * mu * G * cos(angle) / R, 0.05, "2 μ g cos θ/R")], 1.0)

    v, mu = 3.0, 0.2
    t = v / (3 * mu * G)
    x = v * t - mu * G * t * t / 2 + 2 / 3 * v * (1 - t)
    bowl = "slip until v/(3 μ g), then 2/3 v"
    case("roll-bowling", "A disc thrown along the floor: it slips, then rolls", [floor(), disc("disc", R, m, (0, R), (v, 0))],
         everything(mu), [velocity("vx at 1 s", "disc", "x", 1.0, 2 / 3 * v, 0.02, bowl),
                          position("x at 1 s", "disc", "x", 1.0, x, 0.02, bowl),
                          velocity("vx at 0.3 s", "disc", "x", 0.3, v - mu * G * 0.3, 0.02, bowl)], 1.0)

    v, spin = 1.0, 12.0
    final = (v - 0.5 * spin * R) / 1.5
    t = (v - final) / (mu * G)
    x = v * t - mu * G * t * t / 2 + final * (2 - t)
    back = "angular momentum about the floor"
    case("roll-backspin", "A disc with backspin: it comes back", [floor(), disc("disc", R, m, (0, R), (v, 0), spin)],
         everything(mu), [velocity("vx at 2 s", "disc", "x", 2.0, final, 0.01, back),
                          position("x at 2 s", "disc", "x", 2.0, x, 0.02, back)], 2.0)

    motion = rectangular(1.5, 1.0, 1.5)
    case("roll-ground", "A disc on ground that accelerates", [floor(), disc("disc", R, m, (0, R))], everything(0.5), [
        position("x at 1 s", "disc", "x", 1.0, -0.5, 0.005, "the disc takes a third of the acceleration"),
        position("x at 1.5 s", "disc", "x", 1.5, -1.0, 0.01, "then it rolls on steadily")], 1.5,
        ground=planar_ground(motion))

    groove = [floor(-pi / 6, "left"), floor(pi / 6, "right")]
    at = (0, R / cos(pi / 6))
    half = m * G / (2 * cos(pi / 6))
    case("roll-groove", "A disc at rest in a groove of two planes at 30°, without friction", [*groove, disc("disc", R, m, at)],
         everything(0.0), [force("force on the left", ["disc", "left"], [1.0, 2.0], half, 0.01 * half, "W/(2 cos φ)"),
                           force("force on the right", ["disc", "right"], [1.0, 2.0], half, 0.01 * half, "W/(2 cos φ)"),
                           largest("drift", "disc", "x", [0.0, 2.0], 0.0, 1e-3, "equilibrium")], 2.0)

    tilt, heading = math.radians(15), math.radians(40)
    down = (G * sin(tilt) * cos(heading), G * sin(tilt) * sin(heading), -G * cos(tilt))
    a = 5 / 7 * G * sin(tilt)
    case("roll-sphere", "A ball that rolls down a slope of 15°, obliquely", [floor3(), ball3("ball", 0.2, 10, (0, 0, 0.2))],
         everything(0.4), [position("x at 1 s", "ball", "x", 1.0, a / 2 * cos(heading), 0.01, "5/7 g sin θ"),
                           position("y at 1 s", "ball", "y", 1.0, a / 2 * sin(heading), 0.01, "5/7 g sin θ")],
         1.0, gravity=down)

    R3, mu, v0, w0 = 0.1, 0.2, (2.0, 0.0), (6.0, 4.0, 7.0)
    slip = (v0[0] - w0[1] * R3, v0[1] + w0[0] * R3)
    size = hypot(*slip)
    t = 2 / 7 * size / (mu * G)
    end = [v0[i] - 2 / 7 * slip[i] for i in range(2)]
    place = [(v0[i] + end[i]) / 2 * t + end[i] * (1.5 - t) for i in range(2)]
    billiard = "Coriolis 1835: the slip keeps its direction, 2/7 of it is lost"
    ball = ball3("ball", R3, 5, (0, 0, R3), velocity=(2, 0, 0), spin=w0)
    case("roll-billiard", "A billiard ball with side spin, μ = 0.2", [floor3(), ball], everything(mu), [
        position("x at 1.5 s", "ball", "x", 1.5, place[0], 0.02, billiard),
        position("y at 1.5 s", "ball", "y", 1.5, place[1], 0.01, billiard),
        velocity("vx at 1.5 s", "ball", "x", 1.5, end[0], 0.01, billiard),
        velocity("vy at 1.5 s", "ball", "y", 1.5, end[1], 0.01, billiard)], 1.5)

    motion = [0.0, 1.0, 1.000001, 1.2], [[1.0, 0.5, 0], [1.0, 0.5, 0], [0, 0, 0], [0, 0, 0]]
    case("roll-sphere-ground", "A ball on ground that accelerates obliquely", [floor3(), ball3("ball", 0.2, 10, (0, 0, 0.2))],
         everything(0.5), [position("x at 1 s", "ball", "x", 1.0, -5 / 14, 0.004, "the ball takes 2/7 of the acceleration"),
                           position("y at 1 s", "ball", "y", 1.0, -5 / 28, 0.004, "the ball takes 2/7 of the acceleration")],
         1.2, ground=motion)

    lying = quaternion_of((1, 0, 0), -pi / 2)
    drum = cylinder3("drum", 0.3, 0.8, 100, (0, 0, 0.3), orientation=lying)
    tilt = math.radians(10)
    a = G * sin(tilt) / 1.5
    case("roll-cylinder", "A lying cylinder that rolls down a slope of 10°", [floor3(), drum], everything(0.5), [
        position("x at 1 s", "drum", "x", 1.0, a / 2, 0.01 * a / 2, "a = 2/3 g sin θ"),
        position("y at 1 s", "drum", "y", 1.0, 0.0, 0.005, "straight")], 1.0,
        gravity=(G * sin(tilt), 0, -G * cos(tilt)))

    lean, R3 = math.radians(20), 0.3
    rate = sqrt(4 * G / (R3 * sin(lean)))
    # The axis leans towards +x, so that the contact is there and the diameter to it descends.
    n = (sin(lean), 0, cos(lean))
    spin = [-rate * n[2] * c for c in n]
    spin[2] += rate
    coin = cylinder3("coin", R3, 0.001, 20, (0, 0, R3 * sin(lean) + 0.0005 * cos(lean)),
                     orientation=quaternion_of((0, 1, 0), lean), spin=spin)
    stand = "thin disc whose center stands still: Ω² = 4 g/(R sin α), at 20°"
    case("roll-coin", "A coin that wobbles with its center at rest (Euler's disc)", [floor3(), coin], everything(0.8), [
        quantity(f"{axis} of its axis at {t:g} s", "axis", sin(lean) * f(rate * t), 0.035, "", stand, body="coin", axis=axis, time=t)
        for t in (0.1, 0.2, 0.3) for axis, f in (("x", cos), ("y", sin))] +
        [quantity("z of its axis at 0.3 s", "axis", cos(lean), 0.01, "", stand, body="coin", axis="z", time=0.3)],
        0.3, sample=0.01)


# ---------------------------------------------------------------- impacts

def impacts():
    R = 0.1

    for name, e in (("impact-half", 0.5), ("impact-lively", 0.9)):
        t1 = sqrt(2 / G)
        peaks = [R + e**2, R + e**4]
        spans, t = [], t1
        for i in (1, 2):
            flight = 2 * e**i * t1
            spans.append([round(t + 0.2 * flight, 2), round(t + 0.8 * flight, 2)])
            t += flight
        drop = disc("disc", R, 5, (0, 1 + R))
        bounce = "h e² after each bounce"
        case(name, f"A disc that drops 1 m and bounces, e = {e}", [floor(), drop], everything(0.0, e), [
            quantity("height of the first bounce", "peak", peaks[0], 0.01, "m", bounce, body="disc", axis="z", between=spans[0]),
            quantity("height of the second bounce", "peak", peaks[1], 0.02, "m", bounce, body="disc", axis="z", between=spans[1])],
            round(spans[1][1] + 0.1, 1), sample=0.005)
    drop = disc("disc", R, 5, (0, 1 + R))
    case("impact-dead", "A disc that drops 1 m and stays, e = 0", [floor(), drop], everything(0.0, 0.0), [
        quantity("height after the impact", "peak", R, 0.005, "m", "no bounce", body="disc", axis="z", between=[0.5, 1.5]),
        position("z at 1.5 s", "disc", "z", 1.5, R, 0.002, "no bounce")], 1.5)

    block = box("block", 0.6, 0.4, 10, (0, 0.7))
    case("impact-flat", "A block that drops flat from 0.5 m, e = 0", [floor(), block], everything(0.5), [
        quantity("height after the impact", "peak", 0.2, 0.005, "m", "no bounce", body="block", axis="z", between=[0.4, 1.5]),
        largest("largest angle", "block", "angle", [0.0, 1.5], 0.0, 0.01, "symmetry"),
        force("force at rest", ["block", "floor"], [1.0, 1.5], 10 * G, 0.01 * 10 * G, "its weight")], 1.5)

    still = everything(0.0, 1.0)
    pair = [disc("a", R, 2, (-1, 0), (2, 0)), disc("b", R, 2, (0, 0))]
    case("impact-swap", "Two equal discs collide centrally, e = 1", pair, still, [
        velocity("vx of the first at 1 s", "a", "x", 1.0, 0.0, 0.02, "they swap velocities"),
        velocity("vx of the second at 1 s", "b", "x", 1.0, 2.0, 0.02, "they swap velocities"),
        quantity("momentum at 1 s", "momentum", 4.0, 0.01, "N s", "conserved", axis="x", time=1.0)], 1.0, gravity=(0, 0))

    # Oblique: the line of centers at the impact has sine d/(2R).
    def oblique(e, mu):
        d, v, ma, mb = 0.1, 2.0, 1.0, 2.0
        s = d / (2 * R)
        c = sqrt(1 - s * s)
        normal, tangent = (c, -s), (s, c)
        vn, vt = v * normal[0], v * tangent[0]
        reduced = ma * mb / (ma + mb)
        jn = (1 + e) * reduced * vn
        # Solid discs: a tangential impulse changes the slip by 3/m, for each.
        jt = min(mu * jn, vt / (3 / ma + 3 / mb))
        va = [v * (i == 0) - (jn * normal[i] + jt * tangent[i]) / ma for i in range(2)]
        vb = [(jn * normal[i] + jt * tangent[i]) / mb for i in range(2)]
        # The first is hit on its front at `normal`, with -jt along the tangent; planar moment x F_z - z F_x.
        moment = R * (normal[0] * -jt * tangent[1] - normal[1] * -jt * tangent[0])
        wa, wb = moment / (0.5 * ma * R * R), moment / (0.5 * mb * R * R)
        return d, va, vb, wa, wb
    for name, e, mu in (("impact-oblique", 0.8, 0.0), ("impact-friction", 0.5, 0.1)):
        d, va, vb, wa, wb = oblique(e, mu)
        pair = [disc("a", R, 1, (-1, d), (2, 0)), disc("b", R, 2, (0, 0))]
        source = "impulses of two rigid discs with Coulomb's friction"
        wanted = [velocity("vx of the first at 1 s", "a", "x", 1.0, va[0], 0.03, source),
                velocity("vz of the first at 1 s", "a", "z", 1.0, va[1], 0.03, source),
                velocity("vx of the second at 1 s", "b", "x", 1.0, vb[0], 0.03, source),
                velocity("vz of the second at 1 s", "b", "z", 1.0, vb[1], 0.03, source)]
        if mu:
            wanted.append(velocity("spin of the first at 1 s", "a", "angle", 1.0, wa, 0.03 * abs(wa), source))
        wanted.append(quantity("momentum at 1 s", "momentum", 2.0, 0.01, "N s", "conserved", axis="x", time=1.0))
        case(name, f"Two discs collide obliquely, e = {e}, μ = {mu}", pair, everything(mu, e), wanted, 1.0, gravity=(0, 0))

    e, mu, v = 0.5, 0.5, (1.0, -2.0)
    grip = "Routh 1905: friction ends the slip within the impact, and does not reverse it"
    case("impact-grip", "A disc that grips the floor as it bounces, e = 0.5, μ = 0.5",
         [floor(), disc("disc", R, 5, (0, 0.3), v)], everything(mu, e), [
             velocity("vx at 0.3 s", "disc", "x", 0.3, 2 / 3, 0.02, grip),
             velocity("vz at 0.3 s", "disc", "z", 0.3, 1.0, 0.04, grip),
             velocity("spin at 0.3 s", "disc", "angle", 0.3, -2 / 3 / R, 0.2, grip)], 0.3, gravity=(0, 0))
    ball = ball3("ball", R, 5, (0, 0, 0.3), velocity=(1, 0, -2), spin=(0, 0, 0))
    case("impact-grip-spatial", "A ball that grips the floor as it bounces, e = 0.5, μ = 0.5", [floor3(), ball],
         everything(mu, e), [
             velocity("vx at 0.3 s", "ball", "x", 0.3, 5 / 7, 0.02, grip),
             velocity("vz at 0.3 s", "ball", "z", 0.3, 1.0, 0.04, grip),
             quantity("spin about y at 0.3 s", "spin", 5 / 7 / R, 0.2, "rad/s", grip, body="ball", axis="y", time=0.3)], 0.3,
         gravity=(0, 0, 0))

    row = [disc("a", R, 1, (-0.5, 0), (2, 0))] + [disc(n, R, 1, (i * 0.22, 0)) for i, n in enumerate("bcde")]
    case("impact-cradle", "Newton's cradle with small gaps, e = 1", row, still, [
        velocity("vx of the last at 1 s", "e", "x", 1.0, 2.0, 0.04, "one collision after the other"),
        velocity("vx of the first at 1 s", "a", "x", 1.0, 0.0, 0.04, "one collision after the other"),
        velocity("vx of the middle one at 1 s", "c", "x", 1.0, 0.0, 0.04, "one collision after the other")], 1.0, gravity=(0, 0))

    e, mu, v, w = 0.8, 0.1, (1.0, -2.0), -40.0
    jn = (1 + e) * 2.0
    slip = v[0] + w * R
    source = "impulse μ (1 + e) v against the slip, which does not end"
    spinner = disc("disc", R, 5, (0, 0.3), v, w)
    case("impact-spin", "A disc with spin bounces from a floor, e = 0.8, μ = 0.1", [floor(), spinner], everything(mu, e), [
        velocity("vx at 0.3 s", "disc", "x", 0.3, v[0] + mu * jn, 0.02, source),
        velocity("vz at 0.3 s", "disc", "z", 0.3, e * 2.0, 0.04, source),
        velocity("spin at 0.3 s", "disc", "angle", 0.3, w + 2 * mu * jn / R, 0.3, source)], 0.3, gravity=(0, 0))
    assert slip < 0 and slip + 3 * mu * jn < 0

    e, mu = 0.8, 0.05
    v, w = (3.0, 1.0, -2.0), (0.0, 30.0, 0.0)
    slip = (v[0] - w[1] * R, v[1] + w[0] * R)
    size = hypot(*slip)
    jt = [-mu * (1 + e) * 2.0 * s / size for s in slip]
    moment = cross((0, 0, -R), (*jt, 0))
    spin = [w[i] + moment[i] / (0.4 * R * R) for i in range(3)]
    assert mu * (1 + e) * 2.0 < 2 / 7 * size
    ball = ball3("ball", R, 10, (0, 0, 0.3), velocity=v, spin=w)
    case("impact-spin-spatial", "A ball with spin bounces obliquely, e = 0.8, μ = 0.05", [floor3(), ball], everything(mu, e), [
        velocity("vx at 0.3 s", "ball", "x", 0.3, v[0] + jt[0], 0.02, source),
        velocity("vy at 0.3 s", "ball", "y", 0.3, v[1] + jt[1], 0.02, source),
        velocity("vz at 0.3 s", "ball", "z", 0.3, e * 2.0, 0.04, source),
        quantity("spin about x at 0.3 s", "spin", spin[0], 0.1, "rad/s", source, body="ball", axis="x", time=0.3)], 0.3,
        gravity=(0, 0, 0))

    e = 0.9
    offset = (0.06, 0.08)
    d = hypot(*offset)
    depth = sqrt((2 * R)**2 - d * d)
    n = (depth / (2 * R), -offset[0] / (2 * R), -offset[1] / (2 * R))
    j = (1 + e) * 0.5 * 2.0 * n[0]
    pair = [ball3("a", R, 1, (-1, *offset), velocity=(2, 0, 0)), ball3("b", R, 1, (0, 0, 0))]
    central = "impulse along the line of centers"
    case("impact-balls", "Two balls collide obliquely in space, e = 0.9, without friction", pair, everything(0.0, e), [
        velocity("vx of the first at 1 s", "a", "x", 1.0, 2 - j * n[0], 0.02, central),
        velocity("vy of the second at 1 s", "b", "y", 1.0, j * n[1], 0.02, central),
        velocity("vz of the second at 1 s", "b", "z", 1.0, j * n[2], 0.02, central),
        quantity("momentum at 1 s", "momentum", 2.0, 0.01, "N s", "conserved", axis="x", time=1.0)], 1.0, gravity=(0, 0, 0))

    # A rod that drops on its corner without friction: an impulse, then the corner slides along the floor.
    L, H, angle, m = 1.0, 0.02, 0.5, 3.0
    I = m * (L * L + H * H) / 12
    reach, lift = hypot(L / 2, H / 2), atan2(H / 2, L / 2)
    # The corner that is lowest: to the left, at an angle of (angle + lift) below the rod's center.
    height = lambda q: reach * sin(q + lift)
    arm = lambda q: reach * cos(q + lift)
    t1 = sqrt(2 * 0.5 / G)
    x = -arm(angle)
    impulse = G * t1 / (1 / m + x * x / I)  # for e = 0
    w = x * impulse / I

    def slide(_, s):
        q, w = s
        force = m * (G - height(q) * w * w) / (1 + m * arm(q)**2 / I)
        return [w, -arm(q) * force / I]
    q, w = runge_kutta(slide, [angle, w], t1, 0.4, 2000)
    rod = box("rod", L, H, m, (0, height(angle) + 0.5), angle)
    e = 0.5
    after = (1 + e) * impulse
    up, spin = after / m - G * t1, x * after / I
    case("impact-rod-bounce", "A rod that drops on its corner, e = 0.5, without friction", [floor(), rod], everything(0.0, e), [
        velocity("spin at 0.36 s", "rod", "angle", 0.36, spin, 0.2, "impulse at the corner"),
        velocity("vz at 0.36 s", "rod", "z", 0.36, up - G * (0.36 - t1), 0.05, "impulse at the corner")], 0.4)
    corner = "plastic impulse at the corner, then the rod turns while the corner slides; Runge–Kutta"
    case("impact-rod", "A rod that drops on its corner, e = 0, without friction", [floor(), rod], everything(0.0), [
        position("angle at 0.4 s", "rod", "angle", 0.4, q, 0.02, corner),
        velocity("spin at 0.4 s", "rod", "angle", 0.4, w, 0.1, corner),
        position("x at 0.4 s", "rod", "x", 0.4, 0.0, 0.005, "no horizontal force")], 0.4)


# ---------------------------------------------------------------- rocking

def leaning(name, half_width, half_height, mass, angle, base=0.0, x=0.0):
    """A block that stands on its left corner, turned by an angle."""
    at = (x - half_width + cos(angle) * half_width - sin(angle) * half_height,
          base + sin(angle) * half_width + cos(angle) * half_height)
    return box(name, 2 * half_width, 2 * half_height, mass, at, angle)


HOUSNER = "Housner 1963: exact equation of rocking, angular momentum kept about the new corner; Runge–Kutta"


def peaks_between(run, impacts):
    times, angles = run[0], run[1]
    found = []
    for a, b in zip(impacts, impacts[1:]):
        found.append(max(abs(q) for t, q in zip(times, angles) if a <= t <= b))
    return found


def rocks():
    for name, alpha in (("rock-free", 0.25), ("rock-slender", 0.10), ("rock-stocky", 0.40)):
        b, h = sin(alpha), cos(alpha)
        model = Rocking(b, h)
        run = model.run(None, alpha / 2, 6.0)
        hits = run[3]
        quarter = hits[0]
        highs = peaks_between(run, hits[:3])
        window = lambda i: [round(hits[i] + 0.1 * (hits[i + 1] - hits[i]), 2), round(hits[i + 1] - 0.05, 2)]
        block = leaning("block", b, h, 1000, alpha / 2)
        case(name, f"A block of slenderness {alpha} rad rocks freely from half of it", [floor(), block], everything(1.5), [
            quantity("time of the first impact", "crossing", quarter, 0.01 * quarter, "s", HOUSNER, body="block", axis="angle",
                level=0.0, number=1),
            largest("angle after the first impact", "block", "angle", window(0), highs[0], 0.04 * highs[0], HOUSNER),
            largest("angle after the second impact", "block", "angle", window(1), highs[1], 0.06 * highs[1], HOUSNER),
            quantity("time of the second impact", "crossing", hits[1], 0.02 * hits[1], "s", HOUSNER, body="block", axis="angle",
                level=0.0, number=2)], round(hits[2] + 0.15, 1), sample=0.005)

    alpha = 0.25
    b, h = sin(alpha), cos(alpha)
    block = box("block", 2 * b, 2 * h, 1000, (0, h))
    motion = rectangular(0.9 * G * tan(alpha), 1.0, 1.2)
    case("rock-no-uplift", "A block under 0.9 of the acceleration that lifts it", [floor(), block], everything(1.5), [
        largest("largest angle", "block", "angle", [0.0, 1.2], 0.0, 0.001, "a < g b/h")], 1.2, ground=planar_ground(motion))
    motion = rectangular(1.2 * G * tan(alpha), 0.5, 1.2)
    run = Rocking(b, h).run(motion, 0.0, 0.5)
    case("rock-uplift", "A block under 1.2 times the acceleration that lifts it, for 0.5 s", [floor(), block],
         everything(1.5), [position("angle at 0.5 s", "block", "angle", 0.5, run[1][-1], 0.001 + 0.03 * run[1][-1], HOUSNER)],
         1.2, ground=planar_ground(motion))

    # Pulses: p = 2.14 rad/s, slenderness 0.25.
    p = 2.14
    R = 0.75 * G / p**2
    b, h = R * sin(alpha), R * cos(alpha)
    block = box("block", 2 * b, 2 * h, 1000, (0, h))

    def pulse(name, title, rho, half_waves, factor, end=4.0):
        w = rho * p
        A = factor * G * tan(alpha)
        motion = table(lambda t: A * sin(w * t), half_waves * pi / w, half_waves * pi / w / 200, end)
        run = Rocking(b, h).run(motion, 0.0, end)
        top = max(abs(q) for q in run[1])
        falls = top > 1.0
        wanted = [exceeds("overturns", "block", "angle", 1.0, falls, HOUSNER)]
        if not falls:
            wanted.append(largest("largest angle", "block", "angle", [0.0, end], top, 0.05 * top, HOUSNER))
        case(name, f"{title} of {factor} g b/h, frequency {rho} p", [floor(), block], everything(2.0), wanted, end,
             ground=planar_ground(motion))
        return falls
    assert not pulse("rock-half-sine-stands", "A half-sine pulse", 2, 1, 1.65)
    assert pulse("rock-half-sine-falls", "A half-sine pulse", 2, 1, 1.9)
    assert not pulse("rock-sine-low", "A sine pulse", 3, 2, 1.3)
    assert pulse("rock-sine-impact", "A sine pulse, overturning after an impact,", 3, 2, 2.4)
    assert not pulse("rock-sine-island", "A sine pulse between both ways of overturning,", 5, 2, 7.0)
    assert pulse("rock-sine-high", "A sine pulse, overturning without impact,", 5, 2, 8.5)

    alpha = 0.25
    b, h = sin(alpha), cos(alpha)
    base = box("base", 6.0, 1.0, 1e5, (0, 0.5))
    block = leaning("block", b, h, 100, alpha / 2, base=1.0)
    run = Rocking(b, h).run(None, alpha / 2, 3.0)
    high = peaks_between(run, run[3][:2])[0]
    case("rock-on-block", "A block rocks on a heavy block", [floor(), base, block], everything(1.5), [
        quantity("time of the first impact", "crossing", run[3][0], 0.01 * run[3][0], "s", HOUSNER, body="block", axis="angle",
            level=0.0, number=1),
        largest("angle after the first impact", "block", "angle", [0.8, 1.1], high, 0.05 * high, HOUSNER)], 1.2, sample=0.005)
    assert run[3][0] < 0.8 and run[3][1] > 1.15, run[3][:2]

    # In space, turned about the vertical.
    half = (0.27, 0.5, 0.9)
    yaw = math.radians(30)
    model = Rocking(half[0], half[2])
    run = model.run(None, model.alpha / 2, 2.0)
    lean = model.alpha / 2
    q = product(quaternion_of((0, 0, 1), yaw), quaternion_of((0, 1, 0), lean))
    edge = turned(q, (half[0], 0, -half[2]))
    block = box3("block", [2 * s for s in half], 270, (-edge[0], -edge[1], -edge[2]), orientation=q)
    hit = run[3][0]
    high = peaks_between(run, run[3][:2])[0]
    direction = [cos(yaw), sin(yaw), 0]
    case("rock-yaw", "A block in space, turned by 30°, rocks about an edge", [floor3(), block], everything(1.5), [
        quantity("time of the first impact", "crossing", hit, 0.01 * hit, "s", HOUSNER, body="block", axis="lean", toward=direction,
            level=0.0, number=1),
        quantity("lean after the first impact", "largest", high, 0.05 * high, "rad", HOUSNER, body="block", axis="lean",
            toward=direction, between=[round(hit + 0.1, 2), round(run[3][1] - 0.05, 2)])],
        round(run[3][1] + 0.1, 1), sample=0.005)

    limit = 0.27 / (0.9 * cos(yaw))
    for name, push, falls in (("rock-oblique-stands", 0.93 * limit, False), ("rock-oblique-falls", 1.07 * limit, True)):
        block = box3("block", (0.54, 1.473, 1.8), 270, (0, 0, 0.9))
        down = (push * G * cos(yaw), push * G * sin(yaw), -G)
        case(name, f"A block in space pushed obliquely by {push:.3f} g", [floor3(), block], everything(1.0), [
            quantity("tips over", "exceeds", falls, 0, "", "moments about the edge: b/(h cos φ)", body="block", axis="z", level=0.3)],
            3.0, gravity=down)


# ---------------------------------------------------------------- stacks

def stacks():
    weights = "the weight above"
    for n, mass, width, height in ((5, 10.0, 0.5, 0.3), (10, 10.0, 0.5, 0.3)):
        blocks = [box(f"b{i + 1}", width, height, mass, (0, (i + 0.5) * height)) for i in range(n)]
        wanted = []
        for level in (1, 2, n):
            below = "floor" if level == 1 else f"b{level - 1}"
            load = (n - level + 1) * mass * G
            wanted.append(force(f"force under level {level}", [f"b{level}", below], [2.0, 3.0], load, 0.01 * load, weights))
        wanted.append(largest("sideways drift of the top", f"b{n}", "x", [0.0, 3.0], 0.0, 1e-3, "equilibrium"))
        wanted.append(largest("sag of the top", f"b{n}", "dz", [0.0, 3.0], 0.0, 2e-3, "rigid bodies do not sag"))
        case(f"stack-{n}", f"{n} blocks at rest", [floor(), *blocks], everything(0.5), wanted, 3.0)

    pair = [box("light", 0.4, 0.4, 1, (0, 0.2)), box("heavy", 0.6, 0.6, 100, (0, 0.7))]
    case("stack-mass-ratio", "A block of 100 kg on one of 1 kg", [floor(), *pair], everything(0.5), [
        force("force under the light one", ["light", "floor"], [2.0, 3.0], 101 * G, 0.01 * 101 * G, weights),
        force("force between them", ["heavy", "light"], [2.0, 3.0], 100 * G, 0.01 * 100 * G, weights),
        largest("sag of the heavy one", "heavy", "dz", [0.0, 3.0], 0.0, 2e-3, "rigid bodies do not sag")], 3.0)

    for name, push, falls in (("stack-tilt-stands", 0.31, False), ("stack-tilt-falls", 0.36, True)):
        blocks = [box(f"b{i + 1}", 0.4, 0.3, 10, (0, (i + 0.5) * 0.3)) for i in range(4)]
        case(name, f"Four blocks pushed sideways by {push} g (limit 1/3)", [floor(), *blocks], everything(0.8), [
            exceeds("the top falls", "b4", "z", 0.4, falls, "uplift of the whole tower: b/h = 1/3")], 3.0, gravity=(push * G, -G))

    R = 0.35
    gap = 0.01
    up = sqrt(4 * R * R - (R + gap / 2)**2)
    three = [disc("left", R, 100, (-R - gap / 2, R)), disc("right", R, 100, (R + gap / 2, R)), disc("top", R, 100, (0, R + up))]
    load = 150 * G
    case("stack-pyramid-stands", "A disc on two discs, μ = 0.5", [floor(), *three], everything(0.5), [
        force("force under the left one", ["left", "floor"], [1.0, 2.0], load, 0.01 * load, "equilibrium: 3/2 W"),
        force("force between top and left", ["top", "left"], [1.0, 2.0], 50 * G, 0.02 * 50 * G, "equilibrium: W/2 along the line of centers"),
        largest("sag of the top", "top", "dz", [0.0, 2.0], 0.0, 2e-3, "it holds where μ > tan(φ/2) = 0.27")], 2.0)
    case("stack-pyramid-falls", "A disc on two discs, μ = 0.2", [floor(), *three], everything(0.2), [
        exceeds("the top comes down", "top", "z", 0.3, True, "it holds only where μ > tan(φ/2) = 0.27")], 2.0)

    for name, factor, falls in (("stack-overhang-stands", 0.93, False), ("stack-overhang-falls", 1.07, True)):
        ledge = fixed("ledge", {"type": "box", "size": [2, 1]}, (-1, -0.5))
        bricks, x = [], 0.0
        # From the bottom: the right end of each beyond that of the one below it by L/(2 k).
        end = 0.0
        for i in range(4):
            end += factor * 0.5 / (4 - i)
            bricks.append(box(f"b{i + 1}", 1.0, 0.1, 2, (end - 0.5, 0.05 + 0.1 * i)))
        case(name, f"Four bricks that overhang by {factor} of the limit", [ledge, *bricks], everything(0.6), [
            exceeds("the top falls", "b4", "z", 0.1, falls, "overhang L/2 (1 + 1/2 + 1/3 + 1/4)")], 3.0)

    for name, ratio, falls in (("stack-arch-stands", 0.16, False), ("stack-arch-falls", 0.07, True)):
        count, thickness = 9, ratio
        assert line_of_thrust(count, thickness) != falls
        case(name, f"A half-circle arch of nine stones, thickness {ratio} of its radius", [floor(), *arch(count, thickness)],
             everything(1.0), [exceeds("the key stone falls", "s5", "z", 0.3, falls,
                                       "line of thrust within the joints or not; Heyman 1966: 0.106")], 2.0)

    beam = box("beam", 3.0, 0.1, 20, (0, 0.15))
    load = box("load", 0.2, 0.2, 30, (0.5, 0.3))
    props = [fixed("left", {"type": "disc", "radius": 0.1}, (-1, 0)), fixed("right", {"type": "disc", "radius": 0.1}, (1, 0))]
    left, right = 10 * G + 30 * G * 0.25, 10 * G + 30 * G * 0.75
    case("stack-beam", "A beam with a load on two round supports", [*props, beam, load], everything(0.5), [
        force("force on the left", ["beam", "left"], [1.0, 2.0], left, 0.01 * left, "moments"),
        force("force on the right", ["beam", "right"], [1.0, 2.0], right, 0.01 * right, "moments")], 2.0)

    blocks = [box3(f"b{i + 1}", (0.5, 0.4, 0.3), 10, (0, 0, (i + 0.5) * 0.3)) for i in range(4)]
    case("stack-spatial", "Four boxes at rest in space", [floor3(), *blocks], everything(0.5), [
        force("force under level 1", ["b1", "floor"], [1.0, 2.0], 40 * G, 0.4 * G, weights),
        force("force under level 3", ["b3", "b2"], [1.0, 2.0], 20 * G, 0.2 * G, weights),
        largest("sag of the top", "b4", "dz", [0.0, 2.0], 0.0, 2e-3, "rigid bodies do not sag"),
        largest("sideways drift of the top", "b4", "x", [0.0, 2.0], 0.0, 1e-3, "equilibrium")], 2.0)

    drums = [cylinder3(f"d{i + 1}", 0.3, 0.4, 50, (0, 0, (i + 0.5) * 0.4)) for i in range(3)]
    case("stack-drums", "Three standing cylinders at rest in space", [floor3(), *drums], everything(0.5), [
        force("force under the lowest", ["d1", "floor"], [1.0, 2.0], 150 * G, 1.5 * G, weights),
        largest("sag of the top", "d3", "dz", [0.0, 2.0], 0.0, 2e-3, "rigid bodies do not sag"),
        largest("sideways drift of the top", "d3", "x", [0.0, 2.0], 0.0, 1e-3, "equilibrium")], 2.0)

    feet = [(0.6, 0.0), (-0.3, 0.4), (-0.3, -0.4)]
    props = [{"name": f"foot{i + 1}", "fixed": True, "position": [x, y, 0], "orientation": [1, 0, 0, 0],
              "shapes": [{"type": "sphere", "radius": 0.1}]} for i, (x, y) in enumerate(feet)]
    plate = box3("plate", (2.0, 2.0, 0.1), 100, (0.05, 0.1, 0.15))
    exact = (381.5, 422.375, 177.125)
    case("stack-tripod", "A plate on three fixed balls", [*props, plate], everything(0.5), [
        force(f"force on foot {i + 1}", ["plate", f"foot{i + 1}"], [1.0, 2.0], f, 0.01 * f, "moments of 981 N")
        for i, f in enumerate(exact)], 2.0)

    R3 = 0.2
    spread = 2 * R3 / sqrt(3)
    around = [{"name": f"ball{i + 1}", "fixed": True, "position": [spread * cos(2 * pi * i / 3), spread * sin(2 * pi * i / 3), R3],
               "orientation": [1, 0, 0, 0], "shapes": [{"type": "sphere", "radius": R3}]} for i in range(3)]
    up = sqrt((2 * R3)**2 - spread**2)
    top = ball3("top", R3, 10, (0, 0, R3 + up))
    load = 10 * G / (3 * up / (2 * R3))
    case("stack-balls", "A ball on three fixed balls, without friction", [*around, top], everything(0.0), [
        force(f"force on ball {i + 1}", ["top", f"ball{i + 1}"], [1.0, 2.0], load, 0.01 * load, "W/(3 cos γ)") for i in range(3)] +
        [largest("sag of the top", "top", "dz", [0.0, 2.0], 0.0, 2e-3, "equilibrium")], 2.0)

    angle, m, M = pi / 6, 1.0, 2.0
    a = m * G * sin(angle) * cos(angle) / (M + m * sin(angle)**2)
    down = (M + m) * G * sin(angle) / (M + m * sin(angle)**2)
    side = 2.0
    # Right triangle with its slope descending to the right; corners relative to the centroid.
    wide, high = side * cos(angle), side * sin(angle)
    corners = [(-wide / 3, -high / 3), (2 * wide / 3, -high / 3), (-wide / 3, 2 * high / 3)]
    wedge = body("wedge", M, M * (wide**2 + high**2) / 18, [{"type": "polygon", "corners": corners}], (wide / 3, high / 3))
    along = 0.4
    foot = (along * cos(angle) + 0.1 * sin(angle), high - along * sin(angle) + 0.1 * cos(angle))
    slider = box("block", 0.3, 0.2, m, foot, -angle)
    t = 0.4
    source = "momentum and energy of a block on a movable wedge, without friction"
    case("stack-wedge", "A block slides down a wedge that slides away", [floor(), wedge, slider], everything(0.0), [
        position("x of the wedge at 0.4 s", "wedge", "x", t, wide / 3 - a * t * t / 2, 0.01, source),
        position("x of the block at 0.4 s", "block", "x", t, foot[0] + M / m * a * t * t / 2, 0.01, source),
        position("z of the block at 0.4 s", "block", "z", t, foot[1] - down * sin(angle) * t * t / 2, 0.01, source)], t)


def arch(count, thickness):
    """Stones of a half-circle arch of mean radius 1, as trapezoids."""
    inner, outer = 1 - thickness / 2, 1 + thickness / 2
    stones = []
    for i in range(count):
        a, b = pi - i * pi / count, pi - (i + 1) * pi / count
        ring = [(inner * cos(b), inner * sin(b)), (outer * cos(b), outer * sin(b)),
                (outer * cos(a), outer * sin(a)), (inner * cos(a), inner * sin(a))]
        area, cx, cz, second = section(ring)
        corners = [(x - cx, z - cz) for x, z in ring]
        stones.append(body(f"s{i + 1}", 2000 * area, 2000 * second, [{"type": "polygon", "corners": corners}], (cx, cz)))
    return stones


def section(ring):
    """Area, centroid and polar moment about the centroid of a polygon, counterclockwise."""
    area = cx = cz = polar = 0.0
    for (x, z), (u, w) in zip(ring, ring[1:] + ring[:1]):
        c = x * w - u * z
        area += c / 2
        cx += (x + u) * c / 6
        cz += (z + w) * c / 6
        polar += c * (x * x + x * u + u * u + z * z + z * w + w * w) / 12
    cx, cz = cx / area, cz / area
    return area, cx, cz, polar - area * (cx * cx + cz * cz)


def line_of_thrust(count, thickness):
    """Is there a line of thrust within all joints? Thrust and its place in the crown section are searched."""
    stones = arch(count, thickness)
    inner, outer = 1 - thickness / 2, 1 + thickness / 2
    half = count // 2
    weights = [(s["position"][0], s["mass"]) for s in stones]
    joints = [pi - i * pi / count for i in range(half + 1)]
    for i in range(400):
        crown = inner * cos(pi / count / 2) + (outer - inner * cos(pi / count / 2)) * i / 399
        low, high = 0.0, math.inf
        for k, angle in enumerate(joints):
            # Half of the key stone and the stones between joint and crown, about the joint's points.
            loads = weights[k:half] + [(-section_quarter(stones[half]), stones[half]["mass"] / 2)]
            ends = []
            for r in (inner, outer):
                x, z = r * cos(angle), r * sin(angle)
                moment = sum(w * (xw - x) for xw, w in loads)
                ends.append((moment, crown - z))
            # H (crown - z) = moment where the thrust passes the point: between both ends the sign changes.
            # H arm - moment ≥ 0 at the inner end (thrust above it), ≤ 0 at the outer one.
            for (moment, lever), sign in zip(ends, (1, -1)):
                if lever > 1e-9:
                    bound = moment / lever
                    low, high = (max(low, bound), high) if sign > 0 else (low, min(high, bound))
                elif lever < -1e-9:
                    bound = moment / lever
                    low, high = (low, min(high, bound)) if sign > 0 else (max(low, bound), high)
        if low <= high:
            return True
    return False


def section_quarter(stone):
    """Distance of the centroid of half the key stone from the axis of symmetry."""
    corners = [(x + stone["position"][0], z + stone["position"][1]) for x, z in stone["shapes"][0]["corners"]]
    right = [(x, z) for x, z in corners if x > 0]
    ring = [(0.0, min(z for _, z in right)), min(right, key=lambda c: c[1]), max(right, key=lambda c: c[1]),
            (0.0, max(z for _, z in right))]
    return section(ring)[1]


# ---------------------------------------------------------------- falls

def falls():
    for name, overhang, down in (("fall-ledge-stands", 0.47, False), ("fall-ledge-falls", 0.53, True)):
        ledge = fixed("ledge", {"type": "box", "size": [2, 1]}, (-1, -0.5))
        block = box("block", 1.0, 0.2, 10, (overhang - 0.5, 0.1))
        case(name, f"A block of 1 m that overhangs a ledge by {overhang} m", [ledge, block], everything(0.5), [
            exceeds("it falls", "block", "z", 0.2, down, "center of mass beyond the edge or not")], 2.0)

    R, m, v, top = 0.35, 275.0, 2.5, 1.0
    platform = fixed("platform", {"type": "box", "size": [2, 1]}, (-1, 0.5))
    barrel = disc("barrel", R, m, (-0.5, top + R), (v, 0), -v / R)
    t1 = 0.5 / v
    fly = "it leaves the edge at once, since v² > g R; parabola; it lands rolling"
    z = top + R - G * (0.4 - t1)**2 / 2
    case("fall-rack", "A barrel that rolls off a platform of 1 m onto the floor, e = 0", [floor(), platform, barrel],
         everything(0.5), [position("x at 0.4 s", "barrel", "x", 0.4, -0.5 + v * 0.4, 0.02, fly),
                           position("z at 0.4 s", "barrel", "z", 0.4, z, 0.02, fly),
                           position("x at 1 s", "barrel", "x", 1.0, -0.5 + v, 0.03, fly),
                           position("z at 1 s", "barrel", "z", 1.0, R, 0.01, fly),
                           velocity("spin at 1 s", "barrel", "angle", 1.0, -v / R, 0.15, fly)], 1.0)

    # The same in space, with a lying cylinder.
    lying = quaternion_of((1, 0, 0), -pi / 2)
    platform3 = {"name": "platform", "fixed": True, "position": [-1, 0, 0.5], "orientation": [1, 0, 0, 0],
                 "shapes": [{"type": "box", "size": [2, 2, 1]}]}
    drum = cylinder3("barrel", R, 0.9, m, (-0.5, 0, top + R), orientation=lying, velocity=(v, 0, 0), spin=(0, v / R, 0))
    case("fall-rack-spatial", "A cylinder that rolls off a platform of 1 m onto the floor, e = 0", [floor3(), platform3, drum],
         everything(0.5), [position("x at 0.4 s", "barrel", "x", 0.4, -0.5 + v * 0.4, 0.02, fly),
                           position("z at 0.4 s", "barrel", "z", 0.4, z, 0.02, fly),
                           position("x at 1 s", "barrel", "x", 1.0, -0.5 + v, 0.03, fly),
                           position("z at 1 s", "barrel", "z", 1.0, R, 0.01, fly),
                           quantity("spin about y at 1 s", "spin", v / R, 0.15, "rad/s", fly, body="barrel", axis="y", time=1.0)], 1.0)

    # A slender post that tips over.
    b, h = 0.05, 1.0
    model = Rocking(b, h)
    start = 0.1
    run = model.run(None, start, 2.0)
    at = min(range(len(run[0])), key=lambda i: abs(run[1][i] - 0.5))
    time = round(run[0][at], 1)
    at = min(range(len(run[0])), key=lambda i: abs(run[0][i] - time))
    post = leaning("post", b, h, 50, start)
    source = "exact equation of rocking about the corner; Runge–Kutta"
    case("fall-post", "A post that tips over its corner", [floor(), post], everything(1.0), [
        position(f"angle at {time:g} s", "post", "angle", time, run[1][at], 0.02 * run[1][at], source),
        exceeds("it falls", "post", "angle", 1.2, True, source)], time + 1.0)

    block = box3("block", (0.6, 0.5, 0.4), 10, (0, 0, 0.7))
    case("fall-flat-spatial", "A box that drops flat from 0.5 m in space, e = 0", [floor3(), block], everything(0.5), [
        quantity("height after the impact", "peak", 0.2, 0.005, "m", "no bounce", body="block", axis="z", between=[0.4, 1.2]),
        quantity("attitude at 1.2 s", "attitude", 0.0, 0.01, "rad", "symmetry", body="block", time=1.2, reference=[1, 0, 0, 0]),
        force("force at rest", ["block", "floor"], [1.0, 1.2], 10 * G, 0.01 * 10 * G, "its weight")], 1.2)


# ---------------------------------------------------------------- soft contacts, and what codes agree on

def spring(pairs, friction, stiffness, damping):
    return [{"between": pair, "friction": friction, "normal": {"stiffness": stiffness, "damping": damping}} for pair in pairs]


def compliant():
    R, m, k, c = 0.3, 100.0, 1e5, 2000.0
    case("soft-sag", "A disc on a soft floor", [floor(), disc("disc", R, m, (0, R))], spring([["*", "*"]], 0.0, k, c), [
        position("z at 3 s", "disc", "z", 3.0, R - m * G / k, 0.0002, "m g/k"),
        force("force at rest", ["disc", "floor"], [2.5, 3.0], m * G, 0.01 * m * G, "its weight")], 3.0)

    zeta = 0.2
    c = 2 * zeta * sqrt(k * m)
    e = exp(-2 * zeta * math.acos(zeta) / sqrt(1 - zeta**2))
    case("soft-bounce", "A disc thrown at a soft floor, without gravity", [floor(), disc("disc", R, m, (0, R + 0.1), (0, -1))],
         spring([["*", "*"]], 0.0, k, c), [
             velocity("vz at 0.5 s", "disc", "z", 0.5, e, 0.01 * e,
                      "exp(-2 ζ arccos ζ/√(1 - ζ²)) for max(0, k δ + c δ̇), ζ = 0.2")], 0.5, gravity=(0, 0))


def barrels():
    R, pitch, clearance, width, beam = 0.35, 0.76, 0.06, 1.50, 0.04
    k, c = 9.8e5, 2200.0
    ball = 0.005
    A, w = 0.1016, 2 * pi / 1.0748

    def scene(degrees):
        angle = math.radians(degrees)
        racks, barrels_ = [], []
        base = 0.0
        load = 4 * (30 + 2 * 275) * G
        for level in range(4):
            base -= load / 2 / k
            rise = clearance + R - beam / 2
            shapes = [{"type": "box", "size": [width, beam]}]
            for side in (-1, 1):
                for support in (-1, 1):
                    shapes.append({"type": "disc", "radius": ball,
                                   "at": [side * pitch / 2 + support * (R + ball) * sin(angle), rise - (R + ball) * cos(angle)]})
            racks.append(body(f"R{level + 1}", 30, 5.629, shapes, (0, base + beam / 2)))
            load -= 30 * G
            base += clearance
            base -= load / 2 / (2 * cos(angle)**2) / k
            for side, name in ((-1, "1"), (1, "2")):
                barrels_.append(disc(f"B{level + 1}.{name}", R, 275, (side * pitch / 2, base + R)))
            load -= 2 * 275 * G
            base += 2 * R
        every = racks + barrels_
        for b in every:
            b["velocity"] = [-A * w, 0]
        return every
    motion = table(lambda t: -A * w * w * sin(w * t), 4.0, 0.005, 4.0)
    agree = "agreed by MuJoCo (penalty), YADE, Drake, PyBullet (spring contact) and a plain penalty code"

    def laws(scene):
        grounds = [[b["name"], "floor"] for b in scene]
        return spring(grounds, 0.5, k, c) + spring([["*", "*"]], 0.22, k, c)
    for name, degrees, down in (("consensus-20", 20, True), ("consensus-35", 35, False)):
        bodies = scene(degrees)
        names = [b["name"] for b in bodies if b["name"].startswith("B")]
        wanted = [quantity("a barrel falls", "exceeds", down, 0, "", agree, bodies=names, axis="z", level=0.76)]
        if down:
            wanted.append(quantity("time of the first fall", "first_exceeds", 1.82, 0.22, "s",
                            agree + ": 1.64, 1.69, 1.73, 1.75 to 1.85, 2.0 s", bodies=names, axis="z", level=0.76))
        case(name, f"Eight barrels on four racks under a sine, supports at ±{degrees}°", [floor(), *bodies], laws(bodies), wanted,
             4.0, ground=planar_ground(motion))


# ---------------------------------------------------------------- files

def rounded(value):
    """Numbers to twelve digits, so that the files are the same on every machine."""
    if isinstance(value, bool) or value is None or isinstance(value, (str, int)):
        return value
    if isinstance(value, float):
        short = float(f"{value:.10g}")
        return 0.0 if abs(short) < 1e-13 else short
    if isinstance(value, dict):
        return {k: rounded(v) for k, v in value.items()}
    return [rounded(v) for v in value]


def text(made):
    """One line for each body, interface and question."""
    lines = ["{"]
    items = list(made.items())
    for n, (key, value) in enumerate(items):
        comma = "," if n + 1 < len(items) else ""
        if key in ("bodies", "interfaces", "quantities"):
            rows = ",\n".join("    " + json.dumps(row, ensure_ascii=False) for row in value)
            lines.append(f'  "{key}": [\n{rows}\n  ]{comma}')
        else:
            lines.append(f'  "{key}": {json.dumps(value, ensure_ascii=False)}{comma}')
    return "\n".join([*lines, "}", ""])


def main():
    for part in (free, slides, rolls, impacts, rocks, stacks, falls, compliant, barrels):
        part()
    FOLDER.mkdir(exist_ok=True)
    names = {c["id"] for c in CASES}
    assert len(names) == len(CASES)
    for old in FOLDER.glob("*.json"):
        if old.stem not in names:
            old.unlink()
    for made in CASES:
        (FOLDER / f"{made['id']}.json").write_text(text(rounded(made)), encoding="utf-8")
    print(f"{len(CASES)} cases, {sum(len(c['quantities']) for c in CASES)} quantities")


if __name__ == "__main__":
    main()
