"""Tables of results, for all libraries that read Arrow."""

from __future__ import annotations

import os
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from . import _native
from ._store import store

__all__ = ["Column", "Table"]


class Column(NamedTuple):
    """Description of a column.

    Examples
    --------
    >>> intensities({"napa": Record.bundled()}, "pgv").columns[2]
    Column(name='pgv', unit='m/s', role='factor', kind='number', meaning='')
    """

    name: str
    #: SI unit; empty for dimensionless numbers and for texts.
    unit: str
    #: Role: ``key``, ``factor``, ``motion``, ``intensity``, ``outcome``, ``demand`` or ``run``.
    role: str
    #: Type: ``integer``, ``number`` or ``text``.
    kind: str
    meaning: str


class Columns:
    """Mapping of columns by name that pandas accepts.

    ``pandas.DataFrame`` reads an object as columns only if its class is ``dict``; it reads any other mapping as a list
    of names. A real ``dict`` would lose its units when exported to Arrow.
    """

    @property  # type: ignore[misc]
    def __class__(self) -> type:
        return dict


class Table(Columns):
    """Columns of one length: ``pandas.DataFrame``, ``polars.DataFrame``, ``pyarrow.table`` and DuckDB accept it directly.

    Examples
    --------
    >>> table = ensemble([{"stack.levels": 2, "motion.sine.amplitude": f"{size} cm"} for size in (2, 14)])
    >>> len(table), table["outcome"]
    (2, ['stable', 'collapse'])
    >>> table.numbers("top_drift_ratio").shape
    (2,)
    """

    def __init__(self, native: _native.Table) -> None:
        self._native = native

    @property
    def columns(self) -> list[Column]:
        """Descriptions of the columns, in order."""
        return [Column(*facts) for facts in self._native.specs()]

    def __len__(self) -> int:
        return len(self._native)

    def __iter__(self) -> Iterator[str]:
        return (column.name for column in self.columns)

    def __getitem__(self, name: str) -> list[Any]:
        """Returns the values of a column: int, float or str, and None for missing values."""
        return self._native.values(name)

    def keys(self) -> list[str]:
        """Returns the names of the columns, in order."""
        return list(self)

    def values(self) -> list[list[Any]]:
        """Returns the values of all columns, in order."""
        return [self[name] for name in self]

    def items(self) -> list[tuple[str, list[Any]]]:
        """Returns the names of the columns with their values, in order."""
        return [(name, self[name]) for name in self]

    def numbers(self, name: str) -> NDArray[np.float64]:
        """Returns the numbers of a column.

        Parameters
        ----------
        name
            A column of numbers or integers.

        Returns
        -------
        ndarray, shape (rows,)
            SI units; NaN for missing values.
        """
        return self._native.numbers(name)

    def __arrow_c_stream__(self, requested_schema: object = None) -> object:
        """Exports an Arrow stream; units are in the metadata of the fields."""
        return self._native.__arrow_c_stream__(requested_schema)

    def to_csv(self, path: str | os.PathLike[str] | None = None) -> str:
        """Returns the table as CSV, with units in the heading and numbers that read back to the same bits.

        Parameters
        ----------
        path
            File to which the text is also written.

        Returns
        -------
        str
        """
        text = self._native.to_csv()
        if path is not None:
            store(path, text.encode())
        return text

    def to_parquet(self, path: str | os.PathLike[str]) -> None:
        """Writes the table as Parquet; the same table gives the same bytes.

        Parameters
        ----------
        path
            The file.
        """
        store(path, self._native.to_parquet())

    def __copy__(self) -> Table:
        return self

    def __deepcopy__(self, memo: dict[int, Any]) -> Table:
        return self

    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]:
        return _restored, ([(*column[:4], self[column.name]) for column in self.columns],)

    def __repr__(self) -> str:
        return f"<Table: {len(self)} rows of {', '.join(self)}>"


def _restored(columns: list[tuple[str, str, str, str, list[Any]]]) -> Table:
    """Restores a pickled table."""
    return Table(_native.Table.of_parts(columns))
