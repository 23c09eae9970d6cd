"""The folder a run writes into: one run at a time, and nothing of an earlier run beside the new
one.

A run lists its files in ``results.json``, so that the next one removes those and nothing else.  The
lock is one of the system, which lets go of it when the process dies, however it dies; where there
is none (Windows, some network drives) two runs are not kept apart.
"""

from __future__ import annotations

import json
import os
import re
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO

from solidgear.core import SolidgearError
from solidgear.core.machine.processes import Other
from solidgear.show.outputs import OUTPUTS

try:
    import fcntl
except ImportError:  # Windows
    fcntl = None  # type: ignore[assignment]  # a module, or none
try:
    import msvcrt
except ImportError:  # all but Windows
    msvcrt = None  # type: ignore[assignment]  # a module, or none

LOCK = ".solidgear.lock"
#: byte that Windows locks: no other process can read it, so it lies far behind what is written
LOCKED_BYTE = 2**30
#: what is ever listed, and so ever removed: a damaged list can name nothing else
OWN = re.compile(
    r"((?:report|sheet)\.html|(mode|error)_\w+\.png|modes\.html|system_mode_\d+\.png"
    r"|(response|orders|shares)\.(csv|png|svg|html)|response_[ab]\.csv"
    rf"|{'|'.join(output.pattern for output in OUTPUTS)})"
)
#: what a process that was killed can have left half written, see
#: :func:`solidgear.core.machine.whole_file.whole`
HALF = re.compile(
    rf"\.({OWN.pattern}|results\.json|rows\.csv|machine\.json|speed_accuracy\.png)"
    r"\.(?P<process>\d+)\.part"
)
# Folders this process holds; it may enter them again.
_held: set[Path] = set()


def prepare(out: str | os.PathLike) -> Path:
    """Make sure a folder can be written, before an hour is spent.

    Raises
    ------
    SolidgearError
        If it cannot.
    """
    folder = Path(out)
    probe = folder / f".probe.{os.getpid()}"
    try:
        folder.mkdir(parents=True, exist_ok=True)
        probe.touch()
        probe.unlink()
    except OSError as error:
        raise _unwritable(out, error) from None
    return folder


def _unwritable(out: str | os.PathLike, error: OSError) -> SolidgearError:
    return SolidgearError(
        f"`folder` {out}: cannot write there ({error.strerror or error}); name a folder you may write"
    )


@contextmanager
def held(out: str | os.PathLike) -> Iterator[Path]:
    """Hold a folder that can be written, against other processes; a new one that stays empty is
    removed.

    Raises
    ------
    SolidgearError
        If it cannot be written, or another run holds it.
    """
    is_new = not Path(out).exists()
    folder = prepare(out)
    place = folder.resolve()
    if place in _held:
        yield folder
        return
    lock = _locked(folder, out)
    _held.add(place)
    try:
        yield folder
    finally:
        _held.discard(place)
        if lock is not None:
            _give_up(lock, folder / LOCK)
        if is_new and not any(folder.iterdir()):
            folder.rmdir()


@contextmanager
def begun(out: str | os.PathLike) -> Iterator[Path]:
    """Hold a folder for a run and remove the files of an earlier run.

    Raises
    ------
    SolidgearError
        As :func:`held`, and if writing stops.
    """
    with held(out) as folder:
        try:
            # Nothing of an earlier run must stand beside the numbers of this one, should it end
            # early.
            clear(folder)
            (folder / "report.html").unlink(missing_ok=True)
            yield folder
        except OSError as error:
            raise SolidgearError(
                f"`folder` {out}: writing stopped ({error.strerror or error}); "
                "files already there are whole"
            ) from error


def _locked(folder: Path, out) -> IO | None:
    while True:
        try:
            file = (folder / LOCK).open("a+", encoding="ascii")
        except OSError as error:
            raise _unwritable(out, error) from None
        try:
            _lock(file)
        except BlockingIOError:
            file.seek(0)
            process = file.read().strip()
            file.close()
            who = f"process {process}" if process.isdigit() else "another process"
            raise SolidgearError(
                f"`folder` {out}: {who} is writing there; wait for it to end, or name another folder"
            ) from None
        except OSError:  # a drive without locks
            file.close()
            return None
        if _is(file, folder / LOCK):
            file.truncate(0)
            file.write(str(os.getpid()))
            file.flush()
            return file
        file.close()  # of a run that has just ended


def _lock(file: IO) -> None:
    """Lock a file against other processes; BlockingIOError where another one has, OSError where there
    are no locks.
    """
    if fcntl is not None:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        return
    if msvcrt is None:
        raise OSError("this system has no locks")
    file.seek(LOCKED_BYTE)
    try:
        msvcrt.locking(file.fileno(), msvcrt.LK_NBLCK, 1)
    except PermissionError as error:
        raise BlockingIOError(*error.args) from None


def _give_up(lock: IO, path: Path) -> None:
    """Remove a file that is locked while it is held: whoever waits for this very file sees that it is
    gone. Windows removes it afterwards, unless another process has opened it meanwhile.
    """
    try:
        path.unlink(missing_ok=True)
    except OSError:
        pass
    lock.close()
    if fcntl is None:
        try:
            path.unlink(missing_ok=True)
        except OSError:
            pass


def _is(file: IO, path: Path) -> bool:
    """Return True where an open file is still the one of that name."""
    try:
        return os.path.samestat(os.fstat(file.fileno()), path.stat())
    except OSError:
        return False


def clear(folder: Path) -> None:
    """Remove the files that an earlier run listed, and halves of files."""
    for name in _listed(folder):
        if OWN.fullmatch(name) and (folder / name).is_file():
            (folder / name).unlink()
    clear_halves(folder)


def clear_halves(folder: Path) -> None:
    """Remove halves of files left by processes that were killed."""
    for path in folder.iterdir():
        half = HALF.fullmatch(path.name)
        if half and not Other(int(half["process"])).alive:
            path.unlink(missing_ok=True)


def _listed(folder: Path) -> list[str]:
    """Return files of an earlier run, as it listed them."""
    try:
        results = json.loads((folder / "results.json").read_text(encoding="utf-8"))
        return [str(name) for name in results["files"]]
    except (OSError, ValueError, KeyError, TypeError):
        return []
