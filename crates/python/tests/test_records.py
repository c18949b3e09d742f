"""Many records: folders, measures, sets; synthetic motions; the counterpart of each command in the package."""

from __future__ import annotations

import csv
import re
import subprocess
from pathlib import Path

import numpy as np
import pytest

import barrelstack
from barrelstack import BarrelstackWarning, Record, RecordError, Scenario, Study, intensities, read_folder, select
from conftest import ROOT


@pytest.fixture(scope="module")
def library(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder of twelve records, one of them in two files, and one file that is not a record."""
    folder = tmp_path_factory.mktemp("records")
    (folder / "near").mkdir()
    for seed in range(1, 12):
        source = {"kind": "boore", "magnitude": 5.5 + 0.15 * seed, "distance": f"{6 + seed} km", "seed": seed}
        Record.made(synthetic=source).write(folder / "near" / f"motion{seed:02d}.txt")
    made = Record.made(synthetic={"kind": "boore", "magnitude": 6, "distance": "8 km", "seed": 77})
    for component in ("000", "090"):
        one = made.channels[0]
        Record.from_arrays({component: one.acceleration}, one.time_step, unit="m/s2").write(
            folder / f"RSN9001_MADE_UP{component}.AT2"
        )
    (folder / "notes.md").write_text("no record\n")
    return folder


def test_a_folder_is_read_record_by_record(library: Path) -> None:
    with pytest.warns(BarrelstackWarning, match="notes.md"):
        records = read_folder(library)
    assert len(records) == 12
    pair = next(record for name, record in records.items() if "9001" in name)
    assert len(pair.channels) == 2
    table = intensities(records, "pgv", "sa(1.0)")
    assert list(table) == ["record", "component", "pgv", "sa(1.0)"]
    assert len(table) == 13
    name = "near/motion03"
    found = next(one for one in records if one.startswith(name))
    row = table["record"].index(found)
    assert table["pgv"][row] == records[found].intensity("pgv")[0].values["H1"]


def test_a_set_is_that_of_the_command(command: str, library: Path, tmp_path: Path) -> None:
    periods = [0.2, 0.5, 1.0, 2.0]
    median, sigma = [2.0, 1.5, 0.8, 0.3], [0.6, 0.6, 0.65, 0.7]
    rows = "".join(f"{t},{m},{s}\n" for t, m, s in zip(periods, median, sigma, strict=True))
    (tmp_path / "model.csv").write_text("period (s),median (m/s2),sigma\n" + rows)
    words = [
        "motion", "select", str(library), "--target", str(tmp_path / "model.csv"), "--at", "1.0", "--epsilon", "0.5",
        "--count", "5", "--spectrum", "h1", "--seed", "3", "--out", str(tmp_path / "set"), "--quiet",
    ]  # fmt: skip
    done = subprocess.run([command, *words], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    lines = (tmp_path / "set" / "selection.csv").read_text().splitlines()[1:]
    theirs = {row[0]: float(row[3]) for row in csv.reader(lines)}
    with pytest.warns(BarrelstackWarning):
        records = read_folder(library)
    # The command takes each record without an event as one of a separate event, as the names do here.
    ours = select(records, (periods, median, sigma), at=1.0, epsilon=0.5, count=5, spectrum="h1", seed=3)
    assert ours.factors.keys() == theirs.keys()
    for name, factor in theirs.items():
        # Measured: 0; spectra of the command are read from its table of shortest numbers that read back.
        assert ours.factors[name] == pytest.approx(factor, rel=1e-12)
    assert ours.target.shape == ours.found.shape == (2, 4)
    scaled = ours.records[name].spectrum(periods)[1]
    assert scaled == pytest.approx(factor * records[name].spectrum(periods)[1])
    # Given at 1 s: all records match there, where the target has no spread.
    at = [record.spectrum([1.0])[1][0] for record in ours.records.values()]
    assert at == pytest.approx([0.8 * np.exp(0.5 * 0.65)] * 5)
    assert ours.target[1][2] == pytest.approx(0.0, abs=1e-7)


def test_records_without_the_spectrum_are_left_out(library: Path) -> None:
    with pytest.warns(BarrelstackWarning):
        records = read_folder(library)
    # One of the twelve has two components, and so a median over directions.
    with pytest.warns(BarrelstackWarning, match="no rotd50 spectrum") as caught, pytest.raises(RecordError):
        select(records, ([0.5, 1.0], [2.0, 1.0], [0.6, 0.6]), count=5)
    assert len([one for one in caught if "left out" in str(one.message)]) == 11
    with pytest.raises(ValueError, match="level"):
        select(records, ([0.5, 1.0], [2.0, 1.0], [0.6, 0.6]), at=1.0, level="60 cm/s", spectrum="h1", count=5)
    with pytest.raises(OSError, match="nowhere"):
        read_folder(library / "nowhere")


def test_a_set_that_cannot_be_is_refused(library: Path) -> None:
    with pytest.warns(BarrelstackWarning):
        records = read_folder(library)
    with pytest.raises(RecordError, match="30"):
        select(records, "ec8:ag=0.3,site=B", spectrum="h1")
    with pytest.raises(ValueError, match="either level or epsilon"):
        select(records, ([0.5, 1.0], [1.0, 0.5], [0.6, 0.6]), at=1.0)
    with pytest.raises(ValueError, match="not a period of the target"):
        select(records, ([0.5, 1.0], [1.0, 0.5], [0.6, 0.6]), at=0.7, epsilon=1.0, count=3)


def test_motions_are_made_as_a_study_makes_them() -> None:
    ricker = Record.made(pulse={"kind": "ricker", "amplitude": "3 m/s^2", "period": "0.8 s"})
    assert ricker.intensity("pga")[0].values["H1"] == pytest.approx(3.0, rel=1e-9)
    assert any("Ricker" in note or "ricker" in note for note in ricker.notes)
    source = {"kind": "boore", "magnitude": 6, "distance": "8 km", "seed": 5}
    study = Study({
        "base": {"extends": "sliding-block"},
        "motion": [{"synthetic": {"count": 3, **source}}],
        "design": {"kind": "full-factorial"},
    })  # fmt: skip
    records = list(study.records().values())
    assert len(records) == study.motions == 3
    made = Record.made(synthetic=source)
    assert np.array_equal(made.channels[0].acceleration, records[0].channels[0].acceleration)
    assert not np.array_equal(made.channels[0].acceleration, records[1].channels[0].acceleration)
    with pytest.raises(barrelstack.ScenarioError, match="magnitude"):
        Record.made(synthetic={"kind": "boore", "distance": "8 km"})
    with pytest.raises(TypeError, match="sine, pulse and synthetic"):
        Record.made(record="x")


def test_the_ground_of_a_scenario_is_a_record() -> None:
    stack = Scenario.load("demo-napa")
    ground = stack.ground()
    assert ground is not None
    assert [channel.name for channel in ground.channels] == ["H1", "UP"]
    doubled = stack.set("motion.scale.factor", 2.0).ground()
    assert doubled is not None
    assert doubled.channels[0].acceleration == pytest.approx(2.0 * ground.channels[0].acceleration, abs=1e-12)
    assert Scenario.load("candia-8-barrels").set("motion", {"none": True}).ground() is None


def test_a_record_is_drawn() -> None:
    matplotlib = pytest.importorskip("matplotlib", reason="no matplotlib")
    matplotlib.use("Agg")
    figure = Record.bundled().plot()
    labels = [axes.get_ylabel() for axes in figure.axes]
    assert labels[:3] == ["acceleration (m/s²)", "velocity (m/s)", "displacement (m)"]
    assert len(figure.axes) == 4


def test_every_command_has_its_place_in_the_package(command: str, tmp_path: Path) -> None:
    subprocess.run([command, "man", str(tmp_path)], capture_output=True, check=True)
    names = {path.stem.removeprefix("barrelstack-") for path in tmp_path.glob("barrelstack-*.1")}
    text = (ROOT / "docs" / "commands.md").read_text(encoding="utf-8")
    rows = [line.split("|")[1:4] for line in text.splitlines() if line.startswith("| `")]
    documented = {word.replace(" ", "-") for row in rows for word in re.findall(r"`([a-z -]+)`", row[0])}
    # A command with subcommands is represented by these; each motion of `synth` is one of its kinds.
    groups = {name for name in names if any(other.startswith(f"{name}-") for other in names)}
    alone = {name for name in names if not name.startswith("motion-synth-")}
    assert alone - groups - documented == set()
    assert documented - names == set()
    for row in rows:
        for word in re.findall(r"`([A-Za-z_.]+)", row[1]):
            thing = barrelstack
            for part in word.split("."):
                if part in ("help",):
                    break
                if isinstance(thing, type) and part == "fields":
                    break
                assert hasattr(thing, part), f"{row[0].strip()}: {word}"
                thing = getattr(thing, part)
