"""Runs rooms of two and three stacks in barrelstack and in MuJoCo, and compares which stacks fall or are knocked over.

`check` runs trivial cases; `mujoco` runs the rooms in both engines, and `ours` again in barrelstack with seats as in
MuJoCo; `table` compares.
"""

import argparse
import csv
import json
from pathlib import Path

import mujoco
import numpy as np

import rooms
from mujoco_room import SETTINGS, compare, run

GRAVITY = 9.80665
FATES = ("stands", "falls-by-itself", "knocked-over")


def alike_changes():
    """Returns changes of a room that give its seats the friction and the damping of MuJoCo."""
    return [f"interface.{seat}.{own}" for seat in ("barrel-rack", "rack-ground") for own in rooms.ALIKE]


def samples_of(program, out, room):
    """Returns the accelerations (m/s²) of a room before they are scaled: east, north and up."""
    if room["pulse"]:
        level = rooms.pulse_of(**room["pulse"])
        return np.column_stack([level, np.zeros(len(level))])
    return rooms.strong_part(program, out)


def prepared(program, out, room):
    """Returns the folder of a room with its files."""
    folder = out / f"{room['number']:02d}"
    folder.mkdir(parents=True, exist_ok=True)
    if not (folder / "room.toml").exists():
        samples = samples_of(program, out, room)
        rooms.write_record(folder / "motion.txt", samples[:, :2] if room["pulse"] else samples)
        rooms.write_room(folder, room)
    return folder


def ours(program, out, chosen):
    """Runs rooms with barrelstack, as stated, then with seats as in MuJoCo."""
    for name, changes in (("ours", ()), ("alike", alike_changes())):
        for room in chosen:
            answer = rooms.run_room(program, prepared(program, out, room), name, changes)
            fates = [stack["fate"] for stack in answer["shown"]["stacks"]]
            print(name, room["number"], room["levels"], fates, f"{answer['seconds']:.1f} s", flush=True)


def kept_name(settings):
    """Returns the name of the file with the results of MuJoCo for some settings."""
    changed = [f"{key}-{value:g}" for key, value in settings.items() if value != SETTINGS[key]]
    return "_".join(["mujoco", *changed]) + ".json"


def theirs(program, out, chosen, settings):
    """Runs rooms with MuJoCo."""
    for room in chosen:
        folder = prepared(program, out, room)
        kept = folder / kept_name(settings)
        if not kept.exists():
            answer = rooms.run_room(program, folder, "ours")
            case = rooms.case_of(program, folder, room, answer)
            samples = room["factor"] * samples_of(program, out, room)
            result = run(case, lambda times, of=samples: rooms.velocities(of, times), rooms.DURATION, settings)
            kept.write_text(json.dumps(result))
        result = json.loads(kept.read_text())
        fates = [stack["fate"] for stack in result["stacks"]]
        print(kept.stem, room["number"], room["levels"], fates, f"{result['seconds']:.1f} s", flush=True)


def check(program, out):
    """Prints trivial cases in which both engines must agree."""
    folder = out / "check"
    folder.mkdir(parents=True, exist_ok=True)
    room = rooms.draw(1, 1)[0] | {"number": 1001, "levels": [3, 5], "factor": 1.0, "pulse": None, "friction": 0.3}
    rooms.write_record(folder / "motion.txt", rooms.strong_part(program, out))
    if not (folder / "room.toml").exists():
        rooms.write_room(folder, room, moves=False, duration=5.0)
    answer = rooms.run_room(program, folder, "rest")
    case = rooms.case_of(program, folder, room, answer)
    weight = case["gravity"] * sum(body["mass"] for body in case["bodies"][1:])
    found = run(case, None, 5.0, SETTINGS, to_the_end=True)
    moved = max(stack["moved"] for stack in answer["shown"]["stacks"])
    print(f"at rest for 5 s: ours moves by {1e3 * moved:.6f} mm, MuJoCo by {1e3 * found['drift']:.3f} mm,")
    print(f"  after settling {1e3 * found['settled_by']:.2f} mm from where ours rests")
    print(f"  force on the floor: MuJoCo {found['floor_force']:.2f} N, weight {weight:.2f} N")
    # A stack by itself has the imperfections that it has in the room.
    moved_room = folder / "moved"
    moved_room.mkdir(exist_ok=True)
    (moved_room / "motion.txt").write_text((folder / "motion.txt").read_text())
    rooms.write_room(moved_room, room | {"spacing": 3.0, "across": True})
    answer = rooms.run_room(program, moved_room, "ours")
    for stack, levels in zip(answer["shown"]["stacks"], room["levels"]):
        alone = rooms.run_alone(program, moved_room, room, stack["name"], levels, True, rooms.DURATION)
        summary = json.loads((alone / "summary.json").read_text())
        end = None if stack["falls_at"] is None else stack["falls_at"] + answer["onset"]
        print(f"stack {stack['name']} in a room falls at {end}, alone at {summary['outcome']['time']}")
    slide(program, folder)


def slide(program, folder):
    """Prints how far a lying barrel slides along its axis on the ground, in both engines."""
    for speed, friction, damping in ((1.0, 0.05, 1e3), (2.0, 0.4, 1e3), (2.0, 0.4, 1e4)):
        mine, theirs_at = slid(program, folder, speed, friction, damping)
        exact = speed**2 / (2.0 * friction * GRAVITY)
        print(
            f"a barrel slides along its axis from {speed} m/s with friction {friction} and a damper of {damping:.0f} N s/m: "
            f"a block {exact:.4f} m, ours {mine:.4f} m, MuJoCo {theirs_at:.4f} m"
        )


def slid(program, folder, speed, friction, damping):
    """Returns how far (m) a lying barrel slides, here and in MuJoCo, on a spring of 10 MN/m with a damper."""
    mass, seconds = 268.75, 3.0
    size = {"length": 0.945, "bilge_diameter": 0.69, "head_diameter": 0.555}
    solid = ", ".join(f'{key} = "{value} m"' for key, value in size.items())
    height = 0.345 - mass * GRAVITY / 1e7
    text = f"""schema = 1
kind = "free-spatial"
[[body]]
name = "barrel"
solid = {{ type = "barrel", {solid} }}
mass = "{mass} kg"
position = ["0 m", "0 m", "{height} m"]
velocity = ["{speed} m/s", "0 m/s", "0 m/s"]
[[interface]]
between = ["barrel", "ground"]
law = "kelvin-voigt"
stiffness = "10 MN/m"
damping = "{damping} N s/m"
friction = {{ coefficient = {friction} }}
[run]
duration = "{seconds} s"
settle = false
"""
    (folder / "slide.toml").write_text(text)
    rooms.call(program, folder, ["run", "slide.toml", "--variants", "0", "--quiet", "--out", "slide", "--overwrite"])
    mine = json.loads((folder / "slide" / "summary.json").read_text())["bodies"][0]
    # The moments of inertia of a homogeneous barrel.
    solid = rooms.barrel_solid(size)
    axial, across = rooms.homogeneous(solid, mass)
    barrel = {
        "name": "a/B1.1",
        "kind": "barrel",
        "mass": mass,
        "inertia": [axial, across, across],
        "position": [0.0, 0.0, height],
        "quaternion": [1.0, 0.0, 0.0, 0.0],
        "solids": [solid],
    }
    law = {"normal": {"kind": "kelvin-voigt", "stiffness": 1e7, "damping": damping}, "friction": friction}
    ground = {"name": "ground", "kind": "ground", "solids": []}
    case = {"gravity": GRAVITY, "bodies": [ground, barrel], "interfaces": [law], "pairs": [[1, 0, 0, 0, 0]]}
    model = compare.build(case, SETTINGS)
    data = mujoco.MjData(model)
    data.qvel[0] = speed
    for _ in range(round(seconds / SETTINGS["step"])):
        mujoco.mj_step(model, data)
    return mine["position"][0], float(data.qpos[0])


def rows_of(out, chosen, settings):
    """Returns one row for each stack, with its fates in all engines."""
    rows = []
    for room in chosen:
        folder = out / f"{room['number']:02d}"
        results = {"mujoco": json.loads((folder / kept_name(settings)).read_text())["stacks"]}
        for name in ("ours", "alike"):
            if (folder / f"{name}.json").exists():
                answer = json.loads((folder / f"{name}.json").read_text())
                onset = answer["onset"]
                results[name] = [
                    stack
                    | {key: None if stack[key] is None else stack[key] + onset for key in ("falls_at", "touched_at")}
                    for stack in answer["shown"]["stacks"]
                ]
        for at, levels in enumerate(room["levels"]):
            pulse = room["pulse"]
            row = {
                "room": room["number"],
                "stack": results["mujoco"][at]["name"],
                "levels": levels,
                "neighbors": "across" if room["across"] else "along",
                "spacing (m)": room["spacing"],
                "friction": room["friction"],
                "motion": f"pulse {pulse['peak']} m/s {pulse['period']} s {pulse['azimuth']} deg"
                if pulse
                else room["factor"],
            }
            for name, stacks in results.items():
                stack = stacks[at]
                row[name] = stack["fate"]
                for key in ("falls_at", "touched_at"):
                    row[f"{name} {key} (s)"] = "" if stack[key] is None else f"{stack[key]:.3f}"
            rows.append(row)
    return rows


def clustered(rows, name, of, draws=4000):
    """Returns the difference of two shares, ours less MuJoCo's, and its 95 % interval by drawing whole rooms."""
    by_room = {}
    for row in rows:
        by_room.setdefault(row["room"], []).append(of(row[name]) - of(row["mujoco"]))
    sums = np.array([[sum(values), len(values)] for values in by_room.values()], dtype=float)
    picks = np.random.default_rng(1).integers(0, len(sums), (draws, len(sums)))
    drawn = sums[picks].sum(axis=1)
    low, high = np.percentile(drawn[:, 0] / drawn[:, 1], [2.5, 97.5])
    return sums[:, 0].sum() / sums[:, 1].sum(), low, high


def table(out, chosen, settings, path):
    """Prints the comparison, and writes one row for each stack."""
    rows = rows_of(out, chosen, settings)
    count = len(rows)
    classes = {
        "falls by itself": lambda fate: fate == FATES[1],
        "knocked over": lambda fate: fate == FATES[2],
        "falls": lambda fate: fate != FATES[0],
    }
    names = [name for name in ("ours", "alike", "mujoco") if all(name in row for row in rows)]
    print(f"{len(chosen)} rooms, {count} stacks")
    for title, of in classes.items():
        for name in names:
            many = sum(of(row[name]) for row in rows)
            print(f"  {title}, {name}: {compare.summarized(many, count)}")
        for name in names[:-1]:
            only = sum(of(row[name]) and not of(row["mujoco"]) for row in rows)
            other = sum(of(row["mujoco"]) and not of(row[name]) for row in rows)
            difference, low, high = clustered(rows, name, of)
            print(
                f"    {name}: only ours {only}, only MuJoCo {other}, McNemar p = {compare.mcnemar(only, other):.2g}; difference "
                f"{100 * difference:+.0f} points, {100 * low:+.0f} to {100 * high:+.0f} over rooms"
            )
    for name in names[:-1]:
        print(f"  {name} (rows) against MuJoCo (columns): {', '.join(FATES)}")
        for fate in FATES:
            line = [sum(row[name] == fate and row["mujoco"] == other for row in rows) for other in FATES]
            print(f"    {fate:16}", *line)
        same = sum(row[name] == row["mujoco"] for row in rows)
        both = [(row[f"{name} falls_at (s)"], row["mujoco falls_at (s)"]) for row in rows]
        apart = [float(b) - float(a) for a, b in both if a and b]
        close = sum(abs(value) < 0.5 for value in apart)
        print(
            f"    same fate {same} of {count}; of {len(apart)} that fall in both, {close} within 0.5 s, MuJoCo later by "
            f"{np.median(apart):+.2f} s (median)"
        )
    for levels in range(2, 6):
        of_level = [row for row in rows if row["levels"] == levels]
        counts = [
            f"{name} {sum(r[name] == FATES[1] for r in of_level)} + {sum(r[name] == FATES[2] for r in of_level)}"
            for name in names
        ]
        print(f"  {levels} levels, {len(of_level)} stacks, by themselves + knocked over: {'; '.join(counts)}")
    for name in names:
        touched = sum(bool(row[f"{name} touched_at (s)"]) for row in rows)
        print(f"  touched by another stack, {name}: {touched}")
    repeated = [row for row in rows if "alike" in row]
    if repeated:
        same = [sum(row[name] == row["mujoco"] for row in repeated) for name in ("ours", "alike")]
        print(
            f"  {len({row['room'] for row in repeated})} rooms with seats as in MuJoCo, {len(repeated)} stacks: the fate of "
            f"MuJoCo in {same[0]} as stated, in {same[1]} with these seats"
        )
    cost(out, chosen, settings)
    if path:
        fields = list(dict.fromkeys(key for row in rows for key in row))
        with path.open("w", newline="") as file:
            writer = csv.DictWriter(file, fields)
            writer.writeheader()
            writer.writerows(rows)


def cost(out, chosen, settings):
    """Prints the processor time of both engines for a second of a stack."""
    for name, file in (("ours", "ours.json"), ("alike", "alike.json"), ("mujoco", kept_name(settings))):
        seconds = simulated = 0.0
        for room in chosen:
            path = out / f"{room['number']:02d}" / file
            if path.exists():
                result = json.loads(path.read_text())
                end = result["end_time"] if name == "mujoco" else result["shown"]["end_time"]
                seconds += result["seconds"]
                simulated += end * len(room["levels"])
        if simulated:
            print(
                f"  {name}: {seconds / 60:.1f} min of processor time, {1e3 * seconds / simulated:.0f} ms for a second of a stack"
            )


def main():
    """Runs one command."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("command", choices=["check", "ours", "mujoco", "table"])
    parser.add_argument("--program", default="barrelstack")
    parser.add_argument("--out", type=Path, default=Path("rooms"))
    parser.add_argument("--rooms", type=int, default=50)
    parser.add_argument("--seed", type=int, default=41)
    parser.add_argument("--only", default="", help="numbers of rooms, as `1,2,3`; all where it is left out")
    parser.add_argument("--set", action="append", default=[], help="a setting of MuJoCo, as `step=0.00025`")
    parser.add_argument("--csv", type=Path, help="the file of `table` with one row for each stack")
    arguments = parser.parse_args()
    settings = dict(SETTINGS)
    for change in arguments.set:
        key, value = change.split("=")
        settings[key] = type(SETTINGS[key])(value)
    numbers = {int(number) for number in arguments.only.split(",") if number}
    drawn = rooms.draw(arguments.seed, arguments.rooms)
    chosen = [room for room in drawn if not numbers or room["number"] in numbers]
    out = arguments.out
    out.mkdir(parents=True, exist_ok=True)
    if arguments.command == "check":
        check(arguments.program, out)
    elif arguments.command == "ours":
        ours(arguments.program, out, chosen)
    elif arguments.command == "mujoco":
        theirs(arguments.program, out, chosen, settings)
    else:
        table(out, chosen, settings, arguments.csv)


if __name__ == "__main__":
    main()
