# %% [markdown]
# # Incremental dynamic analysis under twenty motions
#
# Each of twenty synthetic motions of magnitude 6 is made stronger until the stack falls (hunt and fill, six runs per motion).
# %%
import matplotlib.pyplot as plt
import numpy as np
from barrelstack import Study

base = {"extends": "candia-8-barrels", "stack": {"levels": 3}, "run": {"duration": "20 s"}}
motion = {"synthetic": {"kind": "boore", "count": 20, "magnitude": 6, "distance": "8 km"}}
design = {"kind": "ida", "first": "15 cm/s", "step": "15 cm/s", "runs": 6}
Study({"base": base, "motion": [motion], "intensity": {"measure": "pgv"}, "design": design}).run("ida")
capacities = Study.ida("ida").capacities
low, median, high = np.nanquantile(capacities, [0.16, 0.5, 0.84])
plt.plot(np.sort(100 * capacities), np.arange(1, 21) / 20, drawstyle="steps-post")
plt.gca().set(xlabel="peak ground velocity (cm/s)", ylabel="share of motions that fell the stack")
assert len(capacities) == 20 and 0.15 < low < median < high
print(f"16, 50 and 84 %: {low:.2f}, {median:.2f} and {high:.2f} m/s")
# %% [markdown]
# The curve is the distribution of the capacity over the motions: the lowest peak ground velocity at which each motion fells the stack.
# It rests on one stack without differences in friction or placement and on motions of a single magnitude and distance. A motion that is made stronger may fell the stack, spare it and fell it again; the lowest level is not always the first of a contiguous range.
