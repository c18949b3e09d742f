"""What results have in common: a report, and for runs pictures and an animation."""

from __future__ import annotations

import html
import os
import warnings
from collections.abc import Iterable
from typing import Generic, TypeVar

from . import _native
from ._errors import BarrelstackWarning
from ._store import store

__all__ = ["Animation", "Pictured", "Reported", "frame"]

#: Size (bytes) above which an animation is too large for a cell of a notebook.
LARGE = 1_000_000


Native = TypeVar("Native", _native.Page, _native.Run, _native.SpatialRun)
NativeRun = TypeVar("NativeRun", _native.Run, _native.SpatialRun)


def frame(page: str) -> str:
    """Wraps a page for display in a notebook.

    Parameters
    ----------
    page
        HTML.

    Returns
    -------
    str
        An element that contains it.
    """
    quoted = html.escape(page, quote=True)
    return f'<iframe srcdoc="{quoted}" style="width: 100%; height: 720px; border: 0"></iframe>'


class Animation:
    """An animation of a run, with controls and a view that can be turned. A notebook shows it if it is the last line of
    a cell.

    Made by :meth:`Run.animate` and :meth:`SpatialRun.animate`. It needs no network and is saved with the notebook.

    Examples
    --------
    >>> film = Scenario.load("sliding-block").run().animate()
    >>> film._repr_html_().startswith("<iframe srcdoc=")
    True
    """

    def __init__(self, page: str) -> None:
        self._page = page

    def html(self) -> str:
        """Returns the animation as one page that needs no network.

        Returns
        -------
        str
        """
        return self._page

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the animation as one page that every browser can show.

        Parameters
        ----------
        path
            A file that ends with ``.html``.
        """
        if not os.fspath(path).lower().endswith((".html", ".htm")):
            raise ValueError(
                f"path: expected a file that ends with .html, found {os.fspath(path)!r}; "
                'render(folder, "animation") writes GIF and animated PNG'
            )
        store(path, self._page.encode())

    def _repr_html_(self) -> str:
        return frame(self._page)

    def __repr__(self) -> str:
        return f"<Animation: {len(self._repr_html_()) / 1e6:.2f} MB>"


class Reported(Generic[Native]):
    """A result with a report."""

    _native: Native

    def html(self, *, language: str = "en") -> str:
        """Returns the report as one page that needs no network.

        Parameters
        ----------
        language
            ``"en"`` or ``"es"``, the language of the page; numbers and units stay as they are.

        Returns
        -------
        str

        Raises
        ------
        ValueError
            When there is no such language.
        """
        return self._native.html() if language == "en" else self._native.html(language)

    def report(self, path: str | os.PathLike[str], *, paper: str = "a4", language: str = "en") -> None:
        """Writes the report.

        Parameters
        ----------
        path
            A file that ends with ``.html`` or ``.pdf``.
        paper
            ``"a4"`` or ``"letter"``.
        language
            ``"en"`` or ``"es"``, the language of the report; numbers and units stay as they are.

        Raises
        ------
        ValueError
            When there is no such paper or language.
        """
        pdf = os.fspath(path).lower().endswith(".pdf")
        store(path, self._native.pdf(paper, language) if pdf else self.html(language=language).encode())


class Pictured(Reported[NativeRun]):
    """A run with a report, pictures and an animation."""

    def animate(self, *, rate: float = 20.0, between: tuple[float, float] | None = None) -> Animation:
        """Returns an animation of the shown run, to be shown in a notebook or saved as a page.

        Parameters
        ----------
        rate
            Frames per second of simulated time (1/s).
        between
            Time interval to show (s); by default the whole run.

        Returns
        -------
        Animation

        Raises
        ------
        ValueError
            When a number is out of range.

        Warns
        -----
        BarrelstackWarning
            When the animation would add more than 1 MB to a notebook.
        """
        window = None if between is None else [float(time) for time in between]
        film = Animation(self._native.animation(rate, window))
        size = len(film._repr_html_().encode())
        if size > LARGE:
            message = (
                f"the animation adds {size / 1e6:.1f} MB to a notebook; for less, show fewer frames per second "
                f"(rate={rate / 2:g}) or a part of the run (between=(start, end))"
            )
            warnings.warn(message, BarrelstackWarning, stacklevel=2)
        return film

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
        language: str = "en",
    ) -> dict[str, int]:
        """Writes figures, animations and a ParaView series of the shown run, like ``barrelstack render``.

        Parameters
        ----------
        folder
            The output folder.
        *parts
            Parts to write, among ``"figures"`` (SVG and ``formats``, with their numbers as CSV), ``"report"`` (PDF),
            ``"animation"`` (GIF and animated PNG), ``"frames"`` (numbered pictures) and ``"paraview"``; all of them by
            default.
        formats
            Formats of figures besides SVG: ``"png"``, ``"pdf"``; both by default.
        dpi
            Resolution (dots per inch) of figures in PNG, 20 to 1200.
        paper
            ``"a4"`` or ``"letter"``.
        rate
            Frames per second of simulated time (1/s); animations show at most 50.
        between
            Time interval to show (s); by default the whole run.
        size
            Longer side of animations (pixels), 64 to 4096.
        overwrite
            Whether to remove the files of an earlier rendering of these parts.
        language
            ``"en"`` or ``"es"``, the language of the figures and of the report; numbers and units stay as they are.

        Returns
        -------
        dict
            The folder or file of each part, and its number of files.

        Raises
        ------
        ValueError
            When there is no such part, format or language, or a number is out of range.
        Error
            When the folder contains an earlier rendering, or cannot be written.
        """
        window = None if between is None else [float(time) for time in between]
        written = self._native.render(
            os.fspath(folder), list(parts), list(formats), dpi, paper, rate, window, size, overwrite, language
        )
        return {os.fspath(place): files for place, files in written}
