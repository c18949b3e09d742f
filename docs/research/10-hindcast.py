# %% [markdown]
# # A hindcast with a record of your own
#
# After an earthquake, 5 of 12 equal stacks lie on the floor, and an instrument nearby has recorded the ground. Does the model agree? The record here is synthetic and is written to a file first; replace the file by your own.
# %%
from barrelstack import Record, Scenario
from scipy.stats import fisher_exact

motion = Record.made(synthetic={"kind": "boore", "magnitude": 6.3, "distance": "7 km", "seed": 7})
motion.scale(pgv="60 cm/s").write("site.at2")
stack = Scenario.load("candia-8-barrels").set({"stack.levels": 3, "run.duration": "30 s"})
run = stack.run(Record.read("site.at2"), variants=64)
model, observed = (run.ensemble["collapsed"], run.ensemble["variants"]), (5, 12)
test = fisher_exact([[fell, of - fell] for fell, of in (model, observed)])
assert model[1] == 64 and 0 < test.pvalue <= 1
# %%
print(f"model: {model[0]} of {model[1]} fall; observed: {observed[0]} of {observed[1]}; p = {test.pvalue:.2f}")
# %% [markdown]
# A small p-value would mean that such different counts are unlikely if stacks fell with one probability; a large one means only that twelve stacks cannot contradict the model.
# The comparison rests on the ground at the instrument being that under the stacks, on twelve stacks that fall independently, although one motion shakes all of them, and on the assumed spread of friction and stiffness among the variants.
