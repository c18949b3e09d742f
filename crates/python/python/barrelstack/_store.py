"""Reads and writes files in the same way as the commands."""

from __future__ import annotations

import contextlib
import errno
import os
import stat

__all__ = ["contents", "store"]

#: Paths that are not files but that the system offers for streams opened by the caller.
OPENED = ("/dev/stdin", "/dev/fd/", "/proc/")


def contents(path: str | os.PathLike[str]) -> bytes:
    """Reads a file; named pipes, which may block the reader, and devices, which have no end, are refused.

    Parameters
    ----------
    path
        The file, or a stream that the caller opened (``/dev/stdin``).

    Raises
    ------
    OSError
        When the path cannot be opened or is not a file.
    """
    name = os.fspath(path)
    mode = os.stat(name).st_mode
    if not (stat.S_ISREG(mode) or stat.S_ISDIR(mode) or name.startswith(OPENED)):
        message = "it is a named pipe or a device, not a file; write its content to a file and name that file"
        raise OSError(errno.EINVAL, message, name)
    with open(name, "rb") as file:
        return file.read()


def store(path: str | os.PathLike[str], content: bytes) -> None:
    """Writes a file under a temporary name and renames it, so that it is never incomplete.

    A link with the name of the file is replaced: a folder from someone else may contain links to files outside.

    Parameters
    ----------
    path
        The file; paths of the system such as ``/dev/stdout`` are written to directly.
    content
        The complete content.
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
