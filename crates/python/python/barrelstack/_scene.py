"""Free scenes: any planar bodies, for your own checks."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from ._progress import Progress
from ._record import Record
from ._run import Glance, Run
from ._scenario import Scenario

__all__ = ["Scene"]


class Scene:
    """A free scene, built body by body.

    Parameters
    ----------
    title
        Title, in one line.
    **tables
        Other tables of a scenario, such as ``run={"duration": "2 s"}`` or ``motion={"bundled": "napa-college-2014"}``.

    Examples
    --------
    >>> scene = Scene("A block slides", run={"duration": "1 s"})
    >>> shape = {"type": "rectangle", "width": "1 m", "height": "0.3 m"}
    >>> start = {"position": ["0 m", "0.15 m"], "velocity": ["1 m/s", "0 m/s"]}
    >>> scene = scene.body("block", shape=shape, mass="100 kg", nodes="corners", **start)
    >>> friction = {"coefficient": 0.3}
    >>> scene = scene.interface("block", "ground", stiffness="5 MN/m", damping="10 kN s/m", friction=friction)
    >>> scene.run().outcome.kind
    'not-judged'
    """

    def __init__(self, title: str = "Free scene", **tables: Any) -> None:
        self.title = title
        self.tables = tables
        self.bodies: list[dict[str, Any]] = []
        self.interfaces: list[dict[str, Any]] = []
        self.elements: list[dict[str, Any]] = []

    def body(
        self,
        name: str,
        *,
        shape: Mapping[str, Any],
        mass: Any,
        position: Sequence[Any],
        **fields: Any,
    ) -> Scene:
        """Adds a body.

        Parameters
        ----------
        name
            Name of the body in results.
        shape
            The fields of the shape, such as ``{"type": "circle", "radius": "35 cm"}``, or of its ``parts``.
        mass
            Mass with its unit.
        position
            Initial position of the reference point of the shape, x and z with their units; z is up and 0 on the
            ground.
        **fields
            Other fields of a body: ``angle``, ``velocity``, ``spin``, ``nodes``, ``group``.

        Returns
        -------
        Scene
            This scene.
        """
        place = list(position)
        self.bodies.append({"name": name, "shape": dict(shape), "mass": mass, "position": place, **fields})
        return self

    def interface(self, first: str, second: str, **fields: Any) -> Scene:
        """Sets the contact laws of two bodies, or kinds of bodies.

        Parameters
        ----------
        first, second
            Names of the bodies or kinds; ``"ground"`` is the ground.
        **fields
            The fields of an interface: ``stiffness``, ``damping``, ``friction``, ``normal``.

        Returns
        -------
        Scene
            This scene.
        """
        self.interfaces.append({"between": [first, second], **fields})
        return self

    def element(self, name: str, kind: str, first: str, second: str, *, stiffness: Any, **fields: Any) -> Scene:
        """Adds a force element between two bodies.

        Parameters
        ----------
        name
            Name of the element in results: ``run.summary["elements"]``.
        kind
            ``"strap"``, which only pulls; ``"rod"``, which keeps a distance; ``"guide"``, a spring with stops along an
            axis of the first body.
        first, second
            Names of the bodies; ``"ground"`` is the ground.
        stiffness
            Stiffness with its unit.
        **fields
            ``at`` and ``to``, the attachment points on the bodies, from the reference points of their shapes;
            ``damping``; for a strap ``length``, ``yields_at``, ``strength``; for a rod ``length``, ``sway_damping``;
            for a guide ``axis``, ``gap`` with ``stop_stiffness`` and ``stop_damping``, ``strength``, ``reach``.

        Returns
        -------
        Scene
            This scene.

        Examples
        --------
        >>> scene = Scene("A ball on a strap", run={"duration": "0.1 s", "settle": False})
        >>> shape = {"type": "circle", "radius": "10 cm"}
        >>> scene = scene.body("ball", shape=shape, mass="5 kg", position=["0 m", "1 m"])
        >>> scene = scene.element("strap", "strap", "ground", "ball", stiffness="10 kN/m", at=["0 m", "2 m"], length="0.9 m")
        >>> scene.run().summary["elements"][0]["name"]
        'strap'
        """
        between = [first, second]
        self.elements.append({"name": name, "kind": kind, "between": between, "stiffness": stiffness, **fields})
        return self

    def scenario(self) -> Scenario:
        """Returns the scene as a scenario.

        Returns
        -------
        Scenario

        Raises
        ------
        ScenarioError
            At the first invalid field; ``value`` has its path, with list items counted from 1.
        """
        tree = {"title": self.title, "kind": "free", **self.tables}
        tree |= {"body": self.bodies, "interface": self.interfaces, "element": self.elements}
        return Scenario({key: value for key, value in tree.items() if value != []}, name=self.title)

    def run(self, record: Record | None = None, progress: Progress = None) -> Run:
        """Runs the scene, like :meth:`Scenario.run`.

        Parameters
        ----------
        record
            A record, or a path, for the ground motion.
        progress
            As for :meth:`Scenario.run`.

        Returns
        -------
        Run
        """
        return self.scenario().run(record, progress=progress)

    def observe(self, look: Callable[[Glance], object], every: int = 100) -> Run:
        """Runs the scene with an observer, like :meth:`Scenario.observe`.

        Parameters
        ----------
        look
            Called every few steps; a true result ends the run.
        every
            Number of accepted steps between two calls.

        Returns
        -------
        Run
        """
        return self.scenario().observe(look, every)
