"""Tables and histories in pandas, polars and xarray; pages of notebooks; work in other processes."""

from __future__ import annotations

import multiprocessing
import sys
from pathlib import Path

import numpy as np
import pytest

import barrelstack
from barrelstack import Record, Run, Scenario, Study, Table, intensities


@pytest.fixture(scope="module")
def run() -> Run:
    return Scenario.load("candia-8-barrels").set({"run.duration": "2 s", "stack.levels": 2}).run(variants=2)


@pytest.fixture(scope="module")
def table(run: Run) -> Table:
    assert run.variants is not None
    return run.variants


def test_pandas_gets_columns_with_units_and_histories_by_time(run: Run, table: Table) -> None:
    pytest.importorskip("pandas", reason="no pandas")
    frame = table.to_pandas()
    assert list(frame.columns) == list(table)
    assert frame.attrs["units"] == {column.name: column.unit for column in table.columns}
    assert frame["outcome"].tolist() == table["outcome"]
    assert frame["variant"].dtype == np.int64
    histories = run.histories.to_pandas()
    assert histories.index.name == "time"
    assert (histories.index.to_numpy() == run.histories.time).all()
    assert (histories["B2.1_rotation"].to_numpy() == run.histories["B2.1_rotation"]).all()
    assert histories.attrs["units"]["B2.1_rotation"] == "rad"


def test_polars_gets_the_same_columns(run: Run, table: Table) -> None:
    pytest.importorskip("polars", reason="no polars")
    assert table.to_polars().columns == list(table)
    assert run.histories.to_polars()["time"].to_list() == run.histories.time.tolist()


def test_xarray_gets_dimensions_and_units_and_writes_them(run: Run, table: Table, tmp_path: Path) -> None:
    xarray = pytest.importorskip("xarray", reason="no xarray")
    histories = run.histories.to_xarray()
    assert histories["B2.1_displacement_x"].dims == ("time",)
    assert histories["B2.1_displacement_x"].attrs == {"long_name": "B2.1 displacement x", "units": "m"}
    assert histories["time"].attrs["units"] == "s"
    assert (histories["B2.1_rotation"].to_numpy() == run.histories["B2.1_rotation"]).all()
    cases = table.to_xarray()
    assert cases.sizes == {"case": 3}
    assert cases["outcome"].values.tolist() == table["outcome"]
    meanings = {column.name: column.meaning for column in table.columns}
    assert cases["first_loss"].attrs == {"long_name": meanings["first_loss"], "units": "s"}
    assert np.isnan(cases["first_loss"].values[0]) == (table["first_loss"][0] is None)
    pytest.importorskip("scipy", reason="no scipy, with which xarray writes netCDF")
    histories.to_netcdf(tmp_path / "run.nc", engine="scipy")
    again = xarray.open_dataset(tmp_path / "run.nc", engine="scipy")
    assert again["B2.1_rotation"].attrs["units"] == "rad"


def test_a_workbook_has_numbers_as_numbers_and_texts_as_texts(table: Table, tmp_path: Path) -> None:
    openpyxl = pytest.importorskip("openpyxl", reason="no openpyxl")
    table.to_excel(tmp_path / "a.xlsx")
    book = openpyxl.load_workbook(tmp_path / "a.xlsx")
    heads, *rows = book["values"].iter_rows(values_only=True)
    assert "first_loss (s)" in heads
    assert "outcome" in heads
    for at, name in enumerate(table):
        # A workbook keeps sixteen digits of a number.
        close = [pytest.approx(value, rel=1e-15) if isinstance(value, float) else value for value in table[name]]
        assert [row[at] for row in rows] == close, name
    about = {row[0]: row[3] for row in book["columns"].iter_rows(values_only=True)}
    assert about["first_loss"] == next(column.meaning for column in table.columns if column.name == "first_loss")
    sums = intensities({"=1+1": Record.bundled()}, "pgv")
    sums.to_excel(tmp_path / "b.xlsx")
    cells = [cell for row in openpyxl.load_workbook(tmp_path / "b.xlsx")["values"].iter_rows() for cell in row]
    assert {cell.data_type for cell in cells if cell.value == "=1+1"} == {"s"}
    run = Scenario.load("sliding-block").run()
    run.histories.to_excel(tmp_path / "c.xlsx")
    sheet = openpyxl.load_workbook(tmp_path / "c.xlsx", read_only=True)["values"]
    assert sum(1 for _ in sheet.iter_rows()) == 1 + len(run.histories.time)
    with pytest.raises(ValueError, match=r"\.xlsx"):
        table.to_excel(tmp_path / "a.csv")


def test_a_missing_package_for_workbooks_is_named(
    table: Table, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "openpyxl", None)
    with pytest.raises(barrelstack.MissingPackageError, match="pip install openpyxl"):
        table.to_excel(tmp_path / "a.xlsx")


@pytest.mark.parametrize("name", ["pandas", "polars", "xarray"])
def test_a_missing_package_is_named(name: str, table: Table, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, name, None)
    with pytest.raises(barrelstack.MissingPackageError, match=f"pip install {name}"):
        getattr(table, f"to_{name}")()


def test_notebooks_show_tables_scenarios_records_and_studies(table: Table) -> None:
    page = table._repr_html_()
    assert page.count("<tr>") == 1 + len(table)
    assert "first_loss" in page
    many = Table(table._native)
    assert "more rows" not in many._repr_html_()
    scenario = Scenario.load("candia-8-barrels")._repr_html_()
    assert "<summary>stack</summary>" in scenario
    assert "levels" in scenario
    marked = Scenario({"extends": "sliding-block", "title": "<b>"})._repr_html_()
    assert "<b>" not in marked
    assert "&lt;b&gt;" in marked
    assert "<table>" in Record.bundled()._repr_html_()
    study = Study.load("napa-four-levels")._repr_html_()
    assert "fingerprint" in study


def work(given: tuple[Scenario, Record]) -> tuple[str, float]:
    """Runs a scenario under a record; called in another process."""
    scenario, record = given
    run = scenario.with_record(record).run(variants=0)
    return run.outcome.kind, float(run.histories["B2.1_displacement_x"][-1])


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("library", ["multiprocessing", "joblib"])
def test_other_processes_run_scenarios_under_records(library: str) -> None:
    scenario = Scenario.load("candia-8-barrels").set({"run.duration": "2 s", "stack.levels": 2})
    tasks = [(scenario, Record.bundled().scale(factor)) for factor in (0.5, 1.0)]
    if library == "joblib":
        joblib = pytest.importorskip("joblib", reason="no joblib")
        found = joblib.Parallel(n_jobs=2)(joblib.delayed(work)(task) for task in tasks)
    else:
        with multiprocessing.get_context("spawn").Pool(2) as pool:
            found = pool.map(work, tasks)
    assert found == [work(task) for task in tasks]
