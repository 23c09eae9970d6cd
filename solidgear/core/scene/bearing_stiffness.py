"""The 6x6 stiffness of a bearing as a file gives it, named entries or rows, and its checks.

Order (x, y, z, thx, thy, thz), SI.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Annotated, Any

import numpy as np
from pydantic import BeforeValidator, Field

from solidgear.core.errors import MOST_PROBLEMS, SceneError, nearest, show
from solidgear.core.frames import DOF_NAMES
from solidgear.core.scene.units import Rows, quantity, quantity_type
from solidgear.core.scene.written import Written


def _entry_names() -> dict[str, tuple[int, int, str]]:
    names = {}
    for i, a in enumerate(DOF_NAMES):
        for j, b in enumerate(DOF_NAMES[i:], start=i):
            if j < 3:  # both are translations
                name, dimension = f"k{a}{b}", "force_per_length"
            elif i < 3:
                name, dimension = f"k{a}_{b}", "force"
            else:
                name, dimension = f"k{a}" if i == j else f"k{a}_{b}", "moment"
            names[name] = (i, j, dimension)
    return names


#: share of the largest entry of a matrix that is rounding of it
ROUNDING = 1e-14
#: name of a stiffness entry -> (row, column, dimension); 21 names make the symmetric 6x6
STIFFNESS_NAMES = _entry_names()
#: words of catalogues -> entries, for hints
SPOKEN = {"radial": "kxx and kzz", "axial": "kyy", "tilting": "kthx and kthz", "torsional": "kthy"}


def stiffness_matrix(entries: Mapping[str, Any]) -> np.ndarray:
    """Return the symmetric (6, 6) matrix of named entries (`STIFFNESS_NAMES`), others zero; plain
    numbers are SI (N/m, N/rad, N m/rad).
    """
    K = np.zeros((6, 6))
    problems: list[SceneError] = []
    for name, value in entries.items():
        if name not in STIFFNESS_NAMES:
            near = nearest(name, STIFFNESS_NAMES) if len(problems) < MOST_PROBLEMS else ""
            near = f"; {name} is {SPOKEN[name]}" if name in SPOKEN else near
            problems.append(
                SceneError(
                    f"unknown stiffness entry{near}; valid are {', '.join(STIFFNESS_NAMES)}",
                    path=(name,),
                )
            )
            continue
        i, j, dimension = STIFFNESS_NAMES[name]
        try:
            K[i, j] = K[j, i] = quantity(value, dimension)
        except SceneError as error:
            problems.append(SceneError(error.reason, path=(name,), value=error.value))
    if problems:
        raise SceneError.of(problems)
    return K


def stiffness_entries(K: Any) -> dict[str, float]:
    """Return the non-zero entries (SI) of a symmetric 6x6 by name, the inverse of `stiffness_matrix`."""
    K = np.asarray(K, dtype=float)
    return {name: float(K[i, j]) for name, (i, j, _) in STIFFNESS_NAMES.items() if K[i, j] != 0.0}


def checked_matrix(value: Any) -> tuple[tuple[float, ...], ...]:
    """Return a 6x6 stiffness, hashable, from named entries or rows in SI; refuse one that is not
    finite, symmetric to 1e-9 and positive semidefinite.
    """
    if isinstance(value, Mapping):
        K = stiffness_matrix(value)
    else:
        rows = value.tolist() if isinstance(value, np.ndarray) else value
        if not (
            isinstance(rows, Sequence)
            and len(rows) == 6
            and all(isinstance(r, Sequence) and len(r) == 6 for r in rows)
        ):
            alternative = (
                "" if isinstance(rows, (list, tuple)) else "named entries such as kxx, or "
            )
            raise SceneError(f"must be {alternative}6 rows of 6 numbers, order x y z thx thy thz")
        K = np.zeros((6, 6))
        for i, row in enumerate(rows):
            for j, entry in enumerate(row):
                try:
                    K[i, j] = quantity(
                        entry if not isinstance(entry, str) else None, "dimensionless"
                    )
                except SceneError:
                    raise SceneError(
                        f"row {i + 1}, column {j + 1} must be a number in SI, "
                        f"finite and at most 1e24, not {show(entry)}"
                    ) from None
    size = np.sqrt(np.abs(np.diag(K)))
    bound = 1e-9 * np.maximum(np.maximum(np.abs(K), np.abs(K.T)), np.outer(size, size))
    if np.any(np.abs(K - K.T) > bound):
        a, b = np.unravel_index(np.argmax(np.abs(K - K.T) - bound), (6, 6))
        raise SceneError(
            f"the stiffness is not symmetric: ({DOF_NAMES[a]}, {DOF_NAMES[b]}) is {K[a, b]:.6g} "
            f"and ({DOF_NAMES[b]}, {DOF_NAMES[a]}) is {K[b, a]:.6g}"
        )
    K = (K + K.T) / 2
    # a spring turned by the last digit of an angle has rounding across, and its square on the diagonal
    bare = np.abs(np.diag(K)) <= ROUNDING**2 * np.abs(K).max()
    bare &= not isinstance(value, Mapping)  # entries by name are as somebody wrote them
    K[(bare[:, None] | bare) & (np.abs(K) <= ROUNDING * np.abs(K).max())] = 0.0
    while (least := _least_eigenvalue(K))[0] < -1e-9:
        eigenvalue, (first, second) = least
        i = min(first, second, key=lambda k: K[k, k])
        # where contacts hold a direction no more, its row is rounding of the others
        if 0 < np.abs(K[i]).max() <= ROUNDING * np.abs(K).max():
            K[i] = K[:, i] = 0.0
            continue
        if K[i, i] < 0:
            raise SceneError(
                f"the stiffness in {DOF_NAMES[i]} is {K[i, i]:.6g}; it must not be negative"
            )
        raise SceneError(
            f"the stiffness is indefinite in the pair ({DOF_NAMES[first]}, {DOF_NAMES[second]}): "
            f"their entries are {K[first, first]:.6g} and {K[second, second]:.6g}, coupled by "
            f"{K[first, second]:.6g}, "
            "and the smallest eigenvalue, with the diagonal scaled to 1, "
            f"is {eigenvalue:.3g}; it must not be negative"
        )
    return tuple(tuple(row) for row in K.tolist())


def _least_eigenvalue(K: np.ndarray) -> tuple[float, tuple[int, int]]:
    """Return the least eigenvalue of a stiffness with its diagonal scaled to 1, and the two motions
    that have most of it.
    """
    size = np.sqrt(np.abs(np.diag(K)))
    # unit-free: a row with no stiffness of its own is scaled so that its largest coupling becomes
    # 1, hence indefinite
    for row_index in np.flatnonzero(size == 0):
        coupled = np.abs(K[row_index])
        coupling = coupled / np.where(size > 0, size, np.sqrt(coupled) + (coupled == 0))
        size[row_index] = coupling.max() or 1.0
    # one size after the other: the product of two tiny ones is zero
    eigenvalue, vector = np.linalg.eigh(K / size[:, None] / size)
    a, b = sorted(np.argsort(-np.abs(vector[:, 0]), kind="stable")[:2])
    return float(eigenvalue[0]), (int(a), int(b))


#: entries of a stiffness by name, as files write them
ENTRIES = {
    name: Annotated[
        quantity_type(dimension),
        Field(description=f"entry ({DOF_NAMES[i]}, {DOF_NAMES[j]}) of the stiffness"),
    ]
    for name, (i, j, dimension) in STIFFNESS_NAMES.items()
}
#: a checked 6x6 stiffness
Matrix = Annotated[
    tuple[tuple[float, ...], ...],
    BeforeValidator(checked_matrix),
    Written(Rows | Annotated[dict, Written(ENTRIES)]),
]


def refuse_two_stiffnesses(table: Mapping[str, Any]) -> None:
    """Refuse a table of a bearing with two descriptions of its stiffness."""
    keys = [k for k in ("stiffness", "matrix", "catalogue", "hold") if k in table]
    if len(keys) > 1:
        raise SceneError(f"give either {keys[0]} or {keys[-1]}, not both", path=(keys[0],))
    if "hold" in table and table.get("axial_series"):
        raise SceneError(
            "a spring in series needs a stiffness beside it; leave one of hold and axial_series "
            "out",
            path=("axial_series",),
        )
