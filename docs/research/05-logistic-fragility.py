# %% [markdown]
# # A logistic fragility curve with statsmodels
#
# Twelve synthetic motions at eight strengths, and a logistic regression of collapse on the logarithm of the peak ground velocity. Cases of one motion resemble each other, so the standard errors are clustered by motion.
# %%
from itertools import product

import numpy as np
import statsmodels.api as sm
from barrelstack import Record, Scenario, ensemble

stack = Scenario.load("candia-8-barrels").set({"stack.levels": 3, "run.duration": "20 s"})
motions = [Record.made(synthetic={"kind": "boore", "magnitude": 6, "distance": "8 km", "seed": n}) for n in range(12)]
pairs = list(product(range(12), np.linspace(20, 90, 8)))
table = ensemble([{"record": motions[n], "motion.scale.pgv": f"{v} cm/s"} for n, v in pairs], stack)
fell = [int(outcome == "collapse") for outcome in table["outcome"]]
model = sm.Logit(fell, sm.add_constant(np.log([v for _, v in pairs])))
fit = model.fit(disp=False, cov_type="cluster", cov_kwds={"groups": [n for n, _ in pairs]})
median = np.exp(-fit.params[0] / fit.params[1])
assert fit.mle_retvals["converged"] and 20 < median < 90 and fit.pvalues[1] < 0.05
# %%
print(f"median {median:.0f} cm/s; slope {fit.params[1]:.1f} ± {fit.bse[1]:.1f}; {sum(fell)} of 96 cases fell")
# %% [markdown]
# The median is the peak ground velocity at which the model gives an even chance of collapse. `Study.fragility` fits a lognormal curve to such data and also draws the friction of each stack.
# The curve rests on twelve motions and one nominal stack: it describes how motions differ, not how stacks differ.
