"""One mesh of a scene solved in all ways of tying: as the scene is tied, and like for like by the mean
motion of sections.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from solidgear.core.body import Body, Supports, as_supports
from solidgear.core.judge.quantities import judged, usual
from solidgear.core.judge.solving import ENOUGH, Answer, Statics, search_modes
from solidgear.core.judge.ties import SCENE, SECTION
from solidgear.core.ladder import build
from solidgear.core.ladder.registry import LADDER
from solidgear.core.machine.meter import Meter
from solidgear.core.safety import ROOM
from solidgear.core.solve.modes import ModeSet
from solidgear.core.solve.statics import SOLVED, flexibility

if TYPE_CHECKING:
    from solidgear.core.scene import Scene


@dataclass(frozen=True)
class Tied:
    """One mesh, tied as in the scene, with statics."""

    body: Body
    supports: Supports
    statics: Statics


def tied_statics(scene: Scene, model: str, options: Mapping[str, Any], meter: Meter) -> Tied:
    """Build one mesh, and solve statics with the ties of the scene."""
    attachments = sorted({s.attachment for s in scene.stations})
    builder_options = dict(options)
    supports = as_supports(scene)
    port_attachments: list[str] | None = None
    if _one_matrix(scene):
        kinds = (*attachments, "section") if LADDER[model].section_ties else attachments
        builder_options["attachments"] = tuple(dict.fromkeys(kinds))
        supports = supports.on_stations(scene.stations)
        port_attachments = [port.attachment for port in scene.ports]
    body = _built(scene, model, builder_options, meter)
    return tied_by(scene, body, supports, port_attachments, meter)


def _one_matrix(scene: Scene) -> bool:
    """Return whether sections are tied on the matrices of the scene.

    Means over seats and over sections are only rows on the same matrices; a rigid seat is another
    matrix.
    """
    return "rigid" not in {s.attachment for s in scene.stations}


def solved_ties(
    scene: Scene,
    tied: Tied,
    model: str,
    options: Mapping[str, Any],
    meter: Meter,
    counted_from: float = math.inf,
    spare: bool = False,
) -> dict[str, Answer]:
    """Solve one mesh, tied as in the scene and by section means; modes are counted from so many
    unknowns on.
    """
    count = tied.body.size >= counted_from
    ties = {SCENE: solved_modes(scene, tied, meter, count, spare)}
    if {s.attachment for s in scene.stations} == {"section"}:
        ties[SECTION] = ties[SCENE]
    elif not LADDER[model].section_ties:
        pass  # planes of section ties would have to be graded; another solid judges like for like
    elif _one_matrix(scene):
        section_supports = tied.supports.with_attachment("section")
        sections = tied_by(scene, tied.body, section_supports, "section", meter)
        ties[SECTION] = solved_modes(scene, sections, meter)
    else:
        by_sections = scene.with_attachment("section")
        body = _built(by_sections, model, options, meter)
        sections = tied_by(by_sections, body, as_supports(by_sections), None, meter)
        ties[SECTION] = solved_modes(by_sections, sections, meter, spare=spare)
    return ties


def _built(scene: Scene, model: str, options: Mapping[str, Any], meter: Meter) -> Body:
    with meter.stage("build"):
        body = build(scene, model, **options)
    if LADDER[model].follows:
        with meter.stage("statics"):
            flexibility(body, SOLVED)
    return body


def tied_by(
    scene: Scene,
    body: Body,
    supports: Supports,
    attachments: list[str] | str | None,
    meter: Meter,
) -> Tied:
    """Solve statics of a body tied in one way."""
    with meter.stage("statics"):
        ports = [scene.port.name, *(port.name for port in scene.further_ports)]
        return Tied(body, supports, Statics.at_points(body, supports, ports, attachments))


def solved_modes(
    scene: Scene, tied: Tied, meter: Meter, count: bool = False, spare: bool = False
) -> Answer:
    """Solve the modes of a body tied in one way."""
    body, supports = tied.body, tied.supports
    with meter.stage("modes"):
        modes = modes_of(scene, body, supports, count, spare)
    # Evidence, not part of the answer: kept apart from what the modes cost.
    meter.move("modes", "count", modes.evidence.get("count_seconds", 0.0))
    return Answer.measured(body, supports, tied.statics, modes)


def modes_of(
    scene: Scene, body: Body, supports: Supports, count: bool, spare: bool = False
) -> ModeSet:
    """Find the modes of a comparison, those that models are judged by among them."""
    names = dict.fromkeys((*usual(scene), *judged(scene)))
    return search_modes(
        body,
        supports,
        max(scene.ask.modes, ENOUGH),
        [q for q in names if q.is_frequency],
        spare=spare,
        max_frequency=scene.ask.max_frequency,
        count=count,
        room=ROOM if count or spare else 0.0,
        # Families of two waves and more are reported for the finest mesh; bearings do not move
        # them, nor do error bars rest on them.
        ovalising=count,
    )
