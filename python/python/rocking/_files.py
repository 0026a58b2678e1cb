"""Files: written whole or not at all."""

from __future__ import annotations

import os
import uuid

#: Folders of the open files of a process.
OPEN_FILES = ("/proc", "/dev/fd")

#: As many links as a system follows.
MOST_LINKS = 40


def write_text(file: str, text: str) -> None:
    """Writes a text under a temporary name, and renames the file when it is complete.

    What is no regular file, or leads to an open file of a process as ``/dev/stdout`` does, is written as it is.
    """
    path = os.path.realpath(file)
    is_regular = not os.path.exists(path) or (os.path.isfile(path) and os.access(path, os.W_OK))
    if _is_stream(file) or not is_regular:
        # A folder or a file that is write-protected raises as Python's own `open` does.
        with open(file, "w", encoding="utf-8") as out:
            out.write(text)
        return
    temporary = f"{path}.{uuid.uuid4().hex}"
    try:
        descriptor = os.open(temporary, os.O_CREAT | os.O_EXCL | os.O_WRONLY, 0o666)
    except OSError as error:
        raise type(error)(error.errno, error.strerror, file) from None
    try:
        with open(descriptor, "w", encoding="utf-8") as out:
            out.write(text)
        if os.path.exists(path):
            os.chmod(temporary, os.stat(path).st_mode & 0o7777)
        os.replace(temporary, path)
    except BaseException:
        os.unlink(temporary)
        raise


def _is_stream(file: str) -> bool:
    """Whether a path leads to an open file of a process: what stands in that file would be lost if another one got its name."""
    for _ in range(MOST_LINKS):
        folder = os.path.realpath(os.path.dirname(file) or ".")
        if folder.startswith(OPEN_FILES):
            return True
        if not os.path.islink(file):
            break
        file = os.path.join(folder, os.readlink(file))
    return False
