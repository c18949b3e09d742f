"""Response spectra, and a record matched to a code.

Both horizontal components of South Napa 2014, their median over all directions, and one matched to Eurocode 8.
"""

import matplotlib.pyplot as plt
import numpy as np
from barrelstack import Record

record, at = Record.bundled().process("compact"), np.geomspace(0.05, 4, 100)
matched = record.match("ec8:ag=0.3,site=B", of="E", periods=(0.15, 2.5), tolerance=0.08)
figure, ax = plt.subplots(figsize=(7, 4), layout="constrained")
curves = (("E", record, "E"), ("N", record, "N"), ("RotD50", record, "rotd50"), ("E, matched", matched, "E"))
for label, one, of in curves:
    periods, acceleration = one.spectrum(at, of=of)
    ax.loglog(periods, acceleration / 9.80665, label=label, linewidth=1.8 if one is matched else 1)
ax.set(xlabel="period (s)", ylabel="Sa, 5 % damping (g)")
ax.legend(fontsize="small")
