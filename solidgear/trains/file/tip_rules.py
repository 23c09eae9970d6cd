"""Tips of two wheels that mesh: refused where they are pointed or cut into the mate.

Tips that the file leaves open, with the rack as well, are those of ISO 53: where no teeth are solved
they stand for nothing but sizes, and one that cuts is a caution.  Tips of a ring are made shorter than
those of ISO 53, which fillets of planets seldom pass, and are refused where they are given alone.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import floor

from solidgear.core import SceneError
from solidgear.core.gears.tip_path import cut_depth, largest_tip
from solidgear.core.gears.wheel import Wheel
from solidgear.core.gears.wheel_pair import WheelPair
from solidgear.trains.file.flanks import Flanks
from solidgear.trains.file.lengths import in_mm, in_um
from solidgear.trains.file.pairs import Pair
from solidgear.trains.file.planetary import PlanetMesh

#: modules that two digits of the profile shifts leave open: tips that cut by less are not refused
ROUNDED = 5e-3
#: last digit of a diameter that fits, m
LAST = 1e-6


def tip_problems(mesh: Pair | PlanetMesh, wheels: WheelPair, solved: bool) -> Iterator[SceneError]:
    """Yield problems of tips that cut into the mate, of given ones and, where teeth are `solved`, of
    assumed ones; with paths from ``pinion`` or ``gear``, or below the table of a stage.
    """
    for k, (key, flanks, _) in enumerate(_members(mesh)):
        wheel = (wheels.first, wheels.second)[k]
        given = flanks.tip_diameter or (flanks.rack and wheel.sign > 0)
        if (given or (solved and wheel.sign > 0)) and is_cutting(wheels, k):
            names = [name for *_, name in _members(mesh)]
            yield SceneError(
                f"{'puts' if given else 'is missing, and by default puts'} tips at "
                f"{in_mm(2 * wheel.tip)} across, which {_cut(wheels, k, names)}",
                path=(key, "rack" if given and not flanks.tip_diameter else "tip_diameter"),
            )


def _members(mesh: Pair | PlanetMesh) -> list[tuple[str, Flanks, str]]:
    """Return key, teeth and name of the first and the second wheel."""
    if isinstance(mesh, Pair):
        gears = mesh.members.items()
        return [(key, gear, shaft) for (key, gear), shaft in zip(gears, mesh.shafts)]
    table = mesh.stage.table
    planet = ("planet", table.planet, "planets")
    if mesh.mate == "sun":
        return [("sun", mesh.stage.sun, "sun"), planet]
    return [planet, ("ring_flanks", table.ring_flanks or Flanks(), "ring")]


def is_cutting(wheels: WheelPair, k: int) -> bool:
    """Return True where tips of the first or the second wheel cut into the other."""
    return cut_depth(wheels, k) > ROUNDED * wheels.first.module


def cut_caution(wheels: WheelPair, k: int, names: Sequence[str]) -> str:
    """Return a sentence on tips that cut."""
    wheel = (wheels.first, wheels.second)[k]
    assumed = "" if wheel.tip_radius is not None else " if they are those of its rack"
    size = f"{in_mm(2 * wheel.tip)} across{assumed},"
    return f"tips of the {names[k]}, {size} {_cut(wheels, k, names)}"


def _cut(wheels: WheelPair, k: int, names: Sequence[str]) -> str:
    """Return what tips do and what would fit, in words."""
    depth = in_um(cut_depth(wheels, k))
    cut = f"cut {depth} deep into the teeth of the {names[1 - k]}"
    wheel, radius = (wheels.first, wheels.second)[k], largest_tip(wheels, k)
    if radius is None:
        return f"{cut}, and no shorter ones fit; correct profile shifts, teeth or centre distance"
    # towards shorter teeth, which are wider in a ring
    steps = floor(wheel.sign * 2 * radius / LAST) * wheel.sign
    least = "at most" if wheel.sign > 0 else "at least"
    return f"{cut}; a tip_diameter of {least} {in_mm(steps * LAST)} fits"


def pointed_problem(wheel: Wheel, flanks: Flanks, path: tuple) -> SceneError | None:
    """Return a problem of teeth whose flanks meet before their tip circle."""
    if wheel.tip_thickness >= 0:
        return None
    point = f"in which these teeth end, {in_mm(2 * wheel.point)} across"
    if flanks.tip_diameter:
        reason = f"of {in_mm(flanks.tip_diameter)} lies beyond the point {point}; correct it"
        return SceneError(reason, path=(*path, "tip_diameter"))
    key = "rack" if flanks.rack else "profile_shift" if wheel.shift else "teeth"
    return SceneError(
        f"puts tips at {in_mm(2 * wheel.tip)} across, beyond the point {point}; give a smaller "
        f"tip_diameter, or correct {'it' if key != 'rack' else 'rack or profile shift'}",
        path=(*path, key),
    )
