"""Pickled runs, which keep their numbers and their page."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from ._errors import RunError

__all__ = ["Kept"]


class Kept:
    """Stand-in for a native run that was pickled, with the same attributes and functions.

    It has the page and all numbers of the run. Functions that need the run itself, such as pictures, raise an error.

    Parameters
    ----------
    native
        The run, or its stand-in.
    properties
        Names of attributes.
    answers
        Names of functions without arguments.
    rows
        Names of functions whose argument is an index, each with the number of indices.
    """

    def __init__(
        self, native: Any, properties: Iterable[str], answers: Iterable[str], rows: Iterable[tuple[str, int]]
    ) -> None:
        self._properties = {name: getattr(native, name) for name in properties}
        self._answers: dict[str, list[Any]] = {name: [getattr(native, name)()] for name in answers}
        self._rows = {name: [getattr(native, name)(at) for at in range(count)] for name, count in rows}

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        if name in self._properties:
            return self._properties[name]
        if name in self._rows:
            return self._rows[name].__getitem__

        def lost(*_: object) -> Any:
            raise RunError(
                "this run was pickled, which keeps only its numbers and its page; run its scenario again to write "
                "files and pictures"
            )

        # The page is kept in English.
        answers = self._answers.get(name)
        return lost if answers is None else lambda *others: lost() if others else answers[0]
