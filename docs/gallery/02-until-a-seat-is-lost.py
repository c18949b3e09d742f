"""Displacement of the top barrels.

The package's own plot of a run; the dotted line is the time at which the first body leaves its seat.
"""

from barrelstack import Scenario

ax = Scenario.load("candia-8-barrels").run(variants=0).plot()
ax.set(xlim=(0, 2.5), ylim=(-0.6, 0.6))
