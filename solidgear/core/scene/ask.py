"""Questions of a scene."""

from __future__ import annotations

import re
from typing import Annotated, Any

from pydantic import BeforeValidator, Field

from solidgear.core.errors import SceneError
from solidgear.core.quantity import AT, QUANTITIES, Quantity
from solidgear.core.scene.limits import MOST_MODES
from solidgear.core.scene.typed import Model
from solidgear.core.scene.units import Frequency, Tolerance
from solidgear.core.scene.written import Word, Written

_KNOWN = ", ".join(f"'{name}'" for name in QUANTITIES[:-1]) + f" or '{QUANTITIES[-1]}'"


#: a quantity, or a compliance or stiffness at a point
QuantityWord = Annotated[
    str,
    Word(
        tuple(map(str, QUANTITIES)),
        "|".join(
            re.escape(q) if q.is_frequency else f"{re.escape(q)}({AT}.+)?" for q in QUANTITIES
        ),
    ),
]


def _read_quantity(value: Any) -> Quantity:
    """Return a quantity, at a further lumped point as ``quantity@name``."""
    quantity = Quantity(value) if isinstance(value, str) else None
    if quantity is None or quantity.symbol not in QUANTITIES:
        raise SceneError(f"must be {_KNOWN}")
    if quantity.points and quantity.is_frequency:
        raise SceneError(
            f"only compliances and stiffnesses belong to a point; write {quantity.symbol} without "
            f"{AT}"
        )
    if quantity.points == ("",):
        raise SceneError(f"names no point behind {AT}; write for example {quantity.at('gear')}")
    return quantity


Asked = Annotated[Quantity, BeforeValidator(_read_quantity), Written(QuantityWord)]


class Ask(Model):
    """The questions: number of modes, highest frequency, tolerance, and quantities to judge by.

    Attributes
    ----------
    modes : int
        Number of elastic modes, 1 to `MOST_MODES`.
    max_frequency : float or None
        Highest frequency, Hz; without it there is no limit.
    tolerance : float
        Relative error that answers may have, between 0 and 1.
    quantities : tuple of Quantity
        Quantities that models are judged by, from `QUANTITIES`, at a further lumped point as
        ``C_zz@name``; empty is the usual set, compliances at every point with first bending and
        first axial mode.
    lumped : bool
        Whether `compare` shows every synthesis of a lumped mass.

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
