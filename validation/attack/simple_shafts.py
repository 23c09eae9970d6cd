"""Very simple shafts, one length or constant varied at a time.

:mod:`validation.attack.families` holds bars against them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from solidgear.scene import Bearing, Material, Port, Scene, Segment

D = 0.04
STEEL = Material(E=2.07e11, nu=0.3, density=7850)

Maker = Callable[[], Scene]


def shaft(*pieces: tuple, material: Material = STEEL) -> list[Segment]:
    """Pieces end to end: length, diameter (or two, of a cone), bore and material, as far as given."""
    out: list[Segment] = []
    for k, piece in enumerate(pieces):
        length, diameter, bore, own = (*piece, *(0.0, material)[len(piece) - 2 :])
        one, other = diameter if isinstance(diameter, tuple) else (diameter, diameter)
        y = out[-1].y1 if out else 0.0
        radii = {"outer0": one / 2, "outer1": other / 2, "inner0": bore / 2, "inner1": bore / 2}
        out.append(Segment(name=f"s{k}", y0=y, y1=y + length, material=own, **radii))
    return out


def seat(y: float, width: float, k: float = 1e9, tilt: float = 0.0, tie: str = "average") -> dict:
    """A bearing, without its name."""
    springs = {"kxx": k, "kyy": k, "kzz": k} | ({"kthx": tilt, "kthz": tilt} if tilt else {})
    return {"y": y, "seat_width": width, "stiffness": springs, "attachment": tie}


def scene(
    pieces: list[Segment], y: float, width: float, *seats: dict, tie: str = "average"
) -> Scene:
    """A shaft with its lumped point at y, on some seats."""
    port = Port(name="p", y=y, lo=y - width / 2, hi=y + width / 2, attachment=tie)
    bearings = [Bearing(name=f"b{k}", **one) for k, one in enumerate(seats)]
    return Scene.from_parts(pieces, port=port, bearings=bearings)


def families() -> dict[str, Maker]:
    """Every shaft by its name."""
    out: dict[str, Maker] = {}
    for family in FAMILIES:
        out |= dict(family())
    return out


def _two(pieces: list[Segment], width: float, k: float = 1e9, tie: str = "average") -> Scene:
    """Two equal seats at the quarters of a shaft, its point in the middle."""
    length = pieces[-1].y1
    ends = (seat(share * length, width, k, tie=tie) for share in (0.25, 0.75))
    return scene(pieces, length / 2, width, *ends, tie=tie)


def _seats() -> Iterator[tuple[str, Maker]]:
    for w in (0.05, 0.12, 0.25, 0.5, 1, 2):
        for k in (1e7, 1e9, 1e11):
            yield (
                f"bar, seats {w:g} D wide on {k:g} N/m",
                lambda w=w, k=k: _two(shaft((8 * D, D)), w * D, k),
            )
    for ratio in (0.03, 0.05, 0.1, 0.2, 0.5, 1, 20, 50):
        wide = (0.2 * ratio if ratio < 3 else 0.4) * D
        held = seat(0.25 * ratio * D, wide, tilt=1e5)
        yield (
            f"bar {ratio:g} D long",
            lambda ratio=ratio, wide=wide, held=held: scene(
                shaft((ratio * D, D)), 0.7 * ratio * D, wide, held
            ),
        )


def _tubes() -> Iterator[tuple[str, Maker]]:
    for wall in (0.02, 0.05, 0.1, 0.3, 0.6):
        for w in (0.1, 0.4):
            yield (
                f"tube, wall {wall:g} R, seats {w:g} D wide",
                lambda wall=wall, w=w: _two(shaft((6 * D, D, D * (1 - wall))), w * D, 1e8),
            )


def _steps() -> Iterator[tuple[str, Maker]]:
    for ratio in (1.002, 1.02, 1.1, 1.5, 3, 8):
        for w in (0.2, 0.8):
            for side, at, y in (("smaller", 1, 2), ("larger", 4, 5.3)):
                yield (
                    f"step of {ratio:g}, seats {w:g} D wide on its {side} side",
                    lambda ratio=ratio, w=w, at=at, y=y: scene(
                        shaft((3 * D, D), (3 * D, ratio * D)),
                        y * D,
                        w * D,
                        seat(at * D, w * D, tilt=1e5),
                    ),
                )


def _rotors() -> Iterator[tuple[str, Maker]]:
    for ratio in (1.5, 2.5, 4):
        for w in (0.5, 1.0, 2.0):
            yield (
                f"rotor of {ratio:g} D on a shaft, seats {w:g} D wide on it",
                lambda ratio=ratio, w=w: scene(
                    shaft((2 * D, D), (6 * D, ratio * D), (2 * D, D)),
                    3.5 * D,
                    w * D,
                    seat(6.5 * D, w * D, 1e10, 1e6),
                ),
            )
    for k in (1e3, 1e5, 1e7, 1e10, 1e12):
        pieces = ((0.02, 0.025), (0.03, 0.03), (0.06, 0.036), (0.02, 0.045), (0.05, 0.032))
        yield (
            f"gearbox shaft on {k:g} N/m",
            lambda k=k, pieces=pieces: scene(
                shaft(*pieces, (0.02, 0.025)),
                0.12,
                0.018,
                seat(0.01, 0.014, k),
                seat(0.19, 0.014, k),
            ),
        )


def _flanges() -> Iterator[tuple[str, Maker]]:
    for thick in (0.03, 0.1, 0.3):
        for ratio in (2, 4):
            for where, y, w in (("its shaft", 2.0, 0.5), ("its rim", 3 + thick / 2, thick)):
                yield (
                    f"flange of {ratio} D, {thick:g} D thick, loaded on {where}",
                    lambda thick=thick, ratio=ratio, y=y, w=w: scene(
                        shaft((3 * D, D), (thick * D, ratio * D), (2 * D, D)),
                        y * D,
                        w * D,
                        seat(0.5 * D, 0.4 * D),
                        seat(4 * D, 0.4 * D),
                    ),
                )


def _plates() -> Iterator[tuple[str, Maker]]:
    wide = 5 * D
    for ratio in (0.006, 0.01, 0.03, 0.08, 0.2):
        for bore in (0, 0.05, 0.3, 0.8):
            for k in (1e7, 1e10):
                yield (
                    f"plate {ratio:g} D thick, bore {bore:g} D, on {k:g} N/m",
                    lambda thick=ratio * wide, bore=bore * wide, k=k: scene(
                        shaft((thick, wide, bore)),
                        0.7 * thick,
                        0.2 * thick,
                        seat(0.25 * thick, 0.2 * thick, k, tilt=1e5),
                    ),
                )


def _bells() -> Iterator[tuple[str, Maker]]:
    for wall in (0.01, 0.03, 0.1):
        for disc in (0.01, 0.03, 0.1):
            inside = 3 * (1 - wall) * D
            yield (
                f"bell, disc of {disc:g} D, wall of {wall:g} radii, loaded on its drum",
                lambda disc=disc, inside=inside: scene(
                    shaft((2.5 * D, D), (disc * D, 3 * D), (2.5 * D, 3 * D, inside)),
                    4.5 * D,
                    0.5 * D,
                    seat(0.5 * D, 0.4 * D),
                    seat(2 * D, 0.4 * D),
                ),
            )
            yield (
                f"bell, disc of {disc:g} D, wall of {wall:g} radii, drum first",
                lambda disc=disc, inside=inside: scene(
                    shaft((D, 3 * D, inside), (disc * D, 3 * D), (1.5 * D, D)),
                    0.5 * D,
                    0.3 * D,
                    seat((1.5 + disc) * D, 0.4 * D),
                    seat((2.2 + disc) * D, 0.4 * D),
                ),
            )


def _materials() -> Iterator[tuple[str, Maker]]:
    for times in (0.01, 0.1, 0.35, 3, 30):
        other = Material(E=times * STEEL.E, nu=0.3, density=7850)
        for ratio in (1, 1.5):
            yield (
                f"second piece {times:g} times as stiff, {ratio:g} D",
                lambda other=other, ratio=ratio: scene(
                    shaft((3 * D, D), (3 * D, ratio * D, 0.0, other)),
                    5 * D,
                    0.5 * D,
                    seat(D, 0.4 * D, tilt=1e5),
                ),
            )
    for nu in (0.0, 0.45, 0.49, 0.499):
        whole = Material(E=STEEL.E, nu=nu, density=7850)
        yield (
            f"Poisson's ratio {nu:g}",
            lambda whole=whole: scene(
                shaft((3 * D, D), (3 * D, 1.5 * D), material=whole),
                5 * D,
                0.5 * D,
                seat(D, 0.4 * D, tilt=1e5),
            ),
        )


def _ties() -> Iterator[tuple[str, Maker]]:
    for tie in ("rigid", "section"):
        for w in (0.1, 0.4, 0.9):
            yield (
                f"bar, {tie} seats {w:g} D wide",
                lambda tie=tie, w=w: _two(shaft((6 * D, D)), w * D, tie=tie),
            )
            yield (
                f"step, {tie} seats {w:g} D wide",
                lambda tie=tie, w=w: scene(
                    shaft((3 * D, D), (3 * D, 1.3 * D)),
                    2.4 * D,
                    min(w, 0.7) * D,
                    seat(1.5 * D, w * D, tie=tie),
                    seat(4.5 * D, w * D, tie=tie),
                    tie=tie,
                ),
            )


def _cones() -> Iterator[tuple[str, Maker]]:
    for angle in (5, 20, 45, 65, 75):
        top = D + float(np.tan(np.radians(angle))) * D
        held = (seat(0.5 * D, 0.4 * D), seat(2 * D, 0.4 * D))
        yield (
            f"cone of {angle} degrees, rising from a cylinder",
            lambda top=top, held=held: scene(
                shaft((3 * D, D), (0.5 * D, (D, top)), (0.3 * D, top)), 3.65 * D, 0.2 * D, *held
            ),
        )
        yield (
            f"cone of {angle} degrees, falling from a step",
            lambda top=top, held=held: scene(
                shaft((3 * D, D), (0.5 * D, (top, D))), 3.25 * D, 0.3 * D, *held
            ),
        )


def _crowded() -> Iterator[tuple[str, Maker]]:
    held = seat(D, 0.4 * D, tilt=1e5)
    for bore in (0.2, 0.6, 0.9):
        yield (
            f"blind bore of {bore:g} D",
            lambda bore=bore: scene(shaft((3 * D, D, bore * D), (3 * D, D)), 5 * D, 0.5 * D, held),
        )
    for gap in (0.001, 0.01, 0.1, 0.5):
        yield (
            f"groove {gap:g} D wide",
            lambda gap=gap: scene(
                shaft((2 * D, D), (gap * D, 0.8 * D), (2 * D, D)), 3.5 * D, 0.5 * D, held
            ),
        )
        yield (
            f"seat that ends {gap:g} D before a step",
            lambda gap=gap: scene(
                shaft((3 * D, D), (3 * D, 1.4 * D)), (2.8 - gap) * D, 0.4 * D, held
            ),
        )
        yield (
            f"two seats {gap:g} D apart",
            lambda gap=gap: scene(
                shaft((6 * D, D)),
                4 * D,
                0.5 * D,
                *(seat(y, 0.4 * D) for y in (2 * D, (2.4 + gap) * D)),
            ),
        )


FAMILIES = (
    *(_seats, _tubes, _steps, _rotors, _flanges, _plates),
    *(_bells, _materials, _ties, _cones, _crowded),
)
