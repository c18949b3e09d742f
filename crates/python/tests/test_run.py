"""Results of a run: arrays without copies, tables, pages, progress, interruptions."""

from __future__ import annotations

import json
import os
import pickle
import re
import subprocess
import sys
import threading
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import barrelstack
from barrelstack import Run, Scenario


@pytest.fixture(scope="module")
def run() -> Run:
    return Scenario.load("candia-8-barrels").set({"run.duration": "3 s", "stack.levels": 2}).run(variants=0)


def address(array: np.ndarray[Any, Any]) -> int:
    return int(array.__array_interface__["data"][0])


def test_histories_arrive_without_a_copy(run: Run) -> None:
    one, two = run.histories["B2.1_displacement_x"], run.histories["B2.1_displacement_x"]
    assert one is not two
    assert address(one) == address(two)
    # The memory belongs to the run, which the array keeps alive, not to NumPy.
    assert not one.flags.owndata
    assert type(one.base).__name__ == "Run"
    assert address(run.forces["R1 on ground"].vertical) == address(run.forces["R1 on ground"].vertical)
    assert address(run.envelopes["B1.1"].peak) == address(run._native.envelope_stresses(1)[1])


def test_a_view_outlives_its_run_and_cannot_be_written() -> None:
    view = Scenario.load("sliding-block").run().histories["block_displacement_x"]
    kept = view.copy()
    assert (view == kept).all()
    with pytest.raises(ValueError, match="read-only"):
        view[0] = 1.0


def test_histories_say_what_the_frames_say(run: Run) -> None:
    frames, time = run.frames, run.histories.time
    body = frames.bodies.index("B2.1")
    ground = frames.poses[:, 0, 0]
    displacement = frames.poses[:, body, 0] - ground - (frames.poses[0, body, 0] - ground[0])
    # Both have their own rates: at common times they hold the same state.
    common, of_frames, of_histories = np.intersect1d(frames.time, time, return_indices=True)
    assert len(common) > 20
    apart = run.histories["B2.1_displacement_x"][of_histories] - displacement[of_frames]
    # Measured 1e-16 m.
    assert np.abs(apart).max() < 1e-12
    assert frames.poses.shape == (len(frames.time), len(frames.bodies), 3)
    assert run.contact_forces(0).shape[1] == 4


def test_the_forces_at_rest_carry_the_stack(run: Run) -> None:
    found = Scenario.load("candia-8-barrels").set("stack.levels", 2).check()[0]
    assert found["barrels"] == 4
    weight = run.forces["R1 on ground"].at_rest
    envelope = run.envelopes["R1"]
    assert 3e3 < weight < 2e4
    assert (envelope.peak >= 0).all()
    assert envelope.points.shape == (len(envelope.peak), 2)


def test_histories_and_tables_are_read_by_whatever_reads_arrow(run: Run) -> None:
    pl = pytest.importorskip("polars", reason="no polars")
    pa = pytest.importorskip("pyarrow", reason="no pyarrow")
    pd = pytest.importorskip("pandas", reason="no pandas")
    frame = pl.DataFrame(run.histories)
    assert (frame["B2.1_rotation"].to_numpy() == run.histories["B2.1_rotation"]).all()
    table = pa.table(run.histories)
    assert table.schema.field("B2.1_rotation").metadata == {b"unit": b"rad"}
    assert pd.DataFrame.from_arrow(run.histories).shape == frame.shape


def test_demands_have_units_and_an_outcome_is_a_sentence(run: Run) -> None:
    assert run.demands.units["base_slip_peak"] == "m"
    assert set(run.demands) == set(run.demands.units) == set(run.demands.meanings)
    assert run.headline in repr(run)
    assert run.outcome.kind == run.summary["outcome"]["kind"]


def test_a_run_shows_its_page_and_writes_the_files_of_the_command(run: Run, tmp_path: Path) -> None:
    page = run.html()
    assert page.startswith("<!doctype html>")
    assert "&quot;" in run._repr_html_()
    assert "<iframe srcdoc=" in run._repr_html_()
    run.report(tmp_path / "a.html")
    assert (tmp_path / "a.html").read_text() == page
    run.report(tmp_path / "a.pdf")
    assert (tmp_path / "a.pdf").read_bytes().startswith(b"%PDF")
    run.write(tmp_path / "files")
    assert {"summary.json", "histories.npz", "report.html"} <= set(os.listdir(tmp_path / "files"))
    with pytest.raises(barrelstack.Error, match="not empty"):
        run.write(tmp_path / "files")


def test_a_report_is_written_in_spanish_and_in_no_unknown_language(run: Run, tmp_path: Path) -> None:
    page = run.html(language="es")
    assert '<html lang="es">' in page
    assert '<html lang="en">' in run.html()
    run.report(tmp_path / "a.html", language="es")
    assert (tmp_path / "a.html").read_text(encoding="utf-8") == page
    run.report(tmp_path / "en.pdf")
    run.report(tmp_path / "es.pdf", language="es")
    assert (tmp_path / "en.pdf").read_bytes() != (tmp_path / "es.pdf").read_bytes()
    run.write(tmp_path / "out", language="es")
    assert '<html lang="es">' in (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    for write in (
        lambda: run.html(language="fr"),
        lambda: run.report(tmp_path / "b.html", language="fr"),
        lambda: run.report(tmp_path / "b.pdf", language="fr"),
        lambda: run.write(tmp_path / "b", language="fr"),
        lambda: run.render(tmp_path / "b", "figures", language="fr"),
    ):
        with pytest.raises(ValueError, match='there is no language "fr"; pages are written in en or es'):
            write()
    again = pickle.loads(pickle.dumps(run))
    assert again.html() == run.html()
    with pytest.raises(barrelstack.RunError, match="this run was pickled"):
        again.html(language="es")


def frames_of(page: str) -> int:
    """Returns the number of times in the data of the only player of a page."""
    data = json.loads(page.split('id="barrelstack-data">')[1].split("</script>")[0])
    (pane,) = data["players"][0]["panes"]
    assert pane["depth"]["bodies"]
    return int(pane["times"]["n"])


def test_an_animation_of_the_demo_fits_into_a_cell(tmp_path: Path) -> None:
    run = Scenario.load("demo-napa").run(variants=0)
    film = run.animate()
    cell = film._repr_html_()
    assert cell.startswith("<iframe srcdoc=")
    assert len(cell.encode()) < 1_000_000
    count = frames_of(film.html())
    assert abs(count - 20 * run.frames.time[-1]) < 3
    fewer = run.animate(rate=10, between=(4.0, 9.0))
    assert abs(frames_of(fewer.html()) - 51) < 3
    assert len(fewer.html()) < len(film.html())
    film.save(tmp_path / "film.html")
    assert (tmp_path / "film.html").read_text(encoding="utf-8") == film.html()
    with pytest.raises(ValueError, match=r"\.html"):
        film.save(tmp_path / "film.gif")
    with pytest.raises(ValueError, match="frames per second"):
        run.animate(rate=0.0)
    with pytest.raises(ValueError, match="run ends"):
        run.animate(between=(1e4, 2e4))


def test_a_large_animation_is_announced_with_a_remedy(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("barrelstack._pictured.LARGE", 1000)
    with pytest.warns(barrelstack.BarrelstackWarning, match=r"rate=10\).*between="):
        run.animate()


def test_a_plot_has_units_and_names(run: Run) -> None:
    matplotlib = pytest.importorskip("matplotlib", reason="no matplotlib")
    matplotlib.use("Agg")
    ax = run.plot()
    assert ax.get_xlabel() == "time (s)"
    assert "(m)" in ax.get_ylabel()
    assert any("B2.1" in text.get_text() for text in ax.get_legend().get_texts())


def test_both_planes_are_listed_with_the_deciding_one_first() -> None:
    demo = Scenario.load("demo-napa").set({"stack.levels": 2, "run.duration": "3 s"})
    with pytest.warns(barrelstack.BarrelstackWarning):
        run = demo.run(variants=2)
    other = run.other
    assert other is not None
    assert other.other is not None
    assert {run.summary["view"], other.summary["view"]} == {"transverse", "longitudinal"}
    assert run.variants is not None
    assert run.variants["variant"] == [0, 1, 2]


def test_progress_is_reported_and_what_it_raises_ends_the_run() -> None:
    scenario = Scenario.load("candia-8-barrels")
    reports: list[tuple[float, float, str]] = []
    scenario.run(variants=8, progress=lambda *now: reports.append(now))
    assert {what for _, _, what in reports} <= {"variants", "s"}
    assert reports

    def refuse(*_: object) -> None:
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        scenario.run(variants=64, progress=refuse)


def test_the_progress_of_the_search_for_a_remedy_has_names_and_totals() -> None:
    # Progress is reported every 50 ms, so the search has to take much longer; with these variants it takes seconds.
    short = {"stack.levels": 3, "motion.sine.cycles": 4, "run.stop_after_collapse": "0.1 s"}
    scenario = Scenario.load("candia-8-barrels").set(short)
    reports: list[tuple[float, float, str]] = []
    found = scenario.run(variants=64, remedy=True, progress=lambda *now: reports.append(now)).summary["remedy"]
    tried = [now for now in reports if "a stack of" in now[2]]
    assert tried
    assert all(done <= of == 64 for done, of, _ in tried), tried
    pattern = re.compile(rf"variants of a stack of .+ \(change \d+ of up to {found['candidates']}\)")
    assert all(pattern.fullmatch(what) for _, _, what in tried), tried


def test_an_observer_sees_every_so_many_steps_and_stops_the_run() -> None:
    glances: list[tuple[float, int, float]] = []

    def look(glance: barrelstack.Glance) -> bool:
        glances.append((glance.time, glance.steps, glance.twists[1, 0]))
        return bool(glance.twists[1, 0] < 0.5)

    with pytest.warns(barrelstack.BarrelstackWarning, match="stopped"):
        run = Scenario.load("sliding-block").observe(look, every=10)
    assert run.interrupted
    assert [steps for _, steps, _ in glances] == [10 * at for at in range(len(glances))]
    # Half of 1 m/s is lost after 0.5 / (0.3 g) s; measured within one call, 10 steps.
    assert abs(glances[-1][0] - 0.5 / (0.3 * 9.80665)) < 0.005

    def fail(_: barrelstack.Glance) -> None:
        raise LookupError("mine")

    with pytest.raises(LookupError, match="mine"):
        Scenario.load("sliding-block").observe(fail)


def test_the_lock_is_free_while_cases_run() -> None:
    counted, done = 0, threading.Event()

    def count() -> None:
        nonlocal counted
        while not done.is_set():
            counted += 1
            time.sleep(0.001)

    thread = threading.Thread(target=count)
    thread.start()
    start = time.perf_counter()
    barrelstack.ensemble([{"stack.levels": 4}] * 16 + [{"stack.levels": 3}] * 16, "candia-8-barrels")
    passed = time.perf_counter() - start
    done.set()
    thread.join()
    # With the lock held it would count once or twice; measured some 900 a second.
    assert passed > 0.1
    assert counted > 50 * passed, (counted, passed)


LONG = """
import os, signal, threading, time, warnings
import barrelstack
warnings.simplefilter("ignore")
pressed = []

def press():
    pressed.append(time.process_time())
    os.kill(os.getpid(), signal.SIGINT)

threading.Timer(2.0, press).start()
try:
    {work}
except KeyboardInterrupt:
    print(time.process_time() - pressed[0])
    raise
"""


@pytest.mark.skipif(os.name == "nt", reason="signals are those of POSIX")
@pytest.mark.parametrize(
    "work",
    [
        'barrelstack.Scenario.load("demo-napa").run(variants=4096)',
        'barrelstack.ensemble([{"stack.levels": 5}] * 4096)',
        'barrelstack.Study.load("napa-four-levels").run("FOLDER")',
        'barrelstack.Scenario.load("candia-8-barrels").set("run.step", "1 us").observe(lambda glance: False)',
        'barrelstack.Scenario.load("candia-8-barrels").set("run.step", "1 us").observe(lambda glance: False, every=10**9)',
    ],
)
def test_ctrl_c_ends_work_within_a_second(work: str, tmp_path: Path) -> None:
    folder = tmp_path / "study"
    code = LONG.format(work=work.replace("FOLDER", str(folder)))
    words = [sys.executable, "-c", code]
    done = subprocess.run(words, capture_output=True, text=True, check=False, timeout=30)
    assert done.stderr.rstrip().endswith("KeyboardInterrupt"), done.stderr
    # Time of the processor, so that other work on the machine does not count. Measured 0.001 to 0.2 s.
    assert float(done.stdout) < 1.0 * (os.cpu_count() or 1), done.stdout
    if folder.exists():
        # Finished chunks are kept, and no file is incomplete.
        assert not list(folder.glob("**/*.part"))
        study = barrelstack.Study.load("napa-four-levels")
        assert len(study.plan(folder)) <= len(study.plan())
