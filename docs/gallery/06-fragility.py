"""Fragility of a stack.

Shares of twelve motions that fell six barrels at six strengths, and the lognormal curve with its 95 % band.
"""

from barrelstack import Study

study = Study(
    {
        "base": {"extends": "candia-8-barrels", "stack": {"levels": 3}, "run": {"duration": "20 s"}},
        "motion": [{"synthetic": {"kind": "boore", "count": 12, "magnitude": 6, "distance": "8 km"}}],
        "intensity": {"measure": "pgv", "range": {"from": "15 cm/s", "to": "90 cm/s", "count": 6}},
        "design": {"kind": "stripes"},
    }
)
study.run("fragility")
study.fragility("fragility").plot()
