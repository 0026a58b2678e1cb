"""Files: written whole or not at all."""

from __future__ import annotations

import os
import tempfile


def write_text(file: str, text: str) -> None:
    """Writes a text under a temporary name, and renames the file when it is complete.

    What is no regular file, as ``/dev/stdout``, is written as it is.
    """
    path = os.path.realpath(file)
    if os.path.exists(path) and not (os.path.isfile(path) and os.access(path, os.W_OK)):
        # A folder or a file that is write-protected raises as Python's own `open` does.
        with open(file, "w", encoding="utf-8") as out:
            out.write(text)
        return
    try:
        descriptor, temporary = tempfile.mkstemp(dir=os.path.dirname(path))
    except OSError as error:
        raise type(error)(error.errno, error.strerror, file) from None
    try:
        with open(descriptor, "w", encoding="utf-8") as out:
            out.write(text)
        os.chmod(temporary, _permissions(path))
        os.replace(temporary, path)
    except BaseException:
        os.unlink(temporary)
        raise


def _permissions(path: str) -> int:
    """Permissions of a file, or those of a new one."""
    if os.path.exists(path):
        return os.stat(path).st_mode & 0o7777
    mask = os.umask(0)
    os.umask(mask)
    return 0o666 & ~mask
