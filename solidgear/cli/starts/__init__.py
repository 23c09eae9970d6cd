"""Scene files to begin with: short, commented, and sound as they are."""

from __future__ import annotations

from solidgear.errors import SolidgearError, nearest, show

#: what a scene may begin as, and what it then is
STARTS = {
    "overhung": "bevel pinion overhung on two bearings",
    "straddle": "bevel pinion between two bearings, and a third one behind",
    "rotor": "motor rotor: a stack of a second material, and a fan as a rigid mass",
    "gearbox": "gearbox shaft of eight segments on two bearings",
}


def start(kind: str, name: str) -> str:
    """Text of a scene file to begin with.

    Parameters
    ----------
    kind : str
        One of `STARTS`.
    name : str
        Of the scene; letters, digits, blanks, ``_``, ``-`` and full stops.

    Returns
    -------
    str
        TOML.

    Raises
    ------
    SolidgearError
        For a kind that there is not, or a name that is none.

    Examples
    --------
    >>> print(start("rotor", "fan").splitlines()[0])
    # A motor rotor: a shaft with a laminated stack as a second material, and a fan as a rigid mass.
    """
    from importlib.resources import files  # every command reads this module

    if kind not in STARTS:
        raise SolidgearError(
            f"kind {show(kind, 40)} is unknown{nearest(kind, STARTS)}; use one of {', '.join(STARTS)}"
        )
    if not name.strip() or not all(c.isalnum() or c in "_-. " for c in name):
        raise SolidgearError(
            f"name {show(name, 60)}: use letters, digits, blanks, _, - and full stops"
        )
    text = files(__name__).joinpath(f"{kind}.toml").read_text("utf-8")
    return text.replace("{name}", name)
