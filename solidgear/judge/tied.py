"""Answers of one mesh, tied as in the scene and by section means."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from solidgear.body import Body, Supports, as_supports
from solidgear.judge.quantities import judged, usual
from solidgear.judge.record import LevelRecord
from solidgear.judge.solving import ENOUGH, Answer, Statics, searched
from solidgear.judge.ties import SCENE, SECTION
from solidgear.ladder import build
from solidgear.ladder.registry import LADDER
from solidgear.machine.meter import Meter
from solidgear.quantity import C_ZZ, FIRST_BENDING, Quantity
from solidgear.solve.statics import SOLVED, flexibility

if TYPE_CHECKING:
    from solidgear.scene import Scene


def solved_ties(
    scene: Scene,
    model: str,
    options: Mapping[str, Any],
    meter: Meter,
    counted_from: float = math.inf,
    spare: bool = False,
) -> dict[str, Answer]:
    """Answers of one mesh, tied as in the scene and by section means; modes are counted from
    so many unknowns on.
    """
    given = {s.attachment for s in scene.stations}
    # Means over seats and over sections are only rows on the same matrices; a rigid seat is another
    # matrix.
    together = "rigid" not in given
    sections = LADDER[model].section_ties
    wanted = (*sorted(given), "section") if sections else sorted(given)
    kinds = tuple(dict.fromkeys(wanted)) if together else None
    extra = {"attachments": kinds} if together else {}
    body = _built(scene, model, {**options, **extra}, meter)
    supports, count = as_supports(scene), body.size >= counted_from
    as_tied: list[str] = [port.attachment for port in scene.ports]
    if together:
        supports = supports.on_stations(scene.stations)
    ties = {
        SCENE: tied_answer(
            scene, body, supports, as_tied if together else None, meter, count, spare
        )
    }
    if given == {"section"}:
        ties[SECTION] = ties[SCENE]
    elif not sections:
        pass  # planes of section ties would have to be graded; another solid judges like for like
    elif together:
        ties[SECTION] = tied_answer(
            scene, body, supports.with_attachment("section"), "section", meter, False
        )
    else:
        plain = scene.with_attachment("section")
        other = _built(plain, model, options, meter)
        ties[SECTION] = tied_answer(plain, other, as_supports(plain), None, meter, False, spare)
    return ties


def _built(scene: Scene, model: str, options: Mapping[str, Any], meter: Meter) -> Body:
    with meter.stage("build"):
        body = build(scene, model, **options)
    if LADDER[model].bounded:
        with meter.stage("statics"):
            flexibility(body, SOLVED)
    return body


def tied_answer(
    scene: Scene,
    body: Body,
    supports: Supports,
    attachments: list[str] | str | None,
    meter: Meter,
    count: bool,
    spare: bool = False,
) -> Answer:
    # Families of two waves and more are reported for the mesh that is; bearings do not move them,
    # nor do error bars rest on them.
    with meter.stage("statics"):
        ports = [port.name for port in scene.ports]
        statics = Statics.at(body, supports, ports, attachments)
    with meter.stage("modes"):
        found = searched(
            body,
            supports,
            max(scene.ask.modes, ENOUGH),
            judged_modes(scene),
            spare=spare,
            max_frequency=scene.ask.max_frequency,
            count=count,
            ovalising=count,
        )
    # Evidence, not part of the answer: kept apart from what the modes cost.
    meter.move("modes", "count", found.evidence.get("count_seconds", 0.0))
    return Answer.of(body, supports, statics, found)


def judged_modes(scene: Scene) -> list[Quantity]:
    """Names of the modes that models are judged by."""
    return [q for q in dict.fromkeys((*usual(scene), *judged(scene))) if q.is_frequency]


def level_of(found: Answer) -> LevelRecord:
    """One mesh of a sequence."""
    body = found.body
    order = body.mesh.get("order")
    return LevelRecord(
        dofs=body.size,
        h=None if order else body.mesh.get("representative_size"),
        order=order,
        quantities={
            name: found.quantities[name]
            for name in (C_ZZ, FIRST_BENDING)
            if name in found.quantities
        },
        mesh=body.mesh,
    )
