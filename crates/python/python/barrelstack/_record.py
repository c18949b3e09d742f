"""Records of strong ground motion."""

from __future__ import annotations

import io
import os
import re
import zipfile
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _native
from ._errors import RecordError
from ._quantity import literal
from ._store import contents, store

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["Channel", "Intensity", "Record"]

#: Names of the default measures.
USUAL = ("pga", "pgv", "pgd", "pgv/pga", "arias", "cav", "d5-75", "d5-95", "bracketed", "tm")


class Channel(NamedTuple):
    """One component of a record.

    Examples
    --------
    >>> channel = Record.bundled()["E"]
    >>> channel.time_step, channel.vertical, len(channel.acceleration)
    (0.005, False, 6997)
    """

    name: str
    #: Degrees clockwise from north; None if unknown, and for a vertical component.
    azimuth: float | None
    vertical: bool
    #: Time between samples (s).
    time_step: float
    #: Instant of the first sample (UTC, ISO 8601); None if the file does not state it.
    start: str | None
    #: Acceleration (m/s²), shape (samples,): a read-only view; vertical components are positive
    #: upward.
    acceleration: NDArray[np.float64]


class Intensity(NamedTuple):
    """A measure of every component, in SI units.

    Examples
    --------
    >>> record = Record.made(pulse={"kind": "ricker", "amplitude": "0.4 g", "period": "0.8 s"})
    >>> record.intensity("pga")[0]
    Intensity(measure='pga', unit='m/s2', values={'H1': 3.92266})
    """

    measure: str
    unit: str
    #: Values by name of the component.
    values: dict[str, float]


class Record:
    """Accelerations of one instrument in one event; immutable.

    Made by :meth:`read`, :meth:`bundled`, :meth:`made`, :meth:`from_arrays` or :meth:`from_obspy`.

    Examples
    --------
    >>> record = Record.bundled("napa-college-2014").scale(pgv=0.6)
    >>> round(record.intensity("pgv")[0].values["E"], 6)
    0.6
    """

    def __init__(self, native: _native.Record) -> None:
        self._native = native

    @classmethod
    def read(
        cls,
        source: str | os.PathLike[str] | bytes | Sequence[str | os.PathLike[str]],
        *,
        unit: str | None = None,
        time_step: float | None = None,
        sensitivity: float | None = None,
        name: str = "record",
    ) -> Record:
        """Reads a record in any of the formats of :func:`barrelstack.formats`.

        Parameters
        ----------
        source
            A path, the bytes of a file, or several paths whose components form one record. Archives of
            ``numpy.savez(file, acceleration=…, dt=0.01)`` are accepted too; the name of an array may end with the
            name of its component (``acceleration_UP``).
        unit
            Unit of acceleration for files that state none: ``"g"``, ``"m/s2"``, ``"cm/s2"``, ``"gal"``.
        time_step
            Time between samples (s) for files that state none.
        sensitivity
            Counts per m/s², for files in counts.
        name
            Name by which error messages refer to the bytes.

        Returns
        -------
        Record

        Raises
        ------
        RecordError
            When the file cannot be read; with path, line and column.

        Notes
        -----
        Units and steps are never guessed.

        Examples
        --------
        >>> Record.made(pulse={"kind": "ricker", "amplitude": "0.4 g", "period": "0.8 s"}).write("pulse.csv")
        >>> Record.read("pulse.csv").channels[0].time_step
        0.002
        """
        given = (unit, time_step, sensitivity)
        if isinstance(source, (bytes, bytearray)):
            saved = _saved(bytes(source), name, unit, time_step)
            return saved if saved is not None else cls(_native.Record.read(bytes(source), name, *given))
        if isinstance(source, (str, os.PathLike)):
            path = os.fspath(source)
            return cls.read(contents(path), unit=unit, time_step=time_step, sensitivity=sensitivity, name=path)
        parts = [cls.read(one, unit=unit, time_step=time_step, sensitivity=sensitivity) for one in source]
        return cls(_native.Record.gather([part._native for part in parts]))

    @classmethod
    def bundled(cls, name: str = "napa-college-2014") -> Record:
        """Returns a bundled record.

        Parameters
        ----------
        name
            ``"napa-college-2014"``: South Napa 2014 at Napa College (CSMIP 68150).

        Returns
        -------
        Record
        """
        found = _native.Record.bundled(name)
        if found is None:
            raise ValueError(f'there is no bundled record {name!r}; there is "napa-college-2014"')
        return cls(found)

    @classmethod
    def made(cls, **motion: Any) -> Record:
        """Makes a motion from a formula, or from random numbers with a seed.

        Parameters
        ----------
        **motion
            One of ``sine``, ``pulse`` and ``synthetic``, as in a ``[[motion]]`` of a study, and ``scale`` to scale it:
            ``pulse={"kind": "ricker", "amplitude": "0.4 g", "period": "0.8 s"}``,
            ``synthetic={"kind": "boore", "magnitude": 6, "distance": "8 km", "seed": 4}``. Quantities of Pint and
            astropy are accepted as well.

        Returns
        -------
        Record
            The motion, sampled at its own time step or, for a formula, at 1/400 of its period; the notes state its
            origin.

        Raises
        ------
        ScenarioError
            At the first invalid field.
        TypeError
            When none of these kinds is given, or more than one.
        ValueError
            When the arguments describe several motions.

        Notes
        -----
        A synthetic motion is the first realization of its seed, as in a study.

        Examples
        --------
        >>> Record.made(sine={"amplitude": "10 cm", "period": "0.8 s", "cycles": 5}).intensity("pgd")[0].unit
        'm'
        """
        kinds = [name for name in ("sine", "pulse", "synthetic") if name in motion]
        if len(kinds) != 1:
            raise TypeError(f"expected one of sine, pulse and synthetic, found {', '.join(motion) or 'none'}")
        fields = dict(motion)
        if "synthetic" in fields:
            fields["synthetic"] = {"count": 1, **fields["synthetic"]}
        base, design = {"extends": "sliding-block"}, {"kind": "full-factorial"}
        tables = {"schema": 1, "base": base, "motion": [fields], "design": design}
        text = "".join(f"{key} = {literal(value)}\n" for key, value in tables.items())
        records = _native.Study.parse("motion", text).records()
        if len(records) != 1:
            raise ValueError(f"expected a single motion, found {len(records)}: use Study.records for several motions")
        return cls(records[0][1])

    @classmethod
    def from_arrays(
        cls,
        acceleration: ArrayLike | Mapping[str, ArrayLike],
        dt: float,
        *,
        unit: str,
        vertical: ArrayLike | None = None,
        second: ArrayLike | None = None,
        name: str = "arrays",
        raw: bool = False,
        start: str | None = None,
        station: str = "",
    ) -> Record:
        """Makes a record from accelerations in memory.

        Parameters
        ----------
        acceleration
            The horizontal component, shape (samples,); or all components by name, with names that state directions as
            in files: ``"360"``, ``"N28W"``, ``"H1"``, ``"UP"``.
        dt
            Time between samples (s).
        unit
            Unit of the numbers; never guessed.
        vertical
            The vertical component, positive upward.
        second
            The other horizontal component.
        name
            Name of the record in results.
        raw
            Whether the record is unprocessed, so that it is processed before use.
        start
            Instant of the first sample (UTC, ISO 8601).
        station
            Name of the station.

        Returns
        -------
        Record

        Raises
        ------
        RecordError
            When a number is not finite, the step is not above zero, or there are fewer than two samples.

        Examples
        --------
        >>> Record.from_arrays({"H1": [0.0, 0.1, 0.0], "UP": [0.0, 0.05, 0.0]}, 0.01, unit="g", name="mine")
        <Record 'mine': H1, UP; 3 samples of 0.01 s, unknown>
        """
        if isinstance(acceleration, Mapping):
            parts = list(acceleration.items())
        else:
            parts = [("H1", acceleration)]
            parts += [("H2", second)] if second is not None else []
            parts += [("UP", vertical)] if vertical is not None else []
        channels = [(str(key), np.ascontiguousarray(values, dtype=np.float64)) for key, values in parts]
        return cls(_native.Record.of_samples(name, channels, float(dt), unit, raw, start, station))

    @classmethod
    def from_obspy(cls, stream: Any, *, unit: str, name: str = "", raw: bool = False) -> Record:
        """Makes a record from a trace or a stream of ObsPy.

        Parameters
        ----------
        stream
            A ``Trace``, or a ``Stream`` whose traces are the components of one instrument, all with one step.
        unit
            Unit of the numbers. Traces are often counts: remove the response or the sensitivity first.
        name
            Name of the record in results; by default the id of the first trace.
        raw
            Whether the record is unprocessed, so that it is processed before use.

        Returns
        -------
        Record

        Raises
        ------
        RecordError
            As :meth:`from_arrays`.
        ValueError
            When traces differ in step, start or length, or when samples are missing.
        """
        traces = list(stream) if hasattr(stream, "traces") else [stream]
        if not traces:
            raise ValueError("the stream has no trace")
        first = traces[0].stats
        for trace in traces:
            stats = trace.stats
            if (stats.delta, stats.npts) != (first.delta, first.npts):
                raise ValueError(
                    f"{trace.id} has {stats.npts} samples of {stats.delta} s, {traces[0].id} has {first.npts} of"
                    f" {first.delta} s; resample and trim the stream first"
                )
            if abs(stats.starttime - first.starttime) > 0.5 * first.delta:
                raise ValueError(f"{trace.id} and {traces[0].id} do not begin together; trim the stream first")
            if np.ma.is_masked(trace.data):
                raise ValueError(f"{trace.id} has gaps; fill or cut them first")
        components = {trace.stats.channel or trace.id: trace.data for trace in traces}
        station = f"{first.network}.{first.station}".strip(".")
        # ObsPy sets 1970 as the start of a trace without one.
        start = first.starttime.datetime.isoformat() + "Z" if first.starttime.timestamp != 0 else None
        return cls.from_arrays(
            components,
            first.delta,
            unit=unit,
            name=name or traces[0].id,
            raw=raw,
            start=start,
            station=station,
        )

    def to_obspy(self) -> Any:
        """Returns the record as a stream of ObsPy, accelerations in m/s².

        Returns
        -------
        obspy.Stream
            One trace per component. Names of components are cut to the three letters of a trace code, and a long
            station name is reduced to the number in it.
        """
        from obspy import Stream, Trace, UTCDateTime

        network, _, station = self.station.rpartition(".")
        if len(station) > 5:
            # A station code has at most five letters: use the number in the name.
            codes = [word for word in re.findall(r"\w+", station) if len(word) <= 5 and any(map(str.isdigit, word))]
            network, station = "", codes[0] if codes else ""
        traces = []
        for channel in self.channels:
            header = {
                "network": network,
                "station": station,
                "channel": channel.name[:3],
                "delta": channel.time_step,
            }
            if channel.start is not None:
                header["starttime"] = UTCDateTime(channel.start)
            traces.append(Trace(channel.acceleration.copy(), header))
        return Stream(traces)

    @property
    def name(self) -> str:
        """Name of the file, or the given name."""
        return self._native.name

    @property
    def format(self) -> str:
        """Name of the file format; ``samples`` if made from arrays."""
        return self._native.format

    @property
    def event(self) -> str:
        """The earthquake, as stated in the file."""
        return self._native.event

    @property
    def station(self) -> str:
        """The station, as stated in the file."""
        return self._native.station

    @property
    def stage(self) -> str:
        """Stage of processing: ``raw``, ``corrected`` or ``unknown``."""
        return self._native.stage

    @property
    def notes(self) -> list[str]:
        """Processing steps, one sentence each."""
        return self._native.notes

    @property
    def warnings(self) -> list[str]:
        """Warnings of the file reader."""
        return self._native.warnings

    @property
    def channels(self) -> list[Channel]:
        """The components, in the order of the file; accelerations are views without copies."""
        facts = self._native.channels()
        return [
            Channel(*fact, self._native.acceleration(at)) for at, fact in enumerate(facts)
        ]

    def __getitem__(self, component: str) -> Channel:
        """Returns a component by name, ``"h1"``, ``"h2"``, ``"vertical"`` or ``"#3"``."""
        return self.channels[self._native.find(component)]

    def velocity(self, component: str = "h1") -> NDArray[np.float64]:
        """Returns the velocity (m/s) at the samples: the integral of accelerations that are linear between samples.

        Parameters
        ----------
        component
            A name, ``"h1"``, ``"h2"``, ``"vertical"`` or ``"#3"``.

        Returns
        -------
        ndarray, shape (samples,)

        Raises
        ------
        RecordError
            When the record has no such component.

        Examples
        --------
        >>> record = Record.bundled()
        >>> float(abs(record.velocity("E")).max()) == record.intensity("pgv")[0].values["E"]
        True
        """
        return self._native.integrated(self._native.find(component))[0]

    def displacement(self, component: str = "h1") -> NDArray[np.float64]:
        """Returns the displacement (m) at the samples, as applied to the ground of a model.

        Parameters
        ----------
        component
            As for :meth:`velocity`.

        Returns
        -------
        ndarray, shape (samples,)
        """
        return self._native.integrated(self._native.find(component))[1]

    def component(self, name: str) -> Record:
        """Returns the record with one component only, rotated if necessary.

        Parameters
        ----------
        name
            As for :meth:`velocity`, or ``"az:122"`` for an azimuth (degrees clockwise from north).

        Returns
        -------
        Record

        Raises
        ------
        RecordError
            When the record has no such component, or when an azimuth is requested but the azimuths of two horizontals
            are unknown.

        Examples
        --------
        >>> [channel.name for channel in Record.bundled().component("vertical").channels]
        ['Up']
        """
        return Record(self._native.component(name))

    def process(
        self,
        chain: str = "default",
        *,
        mean: str | None = None,
        detrend: bool | None = None,
        taper: float | None = None,
        high_pass: float | None = None,
        low_pass: float | None = None,
        order: int | None = None,
        keep_pads: bool | None = None,
        close: bool | None = None,
    ) -> Record:
        """Processes all components by a chain of steps; :attr:`notes` state every step.

        Parameters
        ----------
        chain
            Base chain: ``"default"`` (the chain for the processing stage of the record), ``"raw"`` (remove the mean,
            taper, high-pass at 0.1 Hz, bring the final velocity and displacement to zero), ``"compact"`` (the same
            without pads), or ``"none"``. The other arguments replace its settings.
        mean
            ``"keep"``, ``"pre-event"`` or ``"whole"``.
        detrend
            Whether to subtract the least-squares line.
        taper
            Length of the cosine taper at each end, as a share of the length of the record.
        high_pass, low_pass
            Corner frequencies (Hz) of the zero-phase Butterworth filter.
        order
            Order of the filter, which runs forward and backward.
        keep_pads
            Whether to keep the zero pads, which contain the transients of the filter (Boore 2005).
        close
            Whether to bring velocity and displacement to zero at the end.

        Returns
        -------
        Record

        Raises
        ------
        RecordError
            When a setting is out of range for the record.

        Examples
        --------
        >>> record = Record.bundled().process("compact", high_pass=0.2)
        >>> record.stage
        'corrected'
        """
        steps = (mean, detrend, taper, high_pass, low_pass, order, keep_pads, close)
        return Record(self._native.process(chain, *steps))

    def scale(self, factor: float | None = None, *, of: str = "h1", **target: float | str) -> Record:
        """Multiplies all components by one factor.

        Parameters
        ----------
        factor
            The factor; leave it out to scale to a measure.
        of
            The component to which the measure refers, or ``"rotd50"``, ``"rotd100"`` or ``"geomean"`` for both
            horizontals.
        **target
            One measure and its value: ``pgv=0.6`` (SI), ``pgv="60 cm/s"``, ``pga="0.4 g"``, ``arias=2.0``. Measures
            with a period are written ``**{"sa(1.0)": "0.5 g"}``.

        Returns
        -------
        Record

        Raises
        ------
        RecordError
            When the measure does not scale with the motion, or is zero.

        Examples
        --------
        >>> record = Record.bundled().scale(pga="0.4 g", of="E")
        >>> round(record.intensity("pga")[0].values["E"], 6)  # m/s²
        3.92266
        """
        if factor is not None and not target:
            return Record(self._native.multiplied(float(factor)))
        if factor is not None or len(target) != 1:
            raise TypeError('scale takes a factor, or one measure: scale(pgv="60 cm/s")')
        ((measure, value),) = target.items()
        number = _native.measured(measure, value) if isinstance(value, str) else float(value)
        return Record(self._native.scaled_to(measure, number, of))

    def match(
        self,
        target: str | tuple[ArrayLike, ArrayLike],
        *,
        of: str = "h1",
        damping: float = 0.05,
        method: str = "time",
        periods: tuple[float, float] = (0.1, 3.0),
        tolerance: float = 0.05,
        nearly: bool = False,
    ) -> Record:
        """Matches one component, or both horizontals, to a target spectrum; other components are only scaled.

        Parameters
        ----------
        target
            A code with its parameters, ``"ec8:ag=0.3,site=B"``, ``"asce7:sds=1,sd1=0.6"``, ``"nch433:zone=2,soil=D"``,
            ``"nch2745:zone=2,soil=II"``, ``"nzs1170:z=0.3,site=C"``, ``"ac156:sds=1"`` (accelerations in g); or
            periods (s, ascending) and pseudo-accelerations (m/s²).
        of
            The component to match; ``"rotd50"`` and ``"rotd100"`` match both horizontals together, by their response
            over all directions.
        damping
            Damping ratio of a target that is given as periods and pseudo-accelerations.
        method
            For one component: ``"time"`` adds wavelets at the peak responses; ``"frequency"`` scales Fourier
            amplitudes.
        periods
            Shortest and longest period (s) to match.
        tolerance
            Largest relative misfit that is accepted at any matched period.
        nearly
            Whether to accept the best motion if the tolerance is not reached; :attr:`notes` state the misfits.

        Returns
        -------
        Record

        Raises
        ------
        RecordError
            When a setting is out of range, or the tolerance is not reached.

        Examples
        --------
        >>> record = Record.bundled().process("compact")
        >>> matched = record.match("ec8:ag=0.3,site=B", of="E", periods=(0.15, 2.5), tolerance=0.08)
        >>> periods, acceleration = matched.spectrum([0.5], of="E")
        >>> bool(8.0 < acceleration[0] < 10.0)  # m/s²: 2.5 · 1.2 · 0.3 g is 8.83
        True
        """
        if method not in ("time", "frequency"):
            raise ValueError(f'expected the method "time" or "frequency", found {method!r}')
        wanted: str | list[tuple[float, float]]
        if isinstance(target, str):
            wanted = target
        else:
            period, acceleration = (np.asarray(one, dtype=np.float64) for one in target)
            wanted = list(zip(period.tolist(), acceleration.tolist(), strict=True))
        spread = (float(periods[0]), float(periods[1]))
        by_frequency = method == "frequency"
        record, _, _ = self._native.matched(wanted, damping, of, by_frequency, spread, tolerance, nearly)
        return Record(record)

    def intensity(self, *measures: str) -> list[Intensity]:
        """Returns intensity measures of every component.

        Parameters
        ----------
        *measures
            Names such as ``"pgv"``, ``"sa(1.0)"``, ``"sa(1.0,0.02)"``, ``"d5-95"``, ``"housner"``; by default the usual
            ones.

        Returns
        -------
        list of Intensity
            Each with its unit and a value (SI units) per component. ``pandas.DataFrame`` accepts the list.

        Raises
        ------
        RecordError
            When there is no such measure.

        Examples
        --------
        >>> [row.unit for row in Record.bundled().intensity("pgv", "sa(1.0)", "d5-95")]
        ['m/s', 'm/s2', 's']
        """
        names = [channel[0] for channel in self._native.channels()]
        rows: list[Intensity] = []
        for measure in measures or USUAL:
            values, unit = self._native.intensity(measure)
            rows.append(Intensity(measure, unit, dict(zip(names, values, strict=True))))
        return rows

    def spectrum(
        self,
        periods: ArrayLike | None = None,
        *,
        damping: float = 0.05,
        of: str = "h1",
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Returns the response spectrum of a component, or of both horizontals.

        Parameters
        ----------
        periods
            Periods (s); by default thirty per decade from 0.01 to 10 s.
        damping
            Damping ratio.
        of
            A component, or ``"rotd50"``, ``"rotd100"`` or ``"geomean"``.

        Returns
        -------
        periods : ndarray, shape (n,)
            Periods (s).
        acceleration : ndarray, shape (n,)
            Pseudo-spectral acceleration (m/s²): exact for accelerations that are linear between samples.

        Examples
        --------
        >>> periods, acceleration = Record.bundled().spectrum([0.2, 1.0], of="rotd50")
        >>> acceleration.shape
        (2,)
        """
        at = _native.standard_periods(30) if periods is None else np.ascontiguousarray(periods, dtype=np.float64)
        return at, self._native.spectrum(at, damping, of)

    def plot(self, component: str = "h1", *, damping: float = 0.05) -> Figure:
        """Plots acceleration, velocity and displacement of a component, and its response spectrum.

        Parameters
        ----------
        component
            As for :meth:`component`.
        damping
            Damping ratio of the spectrum.

        Returns
        -------
        matplotlib.figure.Figure
        """
        import matplotlib.pyplot as plt

        one = self.component(component)
        channel = one.channels[0]
        time = channel.time_step * np.arange(len(channel.acceleration))
        figure = plt.figure(figsize=(9, 5), layout="constrained")
        grid = figure.add_gridspec(3, 2, width_ratios=(2, 1))
        rows = (
            ("acceleration (m/s²)", channel.acceleration),
            ("velocity (m/s)", one.velocity(channel.name)),
            ("displacement (m)", one.displacement(channel.name)),
        )
        axes: Any = None
        for row, (label, values) in enumerate(rows):
            axes = figure.add_subplot(grid[row, 0], sharex=axes)
            axes.plot(time, values, linewidth=0.8)
            axes.set_ylabel(label)
            axes.tick_params(labelbottom=row == len(rows) - 1)
        axes.set_xlabel("time (s)")
        axes = figure.add_subplot(grid[:, 1])
        periods, spectrum = one.spectrum(damping=damping, of=channel.name)
        axes.semilogx(periods, spectrum)
        axes.set_xlabel("period (s)")
        axes.set_ylabel(f"pseudo-acceleration (m/s²), damping {100.0 * damping:g} %")
        axes.set_ylim(bottom=0.0)
        figure.suptitle(f"{self.event or self.name}, {channel.name}")
        return figure

    def write(self, path: str | os.PathLike[str]) -> None:
        """Writes the record in the format of the extension: ``.txt`` and ``.npz`` (exact), ``.csv``, ``.at2``.

        Parameters
        ----------
        path
            The file.

        Raises
        ------
        RecordError
            When the extension is unknown, or the format cannot represent the record.
        OSError
            When the file cannot be written.
        """
        ending = os.path.splitext(os.fspath(path))[1].lstrip(".").lower()
        store(path, self._native.written(ending))

    def __copy__(self) -> Record:
        return self

    def __deepcopy__(self, memo: dict[int, Any]) -> Record:
        return self

    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]:
        # An archive stores the record exactly.
        return _restored, (self._native.written("npz"), self.name)

    def _repr_html_(self) -> str:
        names = [channel.name for channel in self.channels]
        head = "".join(f"<th>{name}</th>" for name in ["measure", "unit", *names])
        rows = "".join(
            f"<tr><td>{row.measure}</td><td>{row.unit}</td>"
            + "".join(f"<td>{row.values[name]:.4g}</td>" for name in names)
            + "</tr>"
            for row in self.intensity()
        )
        return f"<p>{self!r}</p>".replace("<R", "&lt;R") + f"<table><tr>{head}</tr>{rows}</table>"

    def __repr__(self) -> str:
        channels = self.channels
        names = ", ".join(channel.name for channel in channels)
        step, count = channels[0].time_step, len(channels[0].acceleration)
        return f"<Record {self.name!r}: {names}; {count} samples of {step:g} s, {self.stage}>"


def _restored(archive: bytes, name: str) -> Record:
    """Restores a pickled record."""
    return Record.read(archive, name=name)


def _saved(data: bytes, name: str, unit: str | None, time_step: float | None) -> Record | None:
    """Returns the record of an archive of ``numpy.savez(file, acceleration=…, dt=0.01)``; None for anything else."""
    if not data.startswith(b"PK"):
        return None
    try:
        with np.load(io.BytesIO(data), allow_pickle=False) as archive:
            arrays = dict(archive)
    except (ValueError, OSError, zipfile.BadZipFile):
        return None
    steps = {key: value for key, value in arrays.items() if key in ("dt", "delta", "time_step") and value.ndim == 0}
    components = {key: value for key, value in arrays.items() if key.startswith("acceleration") and value.ndim == 1}
    if not components or len(steps) > 1 or len(steps) + len(components) < len(arrays):
        return None
    stated = float(next(iter(steps.values()))) if steps else None
    if unit is None:
        raise RecordError(f"{name}: expected the unit of the array acceleration, found none; state it with unit=", name)
    if stated is not None and time_step is not None and stated != time_step:
        raise RecordError(f"{name}: the archive states a step of {stated} s, but {time_step} s was given", name)
    step = stated if time_step is None else time_step
    if step is None:
        raise RecordError(f"{name}: expected a number dt (s) beside the array, found none; state time_step=", name)
    shown = {key.removeprefix("acceleration").strip("_ ") or "H1": value for key, value in components.items()}
    return Record.from_arrays(shown, step, unit=unit, name=name)
