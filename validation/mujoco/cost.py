"""Measures what a step of the same stack in space costs from Python, here and in MuJoCo, on one core.

    cargo run --release -p barrelstack-space --example cases -- 1 cases/cost "stack.levels=3"
    python3 validation/mujoco/cost.py cases/cost

Both stacks are shaken by the same motion from its start; the time is that of the process, over the given seconds of
motion (4 by default), the median of five repetitions. The step of each engine is the one that `compare.py` and a run
take.
"""

import json
import statistics
import sys
import time
from pathlib import Path

import barrelstack
from compare import SETTINGS, build, ground_acceleration, mujoco, np

REPEATS = 5


def of_mujoco(folder, end, each):
    """Returns the time (s) of the process and the number of steps in MuJoCo."""
    case = json.loads(next(iter(sorted(folder.glob("[0-9]*.json")))).read_text())
    motion = json.loads((folder / case["motion"]).read_text())
    model = build(case, SETTINGS)
    data = mujoco.MjData(model)
    step = SETTINGS["step"]
    mujoco.mj_step(model, data, nstep=round(SETTINGS["settle"] / step))
    pushes = ground_acceleration(motion, step, end)
    down = np.array([0.0, 0.0, -case["gravity"]])
    begin = time.process_time()
    # The ground moves in every step, so MuJoCo takes its steps one at a time in either case.
    for push in pushes:
        model.opt.gravity[:] = down - push
        mujoco.mj_step(model, data)
        if each:
            data.xpos.copy()
    return time.process_time() - begin, len(pushes)


def of_ours(view, end, each):
    """Returns the time (s) of the process and the number of steps here."""
    scenario = barrelstack.Scenario.load("demo-napa").set({"stack.levels": 3, "stack.view": view})
    simulation = scenario.simulation(plane="transverse" if view == "both" else None)
    before, steps = float(simulation.time), 0
    begin = time.process_time()
    while float(simulation.time) - before < end:
        many = 1 if each else 200
        simulation.step(many)
        steps += many
        if each:
            simulation.state.poses.copy()
    seconds = time.process_time() - begin
    # The last steps go beyond the end.
    share = end / (float(simulation.time) - before)
    return seconds * share, steps * share


def main():
    """Prints the table."""
    folder = Path(sys.argv[1])
    end = float(sys.argv[2]) if len(sys.argv) > 2 else 4.0
    engines = {
        "MuJoCo, in space": lambda each: of_mujoco(folder, end, each),
        "barrelstack, in space": lambda each: of_ours("spatial", end, each),
        "barrelstack, in a plane": lambda each: of_ours("both", end, each),
    }
    print(
        "| engine | step (ms) | time per step (µs) | time per step, state read after each step (µs) "
        "| time per second of motion (ms) |"
    )
    print("| :--- | ---: | ---: | ---: | ---: |")
    for name, engine in engines.items():
        cells = []
        for each in (False, True):
            found = [engine(each) for _ in range(REPEATS)]
            seconds, steps = statistics.median(one[0] for one in found), found[0][1]
            cells.append((1e6 * seconds / steps, 1e3 * seconds / end, 1e3 * end / steps))
        print(f"| {name} | {cells[0][2]:.3f} | {cells[0][0]:.0f} | {cells[1][0]:.0f} | {cells[0][1]:.0f} |", flush=True)


main()
