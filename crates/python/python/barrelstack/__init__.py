"""Wine-barrel stacks in earthquakes, from Python.

::

    Scenario ── run ──▶ Run          a stack and its ground motion ─▶ outcome, histories, report
    Record   ──────────┘             strong ground motion: read, made from arrays, processed, scaled, measured
    Scenario ── run_in_space ─▶ SpatialRun   the same in three dimensions, under all motion components
    Scenario ── simulation ─▶ Simulation     step by step, with forces of a controller; simulations: many together
    ensemble ──────────▶ Table       many cases at once
    Study    ── run ──▶ Fragility    hundreds of cases in a folder, on one machine or on many
    Scene    ── run ──▶ Run          any planar bodies
    read_folder ── select ─▶ Selection       many records; a set of them for a target
    compare, heights, protect, score ─▶ Page comparison of runs; safe heights; best protections; a score
    Calibration.friction, …  ──▶ Page        contact parameters from your own tests

All numbers are SI: m, s, kg, N, rad; z is up. Quantities as input carry their unit as text (``"60 cm/s"``).
"""

from __future__ import annotations

import json
from typing import Any

from . import _native
from ._calibration import Calibration, Estimate
from ._decide import (
    Comparison,
    Difference,
    Heights,
    Protections,
    Reproduction,
    RockScore,
    compare,
    heights,
    protect,
    reproduce,
    score,
)
from ._ensemble import ensemble
from ._errors import (
    ArgumentError,
    BarrelstackWarning,
    Error,
    FileError,
    MissingPackageError,
    NoFieldError,
    NoItemError,
    RecordError,
    RunError,
    ScenarioError,
    StudyError,
    guard,
)
from ._page import Page
from ._pictured import Animation
from ._record import Channel, Intensity, Record
from ._records import Selection, intensities, read_folder, select
from ._run import Demands, Envelope, Force, Frames, Glance, Histories, Outcome, Run
from ._scenario import Scenario, Section
from ._scene import Scene
from ._simulation import Contacts, ElementForce, Energy, Simulation, Simulations, State
from ._space import OutcomeInSpace, Poses, SpatialRun
from ._study import Chunk, Curve, Fragility, Hunts, Study
from ._table import Column, Table

__version__ = _native.VERSION

__all__ = [
    "Animation",
    "ArgumentError",
    "BarrelstackWarning",
    "Calibration",
    "Channel",
    "Chunk",
    "Column",
    "Comparison",
    "Contacts",
    "Curve",
    "Demands",
    "Difference",
    "ElementForce",
    "Energy",
    "Envelope",
    "Error",
    "Estimate",
    "FileError",
    "Force",
    "Fragility",
    "Frames",
    "Glance",
    "Heights",
    "Histories",
    "Hunts",
    "Intensity",
    "MissingPackageError",
    "NoFieldError",
    "NoItemError",
    "Outcome",
    "OutcomeInSpace",
    "Page",
    "Poses",
    "Protections",
    "Record",
    "RecordError",
    "Reproduction",
    "RockScore",
    "Run",
    "RunError",
    "Scenario",
    "ScenarioError",
    "Scene",
    "Section",
    "Selection",
    "Simulation",
    "Simulations",
    "SpatialRun",
    "State",
    "Study",
    "StudyError",
    "Table",
    "__version__",
    "compare",
    "ensemble",
    "formats",
    "heights",
    "intensities",
    "protect",
    "read_folder",
    "reproduce",
    "scenarios",
    "schema",
    "score",
    "select",
    "studies",
]


def scenarios() -> dict[str, str]:
    """Returns the bundled scenarios.

    Returns
    -------
    dict
        The text of each scenario by its name, with all comments, to start from.

    Examples
    --------
    >>> "demo-napa" in scenarios()
    True
    """
    return dict(_native.scenarios())


def schema(of: str = "scenario") -> dict[str, Any]:
    """Returns a JSON Schema (2020-12).

    Parameters
    ----------
    of
        ``"scenario"`` or ``"study"`` for the schema of such files, ``"summary"`` for the schema of :attr:`Run.summary`.

    Returns
    -------
    dict

    Examples
    --------
    >>> schema("study")["title"]
    'barrelstack study'
    """
    found: dict[str, Any] = json.loads(_native.schema(of))
    return found


def studies() -> dict[str, str]:
    """Returns the bundled studies.

    Returns
    -------
    dict
        The text of each study by its name, with all comments.

    Examples
    --------
    >>> studies()["napa-four-levels"].splitlines()[0]
    '# How strong must the ground shake to bring down eight barrels on four levels?'
    """
    return dict(_native.studies())


def formats() -> dict[str, str]:
    """Returns the supported formats of strong-motion files.

    Returns
    -------
    dict
        The publisher of each format by the name of the format.

    Examples
    --------
    >>> formats()["peer"]
    'PEER AT2 (NGA, NGA-West2, PEER 2000)'
    """
    return dict(_native.formats())


guard(globals(), __all__)
