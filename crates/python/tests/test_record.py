"""Records from bytes, files and arrays."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import barrelstack
from barrelstack import Record, RecordError

G = 9.80665


@pytest.fixture(scope="module")
def napa() -> Record:
    return Record.bundled()


def test_what_is_written_is_read_back_bit_for_bit(napa: Record, tmp_path: Path) -> None:
    for ending in ("npz", "txt"):
        napa.write(tmp_path / f"napa.{ending}")
        again = Record.read(tmp_path / f"napa.{ending}")
        for one, other in zip(again.channels, napa.channels, strict=True):
            assert (one.acceleration == other.acceleration).all()
            assert (one.name, one.azimuth, one.time_step) == (other.name, other.azimuth, other.time_step)
    data = (tmp_path / "napa.npz").read_bytes()
    assert Record.read(data).channels[0].acceleration.sum() == napa.channels[0].acceleration.sum()


def test_accelerations_are_views_that_cannot_be_written(napa: Record) -> None:
    one, two = napa["h1"].acceleration, napa["h1"].acceleration
    assert one.__array_interface__["data"][0] == two.__array_interface__["data"][0]
    assert not one.flags.writeable


def test_arrays_make_the_record_of_their_file(napa: Record) -> None:
    parts = {channel.name: channel.acceleration / G for channel in napa.channels}
    made = Record.from_arrays(parts, napa["h1"].time_step, unit="g", raw=True)
    assert made.stage == "raw"
    # Rounding of a division and a multiplication by g; measured 1e-16.
    assert made.intensity("pgv")[0].values["E"] == pytest.approx(napa.intensity("pgv")[0].values["E"], rel=1e-13)
    flat = Record.from_arrays(np.sin(np.arange(500) / 20), 0.01, unit="m/s2", vertical=np.cos(np.arange(500) / 9))
    assert [channel.name for channel in flat.channels] == ["H1", "UP"]
    assert flat["vertical"].vertical


def test_numbers_that_are_none_are_refused_with_their_place() -> None:
    samples = np.zeros(100)
    samples[41] = np.nan
    with pytest.raises(RecordError, match="42 of channel H1: expected a finite number"):
        Record.from_arrays(samples, 0.01, unit="g")
    with pytest.raises(RecordError, match="unit of acceleration"):
        Record.from_arrays(np.zeros(100), 0.01, unit="furlong")
    with pytest.raises(RecordError) as caught:
        Record.read(b"PEER\nx\nACCELERATION TIME SERIES IN UNITS OF G\nNPTS= 3, DT= .01 SEC\n 0.1 0.2 zero\n", name="site.AT2")
    assert caught.value.path == "site.AT2"
    assert caught.value.line is not None
    with pytest.raises(FileNotFoundError):
        Record.read("no-such-file.AT2")


def test_a_scale_reaches_its_target_with_its_unit(napa: Record) -> None:
    assert napa.scale(pgv="60 cm/s").intensity("pgv")[0].values["E"] == pytest.approx(0.6, rel=1e-12)
    assert napa.scale(pga=3.0).intensity("pga")[0].values["E"] == pytest.approx(3.0, rel=1e-12)
    both = napa.scale(of="rotd100", pgv="0.6 m/s")
    assert both.intensity("pgv")[0].values["E"] <= 0.6
    with pytest.raises(ValueError, match="pgv"):
        napa.scale(pgv="60 cm")
    with pytest.raises(TypeError, match="one measure"):
        napa.scale(2.0, pgv=1.0)
    assert "scaled by" in napa.scale(2.0).notes[-1]


def test_processing_is_listed_step_by_step(napa: Record) -> None:
    assert napa.stage == "raw"
    done = napa.process("compact", high_pass=0.2)
    assert done.stage == "corrected"
    assert any("0.2000 Hz" in note for note in done.notes)
    assert abs(done.displacement("h1")[-1]) < 1e-6
    with pytest.raises(ValueError, match='chain: .*"fancy"'):
        napa.process("fancy")
    with pytest.raises(RecordError, match="give a value in this range"):
        napa.process(low_pass=1e6)


def test_the_spectrum_is_that_of_a_closed_form() -> None:
    # Undamped, with an acceleration a that starts within a millisecond: displacement peaks at 2 a/ω², so PSA is 2 a.
    step = np.full(2000, 1.5)
    step[0] = 0.0
    record = Record.from_arrays(step, 0.001, unit="m/s2")
    periods, psa = record.spectrum([0.2, 0.5], damping=0.0)
    assert periods.tolist() == [0.2, 0.5]
    # Measured 3e-5: the peak lies between samples.
    assert psa == pytest.approx([3.0, 3.0], rel=2e-4)


def test_a_match_follows_its_target(napa: Record) -> None:
    matched = napa.process("compact").match("ec8:ag=0.3,site=B", periods=(0.2, 2.0), tolerance=0.1)
    _, psa = matched.spectrum([0.2])
    # EN 1998-1, 3.2.2.2: a_g S 2.5 with S = 1.2 for ground B of type 1, between T_B and T_C.
    assert psa[0] == pytest.approx(0.3 * G * 1.2 * 2.5, rel=0.1)
    own = matched.match(([0.2, 2.0], [4.0, 2.0]), periods=(0.25, 1.8), tolerance=0.1)
    assert "a table (2 periods" in " ".join(own.notes)
    with pytest.raises(RecordError, match="ec8: site"):
        napa.match("ec8:ag=0.3")
    both = napa.match("asce7:sds=0.6,sd1=0.4", of="rotd100", periods=(0.2, 2.0), tolerance=0.1)
    assert "matched together, rotd100" in " ".join(both.notes)


def test_files_of_agencies_are_read(strong_motion: Path) -> None:
    files = sorted(strong_motion.glob("peer/*.AT2"))
    if not files:
        pytest.skip("no PEER files")
    record = Record.read(files[0])
    assert record.format == "peer"
    assert record.format in barrelstack.formats()
    assert record.intensity("pga")[0].unit == "m/s2"
