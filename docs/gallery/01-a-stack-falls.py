"""A stack falls.

The stack of the paper at four instants of one run, relative to the ground: barrels as circles, racks as points.
"""

import matplotlib.pyplot as plt
from barrelstack import Scenario

scenario = Scenario.load("candia-8-barrels")
frames = scenario.run(variants=0).frames
radius = float(scenario.stack.barrel.section_diameter.split()[0]) / 2
figure, axes = plt.subplots(1, 4, figsize=(9, 3.4), sharey=True, layout="constrained")
for ax, time in zip(axes, (0.0, 1.6, 2.4, 3.2)):
    frame = abs(frames.time - time).argmin()
    for name, (x, z, _) in zip(frames.bodies, frames.poses[frame]):
        if name.startswith("B"):
            ax.add_patch(plt.Circle((x - frames.poses[frame, 0, 0], z), radius, fill=False, color="C3"))
        elif name.startswith("R"):
            ax.plot(x - frames.poses[frame, 0, 0], z, "s", color="0.4", markersize=3)
    ax.axhline(0, color="0.4", linewidth=1)
    ax.set(title=f"{time:.1f} s", xlabel="x (m)", xlim=(-2, 2), ylim=(-0.2, 3.9), aspect="equal")
axes[0].set_ylabel("z (m)")
