"""Writes files as the commands do."""

from __future__ import annotations

import contextlib
import os

__all__ = ["store"]


def store(path: str | os.PathLike[str], content: bytes) -> None:
    """Writes to a temporary name and renames, so that the file is never incomplete and a link of its name is replaced.

    A folder of results may come from someone else, and a link in it lead to files outside.

    Parameters
    ----------
    path
        The file; what the system offers as a file (``/dev/stdout``) is written to as it is.
    content
        All of it.
    """
    name = os.fspath(path)
    if name.startswith(("/dev/", "/proc/")):
        with open(name, "wb") as file:
            file.write(content)
        return
    part = f"{name}.{os.getpid()}.part"
    with contextlib.suppress(FileNotFoundError):
        os.remove(part)
    try:
        with open(part, "xb") as file:
            file.write(content)
        os.replace(part, name)
    except BaseException as error:
        with contextlib.suppress(OSError):
            os.remove(part)
        if isinstance(error, OSError):
            error.filename, error.filename2 = name, None
        raise
