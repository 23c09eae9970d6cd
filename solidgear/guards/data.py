"""Guards on the data of a scene: units, and the stiffness of bearings."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from solidgear.core import DOF_NAMES, Scene, listed
from solidgear.core.loading import case_sentence
from solidgear.core.scene.support import RIGID
from solidgear.guards.notice import Notice, Notices, slip_in_units

if TYPE_CHECKING:
    from solidgear.guards.probe import Probe

# wrong_units.py lists the slips that leave one of these ranges; stiffness begins below that of any
# machine: 1 MN/m, as of soft rolling, film and magnetic bearings, under a shaft of 240 mm
SOUND = {
    "E in Pa": (1e8, 1.5e12),
    "density in kg/m^3": (500.0, 25e3),
    "wave speed in m/s": (300.0, 20e3),
    "stiffness over E d": (2e-5, 10.0),
    "axial stiffness over E d": (5e-6, 5.0),
    "lever sqrt(tilt / radial stiffness) over d": (0.03, 2.0),
    "first bending in Hz": (1.0, 2e5),
}


def load_case(probe: Probe) -> Notices:
    """Yield the case of several under which bearings settle."""
    if sentence := case_sentence(probe.whole):
        yield Notice("fact", (), sentence)


def units(probe: Probe) -> Notices:
    """Yield a notice on an order of magnitude that a slip in units moves: of materials, else of
    bearings, else of the first frequency.
    """
    scene = probe.scene
    mean = float(np.mean([2 * s.outer0 for s in scene.segments]))
    materials, bearings = [], []
    for s in {s.material: s for s in reversed(scene.segments)}.values():
        m = s.material
        materials += [
            (name, value, f"segment {s.name!r}")
            for name, value in zip(SOUND, (m.E, m.density, np.sqrt(m.E / m.density)))
        ]
    # others are worked out at their load, or nothing real
    given_springs = [b for b in scene.bearings if b.catalogue is None and not b.hold]
    for b in given_springs:
        k = np.diag(b.stiffness)
        local = scene.segments[0].material.E * mean
        if 0 < k[1] != RIGID:
            place = f"bearing {b.name!r} in {DOF_NAMES[1]}"
            bearings.append(("axial stiffness over E d", k[1] / local, place))
        for axis, tilt in ((0, 5), (2, 3)):
            if 0 < k[axis] != RIGID:
                place = f"bearing {b.name!r} in {DOF_NAMES[axis]}"
                bearings.append(("stiffness over E d", k[axis] / local, place))
                if k[tilt] > 0:
                    bearings.append(
                        (
                            "lever sqrt(tilt / radial stiffness) over d",
                            np.sqrt(k[tilt] / k[axis]) / mean,
                            place,
                        )
                    )
    first = (
        [("first bending in Hz", probe.first_bending, "the Timoshenko beam")]
        if probe.first_bending
        else []
    )
    # What is wrong early moves all that comes after it.
    for numbers in (materials, bearings, first):
        legend = "d: mean diameter" if numbers is bearings else ""
        if legend and any(np.diag(b.stiffness).max() >= RIGID for b in given_springs):
            legend += f"; {RIGID:g} N/m and more may stand for rigid"
        if sentence := slip_in_units(numbers, SOUND, legend):
            yield Notice("caution", (), sentence)
            return


def doubtful_data(probe: Probe) -> Notices:
    """Yield a notice on bearings whose numbers were assumed or identified."""
    doubtful: dict[str, list[str]] = {}
    for b in probe.scene.bearings:
        if b.status in ("identified", "assumed", "estimated") and not b.hold:
            doubtful.setdefault(b.status, []).append(repr(b.name))
    if doubtful:
        bearings = ", ".join(
            f"bearing{'s' if len(names) > 1 else ''} {listed(names)} ({status})"
            for status, names in doubtful.items()
        )
        yield Notice("caution", (), f"data not measured or published: {bearings}")


def free_motions(probe: Probe) -> Notices:
    """Yield notices on rigid motions that no bearing resists."""
    free = probe.supports.unresisted(probe.body).shape[1]
    if free != 1:  # turning is free
        yield Notice("fact", (), f"rigid motions that no bearing resists: {free}")
    if free > 1 and probe.scene.bearings:
        yield Notice(
            "caution",
            (),
            f"bearings leave {free} rigid motions free, where only torsion should be; give the "
            "missing entries a stiffness",
        )


# strong_coupling.py: below 1e-12 of the diagonal a direction is taken as free; a coupling written
# with four digits shows no less than 1e-3
FREE, FOUR_DIGITS = 1e-12, 1e-3


def oblique_softness(probe: Probe) -> Notices:
    """Yield notices on bearings whose stiffness in one oblique direction is a small difference of
    large entries.
    """
    for b in probe.scene.bearings:
        stiff = np.diag(b.stiffness) > 0
        if not stiff.any():
            continue
        d = np.sqrt(np.diag(b.stiffness)[stiff])
        least = float(np.linalg.eigvalsh(b.stiffness[np.ix_(stiff, stiff)] / np.outer(d, d))[0])
        if least < FOUR_DIGITS and b.catalogue is not None:
            share = "no stiffness"
            if least >= FREE:
                share = f"{least:.1e} of its stiffness"
            yield Notice(
                "caution",
                (),
                f"few rolling elements of bearing {b.name!r} carry at this load, so in one "
                f"oblique direction it has {share}, which changes with the load; more load, "
                "preload or less clearance makes more of them carry; solidgear budget shows the "
                "range",
            )
        elif least < FOUR_DIGITS:
            softness = "is taken as free" if least < FREE else f"is {least:.1e} of its entries"
            yield Notice(
                "caution",
                (),
                f"the couplings of bearing {b.name!r} almost cancel its stiffness in one oblique "
                f"direction, which {softness}; below {FOUR_DIGITS:g} it depends on the fourth digit "
                "of the entries; check their signs and give more digits",
            )


def one_way(probe: Probe) -> Notices:
    """Yield a notice where bearings with a contact angle all hold the shaft in the same direction
    along y.
    """
    yield from (Notice("caution", (), sentence) for sentence in facing_one_way(probe.scene))


def facing_one_way(scene: Scene) -> Iterator[str]:
    """Yield the sentence on rows that all hold the shaft in the same direction along y, if there is
    one.
    """
    rows = [b for b in scene.bearings if b.catalogue and b.catalogue.one_sided]
    ways = {b.catalogue.holds for b in rows if b.catalogue}
    held_otherwise = any(
        not b.floats and (b.catalogue.both_ways if b.catalogue else b.stiffness[1, 1])
        for b in scene.bearings
    )
    if len(rows) > 1 and len(ways) == 1:
        way = ways.pop()
        opposite = "nothing holds it the other way"
        if held_otherwise:
            opposite = "only other bearings hold it the other way, and take all the preload"
        yield (
            f"the bearings {listed([repr(b.name) for b in rows])} all hold the shaft towards {way}: "
            f'{opposite}; turn one of a pair with holds = "{"-y" if way == "+y" else "+y"}"'
        )


def axial_support(probe: Probe) -> Notices:
    """Yield notices on the bearings that hold the shaft along y: named by support, none, or several
    against each other.
    """
    bearings = probe.scene.bearings
    floating = [repr(b.name) for b in bearings if b.floats]
    if floating and not any(b.stiffness[1, 1] for b in bearings):
        float_ = "floats" if len(floating) == 1 else "float"
        others = "" if len(floating) == len(bearings) else ", and no other bearing holds it there"
        yield Notice(
            "caution",
            (),
            f"no bearing locates the shaft along y: {listed(floating)} {float_}{others}; "
            'let one locate it, by support = "locating" or by its kind',
        )
        return
    fixed = [(b, b.catalogue) for b in bearings if b.catalogue and not b.floats]
    both_ways = [repr(b.name) for b, data in fixed if data.both_ways]
    singles = [(repr(b.name), data.holds) for b, data in fixed if data.one_sided]
    if len({way for _, way in singles}) > 1:
        both_ways.append(" with ".join(name for name, _ in singles))
    if len(both_ways) > 1:
        yield Notice(
            "fact",
            (),
            f"bearings {listed(both_ways)} each locate the shaft along y: they share its load by "
            "clearance and stiffness, and forces from heat and seat distances are left out; write "
            'support = "floating" at all but one',
        )
    if any(b.support for b in bearings):
        locating = [repr(b.name) for b in bearings if not b.floats and b.stiffness[1, 1]]
        text = f"along y {listed(locating)} locate{'s' if len(locating) == 1 else ''} the shaft"
        if floating:
            text += f", {listed(floating)} float{'s' if len(floating) == 1 else ''}"
        yield Notice("fact", (), text)


def split_pair(probe: Probe) -> Notices:
    """Yield a notice on a bending pair that the bearings split."""
    split = probe.split
    if split >= 1e-9:
        yield Notice(
            "fact",
            (),
            "bearings that differ between x and z split the first bending pair by "
            f"{100 * split:.2g} % (Timoshenko): 'bending 2' is the twin of 'bending 1'",
        )
