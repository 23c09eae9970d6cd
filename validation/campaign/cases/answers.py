"""Do the error bars of `answer` hold? Bodies drawn to break them, random shafts and scene files."""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Iterable
from functools import partial

import solidgear as sg
from solidgear.core.errors import SolidgearError
from solidgear.core.quantity import Quantity
from solidgear.core.scene import Scene
from solidgear.core.scene.coned import coned
from validation.agree import nested
from validation.agree.commands import answered
from validation.agree.relation import failed
from validation.campaign.case import Case, Run
from validation.campaign.rows import SMALL, SURE, Cost, Found, Row, Said, held
from validation.campaign.scenes.bodies import BODIES
from validation.campaign.scenes.ends import seat_at_edge
from validation.campaign.scenes.shafts import random_scene
from validation.campaign.truths.kept import PRODUCT, TRIANGLES, Truths
from validation.campaign.truths.reference import EXTRA_MODES, LEVELS, plain_mode

#: asked for at every body, as far as they exist
ASKED = (
    *("C_zz", "C_z,thx", "C_thx", "C_yy", "C_thy", "K_zz", "K_thx", "K_yy"),
    *("bending 1", "bending 2", "axial 1", "torsion 1"),
)
#: at further lumped points, and between the main one and them
AT_POINTS = ("C_zz", "C_thx")
#: a reference is refined until its uncertainty is this share of the error, or this small; where a
#: bar seems not to hold until it is sure
SHARE, SHARE_OF_MISSES, FINEST = 0.3, 0.03, 1e-6
#: unknowns of the bending block of a reference
LIMIT = 400_000
#: a mode of a mesh made again is the one that was answered if its frequency is this near
SAME = 0.1

_warm: list[bool] = []


class Answers(Case):
    """Every number of an answer, held against the best of several references."""

    name, question = "answers", "error bars of `answer` against references"
    parts = ((), ("kind",), ("tolerance",), ("kind", "tolerance"))
    seconds = 180.0

    def options(self, parser: argparse.ArgumentParser) -> None:
        add = parser.add_argument
        add("--words", nargs="*", help="drawn bodies whose names have one of these words")
        add("--no-drawn", action="store_true", help="leave the drawn bodies out")
        add("--scenes", nargs="*", default=[], help="scene files")
        add("--tolerance", type=float, nargs="+", default=[1e-2, 1e-3])
        add("--limit", type=int, default=LIMIT, help="unknowns of a reference")
        add("--finest", type=float, default=FINEST, help="uncertainty that is good enough")
        add("--triangles", action="store_true", help="references of triangles too")
        add("--costs", action="store_true", help="processor time of answers alone")
        add("--nested", action="store_true", help="no references: answers beside each other")
        add("--ends", type=int, nargs=2, help="first and last seed of seats that end at edges")
        parser.set_defaults(seeds=None)

    def bodies(self, given: argparse.Namespace) -> list[tuple[str]]:
        first, last = given.seeds or (0, -1)
        random = [f"random {seed}" for seed in range(first, last + 1)]
        first, last = given.ends or (0, -1)
        random += [f"ends {seed}" for seed in range(first, last + 1)]
        return [(name,) for name in (*_drawn(given), *random, *given.scenes)]

    def asked(self, given: argparse.Namespace) -> str:
        drawn = len(_drawn(given))
        parts = [f"{drawn} drawn bodies"] * bool(drawn)
        parts += ["random shafts of seeds {} to {}".format(*given.seeds)] if given.seeds else []
        parts += ["seats at edges of seeds {} to {}".format(*given.ends)] if given.ends else []
        parts += [f"{len(given.scenes)} scene files"] * bool(given.scenes)
        parts += ["with triangles"] * given.triangles + ["costs alone"] * given.costs
        parts += ["beside each other"] * given.nested
        tolerances = ", ".join(f"{one:g}" for one in given.tolerance)
        return f"{'; '.join(parts)}; tolerances {tolerances}"

    def judge(self, run: Run, body: str) -> Found:
        try:
            scene = scene_of(body)
            strange = _strange(scene)
        except Exception as error:  # a scene file may hold anything
            strange = str(error)
        if strange:
            return Found(problems=[f"{body}: {strange}"])
        out, answers = Found(), {}
        for tolerance in run.given.tolerance:
            answer, problem = run.call(ask, scene, tolerance)
            if problem:
                out.problems.append(f"{body} at {tolerance:g}: {problem}")
                continue
            tags = {"tolerance": f"{tolerance:g}"}
            told = {name: answer[name] for name in ("seconds", "unknowns", "reached")}
            out.costs.append(Cost(body, tags, **told))
            if answer["rung"] == "harmonic":
                answers[tolerance] = answer
            else:
                out.problems.append(f"{body} at {tolerance:g}: answered by the {answer['rung']}")
        coarse_first = sorted(answers.items(), reverse=True)
        claims = {f"{tol:g}": answered(answer["values"]) for tol, answer in coarse_first}
        out.failures += map(str, failed(nested.beside(body, claims)))
        if answers and not (run.given.costs or run.given.nested):
            out.rows += self._rows(run, body, scene, answers)
        return out

    def _rows(self, run: Run, body: str, scene: Scene, answers: dict[float, dict]) -> list[Row]:
        """Rows of one body, with references refined as far as its errors ask for it."""
        given, modes = run.given, _Modes(run, scene)
        truths = run.truths(scene, *[given.limit] * len(LEVELS))

        def rows() -> list[Row]:
            return [
                _row(body, tolerance, value, answer["options"], truths, modes)
                for tolerance, answer in answers.items()
                for value in answer["values"]
            ]

        if given.triangles:
            truths.more(TRIANGLES)
        truths.refine(lambda: bool(goals_of(rows(), given.finest)))
        if any(unsettled(row, given.finest) for row in rows()):
            truths.more(PRODUCT)
        return rows()


class _Modes:
    """Shapes of the meshes of answers, made again once and only if they are needed."""

    def __init__(self, run: Run, scene: Scene):
        self.run, self.scene = run, scene
        self.made: dict[str, list[dict]] = {}

    def shape(self, options: dict, name: str, hz: float) -> dict | None:
        """The mode that was answered under a name."""
        key = json.dumps(options, sort_keys=True, default=str)
        if key not in self.made:
            self.made[key] = self.run.call(shapes, self.scene, options)[0] or []
        return shape_of(name, hz, self.made[key])


def _drawn(given: argparse.Namespace) -> list[str]:
    """Names of drawn bodies; of costs alone only those that words select."""
    if given.words:
        return [name for name in BODIES if any(word in name for word in given.words)]
    return [] if given.no_drawn or given.costs or given.ends else list(BODIES)


def _row(
    body: str, tolerance: float, value: dict, options: dict, truths: Truths, modes: _Modes
) -> Row:
    said = Said(**value)
    shape = partial(modes.shape, options, said.quantity, said.value)
    tags = {"kind": kind_of(said.quantity), "tolerance": f"{tolerance:g}"}
    truth = truths.of(said.quantity, said.value, shape)
    return held(said, truth, body=body, tags=tags, tolerance=tolerance)


def kind_of(quantity: str) -> str:
    """Sort a quantity: a mode, a coupling between two motions, or static."""
    name = Quantity(quantity)
    if name.is_frequency:
        return "mode"
    return "static" if name.diagonals is None else "coupling"


def unsettled(row: Row, finest: float = FINEST) -> bool:
    """A better reference might show an error that is worth knowing."""
    if row.error is None:
        return True
    return not row.judged and not row.small and row.doubt > finest


def goals_of(rows: Iterable[Row], finest: float = FINEST) -> dict[str, float]:
    """Uncertainties that a reference should have, of the quantities where it has more."""
    goals: dict[str, float] = {}
    for row in rows:
        share = SHARE_OF_MISSES if row.held is False or row.wrong_side else SHARE
        goal = max(share * row.off, finest)
        if row.error is not None and row.doubt > goal and row.doubt * SURE > SMALL:
            goals[row.quantity] = min(goal, goals.get(row.quantity, 1.0))
    return goals


def shape_of(name: str, hz: float, modes: list[dict]) -> dict | None:
    """The mode that was answered under a name, among modes with shapes."""
    family = name.split()[0]
    like = [m for m in modes if m["family"] == family and abs(m["frequency_hz"] / hz - 1) < SAME]
    return min(like, key=lambda m: abs(m["frequency_hz"] / hz - 1), default=None)


# ------------------------------------------------------------------------------------------------
# - scenes
def scene_of(body: str) -> Scene:
    """The scene of a body: its name if drawn, ``random SEED``, ``ends SEED``, or the path of a scene
    file.
    """
    if body in BODIES:
        return BODIES[body].make()
    if body.startswith("random "):
        return random_scene(int(body.removeprefix("random ")))
    if body.startswith("ends "):
        return seat_at_edge(int(body.removeprefix("ends ")))
    return sg.load(body)


def _strange(scene: Scene) -> str:
    """Reason why the references do not know a scene; empty if they do."""
    if scene.features or scene.body is not None:
        return "no body of revolution"
    return "fillets" if coned(scene).corners else ""


def wanted(scene: Scene) -> tuple[str, ...]:
    """Quantities that are asked of a scene."""
    main, *others = (port.name for port in scene.ports)
    at = (f"{name}@{one}" for one in others for name in AT_POINTS)
    between = (f"C_zz@{main}@{one}" for one in others)
    return (*ASKED, *at, *between)


# ------------------------------------------------------------------------------------------------
# - asked of a worker
def ask(scene: Scene, tolerance: float) -> dict:
    """Numbers with their bars, and what they cost."""
    _warm_up()
    start = time.process_time()
    found = sg.answer(scene, tolerance, ask=wanted(scene))
    seconds = time.process_time() - start
    last = next((step for step in reversed(found.steps) if step.valid), None)
    told = ("quantity", "value", "bar", "size", "side")
    return {
        "values": [{name: getattr(value, name) for name in told} for value in found.values],
        "missing": list(found.missing),
        "reached": found.reached,
        "rung": found.rung,
        "options": dict(last.options) if last else {},
        "unknowns": (last.unknowns or 0) if last else 0,
        "seconds": seconds,
    }


def shapes(scene: Scene, options: dict) -> list[dict]:
    """Modes with their shapes on a mesh made again, or on the usual one where that cannot be."""
    try:
        made = sg.build(scene, "harmonic", **options)
    except (SolidgearError, TypeError):
        made = sg.build(scene, "harmonic")
    found = sg.modes(made, scene, max(scene.ask.modes, 10) + EXTRA_MODES, ovalising=False)
    return [plain_mode(mode) for mode in found.modes]


def _warm_up() -> None:
    """Leave out of the count what the first answer of a process costs beside itself."""
    if not _warm:
        _warm.append(True)
        sg.answer(scene_of("shoulder 1.2"), 0.1, ask=ASKED)
