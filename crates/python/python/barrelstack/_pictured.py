"""What results have in common: a report, and for runs pictures."""

from __future__ import annotations

import os
from collections.abc import Iterable
from typing import Generic, TypeVar

from . import _native
from ._store import store

__all__ = ["Pictured", "Reported"]


Native = TypeVar("Native", _native.Page, _native.Run, _native.SpatialRun)
NativeRun = TypeVar("NativeRun", _native.Run, _native.SpatialRun)


class Reported(Generic[Native]):
    """A result with a report."""

    _native: Native

    def html(self) -> str:
        """Returns the report as one page that needs no network.

        Returns
        -------
        str
        """
        return self._native.html()

    def report(self, path: str | os.PathLike[str], *, paper: str = "a4") -> None:
        """Writes the report.

        Parameters
        ----------
        path
            A file that ends with ``.html`` or ``.pdf``.
        paper
            ``"a4"`` or ``"letter"``.
        """
        pdf = os.fspath(path).lower().endswith(".pdf")
        store(path, self._native.pdf(paper) if pdf else self.html().encode())


class Pictured(Reported[NativeRun]):
    """A run with a report and pictures."""

    def render(
        self,
        folder: str | os.PathLike[str],
        *parts: str,
        formats: Iterable[str] = (),
        dpi: float = 200.0,
        paper: str = "a4",
        rate: float = 20.0,
        between: tuple[float, float] | None = None,
        size: int = 480,
        overwrite: bool = False,
    ) -> dict[str, int]:
        """Writes figures, animations and series of the shown run, like ``barrelstack render``.

        Parameters
        ----------
        folder
            The output folder.
        *parts
            Among ``"figures"`` (SVG and the formats, each with its numbers), ``"report"`` (PDF), ``"animation"`` (GIF
            and animated PNG), ``"frames"`` (numbered pictures) and ``"paraview"``; all of them by default.
        formats
            Formats of figures besides SVG: ``"png"``, ``"pdf"``; both by default.
        dpi
            Resolution (dots per inch) of figures in PNG, 20 to 1200.
        paper
            ``"a4"`` or ``"letter"``.
        rate
            Pictures per second of the run (1/s); animations show at most 50.
        between
            Time interval of the film (s); all of the run by default.
        size
            Longer side of animations (pixels), 64 to 4096.
        overwrite
            Whether to remove the files of an earlier rendering of these parts.

        Returns
        -------
        dict
            The folder or file of each part, and its number of files.

        Raises
        ------
        ValueError
            When there is no such part or format, or a number is out of range.
        Error
            When the folder contains an earlier rendering, or cannot be written.
        """
        window = None if between is None else [float(time) for time in between]
        written = self._native.render(
            os.fspath(folder), list(parts), list(formats), dpi, paper, rate, window, size, overwrite
        )
        return {os.fspath(place): files for place, files in written}
