"""Options of the builders: what they mean, their limits and why, and their checks.

A further option is a parameter of its builder and has its limits here; one that leaves the choice of
meshes to the program is in ``FREE`` of :mod:`solidgear.core.ladder.meshes` too.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from numbers import Integral, Real
from typing import Any

from solidgear.core.elements import ELEMENTS
from solidgear.core.errors import SolidgearError, listed, nearest, show
from solidgear.core.factoring import ENGINES, PRECISIONS


@dataclass(frozen=True)
class Option:
    """One option of a builder."""

    meaning: str
    kind: str = "number"
    least: float | None = None  #: limit that may be met
    most: float | None = None  #: limit that may be met
    above: float | None = None  #: limit that may not be met
    below: float | None = None  #: limit that may not be met
    why: str = ""  #: the reason for the limits
    choices: tuple[str, ...] = ()
    optional: bool = False  #: None may be given, for the choice of the builder


#: ways of tying a station to the shaft
ATTACHMENTS = ("average", "rigid", "section")
#: a last layer below this part of the first costs digits: residuals of modes rise from 1e-8 to 1e-4
THINNEST_LAYER = 1e-6

_REFINEMENT = Option(
    "multiplies the number of cells in every direction",
    least=0.01,
    most=20,
    why="20 makes 400 cells of one in the plane, 8000 in space",
)
_TIES = Option(
    "attachments to build at every station, the default one first",
    "several",
    choices=ATTACHMENTS,
    optional=True,
)
_SIZE = Option(
    "size of cells away from shoulders and seats, m",
    above=0,
    most=100,
    optional=True,
    why="a shaft is at most 20 m long",
)
_RELATIVE = Option(
    "size of cells away from shoulders and seats, in local outer radii",
    least=0.01,
    most=100,
    why="a cell is no longer than a slender shaft",
)
_RATIO = Option(
    "size of a layer relative to the one before",
    least=1e-3,
    most=0.95,
    why="layers shrink, and none to a thousandth at once",
)


def _layers(where: str) -> Option:
    return Option(
        f"geometric layers towards {where}",
        "whole",
        least=0,
        most=20,
        why="further ones are thinner than rounding allows",
    )


BEAM_OPTIONS = {
    "shear": Option("Timoshenko if true, Euler-Bernoulli if not", "flag"),
    "rotary_inertia": Option("whether sections carry rotary inertia in bending", "flag"),
    "head": Option(
        "follow the taper of cones, or take cylinders of their mean radii",
        "choice",
        choices=("cone", "mean"),
    ),
    "mass": Option("mass of an element", "choice", choices=("consistent", "lumped")),
    "kappa": Option("shear coefficient", "choice", choices=("hutchinson", "cowper")),
    "elements": Option(
        "least number of elements along the shaft",
        "whole",
        least=1,
        most=5000,
        optional=True,
        why="frequencies of 100 elements have six digits, and more than 5000 add rounding only",
    ),
    "shoulder": Option("steps of the outer radius as soft as in the solid", "flag"),
    "attachments": _TIES,
}

#: options of the builders by the names of their keyword arguments
HARMONIC_OPTIONS = {
    "order": Option(
        "polynomial order of the quadrilaterals",
        "whole",
        least=1,
        most=12,
        why="bases of higher order are ill-conditioned",
    ),
    "layers": _layers("shoulders"),
    "edge_layers": _layers("seat ends"),
    "ratio": _RATIO,
    "relative_size": _RELATIVE,
    "size": _SIZE,
    "refinement": _REFINEMENT,
    "attachments": _TIES,
    "families": Option(
        "families of motion to build; numbers that need others are not answered",
        "several",
        choices=("bending", "axial", "torsion"),
        optional=True,
    ),
    "ovalising": Option(
        "further harmonics, that is waves around",
        "harmonics",
        least=2,
        most=100,
        why="the lowest modes of the thinnest and shortest tube a scene may have take fewer",
    ),
    "cuts": Option(
        "corners of the mesh, y and r in m, and how often cells around each are cut towards it",
        "places",
        least=1,
        most=12,
        why="further cuts are thinner than rounding allows",
    ),
    "across": Option("points on sides of cells, y and r in m, to draw lines through", "places"),
    "plain": Option("whether every band and strip is one cell", "flag"),
}

CORRECTED_OPTIONS = {
    **{name: HARMONIC_OPTIONS[name] for name in ("order", "layers", "edge_layers")},
    "harmonic_size": _RELATIVE,
    "refinement": _REFINEMENT,
    "modes": Option(
        "free modes that the body keeps, 0 at rest",
        "whole",
        least=0,
        most=60,
        why="higher ones ovalise",
    ),
    "attachments": _TIES,
}

_GRADED = Option(
    "size of tetrahedra at shoulders and seat ends, m",
    above=0,
    most=100,
    optional=True,
    why="a shaft is at most 20 m long",
)

#: how the matrices of a 3D solid are factored (:class:`solidgear.core.factoring.Factoring`); builders
#: do not see these
FACTORING_OPTIONS = {
    "precision": Option(
        "precision of the factor; solutions are refined in double precision",
        "choice",
        choices=PRECISIONS,
    ),
    "out_of_core": Option("whether the factor is kept in files, in the folder TMPDIR", "flag"),
    "engine": Option(
        "solver: this program, or PETSc under mpirun by MUMPS or (statics only) by multigrid",
        "choice",
        choices=ENGINES,
    ),
    "ranks": Option(
        "processes of PETSc",
        "whole",
        least=1,
        most=4096,
        why="more ranks do not pay",
    ),
}

SECTOR_OPTIONS = {
    "size": _SIZE,
    "graded_size": _GRADED,
    "refinement": _REFINEMENT,
    "material_port": Option(
        "whether the lumped point follows the mean of its span's material, not of its surface",
        "flag",
    ),
    "ovalising": HARMONIC_OPTIONS["ovalising"],
    "attachments": _TIES,
    "half": Option("whether a sector with a mirror plane is solved by half of it", "flag"),
    **FACTORING_OPTIONS,
}

SOLID_OPTIONS = {
    "element": Option("element type", "choice", choices=tuple(ELEMENTS)),
    "relative_size": _RELATIVE,
    "size": _SIZE,
    "layers": replace(
        _layers("shoulders, by default 4 of hexahedra and none of tetrahedra"), optional=True
    ),
    "edge_layers": _layers("seat ends"),
    "radial_layers": _layers("surfaces, across the shaft"),
    "ratio": _RATIO,
    "around": Option(
        "elements around the circumference", "whole", least=8, most=720, why="two to a degree"
    ),
    "graded_size": _GRADED,
    "refinement": _REFINEMENT,
    "attachments": _TIES,
    "half": Option("whether a part with mirror planes is solved by symmetry, in parts", "flag"),
    "coarser": Option(
        "number of mesh files in the list after the one that is solved",
        "whole",
        least=0,
        most=4,
        why="a list has five",
    ),
    **FACTORING_OPTIONS,
}


def checked(
    model: str, options: Mapping[str, Any], available: Mapping[str, Option]
) -> dict[str, Any]:
    """Return options of a builder by name, within the limits of those it has, lists as tuples;
    refuse an unknown name and an unusable value.
    """
    out: dict[str, Any] = {}
    for name, value in options.items():
        if name not in available:
            raise SolidgearError(
                f"{model}: there is no such option as {show(name, 40)}{nearest(name, available)}; "
                f"there are {listed(available)}"
            )
        option = available[name]
        out[name] = None
        if value is not None or not option.optional:
            out[name] = _USABLE[option.kind](model, name, value, option)
    thick_enough(model, out)
    return out


def thick_enough(model: str, options: Mapping[str, Any]) -> None:
    """Refuse layers and a ratio that together make a last layer too thin for its digits."""
    if "ratio" not in options:
        return
    for name in ("layers", "radial_layers"):
        count = options.get(name) or 0
        if options["ratio"] ** count < THINNEST_LAYER:
            most = int(math.log(THINNEST_LAYER) / math.log(options["ratio"]))
            raise SolidgearError(
                f"{model}: {name} = {count} with ratio = {options['ratio']:g} makes a last layer "
                f"of {options['ratio'] ** count:.1e} of the first, which costs digits below "
                f"{THINNEST_LAYER:g}; give {name} of at most {most}, or a larger ratio"
            )


def limits(option: Option) -> str:
    """Return the limits of a number, and why, in words."""
    if option.least is not None and option.most is not None:
        words = f"between {option.least:g} and {option.most:g}"
    else:
        words = " and ".join(
            f"{word} {limit:g}"
            for word, limit in (
                ("above", option.above),
                ("at least", option.least),
                ("at most", option.most),
            )
            if limit is not None
        )
    return words + (f" ({option.why})" if option.why else "")


def _usable_number(model: str, name: str, value: Any, option: Option) -> Any:
    integer = option.kind == "whole"
    if is_number(value, integer) and within(
        value, option.above, option.least, option.below, option.most
    ):
        return value
    hint = ""
    if isinstance(value, tuple) and len(value) == 2 and all(is_number(v) for v in value):
        hint = "; decimals take a point"
    kind = "whole number" if integer else "number"
    raise SolidgearError(
        f"{model}: {name} {show(value)} is not usable; give a {kind} {limits(option)}{hint}"
    )


def _usable_choice(model: str, name: str, value: Any, option: Option) -> str:
    if isinstance(value, str) and value in option.choices:
        return value
    raise SolidgearError(
        f"{model}: {name} {show(value)} is unknown{nearest(value, option.choices)}; use one of "
        f"{', '.join(option.choices)}"
    )


def _usable_flag(model: str, name: str, value: Any, option: Option) -> bool:
    if isinstance(value, bool):
        return value
    raise SolidgearError(f"{model}: {name} {show(value)} is not usable; it is true or false")


def _usable_harmonics(model: str, name: str, value: Any, option: Option) -> tuple[int, ...]:
    values = tuple(value) if isinstance(value, (tuple, list)) else (value,)
    if all(
        is_number(v, whole=True) and within(v, least=option.least, most=option.most) for v in values
    ) and len(set(values)) == len(values):
        return values
    raise SolidgearError(
        f"{model}: {name} {show(value)} is not usable; give whole numbers of at least "
        f"{option.least:g} and at most {option.most:g} ({option.why}), each once, such as 2,3"
    )


def _usable_several(model: str, name: str, value: Any, option: Option) -> tuple[str, ...]:
    values = tuple(value) if isinstance(value, (tuple, list)) else (value,)
    if (
        values
        and all(isinstance(v, str) and v in option.choices for v in values)
        and len(set(values)) == len(values)
    ):
        return values
    unknown = next((v for v in values if v not in option.choices), "")
    raise SolidgearError(
        f"{model}: {name} {show(value)} is not usable{nearest(unknown, option.choices)}; give one "
        f"or more of {', '.join(option.choices)}, each once"
    )


def _usable_places(model: str, name: str, value: Any, option: Option) -> tuple[tuple, ...]:
    """Return places as y and r, m, and with limits a whole number behind them."""
    size = 2 + (option.most is not None)
    single = not isinstance(value, (tuple, list)) or any(map(is_number, value))
    values = tuple(tuple(v) if isinstance(v, list) else v for v in ((value,) if single else value))
    for v in values:
        if not isinstance(v, tuple) or len(v) != size or not all(is_number(x) for x in v):
            raise SolidgearError(
                f"{model}: {name} {show(v)} is not usable; give {size} numbers, y and r in m first"
            )
        for count in v[2:]:
            _usable_number(model, name, count, replace(option, kind="whole"))
    return values


_USABLE = {
    "number": _usable_number,
    "whole": _usable_number,
    "choice": _usable_choice,
    "flag": _usable_flag,
    "harmonics": _usable_harmonics,
    "several": _usable_several,
    "places": _usable_places,
}


def is_number(value: Any, whole: bool = False) -> bool:
    """Return True for a finite number, and a whole one if asked."""
    return (
        isinstance(value, Integral if whole else Real)
        and not isinstance(value, bool)
        and (isinstance(value, Integral) or math.isfinite(value))
    )


def within(value, above=None, least=None, below=None, most=None) -> bool:
    """Return True where a number meets limits; ``least`` and ``most`` may be met."""
    return (
        (above is None or value > above)
        and (least is None or value >= least)
        and (below is None or value < below)
        and (most is None or value <= most)
    )
