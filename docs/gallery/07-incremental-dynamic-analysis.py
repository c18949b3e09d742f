"""Incremental dynamic analysis.

Drift of the top against strength for eight motions; a cross marks the lowest strength that fells the stack.
"""

import matplotlib.pyplot as plt
import numpy as np
from barrelstack import Study

study = Study(
    {
        "base": {"extends": "candia-8-barrels", "stack": {"levels": 3}, "run": {"duration": "20 s"}},
        "motion": [{"synthetic": {"kind": "boore", "count": 8, "magnitude": 6, "distance": "8 km"}}],
        "intensity": {"measure": "pgv"},
        "design": {"kind": "ida", "first": "10 cm/s", "step": "10 cm/s", "runs": 8},
    }
)
study.run("ida")
hunts = study.ida("ida")
figure, ax = plt.subplots(figsize=(6, 4), layout="constrained")
for levels, drifts, capacity in zip(hunts.levels, hunts.demands, hunts.capacities):
    (line,) = ax.plot(100 * np.abs(drifts), 100 * levels, marker=".", linewidth=0.9)
    ax.plot(100 * np.nanmax(np.abs(drifts)), 100 * capacity, "x", color=line.get_color())
ax.set(xlabel="largest drift of the top while the stack stood (%)", ylabel="peak ground velocity (cm/s)")
