"""Simulations that advance step by step and accept external forces."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _native
from ._errors import ArgumentError
from ._run import Run, warn
from ._space import SpatialRun

if TYPE_CHECKING:
    from typing_extensions import Never

__all__ = ["Contacts", "ElementForce", "Energy", "Simulation", "Simulations", "State"]


class State(NamedTuple):
    """Positions and velocities of all bodies at one time.

    Examples
    --------
    >>> state = Scenario.load("sliding-block").simulation().state
    >>> state.bodies, state.pose("block").shape
    (['ground', 'block'], (3,))
    """

    #: Time (s); for many simulations the time of each, shape (simulations,).
    time: Any
    #: Names of the bodies, the ground first.
    bodies: list[str]
    #: Positions in the inertial frame: in a plane x (m), z (m) and angle (rad), shape (bodies, 3); in 3D x, y, z (m)
    #: and quaternion w, x, y, z, shape (bodies, 7). The arrays of several simulations have one more axis in front, for
    #: the simulation.
    poses: NDArray[np.float64]
    #: Velocities: in a plane along x and z (m/s) and angular (rad/s), shape (bodies, 3); in 3D along x, y, z (m/s) and
    #: angular about x, y, z (rad/s), shape (bodies, 6). The arrays of several simulations have one more axis in front,
    #: for the simulation.
    twists: NDArray[np.float64]

    def pose(self, body: str) -> NDArray[np.float64]:
        """Returns the position of a body.

        Parameters
        ----------
        body
            Its name.

        Returns
        -------
        ndarray, shape (3,) or (7,)
            As in :attr:`poses`.
        """
        return np.asarray(self.poses[..., self._at(body), :])

    def twist(self, body: str) -> NDArray[np.float64]:
        """Returns the velocity of a body.

        Parameters
        ----------
        body
            Its name.

        Returns
        -------
        ndarray, shape (3,) or (6,)
            As in :attr:`twists`.
        """
        return np.asarray(self.twists[..., self._at(body), :])

    def _at(self, body: str) -> int:
        if body not in self.bodies:
            raise KeyError(f"there is no body {body!r}; there are {', '.join(self.bodies)}")
        return self.bodies.index(body)


class Contacts(NamedTuple):
    """Contacts of the current state, one row each.

    Examples
    --------
    >>> contacts = Scenario.load("sliding-block").simulation().contacts
    >>> contacts.forces.shape == contacts.points.shape == (len(contacts.bodies), 2)
    True
    """

    #: Names of the two bodies of each contact.
    bodies: list[tuple[str, str]]
    #: Points (m) in the inertial frame, shape (contacts, 2) in a plane and (contacts, 3) in three dimensions.
    points: NDArray[np.float64]
    #: Forces (N) on the first of the two bodies, in the same shape.
    forces: NDArray[np.float64]
    #: Penetrations (m), shape (contacts,).
    penetrations: NDArray[np.float64]


class ElementForce(NamedTuple):
    """Force of a force element, such as a strap.

    Examples
    --------
    >>> strap = {"levels": 4, "ties": "levels-together", "pretension": "3 kN"}
    >>> simulation = Scenario.load("candia-8-barrels").set("stack.strap", strap).simulation()
    >>> any(element.force > 0 for element in simulation.elements.values())
    True
    """

    #: Force (N), positive in tension.
    force: float
    #: True if the element is broken; it has no force then.
    broken: bool


class Energy(NamedTuple):
    """Energies (J) at the current time, and work (J) done from the start to this time.

    Examples
    --------
    >>> simulation = Scenario.load("sliding-block").simulation()
    >>> steps = simulation.step(1000)
    >>> simulation.energy.friction > 0
    True
    """

    kinetic: float
    #: Gravitational potential energy, relative to the start.
    potential: float
    #: Energy stored in contacts and in force elements.
    elastic: float
    #: Energy stored in the tangential springs of friction.
    stick: float
    #: Energy lost in dampers and by yielding and breaking.
    damped: float
    #: Energy lost to friction.
    friction: float
    #: Energy lost to viscous damping of bodies.
    viscous: float
    #: Work of the ground on the bodies.
    ground_work: float
    #: Work of the forces of :meth:`Simulation.apply_force`.
    applied_work: float
    #: Stored and lost energy minus the initial energy and all work; zero for an exact integration.
    residual: float
    #: Energy that has passed through the system.
    throughput: float


def _numbers(values: ArrayLike | None) -> list[float]:
    """Returns the components of a vector; an empty list for None."""
    return [] if values is None else np.atleast_1d(np.asarray(values, dtype=float)).tolist()


class Simulation:
    """A run that advances step by step, accepts external forces, and can be copied at any time.

    Made by :meth:`Scenario.simulation`. Without external forces, its results are bit-identical to those of
    :meth:`Scenario.run` or :meth:`Scenario.run_in_space`.

    Examples
    --------
    >>> simulation = barrelstack.Scenario.load("sliding-block").simulation()
    >>> simulation.step(100)
    100
    >>> kept = simulation.copy()
    >>> simulation.apply_force("block", (-500, 0))
    >>> simulation.step(100)
    100
    >>> simulation.reset(kept)
    """

    def __init__(self, native: _native.Simulation) -> None:
        self._native = native
        self._start = native.copy()
        self._bodies = [name for name, _ in native.bodies()]

    @property
    def bodies(self) -> list[str]:
        """Names of the bodies, the ground first."""
        return list(self._bodies)

    @property
    def masses(self) -> dict[str, float]:
        """Mass (kg) of each free body."""
        return dict(zip(self._bodies[1:], self._native.masses()[1:].tolist(), strict=True))

    @property
    def time(self) -> float:
        """Simulated time (s)."""
        return self._native.time

    @property
    def end_time(self) -> float:
        """Time (s) at which the run ends unless it ends earlier, at rest or after a collapse."""
        return self._native.end_time

    @property
    def steps(self) -> int:
        """Number of steps so far."""
        return self._native.steps

    @property
    def ending(self) -> str | None:
        """Reason for the end of the run: ``rest``, ``after-collapse``, ``duration``, ``patience`` or ``broken``; None while
        the run continues."""
        return self._native.ending

    @property
    def collapse(self) -> float | None:
        """Time (s) at which the first body left its seat; None if none has."""
        return self._native.collapse

    def step(self, count: int = 1) -> int:
        """Advances by a number of steps, or by fewer if the run ends first.

        Parameters
        ----------
        count
            Number of steps. A step has the length of the time step of the run; during impacts, it is divided into
            shorter steps, and each of these counts.

        Returns
        -------
        int
            Number of steps that were taken; zero after the end.

        Raises
        ------
        KeyboardInterrupt
            Within a second of Ctrl-C; the steps taken until then are kept.
        """
        return self._native.step(count)

    def step_until(self, time: float) -> int:
        """Advances until a simulated time is reached, or the run ends.

        Parameters
        ----------
        time
            Simulated time (s); the simulation may pass this time by less than one step.

        Returns
        -------
        int
            Number of steps that were taken.
        """
        taken = 0
        native = self._native
        while native.time < time and native.step(1):
            taken += 1
        return taken

    @property
    def state(self) -> State:
        """Positions and velocities of all bodies, as new arrays; :meth:`copy` keeps the complete state."""
        native = self._native
        return State(native.time, self.bodies, native.poses(), native.twists())

    @property
    def contacts(self) -> Contacts:
        """Points, forces and penetrations of all contacts."""
        bodies, rows = self._native.contacts()
        width = 3 if self._native.is_spatial else 2
        if not bodies:
            rows = np.empty((0, 2 * width + 1))
        return Contacts(bodies, rows[:, :width], rows[:, width : 2 * width], rows[:, 2 * width])

    @property
    def forces(self) -> dict[str, NDArray[np.float64]]:
        """Contact forces (N) between bodies, by names such as ``"R1 on ground"``. Each force acts on the body that is
        named first.

        Its components are along x and z in a plane, and along x, y and z in three dimensions. Only bodies that touch
        are listed.
        """
        return dict(self._native.forces())

    @property
    def elements(self) -> dict[str, ElementForce]:
        """Forces of straps, ties, isolators and other force elements, by name."""
        return {name: ElementForce(force, broken) for name, force, broken in self._native.elements()}

    @property
    def energy(self) -> Energy:
        """Energy balance since the start."""
        return Energy(*self._native.energy())

    def apply_force(
        self, body: str, force: ArrayLike, at: ArrayLike | None = None, moment: ArrayLike | None = None
    ) -> None:
        """Sets the external force on a body, in place of an earlier one. The force acts until it is changed.

        Parameters
        ----------
        body
            Name of a free body.
        force
            Force (N) along x and z in a plane, along x, y and z in three dimensions; a force of zero removes the
            earlier one.
        at
            Point (m) at which the force acts, in the frame of the body; by default its center of mass.
        moment
            Additional moment (N·m): one number in a plane, positive from x to z; three numbers in three dimensions.

        Raises
        ------
        KeyError
            When there is no such body.
        ValueError
            When the body is the ground, or the numbers of components are wrong.

        Notes
        -----
        The work of the force is part of :attr:`energy`. The force is constant until the next call. A force that depends
        strongly on velocity, such as that of a damper, should therefore be set again at every step.
        """
        self._native.apply(body, _numbers(force), _numbers(at), _numbers(moment))

    def reset(self, state: Simulation | None = None) -> None:
        """Sets the complete state to that of a copy, from which the run continues with bit-identical results.

        Parameters
        ----------
        state
            A copy of this simulation, made by :meth:`copy`; by default the state at the start, without forces.

        Raises
        ------
        ValueError
            When the state belongs to another simulation.
        """
        if state is not None and not isinstance(state, Simulation):
            raise TypeError(
                f"a state is a copy of the simulation, made by copy(); found {type(state).__name__}"
            )
        self._native.reset(self._start if state is None else state._native)

    def copy(self) -> Simulation:
        """Returns a copy with the complete state, which continues with bit-identical results.

        Returns
        -------
        Simulation
            Independent of this one; both share the stack and the ground motion.
        """
        made = type(self).__new__(type(self))
        made._native, made._start, made._bodies = self._native.copy(), self._start, self._bodies
        return made

    def result(self) -> Run | SpatialRun:
        """Returns the result so far, with all recordings. Before the end of the run, the result counts as interrupted.

        Returns
        -------
        Run or SpatialRun
            The simulation can go on afterwards.

        Warns
        -----
        BarrelstackWarning
            One warning for each caveat of the result.
        """
        planar = self._native.result()
        if planar is not None:
            run: Run | SpatialRun = Run(planar)
        else:
            spatial = self._native.result_in_space()
            assert spatial is not None
            run = SpatialRun(spatial, spatial.toml)
        warn(run.warnings)
        return run

    def run(self) -> Run | SpatialRun:
        """Advances to the end and returns the result.

        Returns
        -------
        Run or SpatialRun
            The result, depending on whether the scenario is planar or three-dimensional.

        Raises
        ------
        KeyboardInterrupt
            Within a second of Ctrl-C.
        """
        while self._native.ending is None:
            self._native.step(2**32)
        return self.result()

    def __copy__(self) -> Simulation:
        return self.copy()

    def __deepcopy__(self, memo: dict[int, Any]) -> Simulation:
        return self.copy()

    def __reduce__(self) -> Never:
        raise _unpicklable("a simulation")

    def __repr__(self) -> str:
        ended = "" if self.ending is None else f", ended: {self.ending}"
        return f"<Simulation at {self.time:.4g} s of {self.end_time:.4g} s, {len(self._bodies)} bodies{ended}>"


class Simulations:
    """Variants of a scenario that advance together, on all cores.

    Made by :meth:`Scenario.simulations`. Each gives bit-identical results whether it advances with others or alone.

    Examples
    --------
    >>> simulations = Scenario.load("candia-8-barrels").simulations(4)
    >>> simulations.step(10).tolist()
    [10, 10, 10, 10]
    """

    def __init__(self, native: _native.Simulations) -> None:
        self._native = native
        self._start = native.copy()
        self._bodies = [name for name, _ in native.bodies()]

    def __len__(self) -> int:
        return len(self._native)

    def __getitem__(self, at: int) -> Simulation:
        """Returns a copy of one simulation, counted from 0."""
        if not 0 <= at < len(self):
            raise IndexError(f"there is no simulation {at}; there are {len(self)}, counted from 0")
        return Simulation(self._native.get(at))

    @property
    def bodies(self) -> list[str]:
        """Names of the bodies, the ground first."""
        return list(self._bodies)

    @property
    def variants(self) -> list[int]:
        """Number of the variant of each simulation, from 1."""
        return self._native.numbers

    @property
    def time(self) -> NDArray[np.float64]:
        """Simulated time (s) of each simulation, shape (simulations,). Times differ, because steps are shorter during
        impacts."""
        return self._native.times()

    @property
    def ended(self) -> NDArray[np.bool_]:
        """True for simulations that have ended, shape (simulations,)."""
        return np.array([ending is not None for ending in self._native.endings()])

    @property
    def collapse(self) -> NDArray[np.float64]:
        """Time (s) at which the first body left its seat, shape (simulations,); NaN if none has."""
        return self._native.collapses()

    @property
    def state(self) -> State:
        """Positions and velocities of all bodies, as new arrays with the shape (simulations, bodies, …)."""
        native = self._native
        return State(native.times(), self.bodies, native.poses(), native.twists())

    def step(self, count: int = 1) -> NDArray[np.int64]:
        """Advances every simulation by a number of steps, or by fewer if its run ends first.

        Parameters
        ----------
        count
            Number of steps.

        Returns
        -------
        ndarray, shape (simulations,)
            Numbers of steps that were taken.

        Notes
        -----
        The simulations are distributed over all cores; each runs as it does alone. The lanes of the vector unit, which
        serve :func:`ensemble`, are not used.
        """
        return np.array(self._native.step(count), dtype=np.int64)

    def apply_force(
        self, body: str, force: ArrayLike, at: ArrayLike | None = None, moment: ArrayLike | None = None
    ) -> None:
        """Sets the force on a body in every simulation, as :meth:`Simulation.apply_force` does.

        Parameters
        ----------
        body
            Name of a free body.
        force
            Forces (N), shape (simulations, 2) in a plane and (simulations, 3) in three dimensions; or one force for
            all.
        at
            Point (m) at which the forces act, in the frame of the body; by default its center of mass.
        moment
            Additional moments (N·m), one row each or one for all.
        """
        count = len(self)
        forces = np.atleast_1d(np.asarray(force, dtype=float))
        forces = np.ascontiguousarray(np.broadcast_to(forces, (count, forces.shape[-1])))
        turns = np.atleast_1d(np.zeros(0) if moment is None else np.asarray(moment, dtype=float))
        if turns.ndim == 1 and turns.shape == (count,) and forces.shape[-1] == 2:
            turns = turns[:, np.newaxis]
        turns = np.ascontiguousarray(np.broadcast_to(turns, (count, turns.shape[-1])))
        self._native.apply(body, forces, _numbers(at), turns)

    def reset(self, state: Simulations | None = None, where: Sequence[bool] | NDArray[np.bool_] | None = None) -> None:
        """Sets the complete state to that of a copy, from which the run continues with bit-identical results.

        Parameters
        ----------
        state
            A copy of these simulations, made by :meth:`copy`; by default the state at the start, without forces.
        where
            True for each simulation to reset; by default all.
        """
        marked = [True] * len(self) if where is None else [bool(one) for one in where]
        if len(marked) != len(self):
            raise ValueError(f"where has {len(marked)} entries; there are {len(self)} simulations")
        self._native.reset(self._start if state is None else state._native, marked)

    def copy(self) -> Simulations:
        """Returns a copy with the complete state of every simulation.

        Returns
        -------
        Simulations
            Independent of these.
        """
        made = type(self).__new__(type(self))
        made._native, made._start, made._bodies = self._native.copy(), self._start, self._bodies
        return made

    def __copy__(self) -> Simulations:
        return self.copy()

    def __deepcopy__(self, memo: dict[int, Any]) -> Simulations:
        return self.copy()

    def __reduce__(self) -> Never:
        raise _unpicklable("simulations")

    def __repr__(self) -> str:
        return f"<Simulations: {len(self)}, {int(self.ended.sum())} ended>"


def _unpicklable(what: str) -> ArgumentError:
    return ArgumentError(
        f"{what} cannot be pickled: pickle the scenario, and start the simulation in the process that steps it"
    )
