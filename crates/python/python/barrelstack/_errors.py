"""Exceptions of the package, with the library's own words.

::

    Error
    ├── ScenarioError   a scenario or study file, an override, a value
    ├── RecordError     a strong-motion file, or what was asked of one
    ├── RunError        a stack that does not stand, a step that is too long
    └── StudyError      a folder, a shard, a study without a verdict
"""

from __future__ import annotations

__all__ = ["BarrelstackWarning", "Error", "RecordError", "RunError", "ScenarioError", "StudyError"]


class Error(Exception):
    """Anything that the library refuses.

    Parameters
    ----------
    message
        The library's words: where, what was expected, what was found, the next move.
    path, line, column
        The place, where it is in a file; lines and columns count from 1.
    value
        The value that was given, as ``field=value``, where it stands in no file.
    """

    #: The row of a table of cases that it is about, from 0.
    row: int | None = None

    def __init__(
        self,
        message: str,
        path: str | None = None,
        line: int | None = None,
        column: int | None = None,
        value: str | None = None,
    ) -> None:
        super().__init__(message)
        self.path = path
        self.line = line
        self.column = column
        self.value = value

    def __reduce__(self) -> tuple[type[Error], tuple[object, ...]]:
        """So that it crosses from a worker to its caller with its place."""
        return type(self), (str(self), self.path, self.line, self.column, self.value)


class ScenarioError(Error, ValueError):
    """A scenario or a study says something that cannot be, at a place."""


class RecordError(Error, ValueError):
    """A strong-motion file cannot be read, or what was asked of one cannot be met."""


class RunError(Error):
    """There is no run: the stack does not stand, or cannot be followed."""


class StudyError(Error):
    """A study cannot be run, collected or decided."""


class BarrelstackWarning(UserWarning):
    """What the reader of a result should know."""
