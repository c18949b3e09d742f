# %% [markdown]
# # Height against direction
#
# Stacks of two to five levels, shaken across and along their barrels by six motions of 50 cm/s.
# %%
from itertools import product

import pandas as pd
from barrelstack import Record, Scenario, ensemble

stack = Scenario.load("demo-napa").set({"stack.view": "transverse", "run.stop_after_collapse": "0.1 s"})
views = [("transverse", 2), ("longitudinal", 1)]
motions = [Record.made(synthetic={"kind": "boore", "magnitude": 6, "distance": "8 km", "seed": n}) for n in range(6)]
grid = product(views, range(2, 6), [motion.scale(pgv="50 cm/s") for motion in motions])
names = ("stack.view", "stack.columns", "stack.levels", "record")
cases = [dict(zip(names, (*view, levels, record))) for view, levels, record in grid]
table = pd.DataFrame(ensemble(cases, stack))
shares = (table["outcome"] == "collapse").groupby([table["stack.levels"], table["stack.view"]]).mean().unstack()
assert shares.shape == (4, 2) and shares["longitudinal"].mean() >= shares["transverse"].mean()
# %%
shares.round(2)
# %% [markdown]
# Along the barrels, where a rack is narrow, stacks fall more often than across them, and higher stacks fall more often than low ones.
# Each share counts six motions of one strength under a nominal stack; `heights` computes safe heights with intervals from many motions and levels of shaking.
