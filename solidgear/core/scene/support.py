"""Support of a seat by its bearing: held ends, and rings that slide along y."""

from __future__ import annotations

from typing import Any, Literal

import numpy as np

from solidgear.core.errors import SceneError
from solidgear.core.scene.limits import MOST_SPRINGS
from solidgear.core.springs import in_series

Hold = Literal["clamped", "pinned"]
Support = Literal["locating", "floating"]

#: stiffness of a held station, N/m and N m/rad: E r and E r^3 of a steel shaft are 1e-11 of it at a
#: radius of 0.1 m and 1e-9 at 1 m. With 1e24 in both statics are as good, but modes drown in
#: rounding: measured 1e-3 to 0.5 of a frequency.
HELD, HELD_TURN = 1e22, 1e20
#: N/m: a given stiffness from there on may stand for rigid: E d of a steel shaft of 0.5 m is 1e11.
#: Beside it forces of catalogue bearings keep nine digits, and with `HELD` none
RIGID = 1e15
#: components that each way of holding stops
HOLDS: dict[str, tuple[int, ...]] = {"clamped": (0, 1, 2, 3, 4, 5), "pinned": (0, 1, 2)}


def held_matrix(hold: str) -> np.ndarray:
    """Return the (6, 6) stiffness that stands for a way of holding, N/m and N m/rad.

    Examples
    --------
    >>> [float(k) for k in np.diag(held_matrix("pinned"))]
    [1e+22, 1e+22, 1e+22, 0.0, 0.0, 0.0]
    """
    size = 3 * [HELD] + 3 * [HELD_TURN]
    return np.diag([size[c] if c in HOLDS[hold] else 0.0 for c in range(6)])


def sliding(stiffness: np.ndarray) -> np.ndarray:
    """Return the (6, 6) stiffness of a bearing with a ring that slides along y in its seat: nothing is
    held along y, and couplings with y are condensed out.
    """
    matrix = np.array(stiffness)
    if matrix[1, 1]:
        matrix = in_series(matrix, np.eye(6)[:, [1]], np.zeros((1, 1)))
    matrix[1] = matrix[:, 1] = 0.0
    return matrix


def few_springs(springs: Any) -> Any:
    """Return springs in series; refuse too many."""
    if isinstance(springs, (list, tuple)) and len(springs) > MOST_SPRINGS:
        raise SceneError(
            f"{len(springs)} springs in series are more than the {MOST_SPRINGS} there may be; "
            "write their sum: 1/k = 1/k1 + 1/k2 + ..."
        )
    return springs
