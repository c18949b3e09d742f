"""Runs in space: the numbers of the command, arrays with their shapes, a page, files."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path

import numpy as np
import pytest

from barrelstack import Scenario, ScenarioError, SpatialRun, compare

CHANGES = {
    "stack.view": "spatial",
    "stack.levels": 3,
    "imperfections.variants": 4,
    "run.duration": "12 s",
}


@pytest.fixture(scope="module")
def run() -> SpatialRun:
    return Scenario.load("demo-napa").set(CHANGES).run_in_space(variant=0)


@pytest.mark.parametrize(
    ("name", "changes"), [("demo-napa", CHANGES), ("rolling-ball", {}), ("tumbling-block", {})]
)
def test_every_number_has_the_bits_of_the_command(
    command: str, name: str, changes: dict[str, str | int]
) -> None:
    sets = [word for path, value in changes.items() for word in ("--set", f"{path}={value}")]
    done = subprocess.run(
        [command, "run", name, *sets, "--json", "--quiet"], capture_output=True, text=True, check=False
    )
    assert done.stdout, done.stderr
    printed = json.loads(done.stdout)
    scenario = Scenario.load(name)
    found = (scenario.set(changes) if changes else scenario).run_in_space().summary
    # Wall-clock times are not results.
    printed["run"].pop("wall_seconds"), found["run"].pop("wall_seconds")
    assert found == printed
    assert found["schema"] == "space/1"


def test_frames_end_where_the_summary_says(run: SpatialRun) -> None:
    frames = run.frames
    assert frames.bodies[0] == "ground"
    assert frames.poses.shape == (len(frames.time), len(frames.bodies), 7)
    assert frames.twists.shape == (len(frames.time), len(frames.bodies), 6)
    lengths = np.linalg.norm(frames.poses[:, :, 3:], axis=2)
    assert np.abs(lengths - 1).max() < 1e-12  # measured 2e-16
    positions = {body["name"]: body["position"] for body in run.summary["bodies"]}
    last = dict(zip(frames.bodies, frames.poses[-1, :, :3], strict=True))
    assert frames.time[-1] == run.summary["run"]["end_time"]
    for name, place in positions.items():
        assert (last[name] == place).all(), name


def test_variants_state_directions(run: SpatialRun) -> None:
    table = run.variants
    assert table is not None
    assert table["variant"] == [0, 1, 2, 3, 4]
    assert {"outcome", "heading", "debris_right", "debris_left", "debris_away", "debris_near"} <= set(table)
    assert run.ensemble is not None
    assert run.directions is not None
    fell = [heading for heading in table["heading"][1:] if heading is not None]
    first = [run.directions[f"first_{heading}"] for heading in ("right", "left", "away", "near")]
    assert sum(first) == len(fell)
    assert run.outcome.heading == table["heading"][0]


def test_its_files_are_those_of_the_command(run: SpatialRun, tmp_path: Path) -> None:
    run.write(tmp_path / "out")
    names = sorted(path.name for path in (tmp_path / "out").iterdir())
    assert names == ["columns.csv", "frames.csv", "report.html", "scenario.toml", "summary.json", "variants.csv"]
    assert (tmp_path / "out" / "report.html").read_text() == run.html()
    with pytest.raises(Exception, match="not empty"):
        run.write(tmp_path / "out")
    assert "<iframe" in run._repr_html_()


def test_an_animation_in_space_fits_into_a_cell(run: SpatialRun) -> None:
    film = run.animate()
    tall = Scenario.load("demo-napa").set("stack.view", "spatial").run_in_space(variants=0)
    for cell in (film._repr_html_(), tall.animate()._repr_html_()):
        assert len(cell.encode()) < 1_000_000
    data = json.loads(film.html().split('id="barrelstack-data">')[1].split("</script>")[0])
    (pane,) = data["players"][0]["panes"]
    assert len(pane["depth"]["bodies"]) == len(run.frames.bodies)
    assert pane["depth"]["poses"] is not None
    assert len(data["players"][0]["ground"]) > 0


def test_plane_and_space_name_each_other() -> None:
    with pytest.raises(ValueError, match=r"run_in_space\(\)"):
        Scenario.load("demo-napa").set("stack.view", "spatial").run()
    with pytest.raises(ValueError, match=r"run\(\), or set .*spatial"):
        Scenario.load("demo-napa").run_in_space()
    with pytest.raises(ValueError, match="there is no variant 9"):
        Scenario.load("demo-napa").set(CHANGES).run_in_space(variant=9)
    with pytest.raises(ScenarioError, match="view"):
        Scenario.load("demo-napa").set("stack.view", "spacial")


def test_repeats_report_and_pictures_are_those_of_the_command(command: str, tmp_path: Path) -> None:
    short = {"stack.view": "spatial", "stack.levels": 2, "run.duration": "0.5 s"}
    scenario = Scenario.load("demo-napa").set(short)
    run = scenario.run_in_space(variants=0, verify=True)
    sets = [word for path, value in short.items() for word in ("--set", f"{path}={value}")]
    words = [command, "run", "demo-napa", *sets, "--variants", "0", "--verify", "--json", "--quiet"]
    printed = json.loads(subprocess.run(words, capture_output=True, text=True, check=True).stdout)
    assert run.summary["verification"] == printed["verification"]
    assert len(printed["verification"]["repeats"]) == 5
    run.report(tmp_path / "report.pdf")
    assert (tmp_path / "report.pdf").read_bytes().startswith(b"%PDF-")
    written = run.render(tmp_path / "pictures", "paraview", "animation", rate=5.0, size=64)
    assert sorted(Path(place).name for place in written) == ["animation", "paraview"]
    assert scenario.check()[0]["view"] == "spatial"


def test_a_comparison_in_space_has_the_shares_of_the_runs(run: SpatialRun) -> None:
    stack = Scenario.load("demo-napa").set(CHANGES)
    both = compare({"as it is": stack, "lower": stack.set("stack.levels", 2)})
    assert both.runs["as it is"]["ensemble"] == run.ensemble
    assert both.document["paired"][0]["view"] == "spatial"
