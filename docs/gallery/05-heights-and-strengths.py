"""Outcomes by height and strength.

One motion, four heights and fifteen strengths. Collapse is chaotic: a stronger motion may do less damage.
"""

import matplotlib.pyplot as plt
import numpy as np
from barrelstack import Record, Scenario, ensemble

levels, strengths, record = [2, 3, 4, 5], np.linspace(20, 90, 15), Record.bundled()
cases = [{"stack.levels": n, "motion.scale.pgv": f"{v} cm/s", "record": record} for n in levels for v in strengths]
table = ensemble(cases, Scenario.load("candia-8-barrels").set("run.duration", "40 s"))
fallen = np.array(table["barrels_fallen"], float) / np.array(table["barrels"], float)
figure, ax = plt.subplots(figsize=(7, 3), layout="constrained")
image = ax.pcolormesh(strengths, levels, 100 * fallen.reshape(4, 15), cmap="Reds", shading="nearest", vmin=0, vmax=100)
figure.colorbar(image, label="barrels fallen (%)")
ax.set(xlabel="peak ground velocity (cm/s)", ylabel="levels", yticks=levels)
