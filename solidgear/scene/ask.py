"""Questions that a scene asks."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field, ValidatorFunctionWrapHandler, WrapValidator

from solidgear.errors import SceneError
from solidgear.scene.rules import AT, MOST_MODES
from solidgear.scene.typed import Model
from solidgear.scene.units import Frequency, Tolerance

#: what a model can be judged by: compliance and stiffness at the lumped point, first modes
Quantity = Literal[
    "C_zz",
    "C_z,thx",
    "C_thx",
    "C_yy",
    "K_zz",
    "K_z,thx",
    "K_thx",
    "K_yy",
    "bending 1",
    "bending 2",
    "axial 1",
    "torsion 1",
]


def _at_a_point(value: Any, judge: ValidatorFunctionWrapHandler) -> Any:
    """A quantity, or one of the lumped points by ``quantity@name``."""
    name, at, point = value.partition(AT) if isinstance(value, str) else (value, "", "")
    judge(name)
    if at and not name.startswith(("C_", "K_")):
        raise SceneError(
            f"only compliances and stiffnesses are of a point; write {name} without {AT}"
        )
    if at and not point:
        raise SceneError(f"names no point behind {AT}; write for example {name}{AT}gear")
    return value


Asked = Annotated[Quantity, WrapValidator(_at_a_point)]


class Ask(Model):
    """The questions: how many modes, up to what frequency, to what tolerance, judged by what.

    Attributes
    ----------
    modes : int
        Elastic modes, 1 to `MOST_MODES`.
    max_frequency : float or None
        Hz; None is no limit.
    tolerance : float
        Relative, between 0 and 1.
    quantities : tuple of str
        What models are judged by, names of `Quantity`, those of a further lumped point as
        ``C_zz@name``; empty is the usual set, compliances at every point with first bending and
        first axial mode.

    Raises
    ------
    SceneError
        A field out of its range.

    Examples
    --------
    >>> from solidgear import Ask
    >>> ask = Ask(max_frequency="10 kHz", tolerance=0.02)
    >>> ask.modes, ask.max_frequency, ask.tolerance
    (10, 10000.0, 0.02)
    """

    modes: Annotated[int, Field(strict=True, ge=1, le=MOST_MODES)] = 10
    max_frequency: Frequency | None = None
    tolerance: Tolerance = 0.05
    quantities: tuple[Asked, ...] = ()
    lumped: Annotated[bool, Field(strict=True)] = False
