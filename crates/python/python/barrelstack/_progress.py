"""Progress of work: a bar in terminals and notebooks, or a callback."""

from __future__ import annotations

import logging
import math
import sys
from collections.abc import Callable
from types import TracebackType
from typing import Any, TextIO

__all__ = ["Progress", "reporting"]

logger = logging.getLogger("barrelstack")

#: Progress callback: amount done, total (NaN if unknown), and unit.
Report = Callable[[float, float, str], object]

#: True for a bar, False or None for no display, or a progress callback.
Progress = bool | Report | None


class _Plain:
    """A one-line bar, used if tqdm is not installed."""

    def __init__(self, out: TextIO) -> None:
        self.out = out
        self.width = 0

    def at(self, done: float, of: float, what: str) -> None:
        share = done / of if of > 0 else 0.0
        line = f"{share:4.0%} {done:.4g} of {of:.4g} {what}" if math.isfinite(of) else f"{done:.4g} {what}"
        self.out.write("\r" + line.ljust(self.width))
        self.out.flush()
        self.width = len(line)

    def close(self) -> None:
        if self.width:
            self.out.write("\n")


class _Tqdm:
    """A bar of tqdm, for notebooks and terminals."""

    def __init__(self, make: Any) -> None:
        self.make = make
        self.bar: Any = None
        self.what = ""

    def at(self, done: float, of: float, what: str) -> None:
        if self.bar is None or what != self.what:
            self.close()
            self.bar = self.make(total=of if math.isfinite(of) else None, unit=f" {what}")
            self.what = what
        # A run may end early, so the bar is not completed.
        self.bar.n = round(done, 2)
        self.bar.refresh()

    def close(self) -> None:
        if self.bar is not None:
            self.bar.close()
            self.bar = None


def _bar() -> _Plain | _Tqdm:
    try:
        from tqdm.auto import tqdm
    except ImportError:
        return _Plain(sys.stderr)
    return _Tqdm(tqdm)


class reporting:
    """Context of named work: shows its progress, passes it to a callback or ignores it, and logs it to :mod:`logging`.

    Parameters
    ----------
    progress
        True for a bar, a progress callback, False or None for no display.
    name
        Name of the work in the log.
    """

    def __init__(self, progress: Progress, name: str) -> None:
        self.name = name
        self.bar = _bar() if progress is True else None
        self.call: Report | None = self.bar.at if self.bar else progress if callable(progress) else None

    def __enter__(self) -> Report | None:
        logger.debug("%s: begins", self.name)
        return self.call

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self.bar:
            self.bar.close()
        if error is None:
            logger.debug("%s: done", self.name)
        else:
            logger.info("%s: %s", self.name, kind.__name__ if kind else error)
