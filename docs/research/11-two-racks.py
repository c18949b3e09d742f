# %% [markdown]
# # Two racks compared
#
# Three levels on racks that stand on barrels, and on racks that stand on racks, across the barrels: the same motion, the same draws of friction.
# %%
from barrelstack import Record, Scenario, compare

record = Record.bundled().process("compact").scale(pgv="90 cm/s")
stack = Scenario.load("demo-napa").set({"stack.view": "transverse", "stack.levels": 3}).with_record(record)
racks = {name: stack.set("stack.rack.base", name) for name in ("two-barrel", "rack-on-rack")}
both = compare(racks, variants=12)
fell = {name: summary["ensemble"]["collapsed"] for name, summary in both.runs.items()}
ranges = {name: summary["ensemble"]["interval"] for name, summary in both.runs.items()}
assert set(fell) == set(racks) and all(low <= fell[name] / 12 <= high for name, (low, high) in ranges.items())
# %%
print(both.headline)
for name, (low, high) in ranges.items():
    print(f"{name}: {fell[name]} of 12 fall, 95 % interval {100 * low:.0f} to {100 * high:.0f} %")
# %% [markdown]
# The two intervals overlap, but they are not independent: each variant has the same friction and stiffness on both racks, and every variant that the rack changes is a fall on two-barrel racks. The intervals count variants of one stack under one motion.
# A choice of racks needs many motions and both planes, which `protect` runs.
