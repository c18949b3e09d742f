"""Tables of cases."""

from __future__ import annotations

import numpy as np
import pytest

import barrelstack
from barrelstack import Record, Scenario, ScenarioError, Table, ensemble

BASE = Scenario.load("candia-8-barrels").set({"stack.levels": 2, "run.duration": "3 s"})
MU = "interface.rack-ground.friction.coefficient"


@pytest.fixture(scope="module")
def table() -> Table:
    return ensemble([{MU: mu, "motion.scale.factor": f} for mu in (0.2, 0.4) for f in (0.5, 1.0)], BASE)


def test_a_polars_frame_gives_the_table_of_a_list(table: Table) -> None:
    pl = pytest.importorskip("polars", reason="no polars")
    frame = pl.DataFrame({MU: [0.2, 0.2, 0.4, 0.4], "motion.scale.factor": [0.5, 1.0, 0.5, 1.0]})
    found = ensemble(frame, BASE)
    assert found.to_csv() == table.to_csv()
    back = pl.DataFrame(found)
    assert back["outcome"].to_list() == table["outcome"]
    assert back["steps"].dtype == pl.Int64


def test_pandas_and_pyarrow_are_read_and_read_it(table: Table) -> None:
    pd = pytest.importorskip("pandas", reason="no pandas")
    pa = pytest.importorskip("pyarrow", reason="no pyarrow")
    frame = pd.DataFrame({MU: np.float32([0.25, 0.5]), "stack.levels": np.int8([2, 3])})
    by_pandas = ensemble(frame, BASE)
    by_arrow = ensemble(pa.table({MU: [0.25, 0.5], "stack.levels": [2, 3]}), BASE)
    assert by_pandas.to_csv() == by_arrow.to_csv()
    assert pd.DataFrame.from_arrow(table).shape == (4, len(table.columns))
    assert pa.table(table).column_names == list(table)


def test_a_column_of_numbers_may_state_its_unit_and_cells_may_be_empty() -> None:
    cases = [{"motion.scale.pga (cm/s2)": 100.0}, {"motion.scale.pga (cm/s2)": None}, {"stack.levels": 2}]
    found = ensemble(cases, BASE)
    text = ensemble([{"motion.scale.pga": "1 m/s^2"}], BASE)
    assert found["top_drift_ratio"][0] == text["top_drift_ratio"][0]
    assert found["barrels"] == [4, 4, 4]
    assert [column.unit for column in found.columns][:2] == ["cm/s2", ""]


def test_a_record_shakes_its_case_as_it_shakes_a_run() -> None:
    record = Record.bundled()
    cases = [{"record": record, "motion.scale.pgv": "40 cm/s"}, {"record": record.scale(2.0)}, {"stack.levels": 2}]
    found = ensemble(cases, BASE)
    run = BASE.set("motion.scale.pgv", "40 cm/s").run(record, variants=0)
    assert found["top_drift_ratio"][0] == run.demands["top_drift_ratio"]
    assert found["record"] == ["record of row 0", "record of row 1", None]
    by_name = ensemble([{"record": "napa", "motion.scale.pgv": "40 cm/s"}], BASE, records={"napa": record})
    assert by_name["top_drift_ratio"][0] == found["top_drift_ratio"][0]
    with pytest.raises(ValueError, match='row 0: no record named "x"'):
        ensemble([{"record": "x"}], BASE)


def test_errors_of_a_row_are_raised_before_the_work() -> None:
    with pytest.raises(ScenarioError, match="must be") as caught:
        ensemble([{"stack.levels": 2}, {"stack.levels": -9}], BASE)
    assert caught.value.row == 1
    assert caught.value.value == "stack.levels=-9"
    with pytest.raises(ScenarioError, match="needs a unit"):
        ensemble([{"motion.scale.pgv": 60.0}], BASE)
    with pytest.raises(barrelstack.RecordError, match="there is no such file"):
        ensemble([{"motion.record": "mine.AT2"}], BASE)
    with pytest.raises(ScenarioError, match="one plane"):
        ensemble([{"stack.levels": 3}], "demo-napa")
    with pytest.raises(ValueError, match="no case changes the base"):
        ensemble([{}], BASE)
    with pytest.raises(TypeError, match="`stack.levels` contains values of type object"):
        ensemble([{"stack.levels": object()}], BASE)


def test_cases_of_many_topologies_keep_their_order() -> None:
    levels = [2, 3, 4] * 5
    found = ensemble([{"stack.levels": n} for n in levels], BASE)
    assert found["stack.levels"] == levels
    assert found["barrels"] == [2 * n for n in levels]
    for n in (2, 3, 4):
        rows = [at for at, of in enumerate(levels) if of == n]
        assert len({found["steps"][at] for at in rows}) == 1


def test_columns_say_what_they_mean(table: Table) -> None:
    meanings = {column.name: column for column in table.columns}
    assert meanings["first_loss"].unit == "s"
    assert "left its seat" in meanings["first_loss"].meaning
    assert np.isnan(table.numbers("first_fall")).sum() == table["first_fall"].count(None)
    with pytest.raises(KeyError):
        table["no such"]
    with pytest.raises(TypeError, match="contains text"):
        table.numbers("outcome")
    assert len(table) == 4
    assert barrelstack.__version__ in ("0.1.0",)
