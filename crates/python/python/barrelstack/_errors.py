"""Exceptions of the package, with the messages of the library.

::

    Error
    ├── ScenarioError   a scenario or study file, an override, a value
    ├── RecordError     a strong-motion file, or a request about one
    ├── RunError        a stack that does not stand, a step that is too long
    └── StudyError      a folder, a shard, a study without a verdict
"""

from __future__ import annotations

__all__ = ["BarrelstackWarning", "Error", "RecordError", "RunError", "ScenarioError", "StudyError"]


class Error(Exception):
    """Any error of the library.

    Parameters
    ----------
    message
        The library's message: place, expectation, finding, remedy.
    path, line, column
        The place, where it is in a file; lines and columns count from 1.
    value
        The given value, as ``field=value``, if it is not in a file.
    """

    #: The row of a table of cases that caused it, from 0.
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
        """Keeps its place when it is pickled between processes."""
        return type(self), (str(self), self.path, self.line, self.column, self.value)


class ScenarioError(Error, ValueError):
    """A scenario or a study is invalid, at a place."""


class RecordError(Error, ValueError):
    """A strong-motion file cannot be read, or a request about one cannot be satisfied."""


class RunError(Error):
    """The run is impossible: the stack does not stand, or cannot be simulated."""


class StudyError(Error):
    """A study cannot be run, collected or decided."""


class BarrelstackWarning(UserWarning):
    """A caveat for the reader of a result."""
