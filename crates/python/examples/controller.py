"""A controller: a winch pulls the top of a stack back to its place, with at most 1 kN, at every step."""

from barrelstack import Scenario

scenario = Scenario(
    {
        "stack": {"levels": 4, "columns": 2},
        "motion": {"bundled": "napa-college-2014", "scale": {"pgv": "50 cm/s"}},
        "run": {"until": "duration", "duration": "20 s"},
    }
)
for gain in (0.0, 20e3):
    simulation = scenario.simulation()
    state = simulation.state
    rest = state.pose("R4")[0] - state.pose("ground")[0]
    most = 0.0
    while simulation.ending is None:
        state = simulation.state
        moved = state.pose("R4")[0] - state.pose("ground")[0] - rest
        speed = state.twist("R4")[0] - state.twist("ground")[0]
        pull = -gain * moved - 0.1 * gain * speed
        simulation.apply_force("R4", (min(max(pull, -1e3), 1e3), 0.0))
        simulation.step()
        if simulation.collapse is None:
            most = max(most, abs(moved))
    fate = "stands" if simulation.collapse is None else f"collapses at {simulation.collapse:.1f} s"
    work = simulation.energy.applied_work
    print(f"gain {gain / 1e3:.0f} kN/m: the stack {fate}; the top moved {100 * most:.1f} cm; the winch did {work:.0f} J")
