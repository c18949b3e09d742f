"""A stack under user-supplied accelerations, scaled, with its report as a page."""

import numpy as np

from barrelstack import Record, Scenario

# Any samples will do; these are the samples of the bundled record.
own = Record.bundled()["E"]
samples = np.array(own.acceleration) / 9.80665
record = Record.from_arrays(samples, own.time_step, unit="g", raw=True).process("compact").scale(pgv="80 cm/s")
run = Scenario.load("candia-8-barrels").run(record, variants=16)
run.report("record.html")
print(run.headline)
