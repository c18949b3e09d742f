"""Results of a three-dimensional scenario."""

from __future__ import annotations

import json
import os
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from . import _native
from ._kept import Kept
from ._pictured import Pictured, frame
from ._table import Table

__all__ = ["OutcomeInSpace", "Poses", "SpatialRun"]


class OutcomeInSpace(NamedTuple):
    """Outcome of a three-dimensional run.

    Examples
    --------
    >>> Scenario.load("rolling-ball").run_in_space().outcome.kind
    'not-judged'
    """

    #: ``stable``, ``collapse``, ``not-judged`` or ``invalid``.
    kind: str
    #: ``ejection``, ``rocking``, ``rack-sliding`` or ``overturning``; in a table of
    #: cases also ``gravity``, if the stack falls under its own weight, before it is shaken.
    mode: str | None
    #: Time at which the first body left its seat (s).
    time: float | None
    #: Name of the first body that left its seat.
    first: str | None
    #: Direction in which that body left: ``right`` or ``left`` across the barrels, ``away`` or
    #: ``near`` along them.
    heading: str | None
    #: Time at which the first barrel had fallen (s).
    first_fall: float | None
    barrels_fallen: int | None
    barrels: int
    #: Reason why the run is invalid.
    reason: str | None


class Poses(NamedTuple):
    """Poses of all bodies in three dimensions, one set per frame.

    Examples
    --------
    >>> frames = Scenario.load("rolling-ball").run_in_space().frames
    >>> frames.bodies, frames.poses.shape == (len(frames.time), 2, 7)
    (['ground', 'ball'], True)
    """

    #: Times (s), shape (frames,): a view without a copy.
    time: NDArray[np.float64]
    #: Names of the bodies, the ground first.
    bodies: list[str]
    #: x, y, z (m) and quaternion w, x, y, z in the inertial frame, shape (frames, bodies, 7).
    poses: NDArray[np.float64]
    #: Velocity x, y, z (m/s) and angular velocity about x, y, z (rad/s), shape (frames, bodies, 6).
    twists: NDArray[np.float64]


class SpatialRun(Pictured[_native.SpatialRun]):
    """Results of a three-dimensional scenario: ``x`` across the barrels, ``y`` along them, ``z`` up.

    Made by :meth:`Scenario.run_in_space`.

    Examples
    --------
    >>> run = Scenario.load("rolling-ball").run_in_space()
    >>> bool(run.frames.poses[-1, 1, 0] > run.frames.poses[0, 1, 0])  # the ball has moved to the right
    True
    """

    def __init__(self, native: _native.SpatialRun, stated: str) -> None:
        self._native = native
        self._stated = stated

    @cached_property
    def summary(self) -> dict[str, Any]:
        """All numbers of the run, as printed by ``barrelstack run --json`` (``space/1``); SI units."""
        summary: dict[str, Any] = json.loads(self._native.summary())
        return summary

    @property
    def headline(self) -> str:
        """The result in one sentence."""
        return self._native.headline

    @property
    def outcome(self) -> OutcomeInSpace:
        """Outcome of the shown run."""
        outcome = self.summary["outcome"]
        return OutcomeInSpace(**{name: outcome[name] for name in OutcomeInSpace._fields})

    @property
    def ensemble(self) -> dict[str, Any] | None:
        """Statistics of all variants: ``share`` that collapses, its 95 % ``interval``, its ``range`` over the uncertain
        constants of the seats, the effects of these constants (``decides``), and the collapse modes; None if no
        variants were run."""
        return self.summary["ensemble"]  # type: ignore[no-any-return]

    @property
    def directions(self) -> dict[str, int] | None:
        """Directions in which the first body of each variant left its seat, and in which barrels fell; None if no
        variants were run."""
        return self.summary["directions"]  # type: ignore[no-any-return]

    @property
    def variants(self) -> Table | None:
        """The nominal stack (number 0) and its variants, one row each; None if no variants were run."""
        table = self._native.variants()
        return None if table is None else Table(table)

    @cached_property
    def frames(self) -> Poses:
        """Poses and velocities of all bodies over time."""
        bodies = [name for name, _ in self._native.bodies()]
        return Poses(self._native.frame_times(), bodies, self._native.poses(), self._native.twists())

    @property
    def warnings(self) -> list[str]:
        """Caveats for the reader, one sentence each."""
        return self._native.warnings

    @property
    def scenario(self) -> str:
        """The scenario of the shown run, including all defaults (TOML)."""
        return self._native.toml

    def write(self, folder: str | os.PathLike[str], *, overwrite: bool = False, language: str = "en") -> None:
        """Writes the files of ``barrelstack run --out``: report, summary, frames, variants.

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
        self._native.write(os.fspath(folder), self._stated, overwrite, language)

    def __copy__(self) -> SpatialRun:
        return self

    def __deepcopy__(self, memo: dict[int, Any]) -> SpatialRun:
        return self

    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]:
        native: Any = self._native
        return SpatialRun, (native if isinstance(native, _KeptRun) else _KeptRun(native), self._stated)

    def _repr_html_(self) -> str:
        return frame(self.html())

    def __repr__(self) -> str:
        return f"<SpatialRun: {self.headline}>"


class _KeptRun(Kept):
    """Pickled three-dimensional run."""

    def __init__(self, native: _native.SpatialRun) -> None:
        answers = ("summary", "bodies", "frame_times", "poses", "twists", "html")
        super().__init__(native, ("headline", "warnings", "toml"), answers, ())
        variants = native.variants()
        self._variants = None if variants is None else Table(variants)

    def variants(self) -> _native.Table | None:
        return None if self._variants is None else self._variants._native
