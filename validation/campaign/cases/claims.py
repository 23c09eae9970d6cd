"""Claims that must hold of every part with features, whatever it looks like."""

from __future__ import annotations

import argparse
import tempfile
import time
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

import solidgear as sg
from solidgear.core.judge.quantities import JUDGED
from solidgear.core.judge.study import study
from solidgear.core.judge.ties import SCENE
from solidgear.core.ladder.model import SOLID
from solidgear.core.ladder.registry import LADDER
from solidgear.core.models.kinds import CYCLIC
from solidgear.core.models.solid.plan import tetrahedra_plan
from solidgear.core.scene.closed_form import mass_properties
from solidgear.cuts.solid.featured import featured_body, meshed
from validation.campaign.case import Case, Run
from validation.campaign.cases.commands import spoken
from validation.campaign.rows import CLAIM, Cost, Found, Row
from validation.campaign.scenes.parts import SORTS, draw
from validation.campaign.truths.volumes import removed_mass, toothed_area

#: meshes of one solve each, coarse
LIGHT: dict[str, dict[str, Any]] = {
    "harmonic": {"order": 3, "layers": 1, "edge_layers": 1, "relative_size": 4.0},
    "sector": {"refinement": 0.6},
    "solid": {"element": "tet10", "refinement": 0.35},
}
#: a coarse mesh of tetrahedra loses so much of the arcs over a cut
OF_CUT = 3e-2
#: unknowns, counted on the mesh, of what is not solved for want of time
HEAVY = 50_000


class Claims(Case):
    """Every model of a part: it can be built or says why not, and its body is sound."""

    name, question = "claims", "random parts with features through every model"
    widths = False
    parts, details = ((), ("claim",)), (("claim", "model"),)
    tag_of_costs = "part"
    seconds = 1800.0

    def options(self, parser: argparse.ArgumentParser) -> None:
        add = parser.add_argument
        add("--sort", choices=SORTS)
        add("--light", action="store_true", help="no bars")
        add("--commands", action="store_true", help="the command line as well")

    def judge(self, run: Run, seed: int) -> Found:
        given = run.given
        drawn = draw(seed, given.sort)
        more = {"bars": not given.light, "commands": given.commands}
        body = f"{seed} {drawn.words}"
        return run.found(body, partial(judged, **more), drawn.text, body)


class Part:
    """Record of one part: claims with a number are rows, the others failures."""

    def __init__(self, body: str):
        self.body, self.found = body, Found()

    def fail(self, text: str) -> None:
        """Note a claim that does not hold."""
        self.found.failures.append(f"{self.body}: {text}")

    def leave(self, text: str) -> None:
        """Note what is not tried."""
        self.found.problems.append(f"{self.body}: {text} left out for want of time")

    def note(self, claim: str, value: float, limit: float, model: str) -> None:
        """Note a number that must not be above its limit; no number at all is above it."""
        off = float(value) if np.isfinite(value) else 1e300
        tags = {"claim": claim, "model": model}
        row = Row(self.body, claim, tags, float(limit), off, how="must hold", rule=CLAIM)
        self.found.rows.append(row)


def tried(scene: sg.Scene, out: Part) -> dict[str, sg.Body]:
    """Bodies of all models, where exactly those that say that they fit can be built."""
    bodies = {}
    for name in LADDER.bodies:
        unfit = LADDER[name].unfit(scene)
        if not unfit and heavy(scene, name, LIGHT.get(name, {})):
            out.leave(name)
            continue
        try:
            bodies[name] = sg.build(scene, name, **LIGHT.get(name, {}))
            if unfit:
                out.fail(f"{name} is built, and says: {unfit}")
        except sg.SolidgearError as error:
            if not unfit:
                out.fail(f"{name} fits, and is refused: {error}")
        except Exception as error:  # that is what is looked for
            out.fail(f"{name} crashes: {type(error).__name__}: {error}")
    return bodies


def heavy(scene: sg.Scene, name: str, options: dict[str, Any]) -> bool:
    """A model takes more time than there is."""
    return LADDER[name].size(scene, options).unknowns > HEAVY


def sound(scene: sg.Scene, name: str, body: sg.Body, out: Part) -> None:
    """A free body, of the mass that the part has, symmetric and positive."""
    out.note("rigid", body.rigid_residual(), 1e-12, name)
    if "min_jacobian_ratio" in body.mesh and body.mesh["min_jacobian_ratio"] <= 0:
        out.fail(f"{name}: an element is inverted")
    model = LADDER[name]
    smeared = name != "sector"
    want, taken = expected_mass(scene, smeared)
    mass = body.mass_matrix()
    size = np.sqrt(np.outer(np.diag(want), np.diag(want)))
    # a beam knows no inertia across the shaft exactly; arcs of fillets are those of the order
    limit = max(model.mass_tolerance, 1e-6) + OF_CUT * taken
    if model.family == SOLID:
        out.note("mass", float(np.abs((mass - want) / size).max()), limit, name)
    found = sg.condense(body, scene, scene.port.name)
    c = found.compliance
    held = np.isfinite(np.diag(c))
    c = c[held][:, held]
    scale = np.sqrt(np.outer(np.diag(c), np.diag(c)))
    out.note("symmetry", np.abs((c - c.T) / scale).max(), 1e-9, name)
    low = np.linalg.eigvalsh((c + c.T) / 2 / scale)[0]
    if low <= 0:
        out.fail(f"{name}: C has the eigenvalue {low:.1e}")
    try:
        hertz = sg.modes(body, scene, n=6).frequency_hz
    except sg.SolidgearError as error:
        out.fail(f"{name}: no modes: {error}")
        return
    if not (np.isfinite(hertz).all() and (np.asarray(hertz)[1:] > 0).all()):
        out.fail(f"{name}: frequencies {hertz}")


def expected_mass(scene: sg.Scene, smeared: bool) -> tuple[np.ndarray, float]:
    """(6, 6) rigid mass matrix of the part, and the largest share that is cut out of it; teeth that
    the scene smears are a cone if `smeared`.
    """
    plain = _revolved(mass_properties(scene.outline))
    removed = removed_mass(scene)
    share = float(np.max(np.diag(removed) / np.diag(plain)))
    for f in scene.features:
        if not f.toothed or (f.smeared and smeared):
            continue
        here = next(s for s in scene.segments if s.name == f.segment)
        assert here.outer0 == here.outer1, "teeth are drawn on cylinders here"
        area, polar = toothed_area(f)
        r, lo, hi = here.outer0, here.y0, here.y1
        m = here.material.density * (hi - lo) * r * r * (np.pi - area)
        turning = here.material.density * (hi - lo) * r**4 * (np.pi / 2 - polar)
        middle, square = (lo + hi) / 2, (hi * hi + lo * hi + lo * lo) / 3
        gone = np.diag([m, m, m, m * square + turning / 2, turning, m * square + turning / 2])
        gone[2, 3] = gone[3, 2] = m * middle
        gone[0, 5] = gone[5, 0] = -m * middle
        removed = removed + gone
    return plain - removed, share


def _revolved(p: Any) -> np.ndarray:
    """Rigid mass matrix about the start of the shaft of a body of revolution."""
    across = p.ixx + p.mass * p.centre**2
    out = np.diag([p.mass, p.mass, p.mass, across, p.iyy, across])
    out[2, 3] = out[3, 2] = p.mass * p.centre
    out[0, 5] = out[5, 0] = -p.mass * p.centre
    return out


def softer(scene: sg.Scene, out: Part) -> None:
    """On one mesh a cut makes every compliance larger, if seats are not cut themselves."""
    if not apart_from_seats(scene):
        return
    wanted = [(s, s.attachment) for s in scene.stations]
    plan = tetrahedra_plan(scene, wanted, size=None, graded_size=None, refinement=0.3, around=12)
    made = meshed(scene, plan, 0.3, True)
    before, after = (
        sg.condense(
            featured_body(scene, wanted, made, 0.3, plain=plain), scene, scene.port.name
        ).compliance
        for plain in (True, False)
    )
    held = np.isfinite(np.diag(before))
    scale = np.sqrt(np.diag(before)[held])
    low = np.linalg.eigvalsh((after - before)[held][:, held] / np.outer(scale, scale))[0]
    out.note("stiffer by a cut", max(0.0, -low), 1e-9, "corrected")


def apart_from_seats(scene: sg.Scene) -> bool:
    """No cut touches a seat."""
    spans = [f.span(scene.segments) for f in scene.features if f.sort == "cut"]
    return all(hi < s.lo or lo > s.hi for lo, hi in spans for s in scene.stations)


def agreeing(scene: sg.Scene, out: Part) -> None:
    """Models with bars of their own agree within them."""
    pair = [n for n in ("harmonic", "corrected", "sector") if n in LADDER.fit(scene)]
    pair = [n for n in pair if not LADDER[n].unfit(scene)][:1]
    solved: dict[str, Any] = {}
    for name, most in ((pair[0], 3), ("solid", 3)) if pair else ():
        if name == "solid" and CYCLIC in {f.sort for f in scene.features}:
            continue
        finest = {"element": "tet10", "refinement": 0.95}
        if name == "solid" and heavy(scene, name, finest):
            out.leave("bars of solid")
            continue
        try:
            options = {"element": "tet10"} if name == "solid" else {}
            solved[name] = study(scene, name, options, most=most, evidence=False)
        except sg.SolidgearError as error:
            out.fail(f"{name} cannot be solved: {error}")
    if len(solved) == 2:
        one, other = solved.values()
        for q in JUDGED:
            both = [s.error_bars.get(SCENE, {}).get(q) for s in (one, other)]
            if None in both or q not in one.quantities or q not in other.quantities:
                continue
            a, b = one.quantities[q], other.quantities[q]
            bars = both[0].width + both[1].width
            out.note(f"gap of {q}", abs(a / b - 1), bars, " and ".join(solved))


def judged(text: str, body: str, *, bars: bool = True, commands: bool = False) -> Found:
    """All claims about one file; `bars` solves ever finer meshes, `commands` runs the command line
    on it.
    """
    start = time.process_time()
    out = Part(body)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "part.toml"
        path.write_text(text)
        scene = sg.load(path)
        for claim in _claims(scene, out, bars):
            try:
                claim()
            except Exception as error:  # that is what is looked for
                out.fail(f"crash: {type(error).__name__}: {error}")
        if commands:
            for wrong in spoken(scene, path):
                out.fail(wrong)
    out.found.costs.append(Cost(body, {}, time.process_time() - start))
    return out.found


def _claims(scene: sg.Scene, out: Part, bars: bool) -> Iterator[Callable[[], None]]:
    bodies = tried(scene, out)
    for name, body in bodies.items():
        yield partial(sound, scene, name, body, out)
    if any(f.sort == "cut" for f in scene.features) and "corrected" in bodies:
        yield partial(softer, scene, out)
    if bars:
        yield partial(agreeing, scene, out)
