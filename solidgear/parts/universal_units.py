"""Units of a universal file, by dataset 164."""

from __future__ import annotations

from solidgear.core import SceneError

#: code -> m and N of its units; code 9 comes with factors
UNITS = {
    1: (1.0, 1.0),
    2: (0.3048, 4.4482216152605),
    3: (1.0, 9.80665),
    4: (0.3048, 0.138254954376),
    5: (1e-3, 1e-3),
    6: (1e-2, 1e-2),
    7: (0.0254, 4.4482216152605),
    8: (1e-3, 9.80665),
    10: (1e-3, 1.0),
}


def units_of(code: int, length: float, force: float) -> tuple[float, float]:
    """Return the units of length and force, m and N, by the code of a dataset 164 and the factors in
    it, one metre and one newton in these units.

    Examples
    --------
    >>> units_of(5, 1000.0, 1000.0)
    (0.001, 0.001)
    >>> units_of(9, 100.0, 1.0)
    (0.01, 1.0)
    """
    if code == 9 and length > 0 and force > 0:
        return 1 / length, 1 / force
    if code not in UNITS:
        raise SceneError(f"has units of code {code}; dataset 164 knows 1 to 10")
    return UNITS[code]
