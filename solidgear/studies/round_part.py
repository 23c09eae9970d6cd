"""Whether the body of revolution inside a part will do in its place, with the numbers of both."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from solidgear.evidence import quantities
from solidgear.evidence.quantities import change, judged
from solidgear.evidence.study import Solution
from solidgear.evidence.ties import SCENE
from solidgear.evidence.verdict import BEYOND, WITHIN, gap_verdict, percent
from solidgear.fidelity.ladder import LADDER
from solidgear.fidelity.rung import PARTS, SOLID
from solidgear.studies.guards import Notice, Probe

if TYPE_CHECKING:
    from solidgear.scene import Scene

#: model of revolution that is held against the part
ROUND_MODEL = "harmonic"


def described(scene: Scene) -> Iterator[Notice]:
    """What of the part of a scene is round.

    Parameters
    ----------
    scene : Scene
    """
    body = scene.body
    if body is None:
        return
    yield Notice(
        "fact",
        (),
        f"{body.name}: {1e6 * body.volume:.6g} cm^3, of which {len(scene.segments)} segments are the "
        f"round part: {100 * body.round_share:.3g} % of its surface beside end faces and shoulders "
        f"is of revolution, and the volume of the segments is {100 * (body.round_volume - 1):+.2g} % "
        "from that of the part",
    )
    if body.one_mesh:
        yield Notice(
            "caution",
            tuple(r.name for r in LADDER if PARTS in r.holds),
            f"the mesh of {body.name} is the only one there is: how good its numbers are is not "
            "judged; a STEP file would be meshed coarse to fine",
        )


def against_the_part(scene: Scene, rungs: dict[str, Solution], probe: Probe) -> Iterator[Notice]:
    """The light harmonic solid of the round part against the solids of the part itself.

    Parameters
    ----------
    scene : Scene
        With a part from a file.
    rungs : dict of str to Solution
        Solved with the part.
    probe : Probe
        Of the round part.
    """
    if scene.body is None or scene.body.round:
        return
    names, tolerance = judged(scene), scene.ask.tolerance
    for model in (m for m in LADDER.of(SOLID) if m in rungs and PARTS in LADDER[m].holds):
        mine, theirs = probe.rung(ROUND_MODEL), rungs[model]
        told, verdicts = [], []
        for name in names:
            gap = change(mine.quantities, theirs.quantities, name)
            if gap is None:
                continue
            bands = [r.bands.get(SCENE, {}).get(name) for r in (mine, theirs)]
            band = sum(b.gci for b in bands if b is not None)
            unit = quantities.described(name)[2]
            told.append(
                f"{name} {mine.quantities[name]:.5g} {unit} ({'+' * (gap > 0)}{percent(gap)}"
                + (f" +- {percent(band)})" if all(bands) else ", part without a band)")
            )
            verdicts.append(gap_verdict(gap, band, tolerance))
        if not told:
            continue
        if all(v == WITHIN for v in verdicts):
            words = f"within the {percent(tolerance)} asked for, the {LADDER[ROUND_MODEL].title} of its segments would do"
        elif BEYOND in verdicts:
            words = f"more than the {percent(tolerance)} asked for: the part is needed"
        else:
            words = f"whether that is within the {percent(tolerance)} asked for is open"
        yield Notice(
            "caution",
            (model,),
            f"the round part of {scene.body.name} alone, as {LADDER[ROUND_MODEL].title}, has "
            f"{', '.join(told)} against the {LADDER[model].title} of the part; {words}",
        )
