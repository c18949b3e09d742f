"""Analyses of many runs: comparisons, heights, protections, scores, the cases of the paper."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

from . import _native
from ._page import Page, table_of
from ._progress import Progress, reporting
from ._quantity import plain
from ._scenario import Scenario
from ._table import Table

__all__ = ["Comparison", "Difference", "Heights", "Protections", "Reproduction", "RockScore", "compare", "heights", "protect", "reproduce", "score"]

Path = str | os.PathLike[str]


class Difference(NamedTuple):
    """An input whose value is not the same in all runs.

    Examples
    --------
    >>> block = Scenario.load("sliding-block")
    >>> compare({"long": block, "short": block.set("run.duration", "0.5 s")}).differences[0].values
    ['1 s', '0.5 s']
    """

    #: Path of the input in the scenario, such as ``stack.levels``; see :meth:`Scenario.set`.
    path: str
    #: Value in each run; None if a run has no such field.
    values: list[str | None]
    #: Meaning of the field.
    help: str


class Comparison(Page):
    """Comparison of two or more runs, made by :func:`compare`.

    Examples
    --------
    >>> block = Scenario.load("sliding-block")
    >>> both = compare({"long": block, "short": block.set("run.duration", "0.5 s")})
    >>> list(both.runs), both.differences[0].path
    (['long', 'short'], 'run.duration')
    """

    @property
    def runs(self) -> dict[str, dict[str, Any]]:
        """The summary of each run by name, like :attr:`Run.summary`."""
        return {run["name"]: run["summary"] for run in self.document["runs"]}

    @property
    def differences(self) -> list[Difference]:
        """The inputs that differ, in the order of scenario files."""
        return [Difference(one["path"], one["values"], one["help"]) for one in self.document["differences"]]


def compare(
    runs: Mapping[str, Scenario] | Sequence[Scenario],
    *,
    variants: int | None = None,
    progress: Progress = None,
) -> Comparison:
    """Runs scenarios with their variants and compares them.

    Parameters
    ----------
    runs
        Two to six scenarios; the keys of a mapping are their names. By default, runs are named by their differences.
    variants
        As for :meth:`Scenario.run`.
    progress
        As for :meth:`Scenario.run`.

    Returns
    -------
    Comparison

    Raises
    ------
    Error
        When there are too few or too many scenarios, or two of them are equal.
    RunError
        When a stack cannot be built or does not stand.
    KeyboardInterrupt
        Within a second of Ctrl-C.

    Examples
    --------
    >>> stack = Scenario.load("candia-8-barrels")
    >>> both = compare({"as it is": stack, "one level less": stack.set("stack.levels", 3)}, variants=4)
    >>> both.report("both.html")
    """
    named = isinstance(runs, Mapping)
    pairs = list(runs.items()) if isinstance(runs, Mapping) else [(one.title, one) for one in runs]
    with reporting(progress, f"comparison of {len(pairs)} runs") as report:
        native = [(name, one._shaken) for name, one in pairs]
        return Comparison(_native.compare(native, named, variants, report))


class Heights(Page):
    """Safe heights, made by :func:`heights`.

    Examples
    --------
    >>> import tempfile
    >>> found = heights(tempfile.mkdtemp(), synthetic=0, highest=2)  # two motions: too few for a rating
    >>> sorted(set(found.table["direction"]))
    ['longitudinal', 'transverse']
    """

    @property
    def table(self) -> Table:
        """One row for every height, direction and level of shaking, with the numbers of cases and collapses. The other
        columns are fractions (1): a lower and an upper bound of the probability of collapse, each with 95 % confidence;
        the 95 % range of this probability over the uncertain constants of the seats; and the mean share of the barrels
        that fall."""
        rows = [
            {**one, "levels": height["levels"], "direction": height["direction"], "low": low, "high": high}
            | {"range_low": least, "range_high": most}
            for height in self.document["heights"]
            for one in height["at"]
            for low, high in [one["interval"]]
            for least, most in [one["range"] or (None, None)]
        ]
        names = {name: name for name in ("levels", "direction")} | {"pgv": "pgv (m/s)"}
        shares = ("cases", "collapsed", "low", "high", "range_low", "range_high", "fallen_share")
        return table_of(rows, names | {name: name for name in shares})


def heights(
    folder: Path,
    *,
    rack: str = "two-barrel",
    barrel: str = "bordeaux-225",
    records: Iterable[Path] = (),
    synthetic: int = 22,
    seed: int = 1,
    highest: int = 6,
    space: bool = False,
    progress: Progress = None,
) -> Heights:
    """Computes safe heights: runs stacks of two and more levels under the same motions, in planes or in three
    dimensions.

    Parameters
    ----------
    folder
        Folder of the underlying studies; finished cases of the same request are not run again.
    rack, barrel
        Names from the catalog.
    records
        Files of additional motions, such as records from your own site.
    synthetic
        Number of synthetic motions in addition to the bundled record.
    seed
        Seed of the random motions and of the random friction, stiffness and damping of the seats.
    highest
        Number of levels of the highest stack, from 2 to 6.
    space
        Whether the stacks are modeled in three dimensions and shaken in a horizontal direction that is drawn for every
        run, instead of in the planes across and along the barrels.
    progress
        As for :meth:`Scenario.run`.

    Returns
    -------
    Heights

    Raises
    ------
    StudyError
        When the catalog has no such rack or barrel, or the folder belongs to another study.
    RecordError
        When a record cannot be read.
    KeyboardInterrupt
        Within a second of Ctrl-C; finished runs are kept.

    Notes
    -----
    The numbers are those of ``barrelstack heights``, bit for bit.

    Examples
    --------
    >>> import tempfile
    >>> heights(tempfile.mkdtemp(), rack="rack-on-rack", synthetic=0, highest=2).headline
    'Too few motions to rate any stack on rack-on-rack racks ...'
    """
    with reporting(progress, "heights") as report:
        files = [os.fspath(path) for path in records]
        return Heights(_native.heights(os.fspath(folder), rack, barrel, files, synthetic, seed, highest, space, report))


class Protections(Page):
    """Ranking of protections of a stack by benefit and cost, made by :func:`protect`.

    Examples
    --------
    >>> import tempfile
    >>> stack = Scenario.load("candia-8-barrels").set("stack.levels", 2)
    >>> found = protect(stack, tempfile.mkdtemp(), pgv=["50 cm/s"], count=2, rounds=1, budget=20)
    >>> found.table["name"][0], found.changes("as it is")
    ('as it is', [])
    """

    @property
    def best(self) -> str | None:
        """Name of the protection that saves the most barrels for its cost; None if no benefit is significant."""
        best: str | None = self.document["best"]
        return best

    @property
    def table(self) -> Table:
        """One row for every protection, in the order of the page. The columns are the cost for one stack (US$, lower
        and upper); the probability of collapse (1, or 1/year at a site), the barrels fallen and the barrels saved, each
        with its 95 % interval; and the 95 % range of the probability over the uncertain constants of the seats. The
        last two columns are shares (1) of the draws of these constants: those in which fewer barrels fall than without
        a protection, and those in which fewer barrels fall than with the protection in the next row.
        """
        rows: list[dict[str, Any]] = []
        for one in self.document["protections"]:
            row: dict[str, Any] = {"name": one["name"], "kind": one["kind"], "on_front": one["on_front"]}
            row |= {"cost_low": one["cost"][0], "cost_high": one["cost"][1]}
            for key in ("collapse", "barrels_fallen", "barrels_saved"):
                found = one[key] or {"mean": None, "low": None, "high": None}
                row |= {key: found["mean"], f"{key}_low": found["low"], f"{key}_high": found["high"]}
            row["range_low"], row["range_high"] = one["range"] or (None, None)
            row |= {key: one[key] for key in ("better_than_as_it_is", "better_than_next")}
            rows.append(row)
        units = {"cost_low": "cost_low (US$)", "cost_high": "cost_high (US$)"}
        return table_of(rows, {name: units.get(name, name) for name in rows[0]})

    def changes(self, name: str) -> list[str]:
        """Returns the changes that a protection makes to the scenario.

        Parameters
        ----------
        name
            Name of the protection in the table.

        Returns
        -------
        list of str
            Overrides in the form ``path=value``, as on the command line.

        Raises
        ------
        NoItemError
            When no protection with that name was tried.
        """
        for one in self.document["protections"]:
            if one["name"] == name:
                found: list[str] = one["changes"]
                return found
        raise KeyError(f"no protection {name!r} was tried")


def protect(
    scenario: Scenario | str,
    folder: Path,
    *,
    site: Path | None = None,
    pgv: Iterable[Any] | None = None,
    records: Iterable[Path] = (),
    motions: Path | None = None,
    count: int = 12,
    rounds: int = 3,
    budget: float | None = None,
    seed: int = 1,
    progress: Progress = None,
) -> Protections:
    """Ranks protections of a stack by benefit and cost: fewer levels, other racks, devices, and pairs of these.

    Parameters
    ----------
    scenario
        The scenario of the stack, or its name.
    folder
        Folder of the underlying studies; finished cases of the same request are not run again.
    site
        Hazard curve of the site: a CSV file with ``pgv (cm/s)`` and ``rate (1/year)``.
    pgv
        Peak ground velocities to which motions are scaled, texts or quantities such as ``"50 cm/s"``; by default 25, 50
        and 75 cm/s. Cannot be combined with ``site``.
    records
        Files of motions, used in place of the bundled and synthetic ones.
    motions
        A folder of such files.
    count
        Number of motions per round, if no motions are given.
    rounds
        Number of rounds. The first round evaluates all protections; each further round evaluates the better half of the
        protections of the round before.
    budget
        Maximum cost of the protection of one stack (US$).
    seed
        Seed of the random motions and of the random friction, stiffness and damping of the seats.
    progress
        As for :meth:`Scenario.run`.

    Returns
    -------
    Protections

    Raises
    ------
    StudyError
        When the scenario is not a stack, the hazard curve is not for the peak ground velocity, or the folder belongs to
        another study.
    RunError
        When the stack does not stand.
    KeyboardInterrupt
        Within a second of Ctrl-C; finished runs are kept.

    Notes
    -----
    The numbers are those of ``barrelstack protect``, bit for bit.

    Examples
    --------
    >>> import tempfile
    >>> stack = Scenario.load("candia-8-barrels").set("stack.levels", 2)
    >>> protect(stack, tempfile.mkdtemp(), pgv=["50 cm/s"], count=2, rounds=1, budget=20).headline
    'A stack of 2 levels on candia-2008 racks ...'
    """
    if site is not None and pgv is not None:
        raise ValueError("a hazard curve already states the intensities: give either site or pgv")
    stack = scenario if isinstance(scenario, Scenario) else Scenario.load(scenario)
    levels = None if pgv is None else sorted({_native.measured("pgv", plain(one)) for one in pgv})
    with reporting(progress, f"protections of {stack.title!r}") as report:
        return Protections(
            _native.protect(
                stack._shaken,
                os.fspath(folder),
                None if site is None else os.fspath(site),
                levels,
                [os.fspath(path) for path in records],
                None if motions is None else os.fspath(motions),
                count,
                rounds,
                budget,
                seed,
                report,
            )
        )


class RockScore(Page):
    """The RockScore of a rack and its devices, made by :func:`score`.

    Examples
    --------
    >>> sheet = score("demo-napa", "rock")  # some twenty seconds on two cores
    >>> sheet.table["state"][0], len(sheet.table)
    ('as good as new', 4)
    """

    @property
    def score(self) -> int:
        """The score (cm/s): the peak ground velocity at which one stack in ten collapses, in the weakest state and
        direction, rounded down."""
        score: int = self.document["score"]
        return score

    @property
    def range(self) -> tuple[int, int] | None:
        """The 95 % range of the score (cm/s) over the uncertain friction, stiffness and damping of the seats, sampling error
        included; None if a run has no verdict."""
        found: list[int] | None = self.document["range"]
        return None if found is None else (found[0], found[1])

    @property
    def table(self) -> Table:
        """One row for every state in every direction: the velocity at which one stack in ten collapses (m/s), how it
        was found, its 95 % interval, its 95 % range over the uncertain constants, and the share (1) of stacks that
        collapsed at each level of shaking."""
        rows: list[dict[str, Any]] = []
        for one in self.document["states"]:
            low, high = one["interval"] or (None, None)
            row: dict[str, Any] = {key: one[key] for key in ("state", "direction", "velocity", "found", "runs")}
            row |= {"low": low, "high": high}
            row["range_low"], row["range_high"] = one["range"] or (None, None)
            levels = zip(self.document["velocities"], one["collapsed"], strict=True)
            rows.append(row | {f"collapsed_{100.0 * velocity:g}": share for velocity, share in levels})
        units = {key: f"{key} (m/s)" for key in ("velocity", "low", "high", "range_low", "range_high")}
        return table_of(rows, {name: units.get(name, name) for name in rows[0]})


def score(scenario: Scenario | str, folder: Path, *, progress: Progress = None) -> RockScore:
    """Computes the RockScore of a rack and its devices: one number for comparisons, by a protocol that never changes.

    Parameters
    ----------
    scenario
        A stack with the rack and devices to be scored, or its name; height and motion are those of the protocol.
    folder
        Folder of the underlying studies; finished cases of the same request are not run again.
    progress
        As for :meth:`Scenario.run`.

    Returns
    -------
    RockScore

    Raises
    ------
    StudyError
        When the scenario is not a stack, or the folder belongs to another study.
    RunError
        When the stack does not stand.
    KeyboardInterrupt
        Within a second of Ctrl-C; finished runs are kept.

    Notes
    -----
    The numbers are those of ``barrelstack score``, bit for bit.

    Examples
    --------
    >>> 20 < score("demo-napa", "rock").score < 35  # cm/s; some twenty seconds on two cores
    True
    """
    stack = scenario if isinstance(scenario, Scenario) else Scenario.load(scenario)
    with reporting(progress, f"RockScore of {stack.title!r}") as report:
        return RockScore(_native.score(stack._shaken, os.fspath(folder), report))


class Reproduction(Page):
    """Comparison with the numbers of the paper, made by :func:`reproduce`.

    Examples
    --------
    >>> found = reproduce(studies=False)
    >>> "published" in found.table and len(found.table) > 30
    True
    """

    @property
    def table(self) -> Table:
        """One row for every number and every finding that the paper states: its place in the paper, the quantity, the
        published and the computed value with units, their relative difference (1), and the verdict with its reason."""
        names = ("place", "quantity", "published", "ours", "difference", "band", "verdict", "why")
        return table_of(self.document, {name: name for name in names})


def reproduce(record: Path | None = None, *, studies: bool = True, progress: Progress = None) -> Reproduction:
    """Runs every case of the paper on which the model is based, and compares the published numbers with the computed
    ones.

    Parameters
    ----------
    record
        The file of the Hollywood Storage record of Northridge, north-south, which cannot be bundled;
        without it, the six barrels are shaken by the South Napa record, and results that depend on the motion are
        not compared.
    studies
        Whether to also run the studies around each case, which take most of the time.
    progress
        As for :meth:`Scenario.run`.

    Returns
    -------
    Reproduction

    Raises
    ------
    RecordError
        When the record cannot be used.
    KeyboardInterrupt
        Within a second of Ctrl-C.

    Notes
    -----
    Candia, de la Llera and Almazán (2008), 14th World Conference on Earthquake Engineering.

    Examples
    --------
    >>> reproduce(studies=False).headline
    '... published results could be compared: ... agree, 0 differ.'
    """
    with reporting(progress, "the cases of the paper") as report:
        return Reproduction(_native.reproduce(None if record is None else os.fspath(record), studies, report))
