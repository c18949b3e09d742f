# %% [markdown]
# # Spectrum and intensity measures of a record, against SciPy
#
# The response spectrum at three periods and the Arias intensity of the bundled record, each computed by the package and a second time with SciPy.
# %%
import numpy as np
from barrelstack import Record
from scipy.integrate import trapezoid
from scipy.signal import lsim

record = Record.bundled().process("compact")
periods, ours = record.spectrum([0.3, 1.0, 2.0], of="E")
step, ground = record["E"].time_step, record["E"].acceleration
time, frequencies = step * np.arange(len(ground)), 2 * np.pi / periods
moved = [lsim(([-1.0], [1.0, 2 * 0.05 * w, w**2]), ground, time)[1] for w in frequencies]
theirs = frequencies**2 * np.abs(moved).max(axis=1)
arias = np.pi / (2 * 9.80665) * trapezoid(ground**2, dx=step)
assert np.allclose(ours, theirs, rtol=0.01)
assert np.isclose(record.intensity("arias")[0].values["E"], arias, rtol=0.01)
# %%
dict(zip(periods.tolist(), ours.round(2).tolist()))
# %% [markdown]
# Periods in s, pseudo-accelerations in m/s². The pseudo-acceleration is the largest displacement of a damped oscillator (5 %) times the square of its frequency. Both programs treat the acceleration as linear between samples, so they agree within 1 %.
# The numbers hold for the processed record: the corner of its high-pass filter, 0.1 Hz, limits the periods for which a spectrum has a meaning.
