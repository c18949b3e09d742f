"""Many cases: the share of collapses against the friction under the racks."""

from barrelstack import ensemble

cases = [{"interface.rack-ground.friction.coefficient": 0.05 * number} for number in range(1, 17)]
table = ensemble(cases, "candia-8-barrels")
fell = table["outcome"].count("collapse")
print(f"{fell} of {len(table)} came down")
