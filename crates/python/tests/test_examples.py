"""Examples in docstrings: every public name has one, and all of them run."""

from __future__ import annotations

import doctest
import inspect
import warnings
from pathlib import Path
from typing import Any

import pytest

import barrelstack

NAMES = [name for name in barrelstack.__all__ if name != "__version__"]
FLAGS = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE


def docstrings(name: str) -> dict[str, str]:
    """Returns the docstrings of a public name, and of its members if it is a class."""
    thing = getattr(barrelstack, name)
    found = {name: inspect.getdoc(thing) or ""}
    if inspect.isclass(thing):
        for member, value in vars(thing).items():
            raw = getattr(value, "func", value)
            if not member.startswith("_") and (callable(raw) or isinstance(raw, (property, classmethod, staticmethod))):
                found[f"{name}.{member}"] = inspect.getdoc(getattr(raw, "__func__", raw)) or ""
    return found


@pytest.mark.parametrize("name", NAMES)
def test_every_public_name_has_an_example(name: str) -> None:
    assert ">>> " in docstrings(name)[name]


#: Names whose examples take long.
LONG = ("RockScore", "score")


@pytest.mark.parametrize("name", [pytest.param(one, marks=pytest.mark.heavy if one in LONG else ()) for one in NAMES])
def test_the_examples_run(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    public: dict[str, Any] = {one: getattr(barrelstack, one) for one in NAMES}
    for place, text in docstrings(name).items():
        test = doctest.DocTestParser().get_doctest(text, {**public, "barrelstack": barrelstack}, place, None, None)
        report: list[str] = []
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", barrelstack.BarrelstackWarning)
            result = doctest.DocTestRunner(optionflags=FLAGS, verbose=False).run(test, out=report.append)
        assert result.failed == 0, "".join(report)
