"""Body of revolution inside a part: whether it will do in its place, with the numbers of both."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from solidgear.core import LADDER, WITHIN, Solution, change, gap_verdict, listed
from solidgear.core.judge.deviations import BEYOND
from solidgear.core.judge.quantities import judged
from solidgear.core.judge.ties import SCENE
from solidgear.core.judge.verdict import percent
from solidgear.core.ladder.model import SOLID
from solidgear.core.models.kinds import PARTS
from solidgear.guards.notice import Notice
from solidgear.guards.probe import Probe

if TYPE_CHECKING:
    from solidgear.core import Scene

#: model of revolution that is held against the part
ROUND_MODEL = "harmonic"


def described(scene: Scene) -> Iterator[Notice]:
    """Yield notices on the body of revolution inside the part of a scene."""
    body = scene.body
    if body is None:
        return
    off = 100 * (body.round_volume - 1)
    same = "that of the part" if abs(off) < 1e-6 else f"{off:+.2g} % from that of the part"
    if body.round and abs(off) > 1e-4:
        same += ", as facets of its mesh explain"
        if abs(off) > 0.1:
            # of a polygon on the circle, n sin(t) / 2 and n sin(t) (2 + cos t) / 24 with t = 2 pi / n
            same += (
                ": models of its segments solve the round part; a solid of the mesh is so much "
                f"{'lighter' if off > 0 else 'heavier'}, and its second moment of area about "
                f"twice as much {'lower' if off > 0 else 'higher'}, but its bending depends on "
                "its elements too"
            )
    if body.beside_arcs:
        same += (
            "; arcs such as fillets become cones of the same volume, up to "
            f"{1e3 * body.beside_arcs:.2g} mm off"
        )
    several = len(scene.segments) > 1
    segments = f"{len(scene.segments)} segments are" if several else "1 segment is"
    noun = "segments" if several else "segment"
    yield Notice(
        "fact",
        (),
        f"{body.name}: {1e6 * body.volume:.6g} cm^3; {segments} the round part: "
        f"{100 * body.round_share:.3g} % of its surface without end faces and shoulders is of "
        f"revolution, and the volume of the {noun} is {same}",
    )
    yield from of_files(scene)


def of_files(scene: Scene) -> Iterator[Notice]:
    """Yield notices on the materials of a part, doubts about its files, and a single mesh, which is
    not judged.
    """
    body = scene.body
    assert body is not None  # asked of parts
    yield from _of_materials(scene)
    for sentence in body.doubts(scene.material):
        yield Notice("caution", (), sentence)
    if body.one_mesh and not body.coarser:
        finer = "" if body.edges else "; a STEP file would be meshed coarse to fine"
        yield Notice(
            "caution",
            tuple(model.name for model in LADDER if PARTS in model.holds),
            f"there is one mesh of {body.name}, so that its numbers have no error bar{finer}; "
            'give two, as mesh = ["coarser", "finer"] under [body]',
        )


def _of_materials(scene: Scene) -> Iterator[Notice]:
    """Yield notices on the materials of a part, and on the mean material of the round part."""
    body = scene.body
    assert body is not None  # asked of parts
    if not body.groups:
        return
    labels = [
        f"{group.label} {1e6 * group.volume:.6g} cm^3, {material.density * group.volume:.6g} kg, "
        f"E {material.E / 1e9:.6g} GPa"
        for group, material in zip(body.groups, body.materials(scene.material))
    ]
    yield Notice(
        "fact",
        (),
        f"{body.name} by materials: {'; '.join(labels)}; {body.mass(scene.material):.6g} kg in all",
    )
    if body.mixed:
        yield Notice(
            "caution",
            (),
            f"across {listed(body.mixed, 12)} of the round part several materials lie side by "
            "side; a segment has their mean E and density there, right in tension only",
        )


def against_the_part(
    scene: Scene, solutions: dict[str, Solution], probe: Probe
) -> Iterator[Notice]:
    """Yield notices that compare the light harmonic solid of the round part, which is that of the
    probe, with the solids of the part itself.
    """
    if scene.body is None or scene.body.round:
        return
    names, tolerance = judged(scene), scene.ask.tolerance
    mean_material = ", with one mean material across," if scene.body.mixed else ""
    for model in (m for m in LADDER.of(SOLID) if m in solutions and PARTS in LADDER[m].holds):
        round_solution, solution = probe.solution(ROUND_MODEL), solutions[model]
        labels, verdicts = [], []
        for name in names:
            gap = change(round_solution.quantities, solution.quantities, name)
            if gap is None:
                continue
            bars = [r.error_bars.get(SCENE, {}).get(name) for r in (round_solution, solution)]
            bar = sum(b.width for b in bars if b is not None)
            labels.append(
                f"{name} {round_solution.quantities[name]:.5g} {name.unit} ({'+' if gap > 0 else ''}{percent(gap)}"
                + (f" +- {percent(bar)})" if all(bars) else ", part without an error bar)")
            )
            verdicts.append(gap_verdict(gap, bar, tolerance))
        if not labels:
            continue
        if all(v == WITHIN for v in verdicts):
            words = (
                f"within the {percent(tolerance)} asked for, so the {LADDER[ROUND_MODEL].title} "
                "of its segments is enough"
            )
        elif BEYOND in verdicts:
            words = f"more than the {percent(tolerance)} asked for, so the part itself is needed"
        else:
            words = f"too close to the {percent(tolerance)} asked for to tell"
        yield Notice(
            "caution",
            (model,),
            f"the round part of {scene.body.name} alone{mean_material}, as "
            f"{LADDER[ROUND_MODEL].title}, has {', '.join(labels)} against the "
            f"{LADDER[model].title} of the part: {words}",
        )
