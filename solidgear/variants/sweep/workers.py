"""Workers that turn variants into rows: this process, others on this machine, or a Dask cluster."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Any, Protocol

from solidgear.core import SolidgearError
from solidgear.core.machine.threads import usable_cores

Rows = list[dict[str, Any]]


class RowSolver(Protocol):
    """Task that turns variants into rows; sent to other processes."""

    def rows(self, indices: Iterable[int]) -> Rows:
        """Return the rows of some variants."""


#: takes a task and lists of variants; yields their rows in order
Workers = Callable[[RowSolver, Sequence[Sequence[int]]], Iterator[Rows]]


def workers(jobs: int = 1, dask: str | None = None) -> Workers:
    """Return the workers that were asked for.

    Raises
    ------
    SolidgearError
        If the package it takes is not installed, there is no cluster at that address, or so many
        processes would only stand in each other's way.
    """
    if dask:
        return _dask(dask)
    return _in_this_process if jobs == 1 else _joblib(jobs)


def _rows(task: RowSolver, part: Sequence[int]) -> Rows:
    return task.rows(part)


def _in_this_process(task: RowSolver, parts: Sequence[Sequence[int]]) -> Iterator[Rows]:
    for part in parts:
        yield task.rows(part)


def _joblib(jobs: int) -> Workers:
    most = 8 * usable_cores()
    if jobs > most:
        raise SolidgearError(
            f"--jobs {jobs}: give a whole number up to {most}, eight for each processor here"
        )
    try:
        from joblib import Parallel, delayed
    except ImportError:
        raise SolidgearError(
            f"--jobs {jobs} needs joblib: pip install 'solidgear[sweep]', or use --jobs 1"
        ) from None

    def run(task: RowSolver, parts: Sequence[Sequence[int]]) -> Iterator[Rows]:
        # the task is sent with every part as places fall free, with a basis enlarged meanwhile
        yield from Parallel(n_jobs=jobs, return_as="generator")(
            delayed(_rows)(task, part) for part in parts
        )

    return run


def _dask(address: str) -> Workers:
    try:
        from distributed import Client
    except ImportError:
        raise SolidgearError(
            f"--dask {address} needs Dask: pip install 'solidgear[dask]'"
        ) from None
    try:
        client = Client(address, timeout=10, set_as_default=False)
    except (OSError, TimeoutError, ValueError) as error:
        raise SolidgearError(
            f"--dask {address}: no Dask scheduler answers there ({type(error).__name__})"
        ) from None

    def run(task: RowSolver, parts: Sequence[Sequence[int]]) -> Iterator[Rows]:
        with client:
            shared = client.scatter(task, broadcast=True)
            futures = [client.submit(_rows, shared, part, pure=False) for part in parts]
            try:
                for future in futures:
                    yield future.result()
            finally:
                client.cancel(futures)

    return run
