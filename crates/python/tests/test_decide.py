"""Analyses of many runs, by the command and by the package; pages; refusals."""

from __future__ import annotations

import json
import shutil
import signal
import subprocess
import threading
import time
from pathlib import Path
from typing import Any

import pytest

import barrelstack
from barrelstack import Calibration, Scenario, Study, compare, heights, protect, reproduce, score

TILT = "angle (deg)\n21.4\n22.0\n21.7\n22.9\n21.1\n"
PRESS = "penetration (mm),force (kN)\n0.5,0.49\n1,0.99\n1.5,1.46\n2,1.97\n"
DROPS = "drop height (mm),rebound height (mm)\n100,21\n100,24\n150,33\n150,36\n"


def by_command(command: str, *words: str) -> Any:
    done = subprocess.run([command, *words, "--json"], capture_output=True, text=True, check=False)
    assert done.stdout, done.stderr
    return json.loads(done.stdout)


def test_a_comparison_has_the_numbers_of_the_command(command: str, tmp_path: Path) -> None:
    sets = ["stack.levels=3", "run.duration='5 s'"]
    words = [word for one in sets for word in ("--set", one)]
    printed = by_command(
        command, "compare", "candia-8-barrels", *words, "--against", "stack.levels=2", "--variants", "6",
        "--out", str(tmp_path / "out"), "--quiet",
    )  # fmt: skip
    stack = Scenario.load("candia-8-barrels").set({"stack.levels": 3, "run.duration": "5 s"})
    found = compare([stack, stack.set("stack.levels", 2)], variants=6)
    for document in (printed, found.document):
        for run in document["runs"]:
            run["summary"]["run"].pop("wall_seconds", None)
    assert found.document == printed
    assert [one.path for one in found.differences] == ["stack.levels"]
    assert found.html() == (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    found.report(tmp_path / "both.pdf")
    assert (tmp_path / "both.pdf").read_bytes().startswith(b"%PDF")
    named = compare({"high": stack, "low": stack.set("stack.levels", 2)}, variants=0)
    assert list(named.runs) == ["high", "low"]
    with pytest.raises(barrelstack.Error, match="are the same run"):
        compare([stack, stack])


def test_protections_are_those_of_the_command(command: str, tmp_path: Path) -> None:
    words = ["--set", "stack.levels=2", "--pgv", "50 cm/s", "--count", "4", "--rounds", "1", "--budget", "60", "--quiet"]
    printed = by_command(command, "protect", "candia-8-barrels", *words, "--out", str(tmp_path / "theirs"))
    # The studies are those of the command: another request would refuse their folders.
    shutil.copytree(tmp_path / "theirs", tmp_path / "ours")
    stack = Scenario.load("candia-8-barrels").set("stack.levels", 2)
    start = time.perf_counter()
    found = protect(stack, tmp_path / "ours", pgv=["50 cm/s"], count=4, rounds=1, budget=60.0)
    print(f"{len(found.table)} protections read and drawn in {time.perf_counter() - start:.1f} s")
    assert found.document == printed
    assert found.html() == (tmp_path / "theirs" / "index.html").read_text(encoding="utf-8")
    names = found.table["name"]
    assert found.table["barrels_fallen"] == [one["barrels_fallen"]["mean"] for one in printed["protections"]]
    assert found.changes(names[0]) == printed["protections"][0]["changes"]
    with pytest.raises(ValueError, match="site or pgv"):
        protect(stack, tmp_path / "no", site="hazard.csv", pgv=["1 m/s"])
    with pytest.raises(barrelstack.StudyError, match="free scene"):
        protect("sliding-block", tmp_path / "free")


@pytest.mark.heavy
def test_a_score_is_that_of_the_command(command: str, tmp_path: Path) -> None:
    printed = by_command(command, "score", "demo-napa", "--out", str(tmp_path / "theirs"), "--quiet")
    shutil.copytree(tmp_path / "theirs", tmp_path / "ours")
    found = score("demo-napa", tmp_path / "ours")
    assert found.document == printed
    assert found.score == printed["score"]
    assert found.html() == (tmp_path / "theirs" / "index.html").read_text(encoding="utf-8")
    assert len(found.table) == len(printed["states"])


def test_a_free_scene_has_no_score(tmp_path: Path) -> None:
    with pytest.raises(barrelstack.StudyError, match="free scene"):
        score("sliding-block", tmp_path)


@pytest.mark.heavy
def test_heights_are_those_of_the_command(command: str, tmp_path: Path) -> None:
    printed = by_command(
        command, "heights", "--synthetic=0", "--highest=2", "--out", str(tmp_path / "theirs"), "--quiet"
    )
    found = heights(tmp_path / "ours", synthetic=0, highest=2)
    assert found.document == printed
    assert len(found.table) == sum(len(height["at"]) for height in printed["heights"])


def test_an_unknown_rack_has_no_heights(tmp_path: Path) -> None:
    with pytest.raises(barrelstack.StudyError, match="no rack `three-barrel`"):
        heights(tmp_path / "none", rack="three-barrel")
    with pytest.raises(barrelstack.StudyError, match="cannot have 7 levels; state 2 to 6"):
        heights(tmp_path / "none", highest=7)


def test_the_cases_of_the_paper_are_a_table_and_end_on_ctrl_c() -> None:
    start = time.perf_counter()
    pressed: list[float] = []

    def press() -> None:
        pressed.append(time.perf_counter())
        signal.raise_signal(signal.SIGINT)

    timer = threading.Timer(0.5, press)
    # A shell ignores Ctrl-C for tests in the background.
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        timer.start()
        with pytest.raises(KeyboardInterrupt):
            reproduce(studies=True)
    finally:
        signal.signal(signal.SIGINT, before)
    assert time.perf_counter() - pressed[0] < 1.0
    assert pressed[0] - start < 5.0


@pytest.mark.parametrize(
    ("test", "text", "words", "more"),
    [
        ("friction", TILT, ["--interface", "rack-ground"], {"interface": "rack-ground"}),
        ("stiffness", PRESS, ["--nodes", "2"], {"nodes": 2}),
        ("drop", DROPS, ["--mass", "275 kg", "--stiffness", "9.8 kN/cm"], {"mass": "275 kg", "stiffness": "9.8 kN/cm"}),
    ],
)
def test_a_calibration_has_the_numbers_of_the_command(
    command: str, tmp_path: Path, test: str, text: str, words: list[str], more: dict[str, Any]
) -> None:
    path = tmp_path / "test.csv"
    path.write_text(text)
    printed = by_command(command, "calibrate", test, str(path), *words)
    make = getattr(Calibration, test)
    found = make(path, **more)
    assert found.document == printed
    head, *rows = [line.split(",") for line in text.strip().split("\n")]
    columns = {name: [float(row[at]) for row in rows] for at, name in enumerate(head)}
    assert make(columns, **more).estimates == found.estimates
    assert all(one.low is None or one.low <= one.value for one in found.estimates.values())
    assert "barrel-rack" in found.scenario or "rack-ground" in found.scenario


def test_errors_of_a_test_are_raised() -> None:
    with pytest.raises(barrelstack.Error, match='found only the column "tilt'):
        Calibration.friction({"tilt (deg)": [20.0, 21.0]})
    with pytest.raises(ValueError, match="leave both out"):
        Calibration.drop({"time (s)": [0.0, 0.5]}, mass="1 kg")
    with pytest.raises(ValueError, match="mu-br"):
        Calibration.response(Scenario.load("candia-8-barrels"), {"time (s)": [0.0, 0.1]}, fit=["mu"])


def test_a_run_becomes_pictures_and_a_film(command: str, tmp_path: Path) -> None:
    words = ["--variants", "0", "--only", "figures", "--only", "animation", "--rate", "5", "--size", "200", "--quiet"]
    out = str(tmp_path / "theirs")
    subprocess.run([command, "render", "sliding-block", *words, "--out", out], check=True, capture_output=True)
    run = Scenario.load("sliding-block").run(variants=0)
    written = run.render(tmp_path / "ours", "animation", "figures", rate=5.0, size=200)
    theirs = {path.relative_to(tmp_path / "theirs"): path.read_bytes() for path in (tmp_path / "theirs").rglob("*.*")}
    ours = {path.relative_to(tmp_path / "ours"): path.read_bytes() for path in (tmp_path / "ours").rglob("*.*")}
    assert Path("animation/stack.gif") in ours
    assert ours == theirs
    assert sum(written.values()) <= len(ours)
    for wrong, words_of_it in (({"dpi": 1.0}, "dots per inch"), ({"between": (1e3, 2e3)}, "nothing to render")):
        with pytest.raises(ValueError, match=words_of_it):
            run.render(tmp_path / "wrong", **wrong)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="paraview"):
        run.render(tmp_path / "wrong", "film")
    with pytest.raises(barrelstack.Error, match="not empty"):
        run.render(tmp_path / "ours", "figures")


def test_a_study_from_a_dict_is_that_of_its_text() -> None:
    pint = pytest.importorskip("pint", reason="no pint")
    speed = 40 * pint.UnitRegistry()("cm/s")
    tables = {
        "seed": 3,
        "base": {"extends": "candia-8-barrels", "stack": {"levels": 2}},
        "motion": [{"bundled": "napa-college-2014", "scale": {"pgv": speed}}],
        "factor": [{"field": "interface.rack-ground.friction.coefficient", "values": [0.2, 0.4]}],
        "design": {"kind": "full-factorial"},
    }
    text = """
schema = 1
seed = 3
[base]
extends = "candia-8-barrels"
stack = { levels = 2 }
[[motion]]
bundled = "napa-college-2014"
scale = { pgv = "40 cm/s" }
[[factor]]
field = "interface.rack-ground.friction.coefficient"
values = [0.2, 0.4]
[design]
kind = "full-factorial"
"""
    assert Study(tables).table().to_csv() == Study(text).table().to_csv()
    with pytest.raises(barrelstack.ScenarioError, match="kind"):
        Study({**tables, "design": {"kind": "no such design"}})
