"""Results with their numbers and their page."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Mapping
from functools import cached_property
from typing import Any

from . import _native
from ._pictured import Reported, frame
from ._table import Table

__all__ = ["Page", "table_of"]


def table_of(rows: Iterable[Mapping[str, Any]], names: Mapping[str, str]) -> Table:
    """Converts rows of a document to a table.

    Parameters
    ----------
    rows
        The rows.
    names
        Keys of the rows, and the headings of their columns: a name, with its SI unit in parentheses.

    Returns
    -------
    Table
    """
    rows = list(rows)
    return Table(_native.Table.from_columns([(head, [row[key] for row in rows]) for key, head in names.items()]))


class Page(Reported[_native.Page]):
    """A result with its numbers and its page.

    Examples
    --------
    >>> page = compare([Scenario.load("sliding-block"), Scenario.load("sliding-block").set("run.duration", "0.5 s")])
    >>> isinstance(page, Page), "<html" in page.html()
    (True, True)
    """

    def __init__(self, native: _native.Page) -> None:
        self._native = native

    @cached_property
    def document(self) -> Any:
        """All numbers, as the command that writes this page prints them with ``--json``; SI units."""
        return json.loads(self._native.numbers)

    @property
    def headline(self) -> str:
        """The result in one sentence."""
        return self._native.headline

    @property
    def warnings(self) -> list[str]:
        """Caveats for the reader, one sentence each."""
        return self._native.warnings

    def write(self, folder: str | os.PathLike[str], *, overwrite: bool = False, language: str = "en") -> None:
        """Writes the page as HTML and as Markdown with its figures and their numbers.

        Parameters
        ----------
        folder
            A folder that is new or empty.
        overwrite
            Whether to write into a folder that contains an earlier page.
        language
            ``"en"`` or ``"es"``, the language of the page; numbers and units stay as they are.

        Raises
        ------
        ValueError
            When there is no such language.
        """
        self._native.write(os.fspath(folder), overwrite, language)

    def _repr_html_(self) -> str:
        return frame(self.html())

    def __repr__(self) -> str:
        return f"<{type(self).__name__}: {self.headline}>"
