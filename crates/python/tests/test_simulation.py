"""Simulations that advance step by step: the bits of a run, copies, forces, many at once."""

from __future__ import annotations

import copy
import os
import pickle
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import barrelstack
from barrelstack import Run, Scenario, Simulation, SpatialRun

PLANAR = Scenario.load("candia-8-barrels").set({"run.duration": "6 s", "stack.levels": 3})
SPATIAL = Scenario.load("demo-napa").set({"stack.view": "spatial", "stack.levels": 2, "run.duration": "4 s"})


def same(one: Run | SpatialRun, other: Run | SpatialRun) -> None:
    """Asserts that two runs have the same bits."""
    assert one.outcome == other.outcome
    assert one.summary["energy"] == other.summary["energy"]
    assert one.frames.poses.tobytes() == other.frames.poses.tobytes()
    if isinstance(one, Run) and isinstance(other, Run):
        assert list(one.histories) == list(other.histories)
        for name, values in one.histories.items():
            assert values.tobytes() == other.histories[name].tobytes(), name
    elif isinstance(one, SpatialRun) and isinstance(other, SpatialRun):
        assert one.frames.twists.tobytes() == other.frames.twists.tobytes()


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("scenario", [PLANAR, SPATIAL], ids=["plane", "space"])
def test_steps_have_the_bits_of_the_run(scenario: Scenario) -> None:
    run = scenario.run_in_space(variants=0) if scenario is SPATIAL else scenario.run(variants=0)
    simulation = scenario.simulation()
    assert simulation.ending is None
    for _ in range(20):
        assert simulation.step() == 1
    while simulation.ending is None:
        simulation.step(37)
    assert simulation.step(5) == 0
    same(simulation.result(), run)
    same(scenario.simulation().run(), run)


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("scenario", [PLANAR, SPATIAL], ids=["plane", "space"])
def test_ten_thousand_steps_one_by_one_have_the_bits_of_one_call(scenario: Scenario) -> None:
    def once(portion: int) -> tuple[float, bytes]:
        simulation = scenario.simulation()
        begin = time.process_time()
        while simulation.steps < 10_000:
            assert simulation.step(portion) == portion
        return time.process_time() - begin, simulation.state.poses.tobytes()

    # All steps in one call are the loop of the run. The ratio of the times is printed, not tested: it depends on what else
    # runs on the machine. Of two runs, the least CPU time is hardly affected by other programs.
    pairs = [(once(1), once(10_000)) for _ in range(2)]
    assert len({bits for pair in pairs for _, bits in pair}) == 1
    from_python, in_rust = (min(pair[side][0] for pair in pairs) for side in (0, 1))
    print(f"10,000 steps: {from_python:.3f} s from Python, {in_rust:.3f} s in Rust, {from_python / in_rust:.2f} times")


@pytest.mark.filterwarnings("ignore")
def test_a_variant_and_a_plane_are_those_of_the_run() -> None:
    changes = {"imperfections.variants": 4, "run.duration": "3 s", "stack.levels": 2}
    scenario = Scenario.load("candia-8-barrels").set(changes)
    run = scenario.run(variant=3)
    same(scenario.simulation(variant=3).run(), run)
    many = scenario.simulations(4)
    assert many.variants == [1, 2, 3, 4]
    while not many.ended.all():
        many.step(500)
    same(many[2].result(), run)
    both = Scenario.load("demo-napa").set({"run.duration": "2 s", "stack.levels": 2})
    run = both.run(variants=0)
    assert run.other is not None
    for one in (run, run.other):
        same(both.simulation(plane=one.summary["view"]).run(), one)
    with pytest.raises(ValueError, match="it has transverse and longitudinal"):
        both.simulation(plane="across")
    with pytest.raises(ValueError, match="it has none"):
        SPATIAL.simulation(plane="transverse")
    with pytest.raises(ValueError, match="there is no variant 5"):
        scenario.simulation(variant=5)


@pytest.mark.parametrize("scenario", [PLANAR, SPATIAL], ids=["plane", "space"])
def test_a_copy_is_the_complete_state(scenario: Scenario) -> None:
    simulation = scenario.simulation()
    simulation.step(700)
    kept = simulation.copy()
    others = [copy.copy(simulation), copy.deepcopy(simulation)]
    simulation.step(400)
    end = simulation.state
    for other in [kept.copy(), *others]:
        other.step(400)
        assert other.state.poses.tobytes() == end.poses.tobytes()
    push = np.zeros(2 if scenario is PLANAR else 3)
    push[0] = 900.0
    body = simulation.bodies[-1]
    simulation.apply_force(body, push)
    simulation.step(400)
    simulation.reset(kept)
    assert simulation.time == kept.time
    simulation.step(400)
    assert simulation.state.twists.tobytes() == end.twists.tobytes()
    assert simulation.energy.applied_work == 0.0
    simulation.reset()
    assert (simulation.time, simulation.steps) == (0.0, 0)
    simulation.step(1100)
    assert simulation.state.poses.tobytes() == end.poses.tobytes()
    with pytest.raises(ValueError, match="another simulation"):
        simulation.reset(scenario.simulation())
    with pytest.raises(TypeError, match=r"made by copy\(\)"):
        simulation.reset(simulation.state)  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="pickle the scenario"):
        pickle.dumps(simulation)


def test_contacts_and_forces_carry_the_weight() -> None:
    for scenario, up in ((PLANAR, 1), (SPATIAL, 2)):
        simulation = scenario.set("motion", {}).simulation() if scenario is PLANAR else scenario.simulation()
        weight = 9.80665 * sum(simulation.masses.values())
        on_ground = [force for name, force in simulation.forces.items() if name.endswith(" on ground")]
        # Settled to 1e-10 of gravity.
        assert abs(sum(force[up] for force in on_ground) / weight - 1.0) < 1e-6
        contacts = simulation.contacts
        assert contacts.points.shape == contacts.forces.shape == (len(contacts.bodies), up + 1)
        assert (contacts.penetrations >= 0.0).all()
        total = sum(
            (1 if one == "ground" else -1) * -force[up]
            for (one, other), force in zip(contacts.bodies, contacts.forces, strict=True)
            if "ground" in (one, other)
        )
        assert abs(abs(total) / weight - 1.0) < 1e-6
        assert simulation.elements == {}
    strap = "stack.strap={ levels = 2, ties = 'levels-together', pretension = '3 kN' }"
    strapped = Scenario.load("demo-napa", stack__levels=2).set("stack.view", "longitudinal")
    tied = strapped.set("stack.strap", {"levels": 2, "ties": "levels-together", "pretension": "3 kN"}).simulation()
    assert tied.elements, strap
    assert all(1e3 < element.force < 4e3 and not element.broken for element in tied.elements.values())


def test_a_force_beside_friction_stops_a_block_on_half_the_way() -> None:
    scenario = Scenario.load("sliding-block")
    ways = []
    for share in (0.0, 1.0):
        simulation = scenario.simulation()
        brake = share * 0.3 * 9.80665 * simulation.masses["block"]
        start = simulation.state.pose("block")[0]
        simulation.apply_force("block", (-brake, 0.0))
        while simulation.state.twist("block")[0] > 0.01 and simulation.step():
            pass
        ways.append(simulation.state.pose("block")[0] - start)
        work = -brake * ways[-1]
        assert abs(simulation.energy.applied_work - work) <= 1e-9 * abs(work)
    # measured 0.50002
    assert abs(ways[1] / ways[0] - 0.5) < 1e-3


@pytest.mark.parametrize(
    ("words", "kind", "message"),
    [
        (("none", (1.0, 0.0)), KeyError, "there is no body 'none'|there is no body \"none\""),
        (("ground", (1.0, 0.0)), ValueError, "follows the ground"),
        (("block", 1.0), ValueError, "two components, x and z; the number of values found is 1"),
        (("block", (1.0, 0.0, 0.0)), ValueError, "two components, x and z; the number of values found is 3"),
        (("block", (float("nan"), 0.0)), ValueError, "not finite"),
        (("block", (1.0, 0.0), (0.0,)), ValueError, "a point must have two components"),
        (("block", (1.0, 0.0), None, (1.0, 2.0)), ValueError, "a moment must have one component"),
        (("block", "much"), ValueError, "could not convert"),
    ],
)
def test_a_force_that_cannot_act_is_refused(
    words: tuple[object, ...], kind: type[Exception], message: str
) -> None:
    simulation = Scenario.load("sliding-block").simulation()
    with pytest.raises(kind, match=message) as caught:
        simulation.apply_force(*words)  # type: ignore[arg-type]
    if words[1] != "much":
        assert isinstance(caught.value, barrelstack.Error)


def test_many_advance_as_each_does_alone() -> None:
    many = PLANAR.simulations(5)
    many.step(300)
    state = many.state
    assert state.poses.shape == (5, len(many.bodies), 3)
    assert state.time.shape == (5,)
    kept = many.copy()
    top = many.bodies[-1]
    forces = np.zeros((5, 2))
    forces[3, 0] = 500.0
    many.apply_force(top, forces)
    many.step(100)
    for at in range(5):
        one = PLANAR.set("imperfections.variants", 5).simulation(variant=at + 1)
        one.step(300)
        one.apply_force(top, forces[at])
        one.step(100)
        assert one.state.poses.tobytes() == many.state.poses[at].tobytes()
    many.reset(kept, where=np.arange(5) == 3)
    assert (many.time == kept.time).tolist() == [False, False, False, True, False]
    many.apply_force(top, (0.0, 10.0), moment=[1.0, 0.0, 0.0, 2.0, 0.0])
    many.reset()
    assert (many.time == 0.0).all() and not many.ended.any() and np.isnan(many.collapse).all()
    with pytest.raises(IndexError, match="counted from 0"):
        many[5]
    with pytest.raises(ValueError, match="where has 2 entries"):
        many.reset(where=[True, False])
    with pytest.raises(ValueError, match="must be positive"):
        PLANAR.simulations(0)
    with pytest.raises(TypeError, match="pickle the scenario"):
        pickle.dumps(many)
    free = Scenario.load("sliding-block").simulations(3)
    free.apply_force("block", np.array([[0.0, 0.0], [50.0, 0.0], [100.0, 0.0]]))
    free.step(100)
    speeds = free.state.twist("block")[:, 0]
    assert speeds[0] < speeds[1] < speeds[2]


def test_iteration_over_simulations_ends() -> None:
    assert len(list(Scenario.load("sliding-block").simulations(2))) == 2


CTRL_C = """
import os, signal, threading, time
import barrelstack

# Programs that are started in the background ignore Ctrl-C.
signal.signal(signal.SIGINT, signal.default_int_handler)
simulation = barrelstack.Scenario.load("candia-8-barrels").set("run.step", "1 us").{start}
threading.Timer(1.0, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
begun = time.process_time()
try:
    simulation.step(10**9)
except KeyboardInterrupt:
    print("stopped")
"""


@pytest.mark.skipif(os.name == "nt", reason="signals are those of POSIX")
@pytest.mark.parametrize("start", ["simulation()", "simulations(3)"])
def test_ctrl_c_ends_many_steps(start: str) -> None:
    words = [sys.executable, "-c", CTRL_C.format(start=start)]
    done = subprocess.run(words, capture_output=True, text=True, check=False, timeout=60)
    assert done.stdout == "stopped\n", done.stderr


def test_threads_step_at_the_same_time_as_others_look() -> None:
    simulation = PLANAR.simulation()
    thread = threading.Thread(target=lambda: simulation.step(3000))
    thread.start()
    seen = [simulation.state.time for _ in range(50) if time.sleep(0.001) is None]
    thread.join()
    assert seen == sorted(seen)
    other: Simulation = PLANAR.simulation()
    other.step(3000)
    assert other.state.poses.tobytes() == simulation.state.poses.tobytes()
    assert signal.getsignal(signal.SIGINT) is not None
