"""Tables of results, for all libraries that read Arrow."""

from __future__ import annotations

import html
import io
import os
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from . import _native
from ._store import store

if TYPE_CHECKING:
    import pandas
    import polars
    import xarray

__all__ = ["Column", "Table"]


class Column(NamedTuple):
    """Description of a column.

    Examples
    --------
    >>> intensities({"napa": Record.bundled()}, "pgv").columns[2]
    Column(name='pgv', unit='m/s', role='factor', kind='number', meaning='')
    """

    name: str
    #: SI unit; empty for dimensionless numbers and for strings.
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

    #: Name of the index column, such as ``time``; None if there is no such column.
    _index: str | None = None

    def _arrays(self) -> list[tuple[Column, NDArray[Any]]]:
        """Returns the columns as arrays: integers, numbers with NaN, or strings with None."""
        raise NotImplementedError

    def to_pandas(self) -> pandas.DataFrame:
        """Returns the columns as a DataFrame of pandas; histories are indexed by time.

        Returns
        -------
        pandas.DataFrame
            SI units; ``attrs["units"]`` has the unit of each column.

        Raises
        ------
        MissingPackageError
            When pandas is not installed.
        """
        import pandas

        columns = self._arrays()
        frame = pandas.DataFrame({column.name: values for column, values in columns})
        if self._index is not None:
            frame = frame.set_index(self._index)
        frame.attrs["units"] = {column.name: column.unit for column, _ in columns}
        return frame

    def to_polars(self) -> polars.DataFrame:
        """Returns the columns as a DataFrame of polars, which keeps no units.

        Returns
        -------
        polars.DataFrame
            SI units.

        Raises
        ------
        MissingPackageError
            When polars is not installed.
        """
        import polars

        columns: Any = self
        return polars.DataFrame(columns)

    def to_xarray(self) -> xarray.Dataset:
        """Returns the columns as a Dataset of xarray, with the attributes ``units`` and ``long_name``.

        Returns
        -------
        xarray.Dataset
            SI units. The dimension of a table is ``case``, that of histories ``time``.

        Raises
        ------
        MissingPackageError
            When xarray is not installed.
        """
        import xarray

        dimension = self._index or "case"
        variables = {}
        for column, values in self._arrays():
            attributes = {"long_name": column.meaning} if column.meaning else {}
            if column.kind == "text":
                values = np.array(["" if text is None else text for text in values], dtype=str)
            else:
                attributes["units"] = column.unit or "1"
            variables[column.name] = xarray.Variable((dimension,), values, attributes)
        coordinates = {name: one for name, one in variables.items() if name == dimension}
        data = {name: one for name, one in variables.items() if name != dimension}
        return xarray.Dataset(data, coordinates, {"source": "barrelstack"})

    def to_excel(self, path: str | os.PathLike[str]) -> None:
        """Writes the columns as a workbook (``.xlsx``) of two sheets, by openpyxl.

        The sheet ``values`` has the names of the columns with their SI units in its first row, and the values below. The
        sheet ``columns`` has a row for every column: its name, unit, kind and meaning. Numbers are cells with numbers,
        which every language of a spreadsheet program shows in its own notation; a missing number is an empty cell.

        Parameters
        ----------
        path
            A file that ends with ``.xlsx``.

        Raises
        ------
        ValueError
            When the file has another ending, or when a sheet cannot hold all rows.
        MissingPackageError
            When openpyxl is not installed.
        """
        import openpyxl
        from openpyxl.cell import WriteOnlyCell

        if not os.fspath(path).lower().endswith(".xlsx"):
            raise ValueError(f"path: expected a file that ends with .xlsx, found {os.fspath(path)!r}")
        columns = self._arrays()
        rows = len(columns[0][1]) if columns else 0
        if rows >= ROWS:
            raise ValueError(f"a sheet holds {ROWS - 1} rows, found {rows}; use to_parquet or fewer rows")
        book = openpyxl.Workbook(write_only=True)

        def sheet(name: str, lines: Iterable[Iterable[object]]) -> None:
            page = book.create_sheet(name)
            page.freeze_panes = "A2"
            for line in lines:
                cells = [WriteOnlyCell(page, value) for value in line]
                for cell in cells:
                    # A text that begins with = is a text and not a formula.
                    cell.data_type = "s" if cell.data_type == "f" else cell.data_type
                page.append(cells)

        heads = [f"{column.name} ({column.unit})" if column.unit else column.name for column, _ in columns]
        # NaN, which spreadsheets do not have, differs from itself.
        values = ([value if value == value else None for value in array.tolist()] for _, array in columns)
        sheet("values", [heads, *zip(*values, strict=True)])
        about = [[column.name, column.unit, column.kind, column.meaning] for column, _ in columns]
        sheet("columns", [["name", "unit", "kind", "meaning"], *about])
        content = io.BytesIO()
        book.save(content)
        store(path, content.getvalue())


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

    def _arrays(self) -> list[tuple[Column, NDArray[Any]]]:
        def array(column: Column) -> NDArray[Any]:
            if column.kind == "text":
                return np.array(self[column.name], dtype=object)
            numbers = self.numbers(column.name)
            whole = column.kind == "integer" and not np.isnan(numbers).any()
            return numbers.astype(np.int64) if whole else numbers

        return [(column, array(column)) for column in self.columns]

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

    def _repr_html_(self) -> str:
        columns = self.columns
        head = "".join(
            f'<th title="{html.escape(column.meaning)}">{html.escape(column.name)}'
            f"{f'<br>({html.escape(column.unit)})' if column.unit else ''}</th>"
            for column in columns
        )
        values = [self[column.name] for column in columns]
        shown = min(len(self), SHOWN)
        rows = "".join(f"<tr>{''.join(f'<td>{_cell(one[at])}</td>' for one in values)}</tr>" for at in range(shown))
        hidden = len(self) - shown
        rest = f"<p>and {hidden} more rows</p>" if hidden else ""
        return f"<table><thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table>{rest}"

    def __repr__(self) -> str:
        return f"<Table: {len(self)} rows of {', '.join(self)}>"


#: Number of rows of a sheet of a workbook, its heading included.
ROWS = 1_048_576

#: Number of rows that a notebook shows.
SHOWN = 20


def _cell(value: object) -> str:
    if value is None:
        return ""
    return f"{value:.6g}" if isinstance(value, float) else html.escape(str(value))


def _restored(columns: list[tuple[str, str, str, str, list[Any]]]) -> Table:
    """Restores a pickled table."""
    return Table(_native.Table.of_parts(columns))
