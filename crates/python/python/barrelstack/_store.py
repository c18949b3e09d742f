"""Reads and writes files as the commands do."""

from __future__ import annotations

import contextlib
import errno
import os
import stat

__all__ = ["contents", "store"]

#: What the system offers as a file and the caller opened.
OPENED = ("/dev/stdin", "/dev/fd/", "/proc/")


def contents(path: str | os.PathLike[str]) -> bytes:
    """Reads a file. A named pipe would keep its reader waiting, and a device has no end: both are refused.

    Parameters
    ----------
    path
        The file, or what the caller opened (``/dev/stdin``).

    Raises
    ------
    OSError
        When it cannot be opened or is no file.
    """
    name = os.fspath(path)
    mode = os.stat(name).st_mode
    if not (stat.S_ISREG(mode) or stat.S_ISDIR(mode) or name.startswith(OPENED)):
        message = "it is a named pipe or a device, not a file; write its content to a file and name that file"
        raise OSError(errno.EINVAL, message, name)
    with open(name, "rb") as file:
        return file.read()


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
