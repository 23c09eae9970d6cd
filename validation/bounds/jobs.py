"""What a worker does for the campaign: answers, shapes and references of one body, as plain data."""

from __future__ import annotations

import time
from dataclasses import asdict

import solidgear as sg
from solidgear.errors import SolidgearError
from solidgear.scene import Scene
from solidgear.scene.coned import coned
from validation.attack.reference import Reference
from validation.attack.scenes import random_scene
from validation.bounds.bodies import BODIES
from validation.bounds.truths import (
    PRODUCT,
    SPECTRAL,
    TRIANGLES,
    product_reference,
    spectral_reference,
    told,
    triangle_truth,
)

#: asked for at every body, as far as they exist
ASKED = (
    *("C_zz", "C_z,thx", "C_thx", "C_yy", "C_thy", "K_zz", "K_thx", "K_yy"),
    *("bending 1", "bending 2", "axial 1", "torsion 1"),
)
#: at further lumped points, and between the main one and them
AT_POINTS = ("C_zz", "C_thx")
#: a mode of a mesh made again is the one that was answered if its frequency is this near
SAME = 0.1

#: a shaft longer than this many diameters bends in many modes below its first axial one
SLENDER, MANY = 20.0, 40

_warm: list[bool] = []


def scene_of(body: str) -> Scene:
    """The scene of a body: its name if drawn, ``random SEED``, or the path of a scene file."""
    if body in BODIES:
        return BODIES[body].make()
    if body.startswith("random "):
        return random_scene(int(body.removeprefix("random ")))
    return sg.load(body)


def wanted(scene: Scene) -> tuple[str, ...]:
    """What is asked of a scene."""
    main, *others = (port.name for port in scene.ports)
    at = (f"{name}@{one}" for one in others for name in AT_POINTS)
    between = (f"C_zz@{main}@{one}" for one in others)
    return (*ASKED, *at, *between)


def strange(scene: Scene) -> str:
    """Why the harmonic references do not know a scene; empty if they do."""
    if scene.features or scene.body is not None:
        return "no body of revolution"
    return "fillets" if coned(scene).corners else ""


def run(job: str, *arguments) -> dict:
    """A job by its name; ``{"refused": reason}`` where the program refuses."""
    try:
        return JOBS[job](*arguments)
    except (SolidgearError, ValueError, MemoryError) as error:
        return {"refused": str(error) or type(error).__name__}


def ask(body: str, tolerance: float) -> dict:
    """Numbers with their bars, and what they cost."""
    _warm_up()
    scene = scene_of(body)
    start = time.process_time()
    found = sg.answer(scene, tolerance, ask=wanted(scene))
    seconds = time.process_time() - start
    last = next((step for step in reversed(found.steps) if step.valid), None)
    values = [asdict(value) for value in found.values]
    return {
        "values": [
            {name: v[name] for name in ("quantity", "value", "bar", "size", "side")} for v in values
        ],
        "missing": list(found.missing),
        "reached": found.reached,
        "rung": found.rung,
        "options": dict(last.options) if last else {},
        "unknowns": (last.unknowns or 0) if last else 0,
        "seconds": seconds,
    }


def shapes(body: str, options: dict) -> dict:
    """Modes with their shapes on a mesh made again, or on the usual one where that cannot be."""
    scene = scene_of(body)
    try:
        made = sg.build(scene, "harmonic", **options)
    except (SolidgearError, TypeError):
        made = sg.build(scene, "harmonic")
    found = sg.modes(made, scene, max(scene.ask.modes, 10) + 6, ovalising=False)
    return {"modes": [told(mode) for mode in found.modes]}


def shape_of(name: str, hz: float, modes: list[dict]) -> dict | None:
    """The mode that was answered under a name, among modes with shapes."""
    family = name.split()[0]
    like = [m for m in modes if m["family"] == family and abs(m["frequency_hz"] / hz - 1) < SAME]
    return min(like, key=lambda m: abs(m["frequency_hz"] / hz - 1), default=None)


def spectral(body: str, level: int, limit: int) -> dict:
    """One level of the spectral reference; none if it takes more unknowns than the limit."""
    return {"found": _plain(spectral_reference(_with_modes(scene_of(body)), level, limit))}


def product(body: str) -> dict:
    """The harmonic solid of the product, far finer than in answers."""
    return {"found": _plain(product_reference(_with_modes(scene_of(body))))}


def triangles(body: str) -> dict:
    """The reference of triangles."""
    return {"found": _plain(triangle_truth(scene_of(body)))}


def _plain(found: Reference | None) -> dict | None:
    return None if found is None else asdict(found)


def _with_modes(scene: Scene) -> Scene:
    """With as many modes asked for as a reference needs to have the first axial one among them."""
    thick = 2 * max(max(s.outer0, s.outer1) for s in scene.segments)
    count = MANY if scene.length > SLENDER * thick else scene.ask.modes
    return scene.with_changes(ask=scene.ask.with_changes(modes=max(count, scene.ask.modes)))


def _warm_up() -> None:
    """What the first answer of a process costs beside itself is not counted."""
    if not _warm:
        _warm.append(True)
        sg.answer(scene_of("shoulder 1.2"), 0.1, ask=ASKED)


JOBS = {
    "ask": ask,
    "shapes": shapes,
    SPECTRAL: spectral,
    PRODUCT: product,
    TRIANGLES: triangles,
}
