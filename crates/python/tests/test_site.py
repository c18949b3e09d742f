"""The site: built with warnings as errors, its notebooks and research tasks executed, its references complete."""

from __future__ import annotations

import ast
import json
import os
import re
import subprocess
import sys
import tokenize
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


TASKS = sorted((ROOT / "docs" / "research").glob("*.py"))


def code_lines(text: str) -> set[int]:
    """Returns the numbers of the lines with code, imports not counted."""
    found: set[int] = set()
    for token in tokenize.generate_tokens(iter(text.splitlines(keepends=True)).__next__):
        if token.string.strip() and token.type not in (tokenize.COMMENT, tokenize.ENDMARKER):
            found |= set(range(token.start[0], token.end[0] + 1))
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, (ast.Import, ast.ImportFrom)):
            found -= set(range(node.lineno, (node.end_lineno or node.lineno) + 1))
    return found


def test_lines_of_code_are_counted_without_imports_and_comments() -> None:
    assert code_lines("import os\n\n# a\nx = [\n    1,\n]  # b\nassert x\n") == {4, 5, 6, 7}
    assert code_lines("from os import (\n    path,\n)\nif 1:\n    x = 1\n") == {4, 5}


def test_there_are_sixteen_research_tasks() -> None:
    assert len(TASKS) == 16


@pytest.mark.parametrize("path", TASKS, ids=lambda path: path.stem)
def test_a_research_task_is_ten_lines_that_check_themselves(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    counted = code_lines(text)
    assert len(counted) <= 10
    assert all(len(line) <= 120 for number, line in enumerate(text.splitlines(), 1) if number in counted)
    # Two statements on one line would evade the count.
    statements = [node for node in ast.walk(ast.parse(text)) if isinstance(node, ast.stmt)]
    assert len({node.lineno for node in statements}) == len(statements)
    assert any(isinstance(node, ast.Assert) for node in statements)


@pytest.mark.parametrize("path", TASKS, ids=lambda path: path.stem)
def test_a_research_task_runs(path: Path, site: Path) -> None:
    names = [node.module or "" for node in ast.walk(ast.parse(path.read_text())) if isinstance(node, ast.ImportFrom)]
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        names += [name.name for name in node.names] if isinstance(node, ast.Import) else []
    for name in names:
        pytest.importorskip(name.split(".")[0], reason=f"no {name.split('.')[0]}")
    book = json.loads((site / "source" / "research" / f"{path.stem}.ipynb").read_text(encoding="utf-8"))
    cells = [cell for cell in book["cells"] if cell["cell_type"] == "code"]
    assert all(cell["execution_count"] for cell in cells)
    assert any(cell["outputs"] for cell in cells)
    page = (site / "html" / "research" / f"{path.stem}.html").read_text(encoding="utf-8")
    assert f'href="{path.stem}.ipynb"' in page
    assert f'href="{path.stem}.html"' in (site / "html" / "research" / "index.html").read_text(encoding="utf-8")


def test_the_page_of_the_animation_shows_it(site: Path) -> None:
    page = (site / "html" / "research" / "09-animation.html").read_text(encoding="utf-8")
    (shown,) = re.findall(r'<iframe src="([^"]+)"', page)
    assert 'id="barrelstack-data"' in (site / "html" / "research" / shown).read_text(encoding="utf-8")


def test_the_gallery_shows_ten_figures_with_their_code(site: Path) -> None:
    scripts = sorted((ROOT / "docs" / "gallery").glob("*.py"))
    assert len(scripts) == 10
    page = (site / "html" / "gallery.html").read_text(encoding="utf-8")
    assert page.count("<pre><code") == 10
    for path in scripts:
        assert f'src="gallery/{path.stem}.png"' in page
        assert (site / "html" / "gallery" / f"{path.stem}.png").stat().st_size > 5000


def test_no_page_names_a_folder_of_this_machine(site: Path) -> None:
    for page in [*(site / "source").rglob("*.md"), *(site / "source" / "research").glob("*.ipynb")]:
        text = page.read_text(encoding="utf-8")
        assert str(Path(sys.prefix)) not in text, page
        assert "ipykernel_" not in text, page


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
    written = sum(len(re.findall("Examples\n +--", path.read_text(encoding="utf-8"))) for path in sources)
    # The class of observed states is part of the native module.
    written += ">>> " in (barrelstack.Glance.__doc__ or "")
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
