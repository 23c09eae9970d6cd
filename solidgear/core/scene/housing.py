"""Supports that bearings stand in: the elastic seat of one bearing, and the housing of all.

A housing has no mass here.  A motion without a stiffness is *rigid*, so that ``[housing] axial`` and
a stiffness of ``kyy`` alone mean the same; a motion with zero stiffness is free.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Annotated, Any, ClassVar

import numpy as np
from pydantic import Field, model_validator

from solidgear.core.errors import SceneError
from solidgear.core.frames import DOF_NAMES, shift
from solidgear.core.scene.bearing_stiffness import (
    ENTRIES,
    STIFFNESS_NAMES,
    Matrix,
    stiffness_entries,
)
from solidgear.core.scene.places import Along, Placed, Places
from solidgear.core.scene.typed import Model
from solidgear.core.scene.units import SOFTEST, AxialSpring, Factor, Position, Rows
from solidgear.core.springs import in_series

ONE_HOUSING = (
    "is the entry kyy of a housing's stiffness, all other motions rigid; leave one of them out"
)
EMPTY = "is empty; write entries of its stiffness such as kxx, or matrix = rows"
#: names of the entries on the diagonal of a 6x6, in its order
OWN = tuple(name for name, (i, j, _) in STIFFNESS_NAMES.items() if i == j)


def rigid_motions(entries: Mapping[str, Any]) -> tuple[str, ...]:
    """Return the motions without a named entry, which are rigid; refuse couplings of them."""
    rigid = [k for k, name in enumerate(OWN) if name not in entries]
    for name in entries:
        i, j, _ = STIFFNESS_NAMES.get(name, (-1, -1, ""))
        for k in {i, j} & set(rigid):
            raise SceneError(
                f"couples {DOF_NAMES[k]}, which is rigid unless {OWN[k]} is given",
                path=(name,),
            )
    return tuple(DOF_NAMES[k] for k in rigid)


class Elastic(Model):
    """An elastic support between the outer ring of a bearing and ground.

    Examples
    --------
    >>> import numpy as np
    >>> wall = Elastic(stiffness={"kxx": "2e8 N/m", "kzz": "2e8 N/m"})
    >>> wall.rigid
    ('y', 'thx', 'thy', 'thz')
    >>> ring = wall.beneath_one(np.diag([2e8, 1e8, 2e8, 0.0, 0.0, 0.0]))
    >>> [round(float(k) / 1e8, 6) for k in np.diag(ring)[:3]]
    [1.0, 1.0, 1.0]
    """

    #: 6x6, SI, order (x, y, z, thx, thy, thz). The constructor also takes it as `stiffness`: named
    #: entries, of which those on the diagonal that are left out are rigid, or six rows.
    matrix: Matrix
    #: rigid motions; their rows are zero
    rigid: tuple[str, ...] = ()

    def __init__(self, /, **data: Any):
        if "stiffness" in data:
            stiffness = data.pop("stiffness")
            if isinstance(stiffness, Mapping):
                try:
                    data.setdefault("rigid", rigid_motions(stiffness))
                except SceneError as error:
                    raise error.located(None, prefix=("stiffness",)) from None
            data["matrix"] = stiffness
        super().__init__(**data)

    @model_validator(mode="after")
    def _gives_or_does_not(self):
        for k, name in enumerate(DOF_NAMES):
            spring = self.matrix[k][k]
            if name in self.rigid and any(self.matrix[k]):
                raise SceneError(f"has entries in {name}, which is rigid", path=("matrix",))
            if 0 < spring < SOFTEST:
                raise SceneError(
                    f"the stiffness in {name} is {spring:.6g}, below {SOFTEST:g} in SI, too soft for "
                    "a spring: write 0",
                    path=("matrix",),
                )
        return self

    @property
    def gives(self) -> list[int]:
        """Motions that are not rigid, by place."""
        return [k for k, name in enumerate(DOF_NAMES) if name not in self.rigid]

    @property
    def own(self) -> np.ndarray:
        """(k, k) stiffness against the motions `gives`."""
        return np.array(self.matrix)[np.ix_(self.gives, self.gives)]

    @property
    def entries(self) -> dict[str, float]:
        """Named entries, those of free motions included; motions without one are rigid."""
        free = {OWN[k]: 0.0 for k in self.gives if self.matrix[k][k] == 0.0}
        return stiffness_entries(self.matrix) | free

    def scaled(self, factor: float):
        """Return the support with every stiffness multiplied."""
        return self.with_changes(matrix=np.array(self.matrix) * factor)

    def beneath_one(self, stiffness: np.ndarray, name: str = "the housing") -> np.ndarray:
        """Return the (6, 6) stiffness of a bearing in the support `name`, both at one point."""
        return in_series(stiffness, np.eye(6)[:, self.gives], self.own, name)


def elastic(table: Any) -> Any:
    """Return the housing of a bearing from a table of a file, named entries of a 6x6 or ``matrix``
    alone; anything else as it is.
    """
    if not isinstance(table, Mapping) or "rigid" in table:
        return table
    table, scale = _unscaled(table)
    if not table:
        raise SceneError(EMPTY)
    if "matrix" in table:
        if len(table) > 1:
            raise SceneError("give either matrix, or named entries, not both", path=("matrix",))
        return Elastic(**table).scaled(scale)
    try:
        return Elastic(stiffness=table).scaled(scale)
    except SceneError as error:
        raise SceneError.of(
            SceneError(problem.reason, path=problem.path[1:], value=problem.value)
            for problem in error.problems
        ) from None


#: keys of the housing of a bearing in a file
ELASTIC = {
    **ENTRIES,
    "matrix": Annotated[Rows, Field(description="six rows of the 6x6, in place of entries")],
    "scale": Annotated[Factor, Field(description="factor on all of it")],
}


class Housing(Placed, Elastic):
    """A rigid housing of all bearings on a 6x6 spring to ground.

    Attributes
    ----------
    y : float
        Place on the axis of the shaft that the 6x6 is about, m.

    Examples
    --------
    Two bearings 0.2 m apart in a housing that only tilts, about its middle: pushed alike they are
    as stiff as ever, pushed against each other they are softer.

    >>> import numpy as np
    >>> tilting = Housing(stiffness={"kthx": 1e6}, y=0.1)
    >>> found = tilting.beneath(np.kron(np.eye(2), np.diag([0, 0, 1e8, 0, 0, 0.0])), [0.0, 0.2])
    >>> alike, apart = found[np.ix_([2, 8], [2, 8])] @ [[1, 1], [1, -1]]
    >>> round(float(alike[0]) / 1e8, 6), round(float(alike[1]) / 1e8, 6)
    (1.0, 0.333333)
    """

    class Words(Along):
        """Words for a place, or a spring along the axis alone."""

        #: spring along the axis alone, between the housing and ground, N/m
        axial: AxialSpring | None = None

    sources: ClassVar = {
        "y": ("position",),
        "matrix": ("matrix", "stiffness"),
        "rigid": ("stiffness",),
    }

    needs: ClassVar = (("axial", "stiffness", "matrix"), ("axial", "position"))

    y: Position = 0.0

    @classmethod
    def place(cls, words: Any, table: Mapping[str, Any], places: Places) -> dict[str, Any]:
        words.refuse(ONE_HOUSING, "axial")
        if not {"stiffness", "matrix"} & set(table):
            hint = "this key is missing; write stiffness = {kxx = ...} with position, or axial"
            raise SceneError(hint, path=("stiffness",))
        if "stiffness" in table and "matrix" in table:
            raise SceneError("give either stiffness or matrix", path=("stiffness",))
        if table.get("stiffness") == {}:
            raise SceneError(EMPTY, path=("stiffness",))
        hint = 'write position = "120 mm", the place that the stiffness is about, with from'
        words.require("position", hint)
        return {"y": words.y(places)}

    def moves(self, y: float) -> np.ndarray:
        """Return the (6, k) motion of the bore at a place y (m) for unit motions in which it gives."""
        return shift((0.0, y - self.y, 0.0))[:, self.gives]

    def beneath(self, stiffness: np.ndarray, places: Sequence[float]) -> np.ndarray:
        """Stiffness of bearings that stand in it.

        Parameters
        ----------
        stiffness : (6 m, 6 m) ndarray
            Of the bearings on a rigid one, in their order.
        places : sequence of float
            Of the bearings, m.

        Returns
        -------
        (6 m, 6 m) ndarray

        Raises
        ------
        SolidgearError
            As :func:`solidgear.core.springs.in_series`.
        """
        if not len(places) or not self.gives:
            return stiffness
        return in_series(stiffness, np.vstack([self.moves(y) for y in places]), self.own)


def read_housing(table: Mapping[str, Any], places: Places) -> Housing | float | None:
    """Read a [housing]: a housing, or a spring along the axis, N/m; None where the place is unknown."""
    table, scale = _unscaled(table)
    if "axial" not in table or {"stiffness", "matrix"} & set(table):
        housing = Housing.read(table, places)
        return housing and housing.scaled(scale)
    spring = Housing.Words(**table)
    nowhere = "belongs to a stiffness; along the axis a spring has no place"
    spring.refuse(nowhere, "position", "from_")
    return spring.axial and spring.axial * scale


class _Scale(Model):
    """Factor on a housing."""

    #: factor on the whole stiffness
    scale: Factor = 1.0


def _unscaled(table: Mapping[str, Any]) -> tuple[dict[str, Any], float]:
    """Return the table of a housing without the factor, and the factor."""
    factor = _Scale(**{key: table[key] for key in table if key == "scale"})
    return {key: value for key, value in table.items() if key != "scale"}, factor.scale
