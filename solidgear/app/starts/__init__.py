"""Scene and train files to begin with: short, commented, and sound as they are."""

from __future__ import annotations

from solidgear.core import SolidgearError, nearest, show

#: what one may begin with, and what it then is
STARTS = {
    "overhung": "bevel pinion overhung on two bearings",
    "straddle": "bevel pinion between two bearings, and a third one behind",
    "rotor": "motor rotor: a stack of a second material, and a fan as a rigid mass",
    "gearbox": "gearbox shaft of eight segments on two bearings",
    "countershaft": "shaft with belt, gear and coupling on catalogue bearings, in two load cases",
    "helical": "train of two helical gears on catalogue bearings",
    "bevel": "train of a spiral bevel pair",
}
#: files that a train has beside its own: what follows its name, and the text
SHAFTS = {
    "helical": {"_pinion": "helical_pinion", "_wheel": "helical_wheel"},
    "bevel": {"_pinion": "overhung", "_gear": "bevel_gear"},
}


def start(kind: str, name: str) -> dict[str, str]:
    """Return files to begin with.

    Parameters
    ----------
    kind : str
        One of `STARTS`.
    name : str
        Of the scene; letters, digits, blanks, ``_``, ``-`` and full stops.

    Returns
    -------
    dict of str to str
        Names of files, the one to solve first, and their texts, TOML.

    Raises
    ------
    SolidgearError
        For a kind that there is not, or a name that is none.

    Examples
    --------
    >>> print(start("rotor", "fan")["fan.toml"].splitlines()[0])
    # A motor rotor: a shaft with a laminated stack as a second material, and a fan as a rigid mass.
    >>> list(start("helical", "box"))
    ['box.toml', 'box_pinion.toml', 'box_wheel.toml']
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
    texts = {"": kind} | SHAFTS.get(kind, {})
    return {
        f"{name}{more}.toml": files(__name__)
        .joinpath(f"{text}.toml")
        .read_text("utf-8")
        .replace("{name}", name + more)
        for more, text in texts.items()
    }
