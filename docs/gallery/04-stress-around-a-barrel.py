"""Normal stress around a barrel of the bottom level.

At rest, and the largest at each point until the first loss of a seat.
"""

import matplotlib.pyplot as plt
from barrelstack import Scenario

envelope = Scenario.load("candia-8-barrels").run(variants=0).envelopes["B1.1"]
figure, ax = plt.subplots(subplot_kw={"projection": "polar"}, figsize=(4.5, 4.5), layout="constrained")
ax.plot(envelope.coordinate, envelope.peak / 1e3, label="largest", color="C3", linewidth=1)
ax.plot(envelope.coordinate, envelope.at_rest / 1e3, label="at rest", color="C0", linewidth=1)
ax.set_rlabel_position(60)
ax.set_rticks([500, 1000, 1500])
ax.set_title("normal stress on B1.1 (kN/m)", fontsize="medium")
ax.legend(fontsize="small", loc="upper right")
