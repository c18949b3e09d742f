"""Tests with packages that take long to install: ObsPy, Dask, Slurm. Skipped if missing."""

from __future__ import annotations

import os
import shutil
import signal
import socket
import subprocess
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from barrelstack import Record, Study

pytestmark = pytest.mark.heavy


def test_a_stream_of_obspy_measures_what_its_file_measures(tmp_path: Path) -> None:
    obspy = pytest.importorskip("obspy", reason="no obspy")
    own = Record.bundled()
    stream = own.to_obspy()
    assert [trace.stats.channel for trace in stream] == ["E", "N", "Up"]
    # Through a file written by ObsPy: MiniSEED of doubles, read by both.
    path = tmp_path / "napa.mseed"
    stream.write(str(path), format="MSEED", encoding="FLOAT64")
    by_obspy = Record.from_obspy(obspy.read(str(path)), unit="m/s2")
    # The reader of MiniSEED removes the offset of the digitizer, as ObsPy does on request.
    by_reader = Record.read(path, sensitivity=1.0)
    centered = Record.from_obspy(obspy.read(str(path)).detrend("demean"), unit="m/s2")
    periods = np.geomspace(0.05, 5.0, 40)
    for name in ("E", "N", "Up"):
        assert (by_obspy[name].acceleration == own[name].acceleration).all()
        assert (by_obspy.spectrum(periods, of=name)[1] == own.spectrum(periods, of=name)[1]).all()
        pairs = [(record.intensity("pgv")[0].values[name]) for record in (by_obspy, own, centered, by_reader)]
        assert pairs[0] == pairs[1]
        # The two means are rounded in another order; measured 1e-15.
        assert pairs[2] == pytest.approx(pairs[3], rel=1e-12)
        spectra = [record.spectrum(periods, of=name)[1] for record in (centered, by_reader)]
        assert spectra[0] == pytest.approx(spectra[1], rel=1e-12)
    stream[1].stats.delta *= 2
    with pytest.raises(ValueError, match="resample"):
        Record.from_obspy(stream, unit="m/s2")


CHEAP = """
schema = 1
title = "Two thousand blocks"
[base]
extends = "sliding-block"
[base.run]
duration = "0.5 s"
[[factor]]
field = "interface.block-ground.friction.coefficient"
distribution = { kind = "uniform", from = 0.1, to = 0.6 }
[design]
kind = "latin-hypercube"
count = 2000
chunk = 20
"""


def run_and_kill(client: Any, folder: Path, pids: Any, kills: int) -> int:
    """Runs the cheap study on a cluster, kills a worker a few times, and returns the number of kills."""
    killed = 0

    def progress(done: float, of: float, what: str) -> None:
        nonlocal killed
        if killed < kills and done >= (killed + 1) * of / (kills + 2):
            os.kill(next(iter(pids())), signal.SIGKILL)
            killed += 1

    Study(CHEAP).run_on(client, folder, progress=progress)
    return killed


def test_a_study_on_dask_loses_nothing_when_workers_are_killed(tmp_path: Path) -> None:
    distributed = pytest.importorskip("distributed", reason="no distributed")
    study = Study(CHEAP)
    assert study.cases == 2000
    study.run(tmp_path / "alone")
    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster,
        distributed.Client(cluster) as client,
    ):
        start = time.perf_counter()
        killed = run_and_kill(client, tmp_path / "dask", lambda: client.run(os.getpid).values(), 3)
        print(f"2,000 cases on two workers, {killed} killed: {time.perf_counter() - start:.1f} s")
    assert killed == 3
    for name in ("table.csv", "table.parquet"):
        assert (tmp_path / "dask" / name).read_bytes() == (tmp_path / "alone" / name).read_bytes()


SLURM = """
ClusterName=barrels
SlurmctldHost={host}
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/ctld.pid
SlurmdPidFile={folder}/d.pid
SlurmctldPort={port}
SlurmdPort={other}
SlurmctldLogFile={folder}/ctld.log
SlurmdLogFile={folder}/d.log
ProctrackType=proctrack/pgid
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
ReturnToService=2
MpiDefault=none
NodeName={host} CPUs={cpus} State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""


def free_port() -> int:
    with socket.socket() as one:
        one.bind(("", 0))
        return int(one.getsockname()[1])


@pytest.fixture
def slurm(tmp_path: Path) -> Iterator[dict[str, str]]:
    """A cluster of one machine for this test alone."""
    for program in ("munged", "slurmctld", "slurmd", "sbatch"):
        if shutil.which(program, path=os.environ["PATH"] + ":/usr/sbin") is None:
            pytest.skip(f"no {program}")
    if os.geteuid() != 0:
        pytest.skip("Slurm's daemons want root")
    host, cpus = socket.gethostname().split(".")[0], max(2, os.cpu_count() or 1)
    for name in ("state", "spool"):
        (tmp_path / name).mkdir()
    text = SLURM.format(folder=tmp_path, host=host, cpus=cpus, port=free_port(), other=free_port())
    (tmp_path / "slurm.conf").write_text(text)
    environment = {**os.environ, "SLURM_CONF": str(tmp_path / "slurm.conf"), "PATH": os.environ["PATH"] + ":/usr/sbin"}
    key = tmp_path / "munge.key"
    key.write_bytes(os.urandom(128))
    key.chmod(0o600)
    munge = ["munged", "--foreground", "--force", f"--key-file={key}", f"--socket={tmp_path / 'munge.socket'}"]
    munge += [f"--{name}-file={tmp_path / 'munge'}.{name}" for name in ("log", "pid", "seed")]
    quiet = {"env": environment, "stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    children = [subprocess.Popen(munge, **quiet)]
    for _ in range(50):
        if (tmp_path / "munge.socket").exists():
            break
        time.sleep(0.1)
    children += [subprocess.Popen([daemon, "-D"], **quiet) for daemon in ("slurmctld", "slurmd")]
    try:
        for _ in range(20):
            done = subprocess.run(
                ["timeout", "5", "sinfo", "-h", "-o", "%T"], env=environment, capture_output=True, text=True, check=False
            )
            if done.stdout.strip().startswith("idle"):
                break
            if any(child.poll() is not None for child in children):
                logs = [(tmp_path / log).read_text()[-400:] for log in ("ctld.log", "d.log") if (tmp_path / log).exists()]
                pytest.skip("Slurm's daemons do not stay: " + " | ".join(logs))
            time.sleep(0.5)
        else:
            pytest.skip(f"Slurm's node does not come up: {done.stdout} {done.stderr}")
        yield environment
    finally:
        for child in children:
            child.terminate()
        for child in children:
            try:
                child.wait(timeout=5)
            except subprocess.TimeoutExpired:
                child.kill()


def test_a_study_runs_on_slurm_through_dask(
    slurm: dict[str, str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    jobqueue = pytest.importorskip("dask_jobqueue", reason="no dask_jobqueue")
    distributed = pytest.importorskip("distributed", reason="no distributed")
    for name in ("SLURM_CONF", "PATH"):
        monkeypatch.setenv(name, slurm[name])
    Study(CHEAP).run(tmp_path / "alone")
    cluster = jobqueue.SLURMCluster(
        cores=1, memory="1GB", walltime="00:10:00", job_cpu=1, log_directory=str(tmp_path / "logs"), job_directives_skip=["--mem"]
    )
    with cluster, distributed.Client(cluster) as client:
        cluster.scale(jobs=2)
        client.wait_for_workers(1, timeout=60)
        killed = run_and_kill(client, tmp_path / "slurm", lambda: client.run(os.getpid).values(), 1)
    assert killed == 1
    assert (tmp_path / "slurm" / "table.csv").read_bytes() == (tmp_path / "alone" / "table.csv").read_bytes()
