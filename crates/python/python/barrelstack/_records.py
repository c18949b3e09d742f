"""Many records at once: reading folders, measures, and selection of sets for a target."""

from __future__ import annotations

import os
import warnings
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _native
from ._errors import BarrelstackWarning, RecordError, outside
from ._quantity import plain
from ._record import USUAL, Record
from ._table import Table

__all__ = ["Selection", "intensities", "read_folder", "select"]

#: Periods (s) at which a code spectrum is matched: the default of the command.
PERIODS = tuple(period for period in _native.PERIODS if period <= 5.0)


def read_folder(
    folder: str | os.PathLike[str],
    *,
    unit: str | None = None,
    time_step: float | None = None,
    sensitivity: float | None = None,
) -> dict[str, Record]:
    """Reads all records of a folder and its subfolders.

    Parameters
    ----------
    folder
        The folder; hidden files are skipped.
    unit, time_step, sensitivity
        As for :meth:`Record.read`.

    Returns
    -------
    dict
        Records by name, sorted; files whose names mark them as components of one record are combined.

    Raises
    ------
    OSError
        When a folder is missing or cannot be read.

    Warns
    -----
    BarrelstackWarning
        For each file that is not a record, with the reason.

    Examples
    --------
    >>> import tempfile
    >>> folder = tempfile.mkdtemp()
    >>> Record.bundled().write(f"{folder}/napa.txt")
    >>> list(read_folder(folder))
    ['napa.txt']
    """

    def unreadable(reason: OSError) -> None:
        raise reason

    root = os.fspath(folder)
    files: list[str] = []
    for place, folders, names in os.walk(root, onerror=unreadable):
        folders[:] = sorted(name for name in folders if not name.startswith("."))
        below = os.path.relpath(place, root).replace(os.sep, "/")
        start = "" if below == "." else f"{below}/"
        files += [start + name for name in sorted(names) if not name.startswith(".")]
    found: dict[str, Record] = {}
    for name, parts in _native.group_files(files):
        read: list[Record] = []
        for part in parts:
            path = os.path.join(root, *part.split("/"))
            try:
                read.append(Record.read(path, unit=unit, time_step=time_step, sensitivity=sensitivity))
            except (RecordError, OSError) as refused:
                warnings.warn(f"left out: {refused}", BarrelstackWarning, stacklevel=outside())
        try:
            if read:
                whole = read[0]._native if len(read) == 1 else _native.Record.gather([one._native for one in read])
                found[name] = Record(whole)
        except RecordError as refused:
            warnings.warn(f"left out: {name}: {refused}", BarrelstackWarning, stacklevel=outside())
    return dict(sorted(found.items()))


def intensities(records: Mapping[str, Record], *measures: str) -> Table:
    """Computes intensity measures of many records.

    Parameters
    ----------
    records
        Records by name, such as those of :func:`read_folder`.
    *measures
        As for :meth:`Record.intensity`.

    Returns
    -------
    Table
        One row for every component of every record: ``record``, ``component``, and a column for every measure (SI
        units), None if the component is too short for it.

    Raises
    ------
    RecordError
        When there is no such measure.

    Examples
    --------
    >>> table = intensities({"napa": Record.bundled()}, "pga", "pgv")
    >>> table["component"]
    ['E', 'N', 'Up']
    """
    columns: dict[str, list[object]] = {"record": [], "component": []}
    for name, record in records.items():
        measured = record.intensity(*(measures or USUAL))
        components = list(measured[0].values)
        columns["record"] += [name] * len(components)
        columns["component"] += components
        for one in measured:
            head = f"{one.measure} ({one.unit})" if one.unit else one.measure
            values = (one.values[component] for component in components)
            columns.setdefault(head, []).extend(value if np.isfinite(value) else None for value in values)
    return Table(_native.Table.from_columns(list(columns.items())))


class Selection(NamedTuple):
    """Records whose spectra together have the mean and the standard deviation of a target, made by :func:`select`.

    Examples
    --------
    >>> source = {"kind": "boore", "magnitude": 6.5, "distance": "10 km"}
    >>> records = {f"motion {n}": Record.made(synthetic={**source, "seed": n}) for n in range(8)}
    >>> selection = select(records, "ec8:ag=0.3,site=B", count=3, spectrum="h1")
    >>> len(selection.records), selection.found.shape == selection.target.shape
    (3, True)
    """

    #: The selected records by name, each multiplied by its factor.
    records: dict[str, Record]
    #: Factor of each record.
    factors: dict[str, float]
    #: Periods (s).
    periods: NDArray[np.float64]
    #: Target: medians (m/s², damping 5 %) in the first row, standard deviations of ln Sa (1) in the second;
    #: shape (2, periods).
    target: NDArray[np.float64]
    #: Median and standard deviation of the set, in the same form.
    found: NDArray[np.float64]
    #: Number of records that reach the target within the factors.
    eligible: int


def select(
    records: Mapping[str, Record],
    target: str | tuple[ArrayLike, ArrayLike, ArrayLike],
    *,
    at: float | None = None,
    level: object = None,
    epsilon: float | None = None,
    count: int = 30,
    spectrum: str = "rotd50",
    scale: tuple[float, float] = (0.25, 4.0),
    events: Mapping[str, str] | None = None,
    most_of_event: int | None = None,
    seed: int = 1,
) -> Selection:
    """Selects records whose spectra together match the mean and the standard deviation of a target.

    Parameters
    ----------
    records
        The candidates, such as those of :func:`read_folder`.
    target
        A code spectrum as for :meth:`Record.match`, which all records should match from 0.05 to 5 s; or the periods
        (s, ascending), medians of the pseudo-acceleration (m/s², damping 5 %) and standard deviations of ln Sa (1) of a
        ground-motion model, all of which are matched.
    at
        Period (s) of the model at which Sa is given; selects the conditional spectrum (Baker 2011).
    level
        Sa at that period, in m/s² or as a text or quantity such as ``"0.6 g"``.
    epsilon
        Sa at that period, as a number of standard deviations of ln Sa above the median; in place of ``level``.
    count
        Number of records to select.
    spectrum
        Spectrum of a record to match: ``"rotd50"``, or a component such as ``"h1"``.
    scale
        Range of permitted scale factors.
    events
        The earthquake of each record, in place of that in its header.
    most_of_event
        Maximum number of records of one earthquake.
    seed
        Seed of the random spectra that are drawn from the target.

    Returns
    -------
    Selection

    Raises
    ------
    RecordError
        When too few records reach the target, or the target is inconsistent.
    ValueError
        When a condition is invalid: a period without level or epsilon, a period not in the target, or a period for a
        code.

    Warns
    -----
    BarrelstackWarning
        For each record that is left out because it does not have the spectrum: RotD50, for example, needs two
        horizontal components.

    Notes
    -----
    The selection equals that of ``barrelstack motion select`` for the same spectra and periods: Jayaram, Lin and Baker
    (2011), Earthquake Spectra 27:797-815.

    Examples
    --------
    >>> source = {"kind": "boore", "magnitude": 6.5, "distance": "10 km"}
    >>> records = {f"motion {n}": Record.made(synthetic={**source, "seed": n}) for n in range(8)}
    >>> selection = select(records, "ec8:ag=0.3,site=B", count=3, spectrum="h1", scale=(0.5, 4.0))
    >>> all(0.5 <= factor <= 4.0 for factor in selection.factors.values())
    True
    """
    wanted: str | tuple[list[float], list[float]]
    given: tuple[float, float] | None = None
    if isinstance(target, str):
        if at is not None:
            raise ValueError(
                "a code spectrum states no standard deviation, so it cannot be made conditional: omit the argument at"
            )
        periods, wanted = np.array(PERIODS), target
    else:
        periods, median, deviation = (np.ascontiguousarray(one, dtype=np.float64) for one in target)
        wanted = (median.tolist(), deviation.tolist())
        if (at is None) == (level is not None or epsilon is not None) or (level is not None and epsilon is not None):
            raise ValueError("expected the period at together with either level or epsilon")
        if at is not None:
            given = (float(at), _given(periods, median, deviation, at, level, epsilon))
    candidates: list[tuple[str, list[float], str]] = []
    for name, record in records.items():
        try:
            _, acceleration = record.spectrum(periods, of=spectrum)
        except RecordError as refused:
            warnings.warn(f"left out: {name} has no {spectrum} spectrum: {refused}", BarrelstackWarning, stacklevel=outside())
            continue
        if not (acceleration > 0.0).all():
            warnings.warn(f"left out: {name} has a spectrum that is zero", BarrelstackWarning, stacklevel=outside())
            continue
        event = (events or {}).get(name, record.event) or name
        candidates.append((name, acceleration.tolist(), event))
    chosen, found, eligible = _native.select(
        periods.tolist(), wanted, given, candidates, count, scale, most_of_event, seed
    )
    factors = {candidates[place][0]: factor for place, factor in chosen}
    mean, spread, ours, width = (np.array(one) for one in found)
    return Selection(
        {name: records[name].scale(factor) for name, factor in factors.items()},
        factors,
        periods,
        np.stack([np.exp(mean), spread]),
        np.stack([np.exp(ours), width]),
        eligible,
    )


def _given(
    periods: NDArray[np.float64],
    median: NDArray[np.float64],
    deviation: NDArray[np.float64],
    at: float,
    level: object,
    epsilon: float | None,
) -> float:
    """Returns the given Sa (m/s²) at a period."""
    if epsilon is None:
        said = plain(level)
        try:
            return _native.measured("pga", said) if isinstance(said, str) else float(said)
        except ValueError as refused:
            raise ValueError(f"level {str(refused).removeprefix('pga')}") from None
    places = np.flatnonzero(periods == at)
    if len(places) != 1:
        raise ValueError(f"{at} s is not a period of the target: {', '.join(f'{one:g}' for one in periods)} s")
    place = places[0]
    return float(median[place] * np.exp(deviation[place] * epsilon))
