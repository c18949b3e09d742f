"""Expectations of Python on every package: tables for pandas, pickles, copies, one family of exceptions, types."""

from __future__ import annotations

import copy
import os
import pickle
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import barrelstack
from barrelstack import Calibration, Record, Run, Scenario, Study, Table
from conftest import ROOT


@pytest.fixture(scope="module")
def run() -> Run:
    return Scenario.load("candia-8-barrels").set({"run.duration": "2 s", "stack.levels": 2}).run(variants=2)


def test_pandas_takes_histories_and_tables_by_column(run: Run) -> None:
    pd = pytest.importorskip("pandas", reason="no pandas")
    frame = pd.DataFrame(run.histories)
    assert list(frame.columns) == list(run.histories)
    assert (frame["B2.1_rotation"].to_numpy() == run.histories["B2.1_rotation"]).all()
    table = run.variants
    assert table is not None
    frame = pd.DataFrame(table)
    assert list(frame.columns) == list(table)
    assert frame.shape == (3, len(table.columns))
    assert frame["outcome"].tolist() == table["outcome"]
    friction = next(column.name for column in table.columns if column.kind == "number")
    assert np.array_equal(frame[friction].to_numpy(float), table.numbers(friction), equal_nan=True)


def test_numpy_archives_with_a_number_as_step_are_records(tmp_path: Path) -> None:
    samples = np.sin(np.arange(400) * 0.05)
    path = tmp_path / "mine.npz"
    np.savez(path, acceleration=samples, dt=0.005)
    record = Record.read(path, unit="m/s2")
    assert record.channels[0].time_step == 0.005
    assert (record.channels[0].acceleration == samples).all()
    with pytest.raises(barrelstack.RecordError, match="unit"):
        Record.read(path)
    with pytest.raises(barrelstack.RecordError, match="states a step"):
        Record.read(path, unit="m/s2", time_step=0.01)
    np.savez(path, acceleration_H1=samples, acceleration_UP=0.5 * samples)
    both = Record.read(path, unit="g", time_step=0.01)
    assert [channel.name for channel in both.channels] == ["H1", "UP"]
    np.savez(path, acceleration=samples, dt=0.005, velocity=samples)
    with pytest.raises(barrelstack.RecordError):
        Record.read(path, unit="m/s2")


def test_numbers_of_numpy_are_values_of_fields() -> None:
    scenario = Scenario.load("candia-8-barrels").set("interface.rack-ground.friction.coefficient", np.float64(0.25))
    assert scenario.interface["rack-ground"].friction.coefficient == 0.25
    assert scenario.set({"stack.levels": np.int64(3), "run.settle": np.bool_(False)}).stack.levels == 3
    made = Scenario({"extends": "candia-8-barrels", "run": {"similitude": np.float32(0.5)}})
    assert made.fields.run.similitude == 0.5


def test_scenarios_and_records_are_pickled_and_copied(tmp_path: Path) -> None:
    record = Record.bundled().scale(pgv=0.5)
    again: Record = pickle.loads(pickle.dumps(record))
    assert again.name == record.name
    assert [channel[:5] for channel in again.channels] == [channel[:5] for channel in record.channels]
    for one, other in zip(record.channels, again.channels, strict=True):
        assert (one.acceleration == other.acceleration).all()
    # A record of a file beside the scenario is found from any folder.
    record.write(tmp_path / "shake.txt")
    path = tmp_path / "mine.toml"
    path.write_text('extends = "candia-8-barrels"\n[motion]\nrecord = "shake.txt"\n')
    scenarios = [
        Scenario.load("candia-8-barrels"),
        Scenario.load("candia-8-barrels").with_record(record),
        Scenario.load(path),
    ]
    for scenario in scenarios:
        assert pickle.loads(pickle.dumps(scenario)) == scenario
        assert copy.copy(scenario) is scenario
        assert copy.deepcopy([scenario]) == [scenario]
        ground, same = scenario.ground(), pickle.loads(pickle.dumps(scenario)).ground()
        assert ground is not None
        assert (same.channels[0].acceleration == ground.channels[0].acceleration).all()
    assert copy.deepcopy(record) is record


def test_runs_and_tables_are_pickled_and_copied(run: Run, tmp_path: Path) -> None:
    again: Run = pickle.loads(pickle.dumps(pickle.loads(pickle.dumps(run))))
    assert again.headline == run.headline
    assert again.summary == run.summary
    assert again.html() == run.html()
    assert repr(again) == repr(run)
    for name, values in run.histories.items():
        assert np.array_equal(again.histories[name], values, equal_nan=True), name
    assert (again.frames.poses == run.frames.poses).all()
    assert (again.contact_forces(3) == run.contact_forces(3)).all()
    assert again.forces.keys() == run.forces.keys()
    assert (again.other is None) == (run.other is None)
    table: Table = pickle.loads(pickle.dumps(run.variants))
    assert run.variants is not None
    assert table.columns == run.variants.columns
    assert table.to_csv() == run.variants.to_csv()
    with pytest.raises(barrelstack.RunError, match="run its scenario again"):
        again.write(tmp_path / "out")
    for histories in (pickle.loads(pickle.dumps(run.histories)), copy.deepcopy(run.histories)):
        assert {name: values.tobytes() for name, values in histories.items()} == {
            name: values.tobytes() for name, values in run.histories.items()
        }
    assert pickle.loads(pickle.dumps(run.demands)) == run.demands
    assert copy.copy(run) is copy.deepcopy(run) is run
    assert copy.copy(table) is copy.deepcopy(table) is table


STATED = Scenario({"extends": "sliding-block"})
TILTS = Calibration.friction({"angle (deg)": [21.4, 22.0, 21.7]}, interface="rack-ground")


@pytest.mark.parametrize(
    ("work", "also"),
    [
        (lambda: Record.read("no-such-file.AT2"), FileNotFoundError),
        (lambda: Record.read(3), TypeError),  # type: ignore[arg-type]
        (lambda: Record.bundled("mine"), ValueError),
        (lambda: Record.from_arrays(["a"], 0.01, unit="g"), ValueError),
        (lambda: Record.bundled().scale(1.0, pgv=2.0), TypeError),
        (lambda: Record.bundled().write("/no/such/folder/a.txt"), OSError),
        (lambda: Scenario.load("candia-8-barrels").run(variants=-1), OverflowError),
        (lambda: Scenario.load("candia-8-barrels").run(variants=2**40), OverflowError),
        (lambda: Scenario.load("candia-8-barrels").run(variants="2"), TypeError),  # type: ignore[arg-type]
        (lambda: STATED.set("run.duration", object()), TypeError),
        (lambda: STATED.observe(lambda glance: None, every=-1), OverflowError),
        (lambda: Scenario(3), TypeError),  # type: ignore[arg-type]
        (lambda: Scenario.load("no-such-scenario"), ValueError),
        (lambda: barrelstack.schema("mine"), ValueError),
        (lambda: barrelstack.Study.collect("/no/such/folder"), Exception),
    ],
)
def test_what_the_package_refuses_is_of_one_family(work: Callable[[], object], also: type[Exception]) -> None:
    with pytest.raises(barrelstack.Error) as caught:
        work()
    assert isinstance(caught.value, also)
    assert str(caught.value)


@pytest.mark.parametrize(
    ("work", "also"),
    [
        (lambda run: run.histories["none"], KeyError),
        (lambda run: run.demands["none"], KeyError),
        (lambda run: run.variants["none"], KeyError),
        (lambda run: run.variants[3], TypeError),
        (lambda run: run.variants.numbers("none"), KeyError),
        (lambda run: run.variants.numbers("outcome"), TypeError),
        (lambda run: run.contact_forces(10**9), IndexError),
        (lambda run: run.contact_forces(-1), OverflowError),
        (lambda run: run.contact_forces("a"), TypeError),
        (lambda run: run.plot(only="none"), TypeError),
        (lambda run: run.write(3), TypeError),
        (lambda run: Record.bundled()["none"], ValueError),
        (lambda run: Record.bundled()["#9"], ValueError),
        (lambda run: Record.bundled()[0], TypeError),
        (lambda run: Record.bundled().velocity("none"), ValueError),
        (lambda run: STATED.nothing, AttributeError),
        (lambda run: STATED.motion.nothing, AttributeError),
        (lambda run: STATED.fields["nothing"], KeyError),
        (lambda run: STATED.set("nothing", 3), ValueError),
        (lambda run: STATED.motion.help("nothing"), KeyError),
    ],
)
def test_what_is_not_there_is_refused_in_the_same_family(
    run: Run, work: Callable[[Run], object], also: type[Exception]
) -> None:
    with pytest.raises(barrelstack.Error) as caught:
        work(run)
    assert isinstance(caught.value, also)
    assert str(caught.value) == caught.value.args[0]
    again = pickle.loads(pickle.dumps(caught.value))
    assert (type(again), str(again)) == (type(caught.value), str(caught.value))


def test_what_is_not_there_is_absent_as_in_any_mapping(run: Run) -> None:
    assert run.histories.get("none") is None
    assert "none" not in run.histories
    assert "none" not in run.demands
    assert not hasattr(STATED, "nothing")
    assert getattr(STATED.motion, "nothing", 3) == 3


@pytest.mark.skipif(os.name == "nt", reason="links need a privilege there")
@pytest.mark.parametrize(
    ("name", "write"),
    [
        ("report.html", lambda run, path: run.report(path)),
        ("report.pdf", lambda run, path: run.report(path)),
        ("table.csv", lambda run, path: run.variants.to_csv(path)),
        ("table.parquet", lambda run, path: run.variants.to_parquet(path)),
        ("record.txt", lambda run, path: Record.bundled().write(path)),
        ("record.npz", lambda run, path: Record.bundled().write(path)),
        ("summary.json", lambda run, path: run.write(path.parent, overwrite=True)),
        ("calibration.html", lambda run, path: TILTS.report(path)),
        ("calibration.pdf", lambda run, path: TILTS.report(path)),
    ],
)
def test_no_writer_follows_a_link(
    run: Run, tmp_path: Path, name: str, write: Callable[[Run, Path], object]
) -> None:
    kept = tmp_path / "kept"
    kept.write_text("kept")
    folder = tmp_path / "out"
    folder.mkdir()
    (folder / name).symlink_to(kept)
    write(run, folder / name)
    assert kept.read_text() == "kept"
    assert not (folder / name).is_symlink()
    assert (folder / name).stat().st_size > 100
    assert not list(folder.glob("*.part"))


def test_an_assigned_field_is_refused_where_it_would_change_nothing() -> None:
    scenario = Scenario.load("demo-napa")
    for of, name, path in [(scenario.stack, "levels", "stack.levels"), (scenario, "title", "title")]:
        with pytest.raises(barrelstack.ArgumentError, match=re.escape(f'scenario.set("{path}", value)')):
            setattr(of, name, 3)
    assert scenario.set("stack.levels", 3).stack.levels == 3


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no named pipes")
@pytest.mark.parametrize(
    "read",
    [
        Record.read,
        Scenario.load,
        Study.load,
        lambda path: Calibration.stiffness(path),
        lambda path: Calibration.drop(path),
        lambda path: Calibration.friction(path, interface="rack-ground"),
        lambda path: Calibration.response(Scenario.load("candia-8-barrels"), path),
        lambda path: Calibration.collapse(Scenario.load("candia-8-barrels"), path),
        lambda path: Scenario.load("demo-napa", motion__record=path).run(variants=0),
        lambda path: barrelstack.heights(f"{path}-out", records=[path]),
        lambda path: barrelstack.protect("demo-napa", f"{path}-out", records=[path]),
        lambda path: barrelstack.protect("demo-napa", f"{path}-out", site=path),
    ],
)
def test_no_reader_waits_for_a_pipe_or_reads_a_device(tmp_path: Path, read: Callable[[str], object]) -> None:
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    for path in (str(pipe), "/dev/zero"):
        with pytest.raises(barrelstack.Error, match=r"not a file; write its content to a file"):
            read(path)


def test_what_a_callback_raises_is_passed_on() -> None:
    def look(glance: barrelstack.Glance) -> None:
        raise TypeError("mine")

    with pytest.raises(TypeError, match="mine") as caught:
        STATED.observe(look)
    assert not isinstance(caught.value, barrelstack.Error)


def test_a_wrong_date_prevents_no_import_and_pages_state_the_reason(tmp_path: Path) -> None:
    page = tmp_path / "page.html"
    code = f"import barrelstack; barrelstack.Scenario.load('sliding-block').run().report({str(page)!r})"
    environment = os.environ | {"SOURCE_DATE_EPOCH": "yesterday"}
    words = [sys.executable, "-c", code]
    done = subprocess.run(words, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    text = page.read_text(encoding="utf-8").replace("\u00a0", " ")
    assert "unknown (SOURCE_DATE_EPOCH: expected whole seconds since 1970, found " in text


SCRIPT = """
import barrelstack

scenario = barrelstack.Scenario.load("candia-8-barrels")
levels: int = scenario.stack.levels
print(levels + 1, scenario.stack["levels"], scenario.fields.stack.levels)
run = scenario.run(barrelstack.Record.bundled(), variants=2)
print(run.histories["time"].max(), run.summary["demands"], run.demands, run.headline.upper())
table = run.variants
if table is not None:
    losses = table.numbers("first_loss")
    print(losses.mean(), table["outcome"], [column.name.upper() for column in table.columns])


def look(glance: barrelstack.Glance) -> bool:
    return glance.time < 1.0


scenario.observe(look)
simulation = scenario.simulation()
print(simulation.step(10) + 1, simulation.state.pose("R1") + simulation.state.time, simulation.energy.kinetic + 1.0)
simulation.apply_force("R1", (10.0, 0.0), at=[0.0, 0.1], moment=2.0)
for name, force in simulation.forces.items():
    print(name.upper(), force.sum(), [one.force for one in simulation.elements.values()])
kept = simulation.copy()
simulation.reset(kept)
many = scenario.simulations(4)
print(many.step(3).sum(), many.state.poses.shape, many.ended.any())
"""


@pytest.mark.parametrize(
    "checker",
    [
        ["mypy", "--strict", "--cache-dir", "cache"],
        pytest.param(["pyright", "--pythonpath", sys.executable], marks=pytest.mark.heavy),
    ],
    ids=lambda checker: checker[0],
)
def test_a_script_of_a_user_passes_strict_checkers(checker: list[str], tmp_path: Path) -> None:
    pytest.importorskip(checker[0], reason=f"no {checker[0]}")
    path = tmp_path / "mine.py"
    path.write_text("# pyright: strict\n" + SCRIPT)
    words = [sys.executable, "-m", *checker, str(path)]
    done = subprocess.run(words, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


def test_the_extra_for_the_site_has_what_it_imports() -> None:
    text = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    extra = re.search(r"^docs = \[(.*?)^\]", text, re.DOTALL | re.MULTILINE)
    assert extra is not None
    named = set(re.findall(r'"([\w-]+)', extra.group(1))) | {"numpy", "barrelstack"}
    sources = [ROOT / "docs" / "build.py", *(ROOT / "docs" / "notebooks").glob("*.ipynb")]
    imported = set()
    for path in sources:
        imported |= set(re.findall(r'^(?:    ")?(?:import|from) (\w+)', path.read_text(encoding="utf-8"), re.MULTILINE))
    # The kernel of notebooks and the program that lays out pages are started, not imported.
    needed = (imported - set(sys.stdlib_module_names) - {"__future__"}) | {"ipykernel", "mkdocs"}
    assert needed <= named, needed - named
