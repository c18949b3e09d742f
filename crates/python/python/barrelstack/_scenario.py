"""Scenarios: a stack or bodies, their ground motion, and the settings of the run."""

from __future__ import annotations

import functools
import html
import json
import os
from collections.abc import Callable, Iterator, Mapping
from typing import TYPE_CHECKING, Any

from . import _native
from ._errors import ArgumentError
from ._progress import Progress, reporting
from ._quantity import literal, plain
from ._record import Record
from ._run import Glance, Run, warn
from ._simulation import Simulation, Simulations
from ._space import SpatialRun

if TYPE_CHECKING:
    from typing_extensions import Never

__all__ = ["Scenario", "Section"]


@functools.cache
def _schema(of: str) -> dict[str, Any]:
    schema: dict[str, Any] = json.loads(_native.schema(of))
    return schema


def _is_file(name: str) -> bool:
    """Returns True if a name is a path. If no such file exists, a name without a dot or a separator is built in."""
    return os.path.isfile(name) or any(sign in name for sign in "./\\")


#: Value of a field; quantities are texts with their SI unit.
Value = str | int | float | bool


def _value(text: str) -> Value:
    """Converts a plain number or bool; returns any other text unchanged."""
    if text in ("true", "false"):
        return text == "true"
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            pass
    return text


def _unassigned(path: str) -> ArgumentError:
    """Returns the error for an assignment to a field; scenarios are immutable."""
    return ArgumentError(f'a scenario cannot be changed: scenario.set("{path}", value) returns a new one')


class Section:
    """A table of a scenario; its fields are attributes, and :meth:`help` returns their meanings.

    Examples
    --------
    >>> stack = barrelstack.Scenario.load("demo-napa").stack
    >>> stack.levels
    5
    >>> stack.help("levels")
    'levels = 5: Number of levels of barrels.'
    """

    def __init__(self, path: str, fields: Mapping[str, tuple[str, str]]) -> None:
        self._path = path
        self._fields = fields

    def _names(self) -> list[str]:
        start = f"{self._path}." if self._path else ""
        below = (path[len(start) :] for path in self._fields if path.startswith(start))
        return list(dict.fromkeys(name.split(".")[0] for name in below))

    def __dir__(self) -> list[str]:
        names = [name for name in self._names() if name.isidentifier()]
        return [*names, "help"]

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        return self[name.replace("_", "-") if name not in self._names() else name]

    def __setattr__(self, name: str, value: Never) -> None:
        if not name.startswith("_"):
            raise _unassigned(f"{self._path}.{name}" if self._path else name)
        object.__setattr__(self, name, value)

    def __getitem__(self, name: str) -> Section | Value:
        path = f"{self._path}.{name}" if self._path else name
        if path in self._fields:
            return _value(self._fields[path][0])
        if any(known.startswith(f"{path}.") for known in self._fields):
            return Section(path, self._fields)
        where = f"[{self._path}]" if self._path else "the scenario"
        raise AttributeError(f"{where} has no field {name!r}; it has {', '.join(self._names())}")

    def __iter__(self) -> Iterator[str]:
        return iter(self._names())

    def _ipython_key_completions_(self) -> list[str]:
        return self._names()

    def help(self, name: str) -> str:
        """Returns the meaning of a field.

        Parameters
        ----------
        name
            A field of this table.

        Returns
        -------
        str
            Name, value with unit, and meaning of the field.
        """
        value, meaning = self._fields[f"{self._path}.{name}" if self._path else name]
        return f"{name} = {value}: {meaning}"

    def to_dict(self) -> dict[str, Any]:
        """Returns the table as a nested dict; quantities are texts with their SI unit.

        Returns
        -------
        dict
            One entry per field; inner tables are dicts.
        """
        inner = {name: self[name] for name in self._names()}
        return {name: item.to_dict() if isinstance(item, Section) else item for name, item in inner.items()}

    def __repr__(self) -> str:
        start = f"{self._path}." if self._path else ""
        rows = [(path, *described) for path, described in self._fields.items() if path.startswith(start)]
        return "\n".join(f"{path} = {value}    # {meaning}" for path, value, meaning in rows)


class Scenario:
    """A stack or bodies, their ground motion, and the settings of the run; immutable.

    Parameters
    ----------
    of
        The text of a scenario (TOML), or a nested dict of the same fields. Quantities are texts with a unit
        (``"32 kg"``), or quantities of Pint or astropy.
    name
        Name of the text in error messages.

    Raises
    ------
    ScenarioError
        At the first invalid field, with its position or its path.

    Examples
    --------
    >>> scenario = Scenario({"extends": "candia-8-barrels", "stack": {"levels": 3}})
    >>> scenario.set("motion.scale.pgv", "60 cm/s").stack.levels
    3

    Notes
    -----
    The reference of scenario files describes all fields; :meth:`schema` returns their JSON Schema.
    """

    def __init__(self, of: str | Mapping[str, Any], name: str = "scenario") -> None:
        self._record: Record | None = None
        self._name = os.path.abspath(name)
        if isinstance(of, str):
            self._native = _native.Scenario.parse(name, of, [])
        else:
            self._native = _native.Scenario.from_tree(name, plain(dict(of)))

    @classmethod
    def _of(cls, native: _native.Scenario, record: Record | None, name: str) -> Scenario:
        made = cls.__new__(cls)
        made._native = native
        made._record = record
        #: A path; relative paths in the scenario start from its folder.
        made._name = name
        return made

    @classmethod
    def load(cls, name: str | os.PathLike[str], **changes: Any) -> Scenario:
        """Loads a scenario from a file, or a built-in scenario by name.

        Parameters
        ----------
        name
            A path, or one of :func:`barrelstack.scenarios`. An existing file takes precedence.
        **changes
            Fields to set, with ``__`` for the dot, such as ``stack__levels=6``.

        Returns
        -------
        Scenario

        Raises
        ------
        ScenarioError
            When there is no such scenario, or at the first invalid field.

        Examples
        --------
        >>> Scenario.load("candia-8-barrels", stack__levels=3).stack.levels
        3
        """
        sets = [f"{path.replace('__', '.')}={literal(value)}" for path, value in changes.items()]
        path = os.fspath(name)
        read = _native.Scenario.load if _is_file(path) else _native.Scenario.builtin
        return cls._of(read(path, sets), None, os.path.abspath(path))

    def set(self, path: str | Mapping[str, Any], value: Any = None) -> Scenario:
        """Returns a new scenario with fields set.

        Parameters
        ----------
        path
            The path of a field, such as ``"stack.levels"`` or ``"interface.rack-ground.friction.coefficient"``;
            or a mapping of paths to values, set together.
        value
            The value: a number, a text, a quantity, a list or a dict.

        Returns
        -------
        Scenario
            The new scenario; this one is unchanged.

        Raises
        ------
        ScenarioError
            When no field has the path, or the value is invalid; the attribute ``value`` of the exception has both.

        Examples
        --------
        >>> scenario = Scenario.load("candia-8-barrels").set({"stack.levels": 3, "motion.sine.amplitude": "5 cm"})
        >>> scenario.stack.levels, scenario.motion.sine.amplitude
        (3, '0.05 m')
        """
        changes = path if isinstance(path, Mapping) else {path: value}
        sets = [f"{path}={literal(value)}" for path, value in changes.items()]
        return self._of(self._native.changed(sets), self._record, self._name)

    def with_record(self, record: Record) -> Scenario:
        """Returns a new scenario with a record in place of the stated motion.

        Parameters
        ----------
        record
            The record. Component, processing and scale are those stated under ``motion``.

        Returns
        -------
        Scenario

        Examples
        --------
        >>> scenario = Scenario.load("candia-8-barrels").with_record(Record.bundled().process("compact").scale(pgv=0.4))
        >>> round(scenario.ground().intensity("pgv")[0].values["H1"], 3)
        0.4
        """
        return self._of(self._native, record, self._name)

    @property
    def _shaken(self) -> _native.Scenario:
        return self._native if self._record is None else self._native.with_record(self._record._native)

    @property
    def title(self) -> str:
        """Title, in one line."""
        return self._shaken.title

    @property
    def fingerprint(self) -> str:
        """Sixteen hexadecimal digits that identify everything that affects the run; the title does not affect it."""
        return self._shaken.fingerprint

    @property
    def fields(self) -> Section:
        """All fields with their values, including defaults."""
        settings = self._native.settings()
        return Section("", {path: (value, meaning) for path, value, meaning in settings})

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        return self.fields.__getattr__(name)

    def __setattr__(self, name: str, value: Never) -> None:
        if not name.startswith("_"):
            raise _unassigned(name)
        object.__setattr__(self, name, value)

    def __dir__(self) -> list[str]:
        fields = [name for name in self.fields if name.isidentifier()]
        return [*super().__dir__(), *fields]

    def to_toml(self) -> str:
        """Returns the scenario as the text of a file, including all defaults, with all quantities in SI units.

        Returns
        -------
        str
            TOML that reads back to the same run.
        """
        return self._native.to_toml()

    @staticmethod
    def schema() -> dict[str, Any]:
        """Returns the JSON Schema (2020-12) of scenario files.

        Returns
        -------
        dict
        """
        return _schema("scenario")

    def ground(self) -> Record | None:
        """Returns the ground motion: the record or the formula after processing and scaling.

        Returns
        -------
        Record or None
            A record with the components ``H1`` (positive along x) and ``UP``; None if the ground is at rest.

        Raises
        ------
        RecordError
            When the record cannot be read.
        """
        found = self._shaken.ground()
        return None if found is None else Record(found)

    def check(self) -> list[dict[str, Any]]:
        """Checks that the scenario is valid, and that the stack stands before the motion.

        Returns
        -------
        list of dict
            Settlement, time step and warnings of every plane, as printed by ``barrelstack check --json``.

        Raises
        ------
        RunError
            When the stack does not stand; names the first body to fail and the cause.
        """
        return [json.loads(one) for one in self._shaken.check()]

    def run(
        self,
        record: Record | str | os.PathLike[str] | None = None,
        variants: int | None = None,
        progress: Progress = None,
        *,
        variant: int | None = None,
        remedy: bool = False,
        verify: bool = False,
    ) -> Run:
        """Runs the scenario with its variants, and shows the most typical run.

        Parameters
        ----------
        record
            A record or its path, in place of the motion of the scenario.
        variants
            Number of variants in addition to the nominal stack; by default that of the scenario (64).
        progress
            True for a progress bar, or a function that is called with (done, of, what) about twenty times per second.
        variant
            The variant to show, 0 for the nominal stack; by default the most typical one.
        remedy
            Whether to search for a change that keeps the stack up, as ``barrelstack run`` does.
        verify
            Whether to repeat the run, as a check, with half the time step and with barrels displaced by a nanometer.

        Returns
        -------
        Run
            Results of the governing plane; those of the other plane are in :attr:`Run.other`.

        Raises
        ------
        RunError
            When the stack cannot be built or does not stand.
        RecordError
            When the motion cannot be read.
        ValueError
            When the scenario is three-dimensional; use :meth:`run_in_space`.
        KeyboardInterrupt
            Within a second of Ctrl-C.

        Warns
        -----
        BarrelstackWarning
            One warning for each caveat of the result.

        Notes
        -----
        The numbers are those of ``barrelstack run``, bit for bit. The interpreter lock is released during the run.
        """
        if self._native.is_spatial:
            raise ValueError(f"{self.title!r} is three-dimensional: run it with run_in_space()")
        if record is not None:
            record = record if isinstance(record, Record) else Record.read(record)
            return self.with_record(record).run(
                None, variants, progress, variant=variant, remedy=remedy, verify=verify
            )
        with reporting(progress, f"run of {self.title!r}") as report:
            run = Run(self._shaken.run(variants, variant, remedy, verify, report))
        warn(run.warnings)
        return run

    def run_in_space(
        self,
        record: Record | str | os.PathLike[str] | None = None,
        variants: int | None = None,
        progress: Progress = None,
        *,
        variant: int | None = None,
        remedy: bool = False,
        verify: bool = False,
    ) -> SpatialRun:
        """Runs a three-dimensional scenario (``stack.view = "spatial"``) with its variants, under all motion
        components.

        Parameters
        ----------
        record
            A record or its path, in place of the motion of the scenario.
        variants
            Number of variants in addition to the nominal stack; by default that of the scenario (64).
        progress
            True for a progress bar, or a function that is called with (done, of, what) about twenty times per second.
        variant
            The variant to show, 0 for the nominal stack; by default the most typical one.
        remedy
            Whether to search for a change that keeps the stack up, as ``barrelstack run`` does.
        verify
            Whether to repeat the run, as a check, with half the time step and with barrels displaced by a nanometer.

        Returns
        -------
        SpatialRun
            Results of the scenario.

        Raises
        ------
        RunError
            When the stack cannot be built in three dimensions or does not stand.
        RecordError
            When the motion cannot be read.
        ValueError
            When the scenario is planar; use :meth:`run`.
        KeyboardInterrupt
            Within a second of Ctrl-C.

        Warns
        -----
        BarrelstackWarning
            One warning for each caveat of the result.

        Notes
        -----
        The numbers are those of ``barrelstack run``, bit for bit. The interpreter lock is released during the run.
        """
        if not self._native.is_spatial:
            raise ValueError(
                f"{self.title!r} is a planar scenario: run it with run(), or set {{'stack.view': 'spatial'}}"
            )
        if record is not None:
            record = record if isinstance(record, Record) else Record.read(record)
            return self.with_record(record).run_in_space(
                None, variants, progress, variant=variant, remedy=remedy, verify=verify
            )
        with reporting(progress, f"three-dimensional run of {self.title!r}") as report:
            run = SpatialRun(self._shaken.run_in_space(variants, variant, remedy, verify, report), self.to_toml())
        warn(run.warnings)
        return run

    def simulation(self, *, plane: str | None = None, variant: int = 0) -> Simulation:
        """Returns a simulation that advances step by step and accepts external forces, in a plane or in three
        dimensions.

        Parameters
        ----------
        plane
            ``"transverse"`` (across the barrels) or ``"longitudinal"`` (along them) if the scenario has both planes; by
            default the first.
        variant
            The variant, 0 for the nominal stack.

        Returns
        -------
        Simulation
            At the start of the motion, with the stack at rest.

        Raises
        ------
        RunError
            When the stack cannot be built or does not stand.
        RecordError
            When the motion cannot be read.
        ValueError
            When there is no such plane or variant.

        Notes
        -----
        Settling, time step, ground motion, devices and end of the run are those of :meth:`run`. Until a force is
        applied, results are bit-identical to those of :meth:`run`.
        """
        return Simulation(_native.Simulation.start(self._shaken, plane, variant))

    def simulations(self, count: int, *, plane: str | None = None) -> Simulations:
        """Returns simulations of variants 1 to ``count`` that advance together on all cores.

        Parameters
        ----------
        count
            Number of simulations. A free scene has no variants; it is repeated.
        plane
            As in :meth:`simulation`.

        Returns
        -------
        Simulations
            Simulation ``k`` is bit-identical to ``run(variants=count, variant=k + 1)``.

        Raises
        ------
        RunError
            When a stack cannot be built or does not stand.
        RecordError
            When the motion cannot be read.
        ValueError
            When there is no such plane, or the count is not positive.
        """
        if count < 1:
            raise ValueError(f"the number of simulations must be positive, found {count}")
        return Simulations(_native.Simulations.start(self._shaken, plane, count))

    def observe(self, look: Callable[[Glance], object], every: int = 100) -> Run:
        """Runs the scenario as stated, in one plane, with an observer that may stop the run.

        Parameters
        ----------
        look
            Called with a :class:`Glance` at the start and after every few accepted steps; a true
            result ends the run, which keeps the results so far.
        every
            Number of accepted steps between two calls.

        Returns
        -------
        Run
            ``run.interrupted`` is True if the observer stopped it.

        Raises
        ------
        RunError
            When the stack cannot be built or does not stand.
        Exception
            Any exception of the observer.

        Notes
        -----
        Each call acquires the interpreter lock and takes a few microseconds; force laws that act at every step
        belong in the library.
        """
        run = Run(self._shaken.run_before(every, look))
        warn(run.warnings)
        return run

    def __copy__(self) -> Scenario:
        return self

    def __deepcopy__(self, memo: dict[int, Any]) -> Scenario:
        return self

    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]:
        return _restored, (self.to_toml(), self._record, self._name)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Scenario) and self.fingerprint == other.fingerprint

    def __hash__(self) -> int:
        return hash(self.fingerprint)

    def _repr_html_(self) -> str:
        sections: dict[str, list[str]] = {}
        for path, value, meaning in self._native.settings():
            section, _, field = path.partition(".")
            row = "".join(f"<td>{html.escape(text)}</td>" for text in (field or path, value, meaning))
            sections.setdefault(section if field else "", []).append(f"<tr>{row}</tr>")
        tables = "".join(
            f"<details><summary>{html.escape(section or 'general')}</summary><table>{''.join(rows)}</table></details>"
            for section, rows in sections.items()
        )
        record = "" if self._record is None else f"<p>motion: {html.escape(self._record.name)}</p>"
        return f"<p><strong>{html.escape(self.title)}</strong></p>{record}{tables}"

    def __repr__(self) -> str:
        return f"<Scenario {self.title!r}, {self.fingerprint}>"


def _restored(text: str, record: Record | None, name: str) -> Scenario:
    """Restores a pickled scenario."""
    return Scenario._of(_native.Scenario.parse(name, text, []), record, name)
