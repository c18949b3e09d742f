"""Contact parameters, with their uncertainty, from your own tests."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple, cast

from . import _native
from ._page import Page
from ._progress import Progress, reporting
from ._quantity import plain
from ._scenario import Scenario
from ._store import contents

__all__ = ["Calibration", "Estimate"]

#: Names of all parameters that can be fitted to a response or to collapses.
_ALL = ("k", "c", "mu-br", "mu-rg")


class Estimate(NamedTuple):
    """A parameter with its 95 % interval.

    Examples
    --------
    >>> found = Calibration.friction({"angle (deg)": [21.4, 22.0, 21.7, 22.9, 21.1]})
    >>> estimate = found.estimates["static friction"]
    >>> round(estimate.low, 2), round(estimate.value, 2), round(estimate.high, 2), estimate.unit
    (0.38, 0.4, 0.42, '1')
    """

    name: str
    #: Best estimate in SI units.
    value: float
    #: Lower end of the interval (SI units); None if the test does not bound it.
    low: float | None
    #: Upper end of the interval (SI units); None if the test does not bound it.
    high: float | None
    #: SI unit of the parameter.
    unit: str


def _text(measured: Any) -> tuple[str, str]:
    """Returns a name of the measurements for error messages, and the measurements as CSV."""
    if isinstance(measured, (str, os.PathLike)):
        name = os.fspath(cast("str | os.PathLike[str]", measured))
        return name, contents(name).decode("utf-8-sig")
    if isinstance(measured, Mapping):
        given = cast("Mapping[object, Iterable[object]]", measured)
        columns = [(str(name), plain(list(values))) for name, values in given.items()]
        return "measurements", _native.Table.from_columns(columns).to_csv()
    return "measurements", _native.Table.from_arrow(measured).to_csv()


class Calibration(Page):
    """Contact parameters from tests.

    Measurements are a CSV file, a mapping of columns to values, or any table that supports Arrow; headings carry the
    unit, such as ``"angle (deg)"``. Intervals are 95 % intervals and include the scatter of the measurements; a given
    mass or stiffness, and the model itself, are taken as exact.

    Examples
    --------
    >>> found = Calibration.friction({"angle (deg)": [21.4, 22.0, 21.7, 22.9, 21.1]}, interface="rack-ground")
    >>> round(found.estimates["static friction"].value, 2)
    0.4
    >>> found.scenario.splitlines()[:2]  # lines to paste
    ['[interface.rack-ground.friction]', 'coefficient = 0.4004']
    """

    @property
    def estimates(self) -> dict[str, Estimate]:
        """The parameters by name."""
        return {one["name"]: Estimate(**one) for one in self.document["estimates"]}

    @property
    def correlation(self) -> list[list[float]]:
        """Correlation matrix of the estimates (1), in the order of the estimates; empty if they were not fitted
        jointly."""
        found: list[list[float]] = self.document["correlation"]
        return found

    @property
    def scenario(self) -> str:
        """Lines to paste into a scenario (TOML)."""
        return str(self.document["scenario"])

    @classmethod
    def stiffness(cls, measured: Any, *, nodes: int = 1, interface: str = "barrel-rack") -> Calibration:
        """Fits the stiffness to a press test.

        Parameters
        ----------
        measured
            Columns ``penetration`` and ``force``, in one of the forms described for :class:`Calibration`.
        nodes
            Number of contact nodes that share the force; the fitted k is the stiffness of one node.
        interface
            The pair of bodies that was tested; the lines to paste into a scenario name this pair.

        Returns
        -------
        Calibration

        Raises
        ------
        Error
            When a column or a row is missing, or force does not grow with penetration.
        """
        return cls(_native.calibrate_stiffness(*_text(measured), nodes, interface))

    @classmethod
    def drop(
        cls,
        measured: Any,
        *,
        mass: Any = None,
        stiffness: Any = None,
        nodes: int = 1,
        interface: str = "barrel-rack",
    ) -> Calibration:
        """Fits restitution and damping to drop tests.

        Parameters
        ----------
        measured
            Columns ``drop height`` and ``rebound height``, or a column ``time`` with the times of successive impacts.
        mass, stiffness
            Mass of the falling body, and stiffness of one contact node, with units; together they give the damping.
        nodes
            Number of contact nodes that the body hits at the same time.
        interface
            The pair of bodies that was tested.

        Returns
        -------
        Calibration

        Raises
        ------
        Error
            When a column or a row is missing, or a rebound is higher than its drop.
        ValueError
            When only one of mass and stiffness is given.
        """
        if (mass is None) != (stiffness is None):
            raise ValueError("damping needs both `mass` and `stiffness`: give both of them, or leave both out")
        striker = None if mass is None else (plain(mass), plain(stiffness))
        return cls(_native.calibrate_drop(*_text(measured), striker, nodes, interface))

    @classmethod
    def friction(cls, measured: Any, *, interface: str = "barrel-rack") -> Calibration:
        """Fits the friction of pull or tilt tests.

        Parameters
        ----------
        measured
            Columns ``normal force``, ``breakaway force`` and, if measured, ``sliding force``; or ``angle`` of first
            slip and, if measured, ``sliding distance`` and ``sliding time`` from rest at that angle.
        interface
            The pair of bodies that was tested.

        Returns
        -------
        Calibration

        Raises
        ------
        Error
            When a column or a row is missing.
        """
        return cls(_native.calibrate_friction(*_text(measured), interface))

    @classmethod
    def response(
        cls,
        scenario: Scenario,
        measured: Any,
        *,
        fit: Sequence[str] = _ALL,
        until: Any = None,
        progress: Progress = None,
    ) -> Calibration:
        """Fits stiffness, damping and friction jointly to the recorded response of a shaken stack.

        Parameters
        ----------
        scenario
            The scenario of the test; the fit starts from its values.
        measured
            A column ``time``, counted from the start of the motion, and columns named like histories, such as
            ``"B1.1_displacement_x (mm)"``.
        fit
            Parameters to fit, among ``"k"`` and ``"c"`` (stiffness and damping of barrel-rack), ``"mu-br"`` and
            ``"mu-rg"`` (friction of barrel-rack and rack-ground).
        until
            Time, with its unit, after which rows are ignored; use a short window of mild shaking, without collapse.
        progress
            As for :meth:`Scenario.run`.

        Returns
        -------
        Calibration

        Raises
        ------
        Error
            When the measurements do not match the scenario.
        RunError
            When the scenario cannot be simulated.
        KeyboardInterrupt
            Within a second of Ctrl-C.
        """
        end = None if until is None else plain(until)
        with reporting(progress, "calibration from a response") as report:
            return cls(_native.calibrate_response(scenario._shaken, *_text(measured), list(fit), end, report))

    @classmethod
    def collapse(
        cls,
        scenario: Scenario,
        measured: Any,
        *,
        others: Mapping[str, Scenario] | None = None,
        statements: Sequence[str] = (),
        fit: Sequence[str] = _ALL,
        within: float = 2.0,
        timing: Any = "0.05 s",
        placement: Any = "1 mm",
        simulations: int = 1000,
        seed: int = 1,
        progress: Progress = None,
    ) -> Calibration:
        """Fits stiffness, damping and friction jointly to collapses observed on video or by eye, or to the share of
        the stacks that fell in an earthquake.

        Parameters
        ----------
        scenario
            The scenario of tests that do not name one.
        measured
            One row per test: ``mode``, ``first fall (s)``, ``first barrel``, ``B4.1 fell (s)``, ``loss of seat (s)``,
            ``until (s)``, ``scenario``. A path that ends in ``.toml`` is a file of statements: how many stacks or
            barrels fell in an earthquake, with source and uncertainty.
        others
            Scenarios to which the tests refer, by name.
        statements
            Names of the statements to use from a TOML file; by default, all statements that give a share.
        fit
            As for :meth:`response`.
        within
            Range of each parameter: from the value in the scenario divided by this factor to that value multiplied by
            this factor.
        timing, placement
            Standard deviations, with units, of observed times and of the positions of bodies.
        simulations
            Number of parameter sets, each simulated once per test.
        seed
            Seed of all random numbers.
        progress
            As for :meth:`Scenario.run`.

        Returns
        -------
        Calibration

        Raises
        ------
        Error
            When a cell is invalid, or no simulation within the range resembles the observations.
        KeyboardInterrupt
            Within a second of Ctrl-C.
        """
        named = [(name, one._shaken) for name, one in (others or {}).items()]
        with reporting(progress, "calibration from collapses") as report:
            return cls(
                _native.calibrate_collapse(
                    scenario._shaken,
                    named,
                    list(statements),
                    *_text(measured),
                    list(fit),
                    within,
                    plain(timing),
                    plain(placement),
                    simulations,
                    seed,
                    report,
                )
            )
