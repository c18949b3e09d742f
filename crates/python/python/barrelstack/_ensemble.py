"""Ensembles: many cases at once, in the lanes of the vector unit."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from . import _native
from ._progress import Progress, reporting
from ._quantity import plain
from ._record import Record
from ._scenario import Scenario
from ._table import Table

__all__ = ["ensemble"]


def ensemble(
    cases: Iterable[Mapping[str, Any]] | Any,
    base: Scenario | str = "candia-8-barrels",
    *,
    records: Mapping[str, Record] | None = None,
    progress: Progress = None,
) -> Table:
    """Runs many cases, each bit-identical to a single run, and returns their results.

    Parameters
    ----------
    cases
        Changes of the base in each case: a list of dicts, or any table that supports Arrow (polars, pandas, pyarrow,
        DuckDB). Columns are paths of fields, such as ``"stack.levels"``; a column of numbers may state their unit,
        ``"motion.scale.pgv (cm/s)"``; texts are values as on the command line, ``"60 cm/s"``. Empty cells set nothing.
        A column ``"record"`` sets the motion of the case: a name among ``records``, or, in a list of dicts, a record.
    base
        The scenario that the cases change, or its name.
    records
        The records to which the table refers, by name.
    progress
        True for a progress bar, or a function that is called with (done, of, what).

    Returns
    -------
    Table
        One row per case, in order: its changes, then its outcome, demands and data of the computation.

    Raises
    ------
    ScenarioError
        At the first invalid case, before anything is run; ``row`` is its number.
    RecordError
        When a record cannot be used, or the motion of the first case cannot be read. A later case whose motion cannot
        be read becomes a row with the reason in ``error``.
    KeyboardInterrupt
        Within a second of Ctrl-C.

    Notes
    -----
    All cores are used, the interpreter lock is released, and memory contains the motions of one batch per core.
    A case runs in one plane.

    Examples
    --------
    >>> table = ensemble([{"stack.levels": 2, "motion.sine.amplitude": f"{size} cm"} for size in (2, 6, 14)])
    >>> table["outcome"]
    ['stable', 'stable', 'collapse']
    """
    known = dict(records or {})
    if hasattr(cases, "__arrow_c_stream__"):
        table = _native.Table.from_arrow(cases)
    else:
        rows = [dict(case) for case in cases]
        columns = dict.fromkeys(name for row in rows for name in row)
        if rows and not columns:
            raise ValueError("no case changes the base: run the base itself")
        for number, row in enumerate(rows):
            if isinstance(row.get("record"), Record):
                # A record that is used in several rows is passed once.
                record = row["record"]
                name = next((name for name, other in known.items() if other is record), f"record of row {number}")
                known[name] = record
                row["record"] = name
        table = _native.Table.from_columns(
            [(name, [plain(row.get(name)) if name in row else None for row in rows]) for name in columns]
        )
    scenario = base if isinstance(base, Scenario) else Scenario.load(base)
    native = {name: record._native for name, record in known.items()}
    with reporting(progress, f"ensemble of {len(table)} cases") as report:
        return Table(_native.ensemble(scenario._shaken, table, native, report))
