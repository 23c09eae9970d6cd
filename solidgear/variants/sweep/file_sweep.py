"""A sweep from Python: its rows as a table."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any

from solidgear.core import Source
from solidgear.core.errors import names_in
from solidgear.variants.sweep.design import Design
from solidgear.variants.sweep.entries import as_texts
from solidgear.variants.sweep.file_task import Swept, run
from solidgear.variants.sweep.shaft_task import task_of


def sweep(
    source: Source,
    vary: str | Iterable[str] | Mapping[str, Any] = (),
    *,
    sample: int | None = None,
    seed: int = 0,
    one_at_a_time: bool = False,
    table: str | os.PathLike | None = None,
    keep_sum: str | Iterable[str] = (),
    follow: str | Iterable[str] = (),
    out: str | os.PathLike | None = None,
    jobs: int = 1,
    dask: str | None = None,
    overwrite: bool = False,
    progress: Callable[[int, int, str], None] = lambda done, total, text: None,
    **how: Any,
) -> Swept:
    """Solve many variants of a shaft or of a train.

    Parameters
    ----------
    source : path, dict, Scene or Train
        A scene or train: its file, the tables of one, or an object.
    vary : str or iterable of str, or mapping of str to values
        ``PATH=VALUES``, or values by their paths, numbers in SI: any number or word of the file, such as
        ``segment.neck.diameter=30 mm:40 mm:5``; of a train also of the scene of a shaft, such as
        ``pinion.bearing.2.position=140 mm:160 mm:5``. Every rule of the file applies.
    sample, seed : int
        Points of a Latin hypercube in place of all combinations.
    one_at_a_time : bool
        The file as it is, then each value with all others as in the file.
    table : path, optional
        Of variants of your own, a CSV file with paths as heads, in place of `vary`.
    keep_sum : str or iterable of str
        ``PATH+PATH``: sums that stay what they are in the file.
    follow : str or iterable of str
        ``PATH``: diameters that follow the bore of a designation that varies, beside the seat.
    out : path, optional
        Keeps the rows; the same sweep goes on from there.
    jobs : int
        Processes on this machine (joblib), at most eight for each processor.
    dask : str, optional
        Address of a Dask scheduler, whose workers have solidgear installed.
    overwrite : bool
        Discard rows that are there.
    progress : callable
        Called with the number of rows that are there, of rows in all, and the present step.
    **how
        Of a shaft and of a train: `n`, the natural frequencies of a row.

        Of a shaft: `ask`, some of ``answer`` (by default), ``deflect``, ``bearing`` and ``stress``;
        `model`, the cheapest mesh within the tolerance by default, variant by variant (rows of a
        model that is given have no error bars); `options` of its builder; `tolerance`, relative,
        that of the scene by default. Where springs and positions of bearings vary alone,
        one body does for all, and `reduction_tolerance` is the relative error that its reduction
        may leave in frequencies, 1e-6 by default.

        Of a train: `pinion` and `gear`, models as of ``system-modes``, and `models` of shafts by
        any name; `ask`, some of ``system-modes``, ``response``, ``deflect``, ``bearing`` and
        ``contact``; `max_frequency` in Hz; `point`, an operating point by its name or number;
        `every_point`, a row for each of them; `mesh`, whose transmission error drives the train;
        `local_harmonics` of every mesh; `reduction`, `kept` and `settings` as of an assembly;
        `tolerance` that meshes of harmonic shafts may leave.

    Returns
    -------
    Swept

    Raises
    ------
    SolidgearError
        A path or a value that no variant can have. A variant that the rules of the file refuse is
        no error: its row says why.

    Examples
    --------
    Two diameters together, by a beam:

    >>> import solidgear as sg
    >>> both = "segment.left.diameter+segment.right.diameter=45 mm:50 mm:3"
    >>> rows = sg.sweep("geometry/shaft_stepped.toml", both, model="timoshenko")
    >>> bool(rows["C_zz"][0] > rows["C_zz"][2])
    True
    """
    texts = as_texts(vary)
    variants = None if table is None else Path(table)
    sums, diameters = names_in(keep_sum), names_in(follow)
    design = Design(texts, sample, seed, one_at_a_time, variants, sums, diameters)
    task = task_of(source, design, **how)
    with tempfile.TemporaryDirectory() as folder:
        rows = Path(folder) / "rows.csv" if out is None else Path(out)
        swept = run(task, rows, jobs=jobs, dask=dask, overwrite=overwrite, progress=progress)
        if out is None:
            dict(swept.columns)  # read before their file is gone
        return swept
