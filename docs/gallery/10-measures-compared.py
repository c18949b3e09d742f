"""Measures compared.

Shares of 24 variants that collapse, with 95 % intervals: three levels as they are, strapped, and one level lower.
"""

import matplotlib.pyplot as plt
from barrelstack import Record, Scenario, compare

stack = Scenario.load("candia-8-barrels").set({"stack.levels": 3, "run.duration": "40 s"})
stack = stack.with_record(Record.bundled().process("compact").scale(pgv="65 cm/s"))
strap = {"levels": 3, "ties": "levels-together", "pretension": "3 kN"}
runs = {"as it is": stack, "strapped": stack.set("stack.strap", strap), "two levels": stack.set("stack.levels", 2)}
figure, ax = plt.subplots(figsize=(7, 2.4), layout="constrained")
for row, (name, summary) in enumerate(compare(runs, variants=24).runs.items()):
    spread = summary["ensemble"]
    ax.plot([100 * end for end in spread["interval"]], [row, row], color="C0", linewidth=4, alpha=0.4)
    ax.plot(100 * spread["share"], row, "o", color="C0")
ax.set(yticks=range(len(runs)), yticklabels=list(runs), xlabel="variants that collapse (%)", xlim=(-3, 103))
ax.invert_yaxis()
