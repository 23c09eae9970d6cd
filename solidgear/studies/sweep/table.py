"""A sweep from Python: its rows as a table."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from solidgear.display import Displayed
from solidgear.errors import SolidgearError, listed, nearest
from solidgear.scene.toml_file import is_train
from solidgear.studies.sweep.design import Design
from solidgear.studies.sweep.scene_run import sweep_scene
from solidgear.studies.sweep.train_run import sweep_train

if TYPE_CHECKING:
    from solidgear.studies.sweep.curves import Curves


@dataclass(frozen=True, eq=False, repr=False)
class Swept(Displayed):
    """Rows of a sweep.

    Attributes
    ----------
    columns : dict of str to list
        Values of all rows by the names of columns, SI; None where a row has none. Bars stand beside
        numbers as ``f1_hz bar``, in the same unit.
    whys : dict of str to int
        Why variants were refused, and how many for that reason.
    curves : Curves or None
        Where one number varies.

    Examples
    --------
    >>> import solidgear as sg
    >>> rows = sg.sweep("geometry/shaft_stepped.toml", "segment.left.diameter=45 mm,55 mm", n=2)
    >>> len(rows), bool(rows["f2_hz"][0] < rows["f2_hz"][1]), bool(max(rows["f2_hz bar"]) < 10)
    (2, True, True)
    """

    shown: ClassVar[str] = "swept"

    columns: dict[str, list[Any]]
    varied: tuple[str, ...]
    whys: dict[str, int]
    curves: Curves | None

    def __len__(self) -> int:
        return len(self.columns["variant"])

    def __getitem__(self, name: str) -> np.ndarray:
        if name not in self.columns:
            raise SolidgearError(
                f"a sweep has no column {name!r}{nearest(name, self.columns)}; "
                f"it has {listed(self.columns)}"
            )
        values = self.columns[name]
        texts = any(isinstance(value, str) for value in values)
        return np.array(values, object if texts else float)

    def to_dataframe(self) -> Any:
        """All columns as a data frame of pandas, which must be installed."""
        import pandas

        return pandas.DataFrame(self.columns)


def sweep(
    file: str | os.PathLike,
    vary: str | Iterable[str] = (),
    *,
    sample: int | None = None,
    seed: int = 0,
    one_at_a_time: bool = False,
    table: str | os.PathLike | None = None,
    keep_sum: Iterable[str] = (),
    out: str | os.PathLike | None = None,
    progress: Callable[[int, int, str], None] = lambda done, total, text: None,
    **how: Any,
) -> Swept:
    """Solve many variants of the file of a shaft or of a train.

    Parameters
    ----------
    file : path
        Of the scene or train.
    vary : str or iterable of str
        ``PATH=VALUES``: any entry of the file, such as ``segment.neck.diameter=30 mm:40 mm:5``.
    sample, seed : int
        Points of a Latin hypercube in place of all combinations.
    one_at_a_time : bool
        The file as it is, then each value with all others as in the file.
    table : path, optional
        Of variants of your own, a CSV file with paths as heads, in place of `vary`.
    keep_sum : iterable of str
        ``PATH+PATH``: sums that stay what they are in the file.
    out : path, optional
        Keeps the rows; the same sweep goes on from there.
    progress : callable
        Called with rows that are there, rows in all, and what is being done.
    **how
        Of a shaft those of :func:`solidgear.studies.sweep.scene_run.sweep_scene`, of a train those
        of :func:`solidgear.studies.sweep.train_run.sweep_train`, such as ``model``, ``n``, ``jobs``.

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
    texts = (vary,) if isinstance(vary, str) else tuple(vary)
    own = None if table is None else Path(table)
    design = Design(texts, sample, seed, one_at_a_time, own, tuple(keep_sum))
    run: Callable[..., Any] = sweep_train if is_train(Path(file)) else sweep_scene
    with tempfile.TemporaryDirectory() as folder:
        rows = Path(folder) / "rows.csv" if out is None else Path(out)
        found = run(Path(file), design, rows, progress=progress, **how)
    columns = list(found.columns)
    varied = tuple(columns[1 : columns.index("status")])
    return Swept(found.columns, varied, found.whys, found.curves)
