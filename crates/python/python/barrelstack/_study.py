"""Studies: one scenario run many times, on this machine or on many."""

from __future__ import annotations

import html
import json
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from . import _native
from ._page import Page
from ._progress import Progress, reporting
from ._quantity import literal
from ._record import Record
from ._store import store
from ._table import Table

__all__ = ["Chunk", "Curve", "Fragility", "Hunts", "Study"]


class Chunk(NamedTuple):
    """A chunk of a study: cases that are computed and stored together.

    Examples
    --------
    >>> Study.load("napa-four-levels").plan()[0]
    Chunk(number=0, cases=20, first=0, last=19)
    """

    number: int
    cases: int
    first: int
    last: int


class Curve(NamedTuple):
    """The fragility of one limit state.

    Examples
    --------
    >>> import tempfile
    >>> study = Study({
    ...     "base": {"extends": "candia-8-barrels", "stack": {"levels": 3}},
    ...     "motion": [{"synthetic": {"kind": "boore", "count": 6, "magnitude": 6, "distance": "8 km"}}],
    ...     "intensity": {"measure": "pgv", "levels": ["20 cm/s", "40 cm/s", "60 cm/s", "80 cm/s"]},
    ...     "design": {"kind": "stripes"},
    ... })
    >>> folder = tempfile.mkdtemp()
    >>> table = study.run(folder)
    >>> curve = study.fragility(folder).curves["collapse"]
    >>> 0.2 < curve.median < 0.8  # m/s
    True
    >>> curve.raw.shape, float(curve.probability(curve.median))
    ((4, 5), 0.5)
    """

    limit_state: str
    #: Median (SI unit of the measure); None if the data do not determine a curve.
    median: float | None
    #: Standard deviation of the logarithm.
    dispersion: float | None
    #: 95 % interval of the median.
    median_interval: tuple[float | None, float | None] | None
    #: Raw counts, shape (levels, 5): intensity, cases, failures, and Wilson's 95 % interval.
    raw: NDArray[np.float64]
    #: The 95 % band, shape (points, 3): intensity, lower, upper.
    band: NDArray[np.float64]
    #: Reason why there is no curve; None if there is one.
    no_curve: str | None

    def probability(self, intensity: Any) -> NDArray[np.float64]:
        """Returns the probability of failure at intensities (SI units), from the lognormal curve.

        Parameters
        ----------
        intensity
            Numbers above 0.

        Returns
        -------
        ndarray
            Probabilities, in the shape of the intensities.
        """
        if self.median is None or self.dispersion is None:
            raise ValueError(f"{self.limit_state} has no curve: {self.no_curve}")
        from math import erf, sqrt

        z = np.log(np.asarray(intensity, dtype=np.float64) / self.median) / self.dispersion
        chances = [0.5 * (1.0 + erf(value / sqrt(2.0))) for value in z.ravel().tolist()]
        return np.array(chances, dtype=np.float64).reshape(z.shape)


class Fragility(Page):
    """Results of a study: curves, modes, losses, sensitivities; made by :meth:`Study.fragility`.

    Examples
    --------
    >>> import tempfile
    >>> folder = tempfile.mkdtemp()
    >>> table = Study({
    ...     "base": {"extends": "candia-8-barrels", "stack": {"levels": 2}},
    ...     "factor": [{"field": "motion.sine.amplitude", "values": ["2 cm", "6 cm", "10 cm", "14 cm"]}],
    ...     "design": {"kind": "full-factorial"},
    ... }).run(folder)
    >>> fragility = Study.fragility(folder)
    >>> fragility.headline
    '2 of 4 cases of stacks of 2 levels on candia-2008 racks, shaken across the barrels, collapse.'
    >>> fragility.curves["collapse"].raw.shape[1]
    5
    """

    @property
    def measure(self) -> tuple[str, str]:
        """Name and SI unit of the intensity measure."""
        measure = self.document["measure"]
        return measure["name"], measure["unit"]

    @property
    def curves(self) -> dict[str, Curve]:
        """A curve for every limit state, by name: first ``"collapse"``, then ``"fallen-1"`` (at least one fallen
        barrel) and so on."""
        found: dict[str, Curve] = {}
        for one in self.document["fragility"]:
            raw = [[row["intensity"], row["cases"], row["failures"], *row["interval"]] for row in one["raw"]]
            band = [[row["intensity"], *row["interval"]] for row in one["band_at"]]
            interval = one["median_interval"]
            found[one["limit_state"]] = Curve(
                one["limit_state"],
                one["median"],
                one["dispersion"],
                None if interval is None else (interval[0], interval[1]),
                np.array(raw, dtype=np.float64).reshape(-1, 5),
                np.array(band, dtype=np.float64).reshape(-1, 3),
                one["no_curve"],
            )
        return found

    def plot(self, *limit_states: str, ax: Any = None) -> Any:
        """Plots raw fractions, curves and bands.

        Parameters
        ----------
        *limit_states
            Names of :attr:`curves`; by default the first.
        ax
            Axes to draw into; new ones by default.

        Returns
        -------
        matplotlib.axes.Axes
        """
        import matplotlib.pyplot as plt

        curves = self.curves
        name, unit = self.measure
        if ax is None:
            _, ax = plt.subplots(figsize=(6, 4), layout="constrained")
        for number, state in enumerate(limit_states or list(curves)[:1]):
            curve, color = curves[state], f"C{number}"
            x, cases, failures, low, high = curve.raw.T
            share = failures / np.maximum(cases, 1)
            ax.errorbar(x, share, [share - low, high - share], fmt="o", color=color, markersize=4, capsize=2, label=state)
            if curve.median is not None:
                at = np.linspace(0.5 * x.min(), 1.2 * x.max(), 200)
                ax.plot(at, curve.probability(at), color=color)
            if len(curve.band):
                ax.fill_between(*curve.band.T, color=color, alpha=0.15, linewidth=0)
        ax.set_xlabel(f"{name} ({unit})")
        ax.set_ylabel("probability of failure")
        ax.set_ylim(-0.02, 1.02)
        ax.legend(loc="upper left", fontsize="small")
        return ax


class Hunts(NamedTuple):
    """An incremental dynamic analysis: the result of each motion at each level.

    Examples
    --------
    >>> import tempfile
    >>> folder = tempfile.mkdtemp()
    >>> table = Study({
    ...     "base": {"extends": "candia-8-barrels", "stack": {"levels": 3}},
    ...     "motion": [{"synthetic": {"kind": "boore", "count": 2, "magnitude": 6, "distance": "8 km"}}],
    ...     "intensity": {"measure": "pgv"},
    ...     "design": {"kind": "ida", "first": "20 cm/s", "step": "20 cm/s", "runs": 5},
    ... }).run(folder)
    >>> hunts = Study.ida(folder)
    >>> len(hunts.motions), hunts.capacities.shape
    (2, (2,))
    """

    #: Names of the motions.
    motions: list[str]
    #: For each motion, the levels in ascending order (SI unit of the measure).
    levels: list[NDArray[np.float64]]
    #: For each motion, the demands on the stack at those levels; NaN where the stack collapsed.
    demands: list[NDArray[np.float64]]
    #: For each motion, the lowest level at which the stack collapsed; NaN if it never collapsed.
    capacities: NDArray[np.float64]


def tables(of: Mapping[str, Any]) -> dict[str, Any]:
    """Adds the version of the schema to the tables of a study."""
    return {"schema": 1, **of}


class Study:
    """A study: factors, motions, and the design of the cases.

    Parameters
    ----------
    of
        The text of a study file (TOML), or a nested dict of the same tables, which may contain quantities of Pint or
        astropy; it may extend bundled scenarios.
    name
        Name of the text in error messages.

    Examples
    --------
    >>> study = Study.load("napa-four-levels")
    >>> study.cases, study.motions, len(study.plan())
    (240, 24, 12)
    >>> folder = "napa"
    >>> study.run_chunk(folder, 0), len(study.plan(folder)), len(study.collect(folder))
    (True, 11, 20)
    """

    def __init__(self, of: str | Mapping[str, Any], name: str = "study") -> None:
        # The text is kept, one line per table, because it is stored in folders and sent to workers.
        text = of if isinstance(of, str) else "".join(f"{key} = {literal(item)}\n" for key, item in tables(of).items())
        self._source: tuple[str, str | None] = (text, name)
        self._native = _native.Study.parse(name, text)

    @classmethod
    def load(cls, name: str | os.PathLike[str]) -> Study:
        """Loads a study from a file, or a built-in study by name.

        Parameters
        ----------
        name
            A path, or one of :func:`barrelstack.studies`.

        Returns
        -------
        Study

        Raises
        ------
        ScenarioError
            At the first invalid field.
        RecordError
            When a motion cannot be read.
        """
        path = os.fspath(name)
        made = cls.__new__(cls)
        if os.path.isfile(path) or any(sign in path for sign in "./\\"):
            made._native = _native.Study.load(path)
            made._source = (os.path.abspath(path), None)
        else:
            made._native = _native.Study.builtin(path)
            made._source = (path, None)
        return made

    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]:
        """Pickles the study for workers: as its text, or as its path, which the workers must be able to read."""
        text, name = self._source
        return (Study.load, (text,)) if name is None else (Study, (text, name))

    def _repr_html_(self) -> str:
        text, name = self._source
        facts = {"design": self.design, "cases": self.cases, "motions": self.motions, "fingerprint": self.fingerprint}
        facts |= {"file": text} if name is None else {}
        rows = "".join(f"<tr><th>{key}</th><td>{html.escape(str(value))}</td></tr>" for key, value in facts.items())
        stated = "" if name is None else f"<details><summary>text</summary><pre>{html.escape(text)}</pre></details>"
        return f"<p><strong>{html.escape(self.title)}</strong></p><table>{rows}</table>{stated}"

    @property
    def title(self) -> str:
        """Title, in one line."""
        return self._native.title

    @property
    def design(self) -> str:
        """Design of the cases: ``full-factorial``, ``stripes``, ``ida``, …"""
        return self._native.design

    @property
    def fingerprint(self) -> str:
        """Hash that identifies the study, including the contents of its records."""
        return self._native.fingerprint

    @property
    def cases(self) -> int:
        """Number of cases; for an adaptive design, the maximum number."""
        return self._native.cases

    @property
    def motions(self) -> int:
        """Number of motions."""
        return self._native.motions

    def records(self) -> dict[str, Record]:
        """Returns the motions of the study by name, before they are scaled to levels of intensity.

        Returns
        -------
        dict

        Raises
        ------
        RecordError
            When a motion cannot be read or generated.
        """
        return {name: Record(one) for name, one in self._native.records()}

    def plan(self, folder: str | os.PathLike[str] | None = None) -> list[Chunk]:
        """Returns the chunks of the study.

        Parameters
        ----------
        folder
            If given, only the chunks that are missing in this folder are returned.

        Returns
        -------
        list of Chunk

        Examples
        --------
        >>> sum(chunk.cases for chunk in Study.load("napa-four-levels").plan())
        240
        """
        chunks = [Chunk(*facts) for facts in self._native.chunks()]
        if folder is None or not (Path(folder) / "study.json").is_file():
            return chunks
        missing = set(_native.provenance(os.fspath(folder))[1])
        return [chunk for chunk in chunks if chunk.number in missing]

    def run(
        self,
        folder: str | os.PathLike[str],
        *,
        workers: int | None = None,
        progress: Progress = None,
    ) -> Table:
        """Runs the missing chunks of a folder, on this machine; other processes may do so at the same time.

        Parameters
        ----------
        folder
            Folder for the results: new, empty, or with results of this study, which is then continued.
        workers
            Number of threads; by default, one per core. The results do not depend on this number.
        progress
            As for :meth:`Scenario.run`.

        Returns
        -------
        Table
            One row per case, as returned by :meth:`collect`.

        Raises
        ------
        KeyboardInterrupt
            Within a second of Ctrl-C; finished chunks are kept, and the next run continues from there.
        StudyError
            When the folder belongs to another study or cannot be written.
        """
        with reporting(progress, f"study {self.title!r}") as report:
            self._native.run(os.fspath(folder), workers, report)
        return self.collect(folder)

    def run_chunk(self, folder: str | os.PathLike[str], chunk: int) -> bool:
        """Runs one chunk and writes its shard, unless the shard exists. A shard has the same bytes on every machine.

        Parameters
        ----------
        folder
            Folder for the results, shared by all workers.
        chunk
            Number of the chunk.

        Returns
        -------
        bool
            True if the chunk was run.
        """
        return self._native.run_chunk(os.fspath(folder), chunk)

    def run_on(
        self,
        client: Any,
        folder: str | os.PathLike[str],
        *,
        progress: Progress = None,
        retries: int = 10,
    ) -> Table:
        """Runs the missing chunks of a folder on Dask workers, with one task per chunk.

        Parameters
        ----------
        client
            A ``distributed.Client`` of any cluster, such as a ``LocalCluster`` or dask-jobqueue on Slurm.
        folder
            Folder for the results, on a disk that all workers can access.
        progress
            As for :meth:`Scenario.run`.
        retries
            Number of retries of a failed chunk. A killed worker does not count as a failure: its chunk is given to
            another worker.

        Returns
        -------
        Table
            The table of :meth:`collect`, byte for byte the same as from :meth:`run`.

        Raises
        ------
        KeyboardInterrupt
            Tasks that have not begun are canceled; finished chunks are kept.

        Notes
        -----
        Each task uses one thread, so give workers as many threads as they have cores.
        """
        from distributed import as_completed

        place = os.path.abspath(folder)
        missing = self.plan(place)
        with reporting(progress, f"study {self.title!r} on {client}") as report:
            done, of = 0, sum(chunk.cases for chunk in missing)
            futures = {
                client.submit(
                    _chunk_of,
                    self,
                    place,
                    chunk.number,
                    retries=retries,
                    key=f"{self.fingerprint}-{chunk.number}",
                ): chunk
                for chunk in missing
            }
            try:
                for future in as_completed(futures):
                    future.result()
                    done += futures[future].cases
                    if report:
                        report(done, of, "cases")
            finally:
                client.cancel(list(futures))
        return self.collect(place, write=True)

    def table(self) -> Table:
        """Runs all cases in memory, without a folder.

        Returns
        -------
        Table

        Examples
        --------
        >>> Study({
        ...     "base": {"extends": "sliding-block", "run": {"duration": "0.1 s"}},
        ...     "factor": [{"field": "interface.block-ground.friction.coefficient", "values": [0.2, 0.4]}],
        ...     "design": {"kind": "full-factorial"},
        ... }).table().numbers("interface.block-ground.friction.coefficient").tolist()
        [0.2, 0.4]
        """
        return Table(self._native.table())

    @staticmethod
    def collect(folder: str | os.PathLike[str], *, write: bool = False) -> Table:
        """Returns the finished rows of a study, one per case, in order.

        Parameters
        ----------
        folder
            A folder of a study, finished or not.
        write
            Whether to also write ``table.csv``, ``table.parquet``, ``columns.csv`` and ``provenance.json``.

        Returns
        -------
        Table
        """
        return Table(_native.read_table(os.fspath(folder), write))

    @staticmethod
    def provenance(folder: str | os.PathLike[str]) -> dict[str, Any]:
        """Returns the provenance of the rows in a folder.

        Parameters
        ----------
        folder
            A folder of a study, finished or not.

        Returns
        -------
        dict
            Version, hashes, seed, motions, columns, and progress.
        """
        made: dict[str, Any] = json.loads(_native.provenance(os.fspath(folder))[0])
        return made

    @staticmethod
    def fragility(
        folder: str | os.PathLike[str],
        *,
        hazard: str | os.PathLike[str] | None = None,
        years: float | None = None,
    ) -> Fragility:
        """Computes the fragility from the study in a folder, finished or not.

        Parameters
        ----------
        folder
            A folder of a study.
        hazard
            A CSV table of intensity and annual rate at the site, which adds annual rates and expected losses.
        years
            Exposure time in years; 50 by default.

        Returns
        -------
        Fragility

        Raises
        ------
        StudyError
            When no case has a verdict.
        """
        path = None if hazard is None else os.fspath(hazard)
        return Fragility(_native.decision(os.fspath(folder), path, years))

    @staticmethod
    def ida(folder: str | os.PathLike[str], demand: str = "top_drift_ratio") -> Hunts:
        """Returns the incremental dynamic analysis from the study in a folder.

        Parameters
        ----------
        folder
            A folder of a study whose design is ``ida`` or ``stripes``.
        demand
            Name of a column of the table.

        Returns
        -------
        Hunts
        """
        table = Study.collect(folder)
        names = np.array(table["record"], dtype=object)
        level, value = table.numbers("level"), table.numbers(demand)
        fell = np.array([outcome == "collapse" for outcome in table["outcome"]])
        motions = [str(name) for name in dict.fromkeys(names.tolist())]
        levels: list[NDArray[np.float64]] = []
        demands: list[NDArray[np.float64]] = []
        capacities: list[float] = []
        for motion in motions:
            rows = np.flatnonzero(names == motion)
            rows = rows[np.argsort(level[rows], kind="stable")]
            levels.append(level[rows])
            demands.append(np.where(fell[rows], np.nan, value[rows]))
            capacities.append(level[rows][fell[rows]].min(initial=np.inf))
        found = np.array(capacities)
        return Hunts(motions, levels, demands, np.where(np.isinf(found), np.nan, found))

    @staticmethod
    def export(
        folder: str | os.PathLike[str],
        out: str | os.PathLike[str],
        *,
        asset: str = "wine.barrel.stack",
    ) -> list[str]:
        """Writes fragility and loss for OpenQuake (NRML 0.5) and Pelicun.

        Parameters
        ----------
        folder
            A folder of a study.
        out
            Folder for the files.
        asset
            Name of a stack in the other program.

        Returns
        -------
        list of str
            Parts that could not be exported, with reasons.
        """
        files, notes = _native.export(os.fspath(folder), asset)
        os.makedirs(out, exist_ok=True)
        for name, text in files:
            store(Path(out) / name, text.encode())
        return notes

    def __repr__(self) -> str:
        return f"<Study {self.title!r}: {self.cases} cases under {self.motions} motions>"


def _chunk_of(study: Study, folder: str, chunk: int) -> bool:
    """Runs a chunk on a worker."""
    return study.run_chunk(folder, chunk)
