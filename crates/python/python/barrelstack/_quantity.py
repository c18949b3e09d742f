"""Converts quantities of Pint and astropy to texts with units, as the library reads them."""

from __future__ import annotations

from fractions import Fraction
from typing import Any, Protocol, cast, runtime_checkable

__all__ = ["AstropyQuantity", "PintQuantity", "plain"]


@runtime_checkable
class PintQuantity(Protocol):
    """A quantity of Pint."""

    magnitude: Any

    def to_base_units(self) -> Any: ...


@runtime_checkable
class AstropyQuantity(Protocol):
    """A quantity of astropy."""

    value: Any
    si: Any


#: Base units by their names in Pint and astropy.
_BASE = {
    "meter": "m",
    "m": "m",
    "kilogram": "kg",
    "kg": "kg",
    "gram": "gram",
    "second": "s",
    "s": "s",
    "radian": "rad",
    "rad": "rad",
}


def _written(value: float, powers: dict[str, Fraction | float]) -> str:
    unit = " ".join(
        _BASE[name] if power == 1 else f"{_BASE[name]}^{float(power):g}" for name, power in powers.items()
    )
    return f"{float(value)!r} {unit}".strip()


def _of_pint(quantity: Any) -> str:
    # Pint has no fixed system: its base unit of mass may be the gram or the kilogram.
    base = quantity.to_base_units()
    return _written(base.magnitude, dict(base.unit_items()))


def _of_astropy(quantity: Any) -> str:
    si = quantity.si
    powers = {unit.name: power for unit, power in zip(si.unit.bases, si.unit.powers, strict=True)}
    return _written(si.value * si.unit.scale, powers)


def plain(value: Any) -> Any:
    """Converts a value for the library: quantities become texts with units, also inside containers.

    Parameters
    ----------
    value
        A text, number, bool, list or dict, or a quantity of Pint or astropy in any of them.

    Returns
    -------
    object
        The value without types of other packages.

    Raises
    ------
    TypeError
        When a quantity has a base unit that no field of a scenario has, such as the kelvin.
    """
    if isinstance(value, dict):
        return {str(key): plain(item) for key, item in cast("dict[object, object]", value).items()}
    if isinstance(value, (list, tuple)):
        return [plain(item) for item in cast("list[object]", value)]
    if isinstance(value, float):
        # The number of a NumPy float, whose text names its type.
        return float(value)
    if isinstance(value, (str, bool, int)):
        return value
    try:
        if isinstance(value, PintQuantity):
            return _of_pint(value)
        if isinstance(value, AstropyQuantity):
            return _of_astropy(value)
    except KeyError as unit:
        raise TypeError(f"no field of a scenario has the unit {unit}") from None
    # Numbers and bools of NumPy.
    item = getattr(value, "item", None)
    return plain(item()) if callable(item) and getattr(value, "ndim", 0) == 0 else value


def literal(value: Any) -> str:
    """Formats a value as TOML, for an override.

    Parameters
    ----------
    value
        As for :func:`plain`.

    Returns
    -------
    str
        TOML on one line.
    """
    import json

    value = plain(value)
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, list):
        return "[" + ", ".join(literal(item) for item in cast("list[object]", value)) + "]"
    if isinstance(value, dict):
        given = cast("dict[str, object]", value)
        pairs = (f"{json.dumps(key)} = {literal(item)}" for key, item in given.items())
        return "{ " + ", ".join(pairs) + " }"
    raise TypeError(f"a scenario contains texts, numbers, booleans, lists and dicts, not a {type(value).__name__}")
