"""The same numbers by the command and by the package."""

from __future__ import annotations

import json
import subprocess
import time
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import barrelstack
from barrelstack import Scenario, Study

CASES = [
    ("sliding-block", []),
    ("candia-8-barrels", ["stack.levels=2", "imperfections.variants=8", "run.duration='5 s'"]),
    ("demo-napa", ["stack.levels=3", "imperfections.variants=6", "run.duration='16 s'"]),
]


def by_command(command: str, *words: str) -> dict[str, Any]:
    done = subprocess.run([command, *words], capture_output=True, text=True, check=False)
    assert done.stdout, done.stderr
    found: dict[str, Any] = json.loads(done.stdout)
    return found


@pytest.mark.filterwarnings("ignore::barrelstack.BarrelstackWarning")
@pytest.mark.parametrize(("name", "changes"), CASES)
def test_every_number_of_a_summary_has_the_bits_of_the_command(
    command: str, name: str, changes: list[str]
) -> None:
    sets = [word for change in changes for word in ("--set", change)]
    printed = by_command(command, "run", name, *sets, "--no-remedy", "--json", "--quiet")
    scenario = Scenario.load(name)
    for change in changes:
        path, value = change.split("=")
        scenario = scenario.set(path, json.loads(value.replace("'", '"')))
    found = scenario.run().summary
    # Wall-clock times are not results.
    printed["run"].pop("wall_seconds", None), found["run"].pop("wall_seconds", None)
    assert found == printed
    assert len(json.dumps(found)) > 1000


@pytest.mark.filterwarnings("ignore::barrelstack.BarrelstackWarning")
def test_what_would_have_helped_is_what_the_command_finds(command: str) -> None:
    changes = {"stack.levels": 4, "imperfections.variants": 6, "stack.view": "transverse"}
    sets = [word for path, value in changes.items() for word in ("--set", f"{path}={value}")]
    printed = by_command(command, "run", "demo-napa", *sets, "--json", "--quiet")["remedy"]
    found = Scenario.load("demo-napa").set(changes).run(remedy=True).summary["remedy"]
    assert printed is not None
    # Only the command suggests arguments.
    printed.pop("comparison"), found.pop("comparison")
    assert found == printed


def test_a_former_key_is_read_with_a_warning() -> None:
    short = Scenario.load("candia-8-barrels").set(
        {"stack.levels": 1, "imperfections.variants": 2, "run.duration": "1 s"}
    )
    former = short.set({"imperfections.stiffness": 0.3})
    run = former.run(variant=0)
    assert any("write `unknowns.stiffness` instead" in text for text in run.summary["warnings"])
    present = short.set({"unknowns.stiffness": 0.3}).run(variant=0)
    assert run.summary["ensemble"] == present.summary["ensemble"]


STUDY = """
schema = 1
title = "Friction under two motions"
[base]
extends = "candia-8-barrels"
run = { duration = "6 s" }
[[factor]]
field = "interface.rack-ground.friction.coefficient"
values = [0.2, 0.35, 0.5]
[[factor]]
field = "stack.levels"
values = [2, 3]
[[motion]]
bundled = "napa-college-2014"
[intensity]
measure = "pgv"
levels = ["30 cm/s", "60 cm/s"]
[design]
kind = "full-factorial"
chunk = 3
"""


def test_the_table_of_a_study_is_byte_for_byte_that_of_the_command(command: str, tmp_path: Path) -> None:
    file = tmp_path / "study.toml"
    file.write_text(STUDY)
    subprocess.run([command, "study", str(file), "--out", str(tmp_path / "a"), "--quiet"], check=True, capture_output=True)
    study = Study.load(file)
    reports: list[tuple[float, float, str]] = []
    table = study.run(tmp_path / "b", progress=lambda *now: reports.append(now))
    for name in ("table.csv", "table.parquet", "provenance.json", "columns.csv"):
        assert (tmp_path / "b" / name).read_bytes() == (tmp_path / "a" / name).read_bytes(), name
    assert table.to_csv() == (tmp_path / "a" / "table.csv").read_text()
    assert table["outcome"] == study.table()["outcome"]
    assert reports[-1] == (12.0, 12.0, "cases")
    assert study.plan(tmp_path / "b") == []


def test_cases_of_a_table_have_the_bits_of_single_runs_and_of_a_study(tmp_path: Path) -> None:
    study = Study(STUDY)
    expected = study.table()
    cases = [
        {"interface.rack-ground.friction.coefficient": mu, "stack.levels": levels, "motion.scale.pgv (m/s)": level}
        for mu, levels, level in zip(
            expected["interface.rack-ground.friction.coefficient"], expected["stack.levels"], expected["level"], strict=True
        )
    ]
    base = Scenario.load("candia-8-barrels").set(
        {"run.duration": "6 s", "motion": {"bundled": "napa-college-2014"}}
    )
    table = barrelstack.ensemble(cases, base)
    for column in expected.columns:
        if column.role in ("outcome", "demand", "run"):
            assert table[column.name] == expected[column.name], column.name
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        changes = {path.removesuffix(" (m/s)"): value for path, value in cases[5].items()}
        changes["motion.scale.pgv"] = f"{changes['motion.scale.pgv']!r} m/s"
        run = base.set(changes).run(variants=0)
    assert run.demands["top_drift_ratio"] == table["top_drift_ratio"][5]
    assert run.summary["run"]["steps"] == table["steps"][5]


def test_ten_thousand_rows_are_prepared_in_seconds() -> None:
    # Overhead of a case besides its steps; measured 2.3 s on two half-busy cores.
    cases = [{"interface.block-ground.friction.coefficient": float(mu)} for mu in np.linspace(0.2, 0.4, 10_000)]
    base = Scenario.load("sliding-block").set("run.duration", "10 ms")
    start = time.perf_counter()
    table = barrelstack.ensemble(cases, base)
    print(f"10,000 short cases in {time.perf_counter() - start:.1f} s")
    assert len(table) == 10_000
    assert set(table["outcome"]) == {"not-judged"}
