"""Results of a scenario."""

from __future__ import annotations

import difflib
import json
import os
import warnings
from collections.abc import Iterator, Mapping
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from . import _native
from ._errors import BarrelstackWarning, outside
from ._kept import Kept
from ._pictured import Pictured, frame
from ._table import Column, Columns, Table

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["Demands", "Envelope", "Force", "Frames", "Glance", "Histories", "Outcome", "Run"]

Glance = _native.Glance


def warn(sentences: list[str]) -> None:
    """Issues the caveats of a result as Python warnings."""
    for sentence in sentences:
        warnings.warn(sentence, BarrelstackWarning, stacklevel=outside())


class Outcome(NamedTuple):
    """Outcome of a run.

    Examples
    --------
    >>> outcome = Scenario.load("candia-8-barrels").run(variants=0).outcome
    >>> outcome.kind, outcome.mode, outcome.first
    ('collapse', 'ejection', 'R4')
    """

    #: ``stable``, ``collapse``, ``not-judged``, ``interrupted`` or ``invalid``.
    kind: str
    #: ``ejection``, ``rocking``, ``rack-sliding`` or ``overturning``; in a table of
    #: cases also ``gravity``, if the stack falls under its own weight, before it is shaken.
    mode: str | None
    #: Time at which the first body left its seat (s).
    time: float | None
    #: Name of the first body that left its seat.
    first: str | None
    #: Time at which the first barrel had fallen (s).
    first_fall: float | None
    barrels_fallen: int | None
    barrels: int
    #: Reason why the run is invalid.
    reason: str | None


class Demands(Mapping[str, "float | None"]):
    """Demands on the stack during a part of the run, by name, in SI units; None if not applicable.

    Examples
    --------
    >>> demands = Scenario.load("candia-8-barrels").run(variants=0).demands
    >>> demands.units["base_slip_peak"]
    'm'
    >>> 0.01 < demands["top_drift_ratio"] < 0.1
    True
    """

    def __init__(self, values: dict[str, float | None]) -> None:
        self._values = values

    def __getitem__(self, name: str) -> float | None:
        return self._values[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)

    @property
    def units(self) -> dict[str, str]:
        """SI unit of each demand; ``1`` for a ratio."""
        return {path.removeprefix("demands."): unit for path, unit, _ in _demands()}

    @property
    def meanings(self) -> dict[str, str]:
        """Meaning of each demand, in a sentence."""
        return {path.removeprefix("demands."): meaning for path, _, meaning in _demands()}

    def __repr__(self) -> str:
        units = self.units
        return "\n".join(
            f"{name} = {'—' if value is None else f'{value:.4g} {units.get(name, str())}'}"
            for name, value in self._values.items()
        )


def _demands() -> list[tuple[str, str, str]]:
    return [row for row in _native.fields() if row[0].startswith("demands.")]


class Histories(Columns, Mapping[str, "NDArray[np.float64]"]):
    """Histories of the ground, of every body and of the energies, by name: views without copies.

    Examples
    --------
    >>> histories = Scenario.load("sliding-block").run().histories
    >>> histories.units["block_displacement_x"]  # relative to the ground and the position at rest
    'm'
    >>> histories["block_displacement_x"].shape == histories.time.shape
    True
    """

    def __init__(self, native: _native.Run) -> None:
        self._native = native
        channels = native.channels()
        self._units = {"time": "s", **dict(channels)}
        self._places = {name: at for at, (name, _) in enumerate(channels)}

    @property
    def time(self) -> NDArray[np.float64]:
        """Times of the samples (s), shape (samples,); the same as ``histories["time"]``."""
        return self._native.times()

    @property
    def units(self) -> dict[str, str]:
        """SI unit of each history."""
        return dict(self._units)

    def __getitem__(self, name: str) -> NDArray[np.float64]:
        if name == "time":
            return self.time
        if name not in self._places:
            near = difflib.get_close_matches(name, self._units, 1)
            hint = f"did you mean {near[0]!r}?" if near else f"there are {', '.join(self._units)}"
            raise KeyError(f"there is no history {name!r}; {hint}")
        return self._native.channel(self._places[name])

    _index = "time"

    def _arrays(self) -> list[tuple[Column, NDArray[Any]]]:
        def column(name: str, unit: str) -> Column:
            return Column(name, unit, "", "number", name.replace("_", " "))

        return [(column(name, unit), np.array(self[name])) for name, unit in self._units.items()]

    def __iter__(self) -> Iterator[str]:
        return iter(self._units)

    def __len__(self) -> int:
        return len(self._units)

    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]:
        return Histories, (_kept(self._native),)

    def __arrow_c_stream__(self, requested_schema: object = None) -> object:
        """Exports an Arrow stream, with ``time`` as the first column."""
        columns = [(name, unit, self[name]) for name, unit in self._units.items()]
        return _native.Table.of_numbers(columns).__arrow_c_stream__(requested_schema)


class Force(NamedTuple):
    """The contact force between two bodies of a stack, as it acts on the upper body.

    If neither body rests on the other, the force acts on the body that is named first. Largest forces are those with
    the largest magnitude in any step, with their sign.

    Examples
    --------
    >>> run = Scenario.load("candia-8-barrels").run(variants=0)
    >>> round(run.forces["R1 on ground"].at_rest)  # N: the weight of the stack
    23144
    """

    #: Vertical force at rest (N).
    at_rest: float
    #: Largest vertical force (N) until the first loss of a seat, and its time (s).
    peak_vertical: tuple[float, float]
    #: Largest horizontal force (N) until the first loss of a seat, and its time (s).
    peak_horizontal: tuple[float, float]
    #: Largest vertical force (N) over the whole run, falls included, and its time (s).
    peak_vertical_whole_run: tuple[float, float]
    #: Largest horizontal force (N) over the whole run, falls included, and its time (s).
    peak_horizontal_whole_run: tuple[float, float]
    #: Vertical force (N) at the times of the histories: a view without a copy.
    vertical: NDArray[np.float64]
    #: Horizontal force (N) at the times of the histories: a view without a copy.
    horizontal: NDArray[np.float64]


class Envelope(NamedTuple):
    """Normal stress along the boundary of a body, force per length of boundary.

    Examples
    --------
    >>> envelope = Scenario.load("candia-8-barrels").run(variants=0).envelopes["B1.1"]
    >>> envelope.closed, envelope.points.shape
    (True, (720, 2))
    """

    #: Positions (m) in the frame of the body, shape (points, 2): x and z.
    points: NDArray[np.float64]
    #: Coordinate along the boundary: angle (rad) from x on a circle, x (m) elsewhere.
    coordinate: NDArray[np.float64]
    #: Tributary length of boundary (m) of each value. Multiplied by the stress at rest, it gives the contact force
    #: there.
    length: NDArray[np.float64]
    #: Stress at rest (N/m): a view without a copy.
    at_rest: NDArray[np.float64]
    #: Largest stress until the first loss of a seat (N/m): a view without a copy.
    peak: NDArray[np.float64]
    #: Largest stress over the whole run (N/m): a view without a copy.
    peak_whole_run: NDArray[np.float64]
    #: True if the last point is adjacent to the first.
    closed: bool


class Frames(NamedTuple):
    """Poses of all bodies, one set per frame.

    Examples
    --------
    >>> frames = Scenario.load("sliding-block").run().frames
    >>> frames.bodies, frames.poses.shape == (len(frames.time), 2, 3)
    (['ground', 'block'], True)
    """

    #: Times (s), shape (frames,).
    time: NDArray[np.float64]
    #: Names of the bodies, the ground first.
    bodies: list[str]
    #: x (m), z (m) and angle (rad) in the inertial frame, shape (frames, bodies, 3).
    poses: NDArray[np.float64]
    #: Largest normal stress (N/m) at the contacts of each body, shape (frames, bodies).
    stresses: NDArray[np.float64]


class Run(Pictured[_native.Run]):
    """Results of a scenario in one plane, with all recordings of the shown run.

    Made by :meth:`Scenario.run`.

    Examples
    --------
    >>> run = Scenario.load("sliding-block").run()
    >>> round(float(run.histories["block_displacement_x"][-1]), 2)  # m
    0.17
    """

    def __init__(self, native: _native.Run) -> None:
        self._native = native

    @cached_property
    def summary(self) -> dict[str, Any]:
        """All numbers of the run, as printed by ``barrelstack run --json``; SI units."""
        summary: dict[str, Any] = json.loads(self._native.summary())
        return summary

    @property
    def headline(self) -> str:
        """The result in one sentence."""
        return self._native.headline

    @property
    def outcome(self) -> Outcome:
        """Outcome of the shown run."""
        outcome = self.summary["outcome"]
        return Outcome(**{name: outcome.get(name) for name in Outcome._fields})

    @property
    def ensemble(self) -> dict[str, Any] | None:
        """Statistics of all variants: ``share`` that collapses, its 95 % ``interval``, its ``range`` over the uncertain
        constants of the seats, the effects of these constants (``decides``), and the collapse modes; None if no
        variants were run."""
        return self.summary["ensemble"]  # type: ignore[no-any-return]

    @property
    def variants(self) -> Table | None:
        """The nominal stack (number 0) and its variants, one row each; None if no variants were run."""
        table = self._native.variants()
        return None if table is None else Table(table)

    @property
    def demands(self) -> Demands:
        """Demands on the stack until the first loss of a seat."""
        return Demands(self.summary["demands"])

    @property
    def demands_whole_run(self) -> Demands:
        """Demands on the stack over the whole run, falls included."""
        return Demands(self.summary["demands_whole_run"])

    @cached_property
    def histories(self) -> Histories:
        """Ground, displacements, rotations and energies over time."""
        return Histories(self._native)

    @cached_property
    def forces(self) -> dict[str, Force]:
        """Forces between bodies that rest on each other, by names such as ``"R1 on ground"``.

        Includes bodies that met before the first loss of a seat, such as ``"R1.1 against R1.2"``.
        """
        facts = self._native.joints()
        return {
            name: Force(at_rest, *until_loss, *whole_run, *self._native.joint(at))
            for at, (name, at_rest, until_loss, whole_run) in enumerate(facts)
        }

    @cached_property
    def envelopes(self) -> dict[str, Envelope]:
        """Stress along the boundary of every barrel and rack, by name of the body."""
        found: dict[str, Envelope] = {}
        for at, (name, closed) in enumerate(self._native.envelopes()):
            points = self._native.envelope_points(at)
            stresses = self._native.envelope_stresses(at)
            found[name] = Envelope(points[:, :2], points[:, 2], points[:, 3], *stresses, closed)
        return found

    @cached_property
    def frames(self) -> Frames:
        """Poses of all bodies over time."""
        bodies = [name for name, _ in self._native.bodies()]
        native = self._native
        return Frames(native.frame_times(), bodies, native.poses(), native.frame_stresses())

    def contact_forces(self, frame: int) -> NDArray[np.float64]:
        """Returns the contact forces of a frame, one arrow per pair of bodies.

        Parameters
        ----------
        frame
            Number of the frame, counted from 0.

        Returns
        -------
        ndarray, shape (arrows, 4)
            Position x, z (m), and force x, z (N) on the contactor: the body of the pair whose nodes touch the other.
        """
        return self._native.frame_forces(frame)

    @property
    def warnings(self) -> list[str]:
        """Caveats for the reader, one sentence each."""
        return self._native.warnings

    @property
    def interrupted(self) -> bool:
        """True if an observer stopped the run."""
        return self._native.interrupted

    @property
    def scenario(self) -> str:
        """The scenario of the shown run, including all defaults (TOML)."""
        return self._native.toml

    @property
    def other(self) -> Run | None:
        """Results of the other plane; None if the scenario has one plane."""
        other = self._native.other()
        return None if other is None else Run(other)

    def write(self, folder: str | os.PathLike[str], *, overwrite: bool = False, language: str = "en") -> None:
        """Writes the files of ``barrelstack run --out``: report, summary, histories, forces, envelopes, frames.

        Parameters
        ----------
        folder
            A folder that is new or empty.
        overwrite
            Whether to write into a folder that is not empty.
        language
            ``"en"`` or ``"es"``, the language of the report; numbers and units stay as they are.

        Raises
        ------
        ValueError
            When there is no such language.
        """
        self._native.write(os.fspath(folder), overwrite, language)

    def plot(self, *names: str, ax: Axes | None = None) -> Axes:
        """Plots histories over time.

        Parameters
        ----------
        *names
            Names of histories with the same unit; by default displacements along x of the top barrels, or of all free
            bodies.
        ax
            Axes to draw into; new ones by default.

        Returns
        -------
        matplotlib.axes.Axes
        """
        import matplotlib.pyplot as plt

        shown = names or self._usual()
        if ax is None:
            _, ax = plt.subplots(figsize=(8, 3.5), layout="constrained")
        for name in shown:
            ax.plot(self.histories.time, self.histories[name], label=name, linewidth=1)
        units = {self.histories.units[name] for name in shown}
        ax.set_xlabel("time (s)")
        ax.set_ylabel(f"{'displacement' if not names else 'value'} ({' / '.join(sorted(units))})")
        if self.outcome.time is not None:
            ax.axvline(self.outcome.time, color="0.5", linestyle=":", label=f"{self.outcome.first} leaves its seat")
        ax.legend(loc="upper left", fontsize="small")
        return ax

    def _usual(self) -> list[str]:
        bodies = self.summary["bodies"]
        barrels = [body for body in bodies if body["kind"] == "barrel"]
        top = max((body["level"] for body in barrels), default=None)
        chosen = [body["name"] for body in (barrels or bodies) if body["level"] == top]
        return [f"{name}_displacement_x" for name in chosen]

    def __copy__(self) -> Run:
        return self

    def __deepcopy__(self, memo: dict[int, Any]) -> Run:
        return self

    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]:
        return Run, (_kept(self._native),)

    def _repr_html_(self) -> str:
        return frame(self.html())

    def __repr__(self) -> str:
        return f"<Run: {self.headline}>"


class _KeptRun(Kept):
    """Pickled run in one plane, with the other plane if there is one."""

    def __init__(self, native: _native.Run, alone: bool = False) -> None:
        rows = {
            "channel": len(native.channels()),
            "joint": len(native.joints()),
            "frame_forces": len(native.frame_times()),
            "envelope_points": len(native.envelopes()),
            "envelope_stresses": len(native.envelopes()),
        }
        answers = (
            *("summary", "times", "channels", "joints", "bodies", "frame_times", "poses", "frame_stresses"),
            *("envelopes", "html"),
        )
        super().__init__(native, ("headline", "warnings", "interrupted", "toml"), answers, rows.items())
        variants, other = native.variants(), native.other()
        self._variants = None if variants is None else Table(variants)
        self._other = None if other is None or alone else _KeptRun(other, alone=True)
        if self._other is not None:
            self._other._other = self

    def variants(self) -> _native.Table | None:
        return None if self._variants is None else self._variants._native

    def other(self) -> _KeptRun | None:
        return self._other


def _kept(native: Any) -> Any:
    """Returns the pickled state of a run."""
    return native if isinstance(native, _KeptRun) else _KeptRun(native)
