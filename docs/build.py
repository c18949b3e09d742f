"""Builds the site from pages, references generated from the code, and executed notebooks; warnings are errors."""

from __future__ import annotations

import base64
import inspect
import json
import os
import re
import shutil
import subprocess
import sys
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
    for name, value in vars(thing).items():
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
            text += [] if hasattr(thing, "_fields") else members(thing)
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


def notebook(path: Path, out: Path) -> None:
    """Executes a notebook and writes it as a page: its text, its code, and the output of its cells."""
    book = nbformat.read(path, as_version=4)
    where = {"metadata": {"path": str(TARGET)}}
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
            if "image/png" in data:
                picture = f"{path.stem}-{number}-{at}.png"
                (out / picture).write_bytes(base64.b64decode(data["image/png"]))
                text.append(f"![Figure of this cell]({picture})")
            elif "text" in output or "text/plain" in data:
                told = output.get("text", data.get("text/plain", ""))
                text.append(f"```text\n{told.rstrip()}\n```")
    (out / f"{path.stem}.md").write_text("\n\n".join(text) + "\n", encoding="utf-8")


def main() -> int:
    """Collects the pages and builds the site."""
    # The tests may set another backend of matplotlib, but notebooks must draw into their cells.
    os.environ.pop("MPLBACKEND", None)
    source = TARGET / "source"
    shutil.rmtree(source, ignore_errors=True)
    (source / "notebooks").mkdir(parents=True)
    (source / "reference").mkdir()
    for page in DOCS.glob("*.md"):
        shutil.copy(page, source / page.name)
    shutil.copytree(DOCS / "pictures", source / "pictures")
    for path in sorted((DOCS / "notebooks").glob("*.ipynb")):
        notebook(path, source / "notebooks")
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
