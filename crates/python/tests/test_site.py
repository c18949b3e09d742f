"""The site: built with warnings as errors, its notebooks executed, its references complete."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

import barrelstack
from conftest import ROOT


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    for needed in ("mkdocs", "nbclient", "nbformat", "ipykernel", "matplotlib", "polars", "pandas", "distributed"):
        pytest.importorskip(needed, reason=f"no {needed}")
    kept = os.environ.get("BARRELSTACK_SITE")
    folder = Path(kept) if kept else tmp_path_factory.mktemp("site")
    # The extra "docs" does not install pyarrow.
    hidden = tmp_path_factory.mktemp("hidden")
    (hidden / "pyarrow.py").write_text("raise ImportError", encoding="utf-8")
    environment = {**os.environ, "CARGO_TARGET_DIR": str(folder), "MPLBACKEND": "Agg", "PYTHONPATH": str(hidden)}
    words = [sys.executable, str(ROOT / "docs" / "build.py")]
    done = subprocess.run(words, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return folder / "site"


def test_the_site_is_built_without_a_warning(site: Path) -> None:
    pages = {path.relative_to(site / "html").as_posix() for path in (site / "html").glob("**/*.html")}
    assert {"index.html", "theory.html", "tutorial.html", "reference/package.html"} <= pages


def test_every_notebook_runs_and_draws(site: Path) -> None:
    books = sorted((ROOT / "docs" / "notebooks").glob("*.ipynb"))
    assert len(books) == 10
    for book in books:
        assert list((site / "source" / "notebooks").glob(f"{book.stem}-*.png")), book.stem


def test_the_reference_has_every_public_name(site: Path) -> None:
    text = (site / "source" / "reference" / "package.md").read_text(encoding="utf-8")
    for name in barrelstack.__all__:
        assert name == "__version__" or f"## `{name}" in text, name
    assert "### `Scenario.run(" in text
    assert "*Raises*" in text


def test_the_reference_shows_every_example_as_code(site: Path) -> None:
    text = (site / "source" / "reference" / "package.md").read_text(encoding="utf-8")
    blocks = re.findall(r"^```python\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)
    sources = (ROOT / "crates" / "python" / "python" / "barrelstack").glob("*.py")
    written = sum(path.read_text(encoding="utf-8").count("Examples\n    --") for path in sources)
    assert len(blocks) == written
    assert written >= 10
    assert all(">>> " in block for block in blocks)
    assert len(re.findall("^``[^`]", text, re.MULTILINE)) == 0
    page = (site / "html" / "reference" / "package.html").read_text(encoding="utf-8")
    assert page.count("&gt;&gt;&gt;") >= written


def test_every_file_that_the_theory_manual_names_is_there() -> None:
    text = (ROOT / "docs" / "theory.md").read_text(encoding="utf-8")
    named = set(re.findall(r"`(crates/[\w/.-]+)`", text))
    assert len(named) > 20
    for path in named:
        assert (ROOT / path).exists(), path
