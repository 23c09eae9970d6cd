"""Files that appear whole or not at all."""

from __future__ import annotations

import errno
import os
import sys
import time
from collections.abc import Iterator, Mapping
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path

from solidgear.core.errors import SolidgearError

#: s between attempts to replace a file: on Windows whoever reads one, such as a scanner for viruses,
#: holds it against that
PAUSES = (0.02, 0.1, 0.5) if sys.platform == "win32" else ()


@contextmanager
def whole(path: Path) -> Iterator[Path]:
    """Yield another name in the same folder to write under; it takes the place of ``path`` at the end, or
    is gone if something was raised, for a rename within a folder is all or nothing.  A link stays, and
    what it leads to is replaced; a folder, pipe or device is refused, for a rename would replace it.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     target = Path(folder) / "rows.csv"
    ...     with whole(target) as partial:
    ...         _ = partial.write_text("1,2,3")
    ...         early = target.exists()
    ...     early, target.read_text()
    (False, '1,2,3')
    """
    path = path.resolve()
    if path.is_dir():
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), str(path))
    if path.exists() and not path.is_file():
        raise OSError(errno.EINVAL, "it is a pipe or a device, not a file", str(path))
    partial = path.with_name(f".{path.name}.{os.getpid()}.part")
    try:
        yield partial
        _put(partial, path)
    finally:
        with suppress(PermissionError):  # Windows, where what was raised has left it open
            partial.unlink(missing_ok=True)


def _put(partial: Path, path: Path) -> None:
    """Rename a file, which takes the place of another."""
    for pause in PAUSES:
        try:
            os.replace(partial, path)
        except PermissionError:
            time.sleep(pause)
        else:
            return
    os.replace(partial, path)


@contextmanager
def whole_or_refused(path: Path) -> Iterator[Path]:
    """Yield another name as :func:`whole` does, for a file that a user named; refuse one that cannot
    be written.
    """
    try:
        with whole(path) as partial:
            yield partial
    except OSError as error:
        raise SolidgearError(
            f"{path}: cannot be written ({error.strerror or error}); name a file you may write"
        ) from error


def write_files(files: Mapping[Path, bytes]) -> list[Path]:
    """Write files that a user named, and the folders above them, all of them or none; refuse one
    that cannot be written.
    """
    with ExitStack() as stack:
        for path, content in files.items():
            partial = stack.enter_context(whole_or_refused(path))
            path.parent.mkdir(parents=True, exist_ok=True)
            partial.write_bytes(content)
    return [*files]


def write_page(path: str | os.PathLike, content: str | bytes) -> Path:
    """Write a file that a user named, and the folders above it, whole or not at all; refuse one
    that cannot be written.
    """
    path = Path(path)
    with whole_or_refused(path) as partial:
        path.parent.mkdir(parents=True, exist_ok=True)
        if isinstance(content, bytes):
            partial.write_bytes(content)
        else:
            partial.write_text(content, encoding="utf-8")
    return path
