"""Studies in folders: chunk by chunk, decided, exported."""

from __future__ import annotations

import os
import pickle
import shutil
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

import barrelstack
from barrelstack import Study

STRIPES = """
schema = 1
title = "Six barrels under three motions"
seed = 3
[base]
extends = "candia-8-barrels"
stack = { levels = 3 }
[[motion]]
bundled = "napa-college-2014"
[[motion]]
synthetic = { kind = "boore", count = 2, magnitude = 6.0, distance = "8 km" }
[intensity]
measure = "pgv"
range = { from = "10 cm/s", to = "90 cm/s", count = 5 }
[design]
kind = "stripes"
chunk = 4
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("study") / "six"
    study = Study(STRIPES)
    # In an unusual order, and in two rounds as by two processes.
    for chunk in reversed(study.plan()):
        assert study.run_chunk(folder, chunk.number)
    assert not study.run_chunk(folder, 0)
    assert study.plan(folder) == []
    return folder


def test_chunks_in_any_order_give_the_table_of_a_run(folder: Path, tmp_path: Path) -> None:
    table = Study.collect(folder, write=True)
    Study(STRIPES).run(tmp_path / "again", workers=1)
    assert (folder / "table.csv").read_bytes() == (tmp_path / "again" / "table.csv").read_bytes()
    assert len(table) == 15
    assert Study.provenance(folder)["complete"] is True


def test_a_curve_is_the_lognormal_that_it_states(folder: Path) -> None:
    fragility = Study.fragility(folder)
    assert fragility.measure == ("pgv", "m/s")
    curve = next(iter(fragility.curves.values()))
    assert curve.median is not None
    assert curve.probability([curve.median])[0] == pytest.approx(0.5, abs=1e-12)
    assert curve.raw.shape == (5, 5)
    assert curve.raw[:, 1].tolist() == [3] * 5
    assert fragility.html().startswith("<!doctype html>")
    assert "<iframe" in fragility._repr_html_()


def test_an_incremental_analysis_has_a_curve_a_motion(folder: Path) -> None:
    hunts = Study.ida(folder)
    assert len(hunts.motions) == 3
    for levels, demands, capacity in zip(hunts.levels, hunts.demands, hunts.capacities, strict=True):
        assert (np.diff(levels) > 0).all()
        assert np.isfinite(demands[levels < capacity]).all() or np.isnan(capacity)


@pytest.mark.skipif(os.name == "nt", reason="links need a privilege there")
def test_an_export_and_a_collected_table_follow_no_link(folder: Path, tmp_path: Path) -> None:
    kept = tmp_path / "kept"
    kept.write_text("kept")
    Study.export(folder, tmp_path / "first")
    names = [path.name for path in (tmp_path / "first").iterdir()]
    out = tmp_path / "out"
    out.mkdir()
    for name in names:
        (out / name).symlink_to(kept)
    Study.export(folder, out)
    assert kept.read_text() == "kept"
    assert all((out / name).read_bytes() == (tmp_path / "first" / name).read_bytes() for name in names)
    again = shutil.copytree(folder, tmp_path / "again")
    for name in ("table.csv", "table.parquet", "columns.csv", "provenance.json"):
        (again / name).unlink(missing_ok=True)
        (again / name).symlink_to(kept)
    table = Study.collect(again, write=True)
    assert kept.read_text() == "kept"
    assert (again / "table.csv").read_text(encoding="utf-8") == table.to_csv()


def test_an_export_is_what_openquake_documents(folder: Path, tmp_path: Path) -> None:
    Study.export(folder, tmp_path / "out", asset="stack")
    root = ElementTree.parse(tmp_path / "out" / "openquake-fragility.xml").getroot()
    space = "{http://openquake.org/xmlns/nrml/0.5}"
    function = root.find(f"{space}fragilityModel/{space}fragilityFunction")
    assert function is not None
    assert function.get("shape") == "logncdf"
    curve = next(iter(Study.fragility(folder).curves.values()))
    params = function.find(f"{space}params")
    assert params is not None
    assert curve.median is not None
    assert curve.dispersion is not None
    mean = 100 * curve.median * np.exp(0.5 * curve.dispersion**2)
    # OpenQuake states a curve by its mean capacity, PGV in cm/s; measured 1e-15.
    assert float(params.get("mean", "")) == pytest.approx(mean, rel=1e-9)


def test_a_study_crosses_to_a_worker_by_its_text() -> None:
    study = Study(STRIPES)
    again = pickle.loads(pickle.dumps(study))
    assert again.fingerprint == study.fingerprint
    assert again.plan() == study.plan()


def test_errors_of_studies_have_their_place(tmp_path: Path) -> None:
    with pytest.raises(barrelstack.ScenarioError) as caught:
        Study(STRIPES.replace("count = 5", "cuont = 5"))
    assert caught.value.line == 14
    with pytest.raises(barrelstack.StudyError, match="no study"):
        Study.collect(tmp_path)
    error = pickle.loads(pickle.dumps(caught.value))
    assert (error.line, str(error)) == (14, str(caught.value))
