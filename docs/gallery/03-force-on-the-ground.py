"""Force of the bottom rack on the ground.

The vertical force varies about the weight of the stack; the horizontal force cannot exceed the friction.
"""

import matplotlib.pyplot as plt
from barrelstack import Record, Scenario

stack = Scenario.load("candia-8-barrels").set({"stack.levels": 3, "run.duration": "40 s"})
run = stack.run(Record.bundled().process("compact").scale(pgv="50 cm/s"), variants=0)
force = run.forces["R1 on ground"]
figure, ax = plt.subplots(figsize=(8, 3), layout="constrained")
ax.plot(run.histories.time, force.vertical / 1e3, linewidth=0.7, label="vertical")
ax.plot(run.histories.time, force.horizontal / 1e3, linewidth=0.7, label="horizontal")
ax.axhline(force.at_rest / 1e3, color="0.3", linestyle=":", linewidth=1, label="weight of the stack")
ax.set(xlabel="time (s)", ylabel="force (kN)", xlim=(3, 15))
ax.legend(fontsize="small", ncols=3)
