"""Guards on effects that beams leave out, and on ovalising.  Limits are those of steel (nu = 0.3)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from solidgear.core import BEAM, COMPLIANCE, LADDER, SolidgearError, listed
from solidgear.core.judge import deviations
from solidgear.core.judge.at_rest import spin_caution
from solidgear.core.judge.deviations import TIES
from solidgear.core.judge.quantities import in_words
from solidgear.core.meshing.corners import sharpest_corner
from solidgear.core.models.beam.shoulder import MISSING, grown
from solidgear.guards.notice import Notice, Notices, against, beams, of_theory, sure, with_lumped
from solidgear.guards.probe import Probe

if TYPE_CHECKING:
    from solidgear.core import Scene


def beam_against_solid(probe: Probe) -> Notices:
    """Yield a notice on every beam, compared with a light harmonic solid of the same scene, tied as
    in the scene and by section means.
    """
    tolerance = probe.scene.ask.tolerance
    for model in LADDER.of(BEAM):
        try:
            gaps = probe.gaps(model)
        except SolidgearError as error:
            # One beam that cannot be made does not concern the others.
            yield Notice(
                "avoid", (model,), f"there is no {LADDER[model].title} of this shaft: {error}"
            )
            continue
        if not gaps:
            continue
        by_kind = {
            kind: [gap for gap in gaps if gap.standing(tolerance) == kind]
            for kind in (deviations.BEYOND, deviations.OPEN, deviations.WITHIN)
        }
        kind, worst = next((kind, rows[0]) for kind, rows in by_kind.items() if rows)
        name, gap = worst.quantity, worst.relative
        if name.diagonals:  # a share of their mean is no ratio of the two numbers
            share = f"{abs(gap):.3g} times" if abs(gap) > 1 else f"{100 * abs(gap):.3g} % of"
            ratio = f"{share} the geometric mean of both diagonal entries off"
        else:
            words = ("larger", "smaller") if name.kind == COMPLIANCE else ("higher", "lower")
            ratio = against(gap, *words)
        quantity = in_words(name, probe.main)
        text = (
            f"{quantity} of the {LADDER[model].title} is {ratio} that of a light "
            f"harmonic solid{TIES[worst.attachment]}{sure(worst.bar)}"
        )
        if kind == deviations.BEYOND:
            yield Notice(
                "avoid",
                with_lumped(model),
                f"{text}, more than the {100 * tolerance:g} % asked for; use {probe.instead()}",
            )
        elif kind == deviations.OPEN:
            yield Notice(
                "open",
                with_lumped(model),
                f"{text}, which is too close to the {100 * tolerance:g} % asked for to tell; run "
                "compare to find out",
            )
        else:
            yield Notice(
                "fact",
                with_lumped(model),
                f"{text}, the largest difference of all that is compared",
            )


# slenderness.py: where the last of first bending free, on bearings, and C_zz on bearings passes 1 %
# and 5 %
EULER, TIMOSHENKO = (18.0, 7.9), (1.12, 0.77)


def slenderness(probe: Probe) -> Notices:
    """Yield notices where length over mean diameter is below the limits of uniform shafts."""
    scene = probe.scene
    ratio = scene.length**2 / sum(s.length * (s.outer0 + s.outer1) for s in scene.segments)
    for name, (one_percent, five_percent), models, better in (
        (
            "Euler-Bernoulli",
            EULER,
            of_theory(shear=False),
            probe.instead("the Timoshenko beam or a solid", "timoshenko"),
        ),
        ("Timoshenko", TIMOSHENKO, of_theory(shear=True), probe.instead()),
    ):
        if ratio < one_percent:
            yield Notice(
                "caution",
                models,
                f"length over mean diameter is {ratio:.2f}: on uniform shafts {name} needs "
                f"{one_percent:g} for 1 % and {five_percent:g} for 5 %; use {better}",
            )


# shoulder_step.py: ratio of diameters, share that a beam lacks of the deflection of an overhang of
# one diameter
STEPS = np.array(
    [
        [1.0, 0.0],
        [1.1, 0.0049],
        [1.2, 0.0132],
        [1.3, 0.0238],
        [1.5, 0.0473],
        [1.75, 0.0766],
        [2.0, 0.1036],
        [3.0, 0.1836],
    ]
)
#: ratio of diameters from which 1 % is missed
STEP = 1.17


def shoulder(probe: Probe) -> Notices:
    """Yield notices on steps of the outer radius beyond which stress does not fill the thick part
    at once.
    """
    bent = [model for model in LADDER.of(BEAM) if probe.asked(model).get("shoulder")]
    soft = [name for model in bent for name in with_lumped(model)]
    better = probe.instead("the harmonic solid, or the beam's option shoulder")
    stiff = tuple(model for model in beams() if model not in soft)
    segments, degrees = probe.scene.segments, np.degrees(sharpest_corner(probe.scene)[0])
    if not stiff:
        return
    fillets = "" if degrees > 180 else " (with fillets)"
    by_materials: dict[str, list[tuple[str, str, str, str]]] = {}
    for a, b in zip(segments, segments[1:]):
        (thin, inside), (thick, outside) = sorted(
            ((a.outer1, a.material), (b.outer0, b.material)), key=lambda side: side[0]
        )
        ratio = thick / thin
        more, _ = grown(ratio, inside, outside)
        # of one material; both are shares of the deflection of the beam
        lacking = float(np.interp(ratio, STEPS[:, 0], STEPS[:, 1]))
        lacking = more * lacking / (1 - lacking + more * lacking)
        one_material = abs(more - 1) < 0.1
        small = ratio < STEP if one_material else lacking < 0.01
        if small:
            continue
        missing = more * float(np.interp(ratio, MISSING[:, 0], MISSING[:, 1]))
        materials = "" if one_material else f", {more:.2g} times as much as with one material"
        by_materials.setdefault(materials, []).append(
            (
                f"{a.name!r} to {b.name!r}, y = {1e3 * b.y0:.6g} mm",
                f"{ratio:.2f}",
                f"{2e3 * thin * missing:.2g}",
                f"{100 * lacking:.1f}",
            )
        )
    for materials, steps in by_materials.items():
        places, ratios, missed, shares = (listed(column) for column in zip(*steps))
        yield Notice(
            "caution",
            stiff,
            f"shoulder{'s' if len(steps) > 1 else ''} {places}, ratio {ratios}{fillets}: a beam "
            f"lacks {missed} mm of thin shaft, {shares} % of a short overhang's deflection{materials}; "
            f"use {better}",
        )


# odd_geometry.py: the tilt compliance of a beam is 10 % further off than with a head of half its
# diameter, 88 % at 0.1
DISC = 0.2


def disc_head(probe: Probe) -> Notices:
    """Yield notices on a head so short that it bends in itself."""
    parts = probe.parts
    for port in probe.points:
        middle = (port.lo + port.hi) / 2
        index = next(i for i, (low, high, _) in enumerate(parts) if low <= middle <= high)
        low, high, widest = parts[index]
        neighbours = [wide for i, (_, _, wide) in enumerate(parts) if abs(i - index) == 1]
        if neighbours and max(neighbours) < widest and high - low < DISC * widest:
            yield Notice(
                "caution",
                beams(),
                f"the head with {port.name!r}, y = {1e3 * low:.6g} to {1e3 * high:.6g} mm, is "
                f"{(high - low) / widest:.2g} of its diameter long: below {DISC:g} a beam misses "
                f"10 % and more of its tilt compliance; use {probe.instead()}",
            )


JOINT = 0.5  # odd_geometry.py: the tilt compliance of a beam misses 5 %, at 0.3 12 %


def thin_joint(probe: Probe) -> Notices:
    """Yield a notice on neighbours joined by a ring thinner than either of them."""
    joints = []
    for a, b in zip(probe.scene.segments, probe.scene.segments[1:]):
        ring = min(a.outer1, b.outer0) - max(a.inner1, b.inner0)
        share = ring / min(a.outer1 - a.inner1, b.outer0 - b.inner0)
        if share < JOINT:
            joints.append(
                f"{a.name!r} and {b.name!r} share a ring of {1e3 * ring:.3g} mm at y = "
                f"{1e3 * b.y0:.6g} mm, {share:.2g} of the thinner wall"
            )
    if joints:
        yield Notice(
            "caution",
            beams(),
            f"{'; '.join(joints)}: below {JOINT:g} a beam's tilt compliance misses 5 %, below 0.3 it "
            f"misses 12 %; use {probe.instead()}",
        )


BEYOND = 0.02  # odd_geometry.py's shaft: 1.4 % in the tilt compliance; 7 % at 0.1


def point_beyond_surface(probe: Probe) -> Notices:
    """Yield notices on a lumped point that a solid reaches by extrapolating from its surface, a
    beam along the shaft.
    """
    for port in probe.points:
        distance = max(port.lo - port.y, port.y - port.hi) / probe.diameter(port.y)
        if distance > BEYOND and port.attachment != "section":
            yield Notice(
                "caution",
                (*beams(), *probe.solids),
                f"the lumped point {port.name!r} lies {distance:.2f} diameters beyond its surface "
                f"({1e3 * port.lo:.6g} to {1e3 * port.hi:.6g} mm): from {BEYOND:g} on beams and "
                "solids differ in meaning (7 % in tilt at 0.1); move the point or its surface",
            )


NEAR = 1.2
SUSPECT = (
    1.5  # worth a solution: thin_hollow_shaft.py finds thick rings up to 13 % below the closed form
)


def ovalising(probe: Probe) -> Notices:
    """Yield notices on modes of two and three waves around (a tube ovalises, a disc warps), near or
    below first bending or within the range asked for.
    """
    scene, first = probe.scene, probe.first_bending or 0.0
    limit = max(NEAR * first, scene.ask.max_frequency or 0.0)
    if _two_waves(probe) > SUSPECT * limit:
        return
    inside = {n: f for n, f in probe.ovalising.items() if f < limit}
    if not inside:
        return
    low = min(inside.values())
    lowest = " and ".join(f"n = {n} at {f:.4g} Hz" for n, f in inside.items())
    bound = f"the {limit:g} Hz asked for"
    if limit == NEAR * first:
        bound = f"{NEAR:g} times first bending, {first:.4g} Hz"
    yield Notice(
        "avoid" if low < first else "caution",
        beams(),
        f"sections lose their shape below {bound}: {lowest}, which a beam leaves out; use "
        + probe.instead("the harmonic solid"),
    )
    cells = probe.cells_around if probe.body.fidelity == "solid" else DEFAULT_AROUND
    needed = max(cells_around(scene, n) for n in inside)
    if cells < needed:
        yield Notice(
            "caution",
            ("solid",),
            f"sections lose their shape below {bound}: {lowest}; {cells} cells around make them up "
            "to 25 % too high in a thin wall, 24 cells 2.3 %, 32 cells 0.9 %; use --set "
            f"around={needed}",
        )


def spin(probe: Probe) -> Notices:
    """The speed that a file states moves natural frequencies, which are those at rest."""
    for sentence in spin_caution(probe.whole):
        yield Notice("caution", (), sentence)


#: cells around of the 3D solid by default
DEFAULT_AROUND = 12
#: cells to a wave of a wall that is thin (below a quarter of the radius) or not:
#: thin_hollow_shaft.py, n = 2 of a wall of 0.1 is 2.3 % too high with twelve; a thick disc needs
#: half as many
THIN, CELLS_THIN, CELLS_THICK, MOST_AROUND = 0.25, 12, 6, 48


def cells_around(scene: Scene, waves: int) -> int:
    """Return the cells around that hexahedra need for a shape of so many waves."""
    wall = min(
        min(s.outer0 - s.inner0, s.outer1 - s.inner1) / max(s.outer0, s.outer1)
        for s in scene.segments
    )
    cells_per_wave = CELLS_THIN if wall < THIN else CELLS_THICK
    return min(MOST_AROUND, max(8, 4 * -(-cells_per_wave * waves // 4)))


def _two_waves(probe: Probe) -> float:
    """Compute the frequency of two waves around in closed form, Hz: the lowest of every part as a
    free disc (Leissa, Vibration of Plates, table 2.3) and of every wall as a long ring (Love, sec.
    293).
    """
    segments = probe.scene.segments
    speed = min(
        np.sqrt(s.material.E / (1 - s.material.nu**2) / s.material.density) for s in segments
    )
    discs = [5.36 / np.sqrt(12) * (high - low) / (wide / 2) ** 2 for low, high, wide in probe.parts]
    walls = [
        (outer, inner)
        for s in segments
        for outer, inner in ((s.outer0, s.inner0), (s.outer1, s.inner1))
        if inner
    ]
    rings = [np.sqrt(0.6) * (outer - inner) / ((outer + inner) / 2) ** 2 for outer, inner in walls]
    return float(min(discs + rings) * speed / (2 * np.pi))
