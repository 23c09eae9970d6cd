"""Causes of differences: switch one assumption at a time and measure the effect."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from solidgear.core.errors import SolidgearError
from solidgear.core.judge.quantities import Values, change
from solidgear.core.judge.record import CauseRecord
from solidgear.core.judge.solving import solve
from solidgear.core.quantity import C_ZZ, FIRST_BENDING, K_ZZ, Quantity

if TYPE_CHECKING:
    from solidgear.core.scene import Scene


#: quantities shown for a cause
SHOWN = (C_ZZ, K_ZZ, FIRST_BENDING)


def _solve(scene: Scene, model: str, **options) -> Values:
    return solve(scene, model, **options).quantities


def _row(cause: str, text: str, model: str, new: Values, old: Values) -> CauseRecord:
    moved = {name: change(new, old, name) for name in SHOWN}
    return CauseRecord(cause=cause, change=text, model=model, quantities=moved)


def beam_causes(scene: Scene) -> list[CauseRecord]:
    """Measure the assumptions inside the beam model, with the beam's nodes as ports."""
    scene = scene.with_attachment("section")
    plain = _solve(scene, "euler")
    sheared = _solve(scene, "timoshenko", rotary_inertia=False)
    full = _solve(scene, "timoshenko")
    out = [
        _row("shear", "Euler-Bernoulli -> with shear", "beam", sheared, plain),
        _row("rotary inertia", "without -> with", "timoshenko", full, sheared),
        _row(
            "mass lumping",
            "consistent -> lumped",
            "timoshenko",
            _solve(scene, "timoshenko", mass="lumped"),
            full,
        ),
    ]
    if not any(s.inner0 or s.inner1 for s in scene.segments):
        cowper = _solve(scene, "timoshenko", kappa="cowper")
        out.insert(2, _row("shear coefficient", "Hutchinson -> Cowper", "timoshenko", cowper, full))
    if any(s.outer0 != s.outer1 or s.inner0 != s.inner1 for s in scene.segments):
        out.insert(
            -1,
            _row(
                "head smearing",
                "cone -> mean cylinder",
                "timoshenko",
                _solve(scene, "timoshenko", head="mean"),
                full,
            ),
        )
    return out


def attachment_causes(variants: dict[str, Values], model: str) -> list[CauseRecord]:
    """Measure the effect of the attachment, from results at hand (``average``, ``rigid``,
    ``section`` -> quantities).
    """
    base = variants.get("average")
    if base is None:
        return []
    words = {"rigid": "average -> rigid seats", "section": "average -> section mean everywhere"}
    return [_row("attachment", words[a], model, variants[a], base) for a in words if a in variants]


def shoulder_cause(
    scene: Scene,
    beam_gap: dict[Quantity, float | None],
    options: dict,
    tell: Callable[[str], None] = lambda _: None,
) -> CauseRecord | None:
    """Measure the share of the beam-to-solid gap that comes from the steps of the shaft; None when
    the shaft has no step, or the plain shaft cannot be made.

    The gap (Timoshenko over harmonic, section mean everywhere) of the scene, less the gap of the
    same scene with every outer radius brought down to the smallest one: the corner at a shoulder
    that stress cannot fill.
    """
    if not scene.steps:
        return None
    least_radius = scene.outline.least_radius
    try:
        plain = scene.with_changes(
            segments=tuple(
                s.with_changes(outer0=least_radius, outer1=least_radius) for s in scene.segments
            ),
            blends=(),
        ).with_attachment("section")
    except SolidgearError:
        tell(
            "the effect of the shoulders is not computed: a shaft of the smallest diameter would "
            "be thinner than one of the bores"
        )
        return None
    beam, solid = _solve(plain, "timoshenko"), _solve(plain, "harmonic", **options)

    def share(name):
        stepped, plain_gap = beam_gap.get(name), change(beam, solid, name)
        return None if stepped is None or plain_gap is None else stepped - plain_gap

    return CauseRecord(
        cause="shoulder",
        change="gap to the solid with steps, less without",
        model="timoshenko",
        quantities={name: share(name) for name in SHOWN},
    )
