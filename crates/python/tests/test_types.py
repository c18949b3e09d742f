"""Types: stubs against the module, strict checks of package and examples; documented names."""

from __future__ import annotations

import importlib.util
import inspect
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import barrelstack
from conftest import ROOT

PACKAGE = ROOT / "crates" / "python"


def mypy(*words: str) -> None:
    pytest.importorskip("mypy", reason="no mypy")
    done = subprocess.run([sys.executable, "-m", *words], cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


def test_the_stubs_say_what_the_module_holds() -> None:
    mypy("mypy.stubtest", "barrelstack._native", "--concise")


def test_the_types_of_fields_are_those_of_the_schema() -> None:
    spec = importlib.util.spec_from_file_location("fields_writer", PACKAGE / "fields.py")
    assert spec is not None
    assert spec.loader is not None
    writer = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(writer)
    written = (PACKAGE / "python" / "barrelstack" / "fields.py").read_text(encoding="utf-8")
    assert written == writer.module(), "run `python crates/python/fields.py` with the present package installed"


#: A script of a user, whose types are checked.
SCRIPT = """\
from barrelstack import Record, Scenario
from barrelstack.fields import MotionFields, ScenarioFields

motion: MotionFields = {"sine": {"amplitude": "5 cm"}}
fields: ScenarioFields = {
    "extends": "candia-8-barrels",
    "stack": {"levels": 2},
    "interface": {"rack-ground": {"friction": {"coefficient": 0.4}}},
    "run": {"duration": "1 s"},
}
fields["motion"] = motion
run = Scenario(fields).run(variants=0)
peak = float(run.histories["B2.1_displacement_x"].max())
print(run.outcome.kind, round(peak, 3), Record.bundled().name)
"""


def checked_scripts(folder: Path) -> tuple[Path, Path]:
    """Returns a script of a user without and with a misspelled field."""
    right, wrong = folder / "right.py", folder / "wrong.py"
    right.write_text(SCRIPT, encoding="utf-8")
    wrong.write_text(SCRIPT.replace('"levels"', '"level"'), encoding="utf-8")
    return right, wrong


def test_a_script_of_a_user_is_strictly_typed_and_its_mistakes_are_found(tmp_path: Path) -> None:
    pytest.importorskip("mypy", reason="no mypy")
    words = [sys.executable, "-m", "mypy", "--strict", "--cache-dir", str(tmp_path / "cache")]
    right, wrong = checked_scripts(tmp_path)
    for path, status in ((right, 0), (wrong, 1)):
        done = subprocess.run([*words, str(path)], cwd=tmp_path, capture_output=True, text=True, check=False)
        assert done.returncode == status, done.stdout + done.stderr
    assert 'Extra key "level"' in done.stdout, done.stdout
    done = subprocess.run([sys.executable, str(right)], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("stable")


def test_package_and_examples_are_strictly_typed(tmp_path: Path) -> None:
    there = importlib.util.find_spec("gymnasium") is not None
    paths = (PACKAGE / "examples").glob("*.py")
    examples = sorted(str(path) for path in paths if there or path.stem != "environment")
    assert len(examples) >= 5
    mypy("mypy", "--strict", "--cache-dir", str(tmp_path), str(PACKAGE / "python" / "barrelstack"), *examples)


@pytest.mark.heavy
def test_another_checker_knows_every_public_type(tmp_path: Path) -> None:
    pytest.importorskip("pyright", reason="no pyright")
    words = [sys.executable, "-m", "pyright", "--verifytypes", "barrelstack", "--ignoreexternal"]
    home = Path(sys.executable).parent
    environment = {**os.environ, "PATH": f"{home}{os.pathsep}{os.environ['PATH']}", "VIRTUAL_ENV": str(home.parent)}
    done = subprocess.run(words, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "Type completeness score: 100%" in done.stdout, done.stdout
    (tmp_path / "pyrightconfig.json").write_text('{"typeCheckingMode": "strict"}', encoding="utf-8")
    for path, status in zip(checked_scripts(tmp_path), (0, 1), strict=True):
        words = [sys.executable, "-m", "pyright", str(path)]
        done = subprocess.run(words, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False)
        assert done.returncode == status, done.stdout + done.stderr
    examples = tmp_path / "examples"
    shutil.copytree(PACKAGE / "examples", examples, ignore=shutil.ignore_patterns("__pycache__"))
    words = [sys.executable, "-m", "pyright", str(examples)]
    done = subprocess.run(words, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


def test_everything_public_is_documented() -> None:
    for name in barrelstack.__all__:
        thing = getattr(barrelstack, name)
        if name == "__version__":
            continue
        assert inspect.getdoc(thing), name
        if inspect.isclass(thing):
            for member, value in vars(thing).items():
                if callable(value) and not member.startswith("_") and thing.__module__.startswith("barrelstack."):
                    assert inspect.getdoc(value), f"{name}.{member}"


@pytest.mark.parametrize("path", sorted((PACKAGE / "examples").glob("*.py")), ids=lambda path: path.stem)
def test_examples_run(path: Path, tmp_path: Path) -> None:
    arguments = []
    if path.stem == "environment":
        pytest.importorskip("gymnasium", reason="no gymnasium")
        # Seconds of training.
        arguments = ["2"]
    words = [sys.executable, "-W", "ignore", str(path), *arguments]
    done = subprocess.run(words, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stdout


@pytest.mark.parametrize("page", ["README.md", "docs/index.md"])
def test_the_example_of_a_first_page_runs(page: str, tmp_path: Path) -> None:
    pytest.importorskip("polars", reason="no polars")
    text = (ROOT / page).read_text(encoding="utf-8")
    blocks = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    assert len(blocks) == 1
    environment = {**os.environ, "MPLBACKEND": "Agg"}
    words = [sys.executable, "-W", "ignore", "-c", blocks[0]]
    done = subprocess.run(words, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
