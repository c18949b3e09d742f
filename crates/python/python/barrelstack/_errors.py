"""Exceptions of the package, with the messages of the library.

::

    Error
    ├── ScenarioError   a scenario or study file, an override, a value
    ├── RecordError     a strong-motion file, or a request about one
    ├── RunError        a stack that does not stand, a step that is too long
    ├── StudyError      a folder, a shard, a study without a verdict
    ├── ArgumentError   an argument of the wrong type or out of range; also a ValueError, TypeError and OverflowError
    ├── FileError       a file or folder that cannot be opened or written; also an OSError
    ├── MissingPackageError     an optional package that a function needs is not installed; also an ImportError
    └── NoItemError     a name or number that a table, histories or a record does not have; also a KeyError and
        │               IndexError
        └── NoFieldError    a field that a scenario does not have; also an AttributeError

Exceptions of the caller's callbacks are passed on, and dicts, lists and arrays that the package returns raise their
usual exceptions.
"""

from __future__ import annotations

import functools
import inspect
import os
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

__all__ = [
    "ArgumentError",
    "BarrelstackWarning",
    "Error",
    "FileError",
    "MissingPackageError",
    "NoFieldError",
    "NoItemError",
    "RecordError",
    "RunError",
    "ScenarioError",
    "StudyError",
]

#: Special methods that users call by creating an object, by an index or by an attribute; they are guarded, too.
GUARDED = ("__init__", "__getitem__", "__getattr__")

#: The folder of the package.
HERE = str(Path(__file__).resolve().parent) + os.sep


class Error(Exception):
    """Any error of the library.

    Parameters
    ----------
    message
        The message of the library: the position, what was expected, what was found, and the remedy.
    path, line, column
        The position, if it is in a file; lines and columns count from 1.
    value
        The wrong value as ``field=value``, if it is not in a file.

    Examples
    --------
    >>> try:
    ...     Scenario.load("demo-napa").set("stack.levels", 99)
    ... except Error as error:
    ...     print(type(error).__name__, error.value)
    ScenarioError stack.levels=99
    """

    #: Row of a table of cases that caused the error, counted from 0.
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
        """Keeps the position when the exception is pickled between processes."""
        return type(self), (str(self), self.path, self.line, self.column, self.value)


class ScenarioError(Error, ValueError):
    """A scenario or a study is invalid at a known position.

    Examples
    --------
    >>> try:
    ...     Scenario("extends = 'demo-napa'\\nstack.levels = 99", name="mine.toml")
    ... except ScenarioError as error:
    ...     print(error.path, error.line)
    mine.toml 2
    """


class RecordError(Error, ValueError):
    """A strong-motion file cannot be read, or does not permit what was requested.

    Examples
    --------
    >>> try:
    ...     Record.read(b"not a record", name="mine.txt")
    ... except RecordError as error:
    ...     print(error.path)
    mine.txt
    """


class RunError(Error):
    """The run is impossible: the stack does not stand, or cannot be simulated.

    Examples
    --------
    >>> try:
    ...     Scenario.load("candia-8-barrels").set("run.step", "0.1 s").check()
    ... except RunError as error:
    ...     print(error)
    override `run.step="0.1 s"`: run.step = 100 ms is too long: ...
    """


class StudyError(Error):
    """A study cannot be run or collected, or its results do not permit a decision.

    Examples
    --------
    >>> import tempfile
    >>> try:
    ...     Study.fragility(tempfile.mkdtemp())
    ... except StudyError as error:
    ...     print("no study")
    no study
    """


class ArgumentError(Error, ValueError, TypeError, OverflowError):
    """An argument has the wrong type or is out of range.

    Examples
    --------
    >>> try:
    ...     Record.bundled().scale()
    ... except ArgumentError as error:
    ...     print(error)
    scale takes a factor, or one measure: scale(pgv="60 cm/s")
    """


class FileError(Error, OSError):
    """A file or a folder cannot be opened or written.

    Examples
    --------
    >>> try:
    ...     Record.read("missing.at2")
    ... except FileError as error:
    ...     print(error.path)
    missing.at2
    """


class MissingFileError(FileError, FileNotFoundError):
    """A file or a folder does not exist."""


class MissingPackageError(Error, ImportError):
    """An optional package that a function needs is not installed.

    Examples
    --------
    >>> issubclass(MissingPackageError, ImportError)
    True
    """


class NoItemError(Error, KeyError, IndexError):
    """There is no item with this name or number.

    Examples
    --------
    >>> try:
    ...     Scenario.load("sliding-block").run().histories["block_rotaton"]
    ... except NoItemError as error:
    ...     print(error)
    there is no history 'block_rotaton'; did you mean 'block_rotation'?
    """

    def __str__(self) -> str:
        """Returns the message without the quotation marks that a KeyError adds."""
        return Exception.__str__(self)


class NoFieldError(NoItemError, AttributeError):
    """A scenario has no such field.

    Examples
    --------
    >>> try:
    ...     Scenario.load("demo-napa").stack.height
    ... except NoFieldError as error:
    ...     print(error)
    [stack] has no field 'height'; it has ...
    """


class BarrelstackWarning(UserWarning):
    """A caveat for the reader of a result.

    Examples
    --------
    >>> import warnings
    >>> with warnings.catch_warnings(record=True) as caught:
    ...     warnings.simplefilter("always")
    ...     run = Scenario.load("candia-8-barrels").run(Record.bundled().scale(pgv="20 cm/s"), variants=0)
    >>> print(caught[0].message)
    the run ends at 12.0 s, before the motion ends at 35.0 s: ...
    """


def _of_package(error: BaseException) -> bool:
    """Returns True if an exception was raised by the package itself and not by a callback or another package."""
    trace = error.__traceback__
    while trace is not None and trace.tb_next is not None:
        trace = trace.tb_next
    return trace is not None and trace.tb_frame.f_code.co_filename.startswith(HERE)


def _converted(error: Exception) -> Error:
    """Converts an exception of Python to one of the package."""
    if isinstance(error, OSError):
        path = None if error.filename is None else os.fsdecode(error.filename)
        kind = MissingFileError if isinstance(error, FileNotFoundError) else FileError
        return kind(f"{path}: {error.strerror}" if path is not None else str(error), path=path)
    if isinstance(error, ImportError):
        name = (error.name or str(error)).split(".")[0]
        return MissingPackageError(f"this function needs the package {name}, which is not installed: pip install {name}")
    if isinstance(error, LookupError):
        return NoItemError(str(error.args[0]) if error.args else "there is no such item")
    if isinstance(error, AttributeError):
        return NoFieldError(str(error))
    return ArgumentError(str(error))


def _guard(function: Callable[..., Any]) -> Callable[..., Any]:
    """Wraps a function such that it raises exceptions of the package in place of those of Python."""

    @functools.wraps(function)
    def guarded(*args: Any, **kwargs: Any) -> Any:
        try:
            return function(*args, **kwargs)
        except Error:
            raise
        except (TypeError, ValueError, OverflowError, OSError, LookupError, AttributeError, ImportError) as error:
            if not _of_package(error):
                raise
            raise _converted(error) from error

    return guarded


def guard(module: dict[str, Any], names: list[str]) -> None:
    """Makes all public functions and methods of a package raise exceptions of one family.

    Parameters
    ----------
    module
        Namespace of the package; functions are replaced here and in their own modules, so that they can be pickled.
    names
        Public names of the package.
    """
    owners: list[type] = []
    for name in names:
        thing = module[name]
        if inspect.isfunction(thing):
            module[name] = _guard(thing)
            setattr(sys.modules[thing.__module__], name, module[name])
        elif inspect.isclass(thing):
            # Public methods may be inherited from a private class.
            owners += [one for one in thing.__mro__ if one.__module__.startswith("barrelstack.") and one not in owners]
    for owner in owners:
        for member, value in list(vars(owner).items()):
            if member.startswith("_") and member not in GUARDED or isinstance(value, type):
                continue
            if isinstance(value, (classmethod, staticmethod)):
                setattr(owner, member, type(value)(_guard(value.__func__)))
            elif isinstance(value, property) and value.fget is not None:
                setattr(owner, member, property(_guard(value.fget), value.fset, value.fdel, value.__doc__))
            elif inspect.isfunction(value) and not issubclass(owner, Exception):
                setattr(owner, member, _guard(value))


def outside() -> int:
    """Returns the ``stacklevel`` at which a warning refers to the code that called the package."""
    level, frame = 1, sys._getframe(1)
    while frame.f_back is not None and frame.f_code.co_filename.startswith(HERE):
        level, frame = level + 1, frame.f_back
    return level
