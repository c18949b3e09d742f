"""Builds the site from pages, references generated from the code, executed notebooks and figures; warnings are errors."""

from __future__ import annotations

import ast
import base64
import html
import importlib.util
import inspect
import json
import os
import re
import runpy
import shutil
import subprocess
import sys
import tempfile
import time
import tokenize
import warnings
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import nbclient
import nbformat

import barrelstack
from barrelstack import _native

DOCS = Path(__file__).resolve().parent
TARGET = Path(os.environ.get("CARGO_TARGET_DIR", DOCS.parent / "target")) / "site"
SECTION = re.compile(r"^(Parameters|Returns|Raises|Warns|Notes|Examples|Attributes)\n-+\n", re.MULTILINE)


def items(text: str) -> str:
    """Converts the entries of a numpydoc section to a list."""
    lines = []
    for line in text.splitlines():
        if line and not line.startswith(" "):
            lines.append(f"- **{line.strip()}**")
        elif line.strip():
            lines.append(f"  {line.strip()}")
    return "\n".join(lines)


def inline(text: str) -> str:
    """Converts references and literals of reStructuredText to Markdown; not for code, whose fences look like literals."""
    text = re.sub(r":(?:meth|class|func|attr|mod):`([^`]+)`", r"`\1`", text)
    return re.sub(r"``([^`]+)``", r"`\1`", text)


def docstring(text: str) -> str:
    """Converts a numpydoc docstring to Markdown."""
    parts = SECTION.split(re.sub(r"^::\n", "", text, flags=re.MULTILINE))
    out = [inline(parts[0].strip())]
    for name, body in zip(parts[1::2], parts[2::2], strict=True):
        body = body.strip("\n")
        if name == "Examples":
            out.append(f"```python\n{inspect.cleandoc(body)}\n```")
        elif name == "Notes":
            out.append(inline(body.strip()))
        else:
            out.append(f"*{name}*\n\n{inline(items(body))}")
    return "\n\n".join(out)


def signature(thing: Any) -> str:
    """Returns the signature with names and defaults, without types, which are in the stubs."""
    parameters = []
    for parameter in inspect.signature(thing).parameters.values():
        if parameter.name not in ("self", "cls"):
            parameters.append(str(parameter.replace(annotation=inspect.Parameter.empty)))
    return f"({', '.join(parameters)})"


def members(thing: Any) -> list[str]:
    """Returns the documentation of the methods and properties of a class, in their order."""
    found = []
    private = [one for one in thing.__mro__[1:] if one.__module__.startswith("barrelstack.")]
    hidden = [one for one in private if one.__name__ not in barrelstack.__all__]
    for name, value in [item for one in [thing, *hidden] for item in vars(one).items()]:
        if name.startswith("_"):
            continue
        raw = value.__func__ if isinstance(value, (classmethod, staticmethod)) else value
        told = inspect.getdoc(raw if not hasattr(value, "func") else value.func)
        if told is None or type(value).__name__ == "_tuplegetter":
            continue
        call = signature(raw) if inspect.isfunction(raw) else ""
        found.append(f"### `{thing.__name__}.{name}{call}`\n\n{docstring(told)}")
    return found


def fields(thing: Any) -> str:
    """Returns the fields of a named tuple with their comments in the source."""
    if not hasattr(thing, "_fields"):
        return ""
    told, rows = [], []
    for line in inspect.getsource(thing).splitlines():
        line = line.strip()
        if line.startswith("#:"):
            told.append(line[2:].strip())
        elif re.match(r"\w+: ", line):
            name = line.split(":")[0]
            if name in thing._fields:
                rows.append(f"- `{name}`{': ' + ' '.join(told) if told else ''}")
            told = []
    return "\n".join(rows)


def api() -> str:
    """Returns the reference of the package."""
    text = ["# The package\n", docstring(inspect.getdoc(barrelstack) or "")]
    for name in barrelstack.__all__:
        thing = getattr(barrelstack, name)
        if inspect.isclass(thing):
            own = inspect.getdoc(thing) or ""
            text.append(f"## `{name}`\n\n{docstring(own)}\n\n{fields(thing)}".rstrip())
            text += members(thing)
        elif callable(thing):
            text.append(f"## `{name}{signature(thing)}`\n\n{docstring(inspect.getdoc(thing) or '')}")
    return "\n\n".join(text) + "\n"


def summary() -> str:
    """Returns the reference of the summary of a run."""
    rows = [f"| `{path}` | {unit} | {meaning} |" for path, unit, meaning in _native.fields()]
    head = "# The summary of a run\n\nThe keys that `barrelstack run --json` prints and `Run.summary` contains.\n\n"
    return head + "| key | unit | meaning |\n|---|---|---|\n" + "\n".join(rows) + "\n"


def code(text: str) -> str:
    """Escapes angle brackets of text that is not markup."""
    return re.sub(r"<(?=[a-z])", "&lt;", text)


def cells(path: Path) -> list[tuple[str, str]]:
    """Returns the cells of a script, each with its kind; a line ``# %%`` begins code, ``# %% [markdown]`` text."""
    found = []
    for part in re.split(r"^# %%", path.read_text(encoding="utf-8"), flags=re.MULTILINE)[1:]:
        head, _, body = part.partition("\n")
        if head.strip() == "[markdown]":
            found.append(("markdown", re.sub(r"^# ?", "", body.strip(), flags=re.MULTILINE)))
        else:
            found.append(("code", body.strip()))
    return found


def imported(path: Path) -> list[str]:
    """Returns the packages that a script imports, sorted."""
    names: set[str] = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            names |= {name.name.split(".")[0] for name in node.names}
        elif isinstance(node, ast.ImportFrom):
            names.add((node.module or "").split(".")[0])
    return sorted(names, key=str.lower)


def missing(path: Path) -> list[str]:
    """Returns the packages that a script imports and that are not installed."""
    return [name for name in imported(path) if importlib.util.find_spec(name) is None]


def lines(path: Path) -> int:
    """Returns the number of lines with code of a script, imports not counted."""
    text = path.read_text(encoding="utf-8")
    blank = {tokenize.COMMENT, tokenize.NL, tokenize.NEWLINE, tokenize.ENDMARKER, tokenize.INDENT, tokenize.DEDENT}
    found: set[int] = set()
    for token in tokenize.generate_tokens(iter(text.splitlines(keepends=True)).__next__):
        if token.type not in blank:
            found |= set(range(token.start[0], token.end[0] + 1))
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, (ast.Import, ast.ImportFrom)):
            found -= set(range(node.lineno, (node.end_lineno or node.lineno) + 1))
    return len(found)


def book_of(path: Path) -> Any:
    """Returns a notebook, or a script as a notebook."""
    if path.suffix == ".ipynb":
        return nbformat.read(path, as_version=4)
    make = {"markdown": nbformat.v4.new_markdown_cell, "code": nbformat.v4.new_code_cell}
    book = nbformat.v4.new_notebook(cells=[make[kind](source) for kind, source in cells(path)])
    for number, cell in enumerate(book.cells):
        cell["id"] = f"c{number}"
    return book


def output_text(output: Any) -> str:
    """Returns the text of an output; of warnings only their sentences, since their places name files of this machine."""
    text: str = output.get("text", output.get("data", {}).get("text/plain", ""))
    if output.get("name") == "stderr":
        text = "\n".join(f"Warning: {sentence}" for sentence in re.findall(r"Warning: (.*)", text))
        output["text"] = text
    return text.rstrip()


def notebook(path: Path, out: Path) -> str:
    """Executes a notebook or a script and writes it as a page: its text, its code, and the output of its cells.

    A script whose packages are not all installed is written without output. Returns a line for the log.
    """
    begin, book, lacking = time.monotonic(), book_of(path), missing(path) if path.suffix == ".py" else []
    if not lacking:
        with tempfile.TemporaryDirectory() as place:
            where = {"metadata": {"path": place}}
            nbclient.NotebookClient(book, timeout=600, kernel_name="python3", resources=where).execute()
    text = []
    for number, cell in enumerate(book.cells):
        source = cell["source"]
        if cell["cell_type"] == "markdown":
            text.append(source)
            continue
        text.append(f"```python\n{source}\n```")
        for at, output in enumerate(cell.get("outputs", [])):
            data = output.get("data", {})
            kind = next((kind for kind in ("png", "gif") if f"image/{kind}" in data), None)
            if kind:
                picture = f"{path.stem}-{number}-{at}.{kind}"
                (out / picture).write_bytes(base64.b64decode(data[f"image/{kind}"]))
                text.append(f"![Figure of this cell]({picture})")
            elif framed := re.match('<iframe srcdoc="([^"]*)"', str(data.get("text/html", ""))):
                page = f"{path.stem}-{number}-{at}.html"
                (out / page).write_text(html.unescape(framed[1]), encoding="utf-8")
                text.append(f'<iframe src="{page}" title="Output of this cell" width="100%" height="720"></iframe>')
            elif written := output_text(output):
                text.append(f"```text\n{written}\n```")
    if lacking:
        text.append(f"Not executed here, because these packages are not installed: {', '.join(lacking)}.")
    if path.suffix == ".py":
        nbformat.write(book, out / f"{path.stem}.ipynb")
        shutil.copy(path, out / path.name)
        text.append(f"To run it: [the script]({path.name}), [the executed notebook]({path.stem}.ipynb).")
    (out / f"{path.stem}.md").write_text("\n\n".join(text) + "\n", encoding="utf-8")
    if lacking:
        return f"{path.name}: not executed, no {', '.join(lacking)}"
    return f"{path.name}: {time.monotonic() - begin:.1f} s"


def tasks(scripts: list[Path]) -> str:
    """Returns the table of research tasks."""
    rows = []
    for path in scripts:
        title = re.sub("^# ", "", cells(path)[0][1].splitlines()[0])
        packages = [name for name in imported(path) if name not in (*sys.stdlib_module_names, "barrelstack")]
        rows.append(f"| [{title}]({path.stem}.md) | {lines(path)} | {', '.join(packages)} |")
    head = (
        "# Research tasks\n\nEach task takes at most ten lines beyond its imports, and checks its own result. The numbers"
        " of motions and variants are small, so that each runs within seconds; raise them for your work.\n\n"
        "| task | lines | other packages |\n| :--- | :--- | :--- |\n"
    )
    return head + "\n".join(rows) + "\n"


def gallery(out: Path) -> str:
    """Draws the figures of the gallery and returns their page, with the code of each."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    text = ["# Gallery\n\nTen figures, each with all of its code."]
    home = os.getcwd()
    for path in sorted((DOCS / "gallery").glob("*.py")):
        source = path.read_text(encoding="utf-8")
        title, _, rest = (ast.get_docstring(ast.parse(source)) or "").partition("\n")
        with tempfile.TemporaryDirectory() as place, warnings.catch_warnings():
            warnings.simplefilter("ignore", barrelstack.BarrelstackWarning)
            os.chdir(place)
            try:
                runpy.run_path(str(path))
            finally:
                os.chdir(home)
        plt.savefig(out / f"{path.stem}.png", dpi=100)
        plt.close("all")
        code_only = source.split('"""', 2)[2].strip()
        text.append(f"## {title.rstrip('.')}\n\n{rest.strip()}\n\n![{title}]({out.name}/{path.stem}.png)\n\n```python\n{code_only}\n```")
    return "\n\n".join(text) + "\n"


def main() -> int:
    """Collects the pages and builds the site."""
    # The tests may set another backend of matplotlib, but notebooks must draw into their cells.
    os.environ.pop("MPLBACKEND", None)
    source = TARGET / "source"
    shutil.rmtree(source, ignore_errors=True)
    (source / "notebooks").mkdir(parents=True)
    for folder in ("reference", "research", "gallery"):
        (source / folder).mkdir()
    for page in DOCS.glob("*.md"):
        shutil.copy(page, source / page.name)
    shutil.copytree(DOCS / "pictures", source / "pictures")
    (source / "gallery.md").write_text(gallery(source / "gallery"), encoding="utf-8")
    scripts = sorted((DOCS / "research").glob("*.py"))
    (source / "research" / "index.md").write_text(tasks(scripts), encoding="utf-8")
    # Two at a time, since much of their time is spent on starting one process each.
    with ThreadPoolExecutor(2) as pool:
        books = [*sorted((DOCS / "notebooks").glob("*.ipynb")), *scripts]
        for line in pool.map(lambda path: notebook(path, source / path.parent.name), books):
            print(line, flush=True)
    reference = source / "reference"
    (reference / "package.md").write_text(api(), encoding="utf-8")
    (reference / "scenario.md").write_text(code(_native.reference("scenario")), encoding="utf-8")
    (reference / "study.md").write_text(code(_native.reference("study")), encoding="utf-8")
    (reference / "summary.md").write_text(summary(), encoding="utf-8")
    config = (DOCS / "mkdocs.yml").read_text(encoding="utf-8")
    config += f"\ndocs_dir: {json.dumps(str(source))}\nsite_dir: {json.dumps(str(TARGET / 'html'))}\n"
    (TARGET / "mkdocs.yml").write_text(config, encoding="utf-8")
    words = [sys.executable, "-m", "mkdocs", "build", "--strict", "--quiet", "--config-file", str(TARGET / "mkdocs.yml")]
    done = subprocess.run(words, check=False)
    if done.returncode == 0:
        print(f"site: {TARGET / 'html' / 'index.html'}")
    return done.returncode


if __name__ == "__main__":
    sys.exit(main())
