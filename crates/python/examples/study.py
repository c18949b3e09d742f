"""A study: a stack of each height under one motion at three strengths, and its fragility."""

import tempfile

from barrelstack import Study

study = Study(
    """
    schema = 1
    [base]
    extends = "demo-napa"
    [base.stack]
    view = "longitudinal"
    [[factor]]
    field = "stack.levels"
    values = [2, 4, 6]
    [intensity]
    measure = "pgv"
    range = { from = "20 cm/s", to = "120 cm/s", count = 6 }
    [design]
    kind = "full-factorial"
    """
)
with tempfile.TemporaryDirectory() as folder:
    table = study.run(folder)
    print(table.to_csv().splitlines()[0][:80])
    fragility = study.fragility(folder)
    print(fragility.headline)
    for name, curve in fragility.curves.items():
        print(name, curve.median, curve.no_curve)
