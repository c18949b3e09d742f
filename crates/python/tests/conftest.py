"""Shared fixtures, and the closing line that the test command adds up."""

from __future__ import annotations

import os
import shutil
from pathlib import Path

import pytest

# Pages of the command and of the package state the same date and commit.
os.environ.update(SOURCE_DATE_EPOCH="1408875644", BARRELSTACK_COMMIT="0123456789ab")

ROOT = Path(__file__).resolve().parents[3]


@pytest.fixture(scope="session")
def command() -> str:
    """The program, as the reference for numbers."""
    found = os.environ.get("BARRELSTACK_COMMAND") or shutil.which("barrelstack")
    if found is None:
        pytest.skip("no program to compare with: build it and name it in BARRELSTACK_COMMAND")
    return found


@pytest.fixture(scope="session")
def strong_motion() -> Path:
    """A folder of strong-motion files that cannot be bundled."""
    folder = ROOT.parent / "shared" / "ground-motions"
    if not folder.is_dir():
        pytest.skip(f"no folder {folder}")
    return folder


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """Reports skipped tests with reasons, then one line in the form of the other runners."""
    stats = terminalreporter.stats
    for report in stats.get("skipped", []):
        reason = report.longrepr[2] if isinstance(report.longrepr, tuple) else report.longrepr
        terminalreporter.write_line(f"{report.nodeid}: {str(reason).removeprefix('Skipped: ')} (not run)")
    count = {name: len(stats.get(name, [])) for name in ("passed", "failed", "error", "skipped")}
    failed = count["failed"] + count["error"]
    terminalreporter.write_line(f"{count['passed']} passed, {failed} failed, {count['skipped']} skipped")
