"""A stack of wine barrels, shaken by a sine."""

from barrelstack import Scenario

run = Scenario(
    {
        "stack": {"levels": 4, "columns": 2},
        "motion": {"sine": {"amplitude": "10 cm", "period": "0.8 s", "cycles": 5}},
    }
).run(variants=0)
print(run.headline)
top = run.histories["B4.1_displacement_x"]
print(f"{run.outcome.kind}; the top moves by up to {100 * abs(top).max():.1f} cm")
