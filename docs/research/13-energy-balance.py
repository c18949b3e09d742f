# %% [markdown]
# # The energy balance of a run
#
# Where does the work of the ground go? The change of the stored energies and the dissipated energies together equal the work of the ground, up to a residual that measures the error of the time integration.
# %%
import matplotlib.pyplot as plt
import numpy as np
from barrelstack import Record, Scenario

stack = Scenario.load("candia-8-barrels").set({"stack.levels": 3, "run.duration": "40 s"})
run = stack.run(Record.bundled().process("compact").scale(pgv="50 cm/s"), variants=0)
names = ("kinetic", "potential", "elastic", "stick", "friction", "damped")
energy = {name: run.histories[f"energy_{name}"] for name in names}
work = run.histories["energy_ground_work"]
plt.stackplot(run.histories.time, energy["friction"], energy["damped"])
plt.gca().set(xlabel="time (s)", ylabel="dissipated energy (J)", title="friction (below) and dampers (above)")
assert np.allclose(sum(part - part[0] for part in energy.values()), work, atol=1e-5 * work.max())
assert np.diff(energy["friction"]).min() > -1e-6 and np.diff(energy["damped"]).min() > -1e-6
# %%
{name: round(float(part[-1] - part[0]), 2) for name, part in {"work of the ground": work, **energy}.items()}
# %% [markdown]
# Changes in J from start to end. Friction takes most of the energy, and the dampers of the contacts take the rest: a rocking stack that stands loses its energy by slip and by impacts.
# The two dissipated energies never decrease, which the assertion checks at every sample. The shares belong to this stack, this motion and these constants of the contacts.
