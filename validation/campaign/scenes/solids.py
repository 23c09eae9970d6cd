"""Bodies for 3D solids beside shafts of revolution: STEP and mesh files of turned shafts, parts with
features, blocks and brackets; each with its meshes, coarse to fine, and how its truth is had.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

import solidgear as sg
from solidgear.core.elements import ELEMENTS
from solidgear.core.ladder import build
from solidgear.core.ladder.registry import LADDER
from solidgear.core.meshing.quality import MeshError
from solidgear.core.models.kinds import CYCLIC
from solidgear.core.scene import Bearing, Material, Port, Scene, Segment
from solidgear.cuts.solid.cuts import mirror_plane
from solidgear.show.outputs import node_order
from validation.campaign.scenes.parts import draw
from validation.campaign.truths.elsewhere import Drawing
from validation.mesh_files import write_boxes, write_mesh
from validation.step_parts import write_step

#: sorts of turned shafts in files: meshes that promise no twins
STEP, MESH_FILE = "STEP", "mesh file"
#: where the truth of a body comes from
HARMONIC, FEATURES, SECTORS, BRICKS = "harmonic", "features", "sectors", "bricks"
ELSEWHERE = "elsewhere"
MATERIAL = Material(E=2.07e11, nu=0.3, density=7850.0)
STEEL = 'material = { E = "207 GPa", nu = 0.3, density = 7850.0 }\n'
SOFT = 'material = { E = "2 GPa", nu = 0.45, density = 1400.0 }\n'
#: hexahedra of a mesh file: twice as many around as meshes of the product have, which know their arcs
AROUND = 16
#: ratio of lengths of cells towards edges of bricks that are the truth
RATIO = 0.2
#: share of a length that the largest of these cells takes at either end
NEAR = 0.1


@dataclass(frozen=True)
class Mesh:
    """A mesh of a scene by a model."""

    scene: Scene
    element: str  #: as tables name it
    options: dict[str, Any]
    model: str = "solid"


@dataclass(frozen=True)
class Part:
    """A body that is no shaft of revolution, or not by its file."""

    sort: str  #: as tables name it
    meshes: list[Mesh]
    source: str  #: of the truth
    #: what the truth is computed from: one scene, or bricks coarse to fine
    exact: list[Scene]
    text: str = field(default="", repr=False)  #: of the scene file of parts with features
    drawing: Drawing | None = None  #: of parts whose truth is had elsewhere


# ------------------------------------------------------------------------------------------------
# - turned shafts in files
def _turned(dice: random.Random) -> tuple[Scene, str]:
    """A shaft of two or three diameters, and its seats as text, mm, alike in both planes."""
    segments: list[Segment] = []
    y, bore = 0.0, dice.choice((0.0, 0.0, 14.0))
    for k in range(dice.choice((2, 2, 3))):
        sizes = {"length": dice.randint(30, 50), "diameter": dice.randint(22, 55), "bore": bore}
        place = {"y0": y / 1e3, **{name: value / 1e3 for name, value in sizes.items()}}
        segments.append(Segment.cylinder(f"s{k}", **place))
        y += sizes["length"]
    first, last = segments[0], segments[-1]
    tie = dice.choice(("average", "average", "rigid"))
    firm = float(f"{10 ** dice.uniform(7.5, 9.5):.4g}")
    seats = {"A": (first, 3.0, 11.0), "B": (last, 1e3 * last.length - 12, 1e3 * last.length - 4)}
    springs = {"A": {"kxx": firm, "kyy": firm, "kzz": firm}, "B": {"kxx": 3e8, "kzz": 3e8}}
    bearings, text = [], []
    for name, (segment, lo, hi) in seats.items():
        given = {"seat_width": (hi - lo) / 1e3, "stiffness": springs[name], "attachment": tie}
        bearings.append(Bearing(name=name, y=segment.y0 + (lo + hi) / 2e3, **given))
        numbers = ", ".join(f'{key} = "{k:.6g} N/m"' for key, k in springs[name].items())
        seat = _seat(segment, lo, hi)
        head = f'[[bearing]]\nname = "{name}"\nattachment = "{tie}"'
        text.append(f"{head}\n{seat}\nstiffness = {{ {numbers} }}")
    port = Port(name="gear", y=first.y0 + 19e-3, lo=first.y0 + 14e-3, hi=first.y0 + 24e-3)
    text.append(f'[port]\nname = "gear"\n{_seat(first, 14, 24)}')
    return Scene.from_parts(segments, MATERIAL, bearings, port), "\n".join(text)


def _seat(segment: Segment, lo: float, hi: float) -> str:
    start = 1e3 * segment.y0
    return (
        f'seat = {{ diameter = "{2e3 * segment.outer0:.6g} mm", '
        f'from = "{start + lo:.6g} mm", to = "{start + hi:.6g} mm" }}'
    )


def _loaded(path: Path, text: str) -> Scene:
    path.write_text(text)
    return sg.load(path)


def step_part(seed: int, folder: Path) -> Part:
    """A turned shaft whose faces are B-splines."""
    shaft, seats = _turned(random.Random(seed))
    path = folder / f"step-{seed}.step"
    if not path.exists():
        write_step(path, shaft.segments, splines=True)
    body = f'[body]\nstep = "{path.name}"\nunit = "mm"\n'
    scene = _loaded(path.with_suffix(".toml"), STEEL + body + seats)
    meshes = [Mesh(scene, "tet10", {"refinement": r}) for r in (0.15, 0.3)]
    return Part(STEP, meshes, HARMONIC, [shaft])


def mesh_part(seed: int, folder: Path) -> Part:
    """A turned shaft as meshes of tetrahedra in a file, of every other seed of hexahedra."""
    shaft, seats = _turned(random.Random(seed))
    element = "tet10" if seed % 2 else "hex20"
    levels: Sequence[dict[str, Any]] = [
        {"element": element, "refinement": r} for r in (0.1, 0.2, 0.3)
    ]
    if element == "hex20":
        usual = LADDER["solid"].meshes({"element": element}).levels[:3]
        levels = [{**level, "around": AROUND} for level in usual]
    files = [folder / f"mesh-{seed}-{k}.vtu" for k in range(len(levels))]
    for file, level in zip(files, levels):
        if not file.exists():
            _write(file, build(shaft, "solid", **level))
    scenes = [
        _loaded(
            file.with_suffix(".toml"), f'{STEEL}[body]\nmesh = "{file.name}"\nunit = "mm"\n{seats}'
        )
        for file in files
    ]
    meshes = [Mesh(scene, element, {}) for scene in scenes]
    return Part(MESH_FILE, meshes, HARMONIC, [shaft])


def _write(path: Path, body: Any) -> None:
    """Write the mesh of a 3D solid, mm."""
    mesh = body.geometry.volume()
    element = ELEMENTS[mesh.element]
    cells = mesh.cells[node_order(mesh.local, element.vtk)].T
    write_mesh(path, 1e3 * mesh.nodes.T, element.cell, cells, {"all": range(len(cells))})


# ------------------------------------------------------------------------------------------------
# - parts with features
def cut_part(seed: int, folder: Path) -> Part:
    """A shaft with keyways, flats and cross holes, by itself and as a correction."""
    drawn, scene = _drawn(seed, "cut", folder)
    sort = "cut" if mirror_plane(scene.features) is None else "half"
    meshes = [Mesh(scene, "tet10", {"refinement": r}) for r in (0.12, 0.25)]
    corrected = LADDER["corrected"].meshes({}).levels[:1]
    meshes += [Mesh(scene, "corrected", dict(level), "corrected") for level in corrected]
    return Part(sort, meshes, FEATURES, [scene], drawn.text)


def sector_part(seed: int, folder: Path) -> Part:
    """A shaft with teeth, splines or bolt circles, as one of its sectors."""
    drawn, scene = _drawn(seed, "cyclic", folder)
    meshes = [Mesh(scene, "sector", {"refinement": 0.08}, "sector")]
    return Part("sector", meshes, SECTORS, [scene], drawn.text)


def _drawn(seed: int, sort: str, folder: Path) -> tuple[Any, Scene]:
    """The first part of a sort that fits together, from a seed on, a thousand apart."""
    for attempt in range(100):
        drawn = draw(seed + 1000 * attempt, sort)
        try:
            scene = _loaded(folder / f"{sort}-{seed}.toml", drawn.text)
            cyclic = {feature.sort for feature in scene.features} == {CYCLIC}
            if not LADDER["sector" if cyclic else "corrected"].unfit(scene):
                return drawn, scene
        except (sg.SolidgearError, MeshError):
            continue
    raise ValueError(f"no part of sort {sort!r} from seed {seed} on")


# ------------------------------------------------------------------------------------------------
# - blocks and brackets
def _held(dice: random.Random, foot: str, eye: str) -> str:
    """A wall and a loaded face."""
    tie = dice.choice(("average", "rigid"))
    wall = 'name = "wall"\nattachment = "rigid"\nhold = "clamped"'
    point = f'name = "tip"\nattachment = "{tie}"'
    ends = f'[[bearing]]\n{wall}\npatch = "{foot}"\n[[port]]\n{point}\npatch = "{eye}"\n'
    return f"{ends}[ask]\nmodes = 4\n"


def _material(dice: random.Random) -> str:
    return dice.choice((STEEL, STEEL, SOFT))


def block_part(seed: int, folder: Path) -> Part:
    """A block held by one of its faces, thin by every other seed, of bricks and of tetrahedra."""
    dice = random.Random(seed)
    x, y, z = (dice.uniform(10, 20) for _ in range(3))
    thin = dice.uniform(6, 12) if seed % 2 else 1.0
    edges = [x / 1e3, 2 * y / 1e3, max(z / thin, 1.2) / 1e3]
    material, held = _material(dice), _held(dice, "foot", "eye")
    counts = [max(1, round((edge / min(edges)) ** 0.5)) for edge in edges]
    patches = {"foot": lambda m: m[1] < 1e-9, "eye": lambda m: m[1] > edges[1] - 1e-9}

    def even(n: int) -> list[np.ndarray]:
        return [np.linspace(0, edge, n * count + 1) for edge, count in zip(edges, counts)]

    def graded(n: int) -> list[np.ndarray]:
        return [_graded([0, edge], n, n * count) for edge, count in zip(edges, counts)]

    tetrahedra = _boxes(folder, f"block-{seed}-t", material, held, map(even, (1, 2, 3)), patches)
    bricks = _boxes(
        folder, f"block-{seed}-x", material, held, map(graded, (2, 3)), patches, bricks=True
    )
    own = held.replace('"foot"', '"-y"').replace('"eye"', '"+y"')
    block = f"body = {{ block = {[float(f'{e:.9g}') for e in edges]} }}\n"
    scene = _loaded(folder / f"block-{seed}.toml", material + block + own)
    meshes = [
        Mesh(scene, element, {"element": element, "refinement": r})
        for element, refinements in (("hex20", (0.25, 0.5)), ("hex27", (0.25, 0.5)))
        for r in refinements
    ]
    meshes += [Mesh(tetrahedron, "tet10", {}) for tetrahedron in tetrahedra]
    return Part("block", meshes, BRICKS, bricks)


def bracket_part(seed: int, folder: Path) -> Part:
    """An angle of two arms, held at the end of one and loaded at that of the other."""
    dice = random.Random(seed)
    arms = [dice.uniform(3, 10) / 1e3 for _ in range(2)]
    reach = [arm + dice.uniform(10, 25) / 1e3 for arm in arms]
    deep = dice.uniform(5, 20) / 1e3
    material, held = _material(dice), _held(dice, "foot", "eye")
    patches = {"foot": lambda m: m[1] > reach[1] - 1e-9, "eye": lambda m: m[0] > reach[0] - 1e-9}
    places = [[0, arms[0], reach[0]], [0, arms[1], reach[1]], [0, deep]]

    def hollow(m: np.ndarray) -> np.ndarray:
        return (m[0] > arms[0]) & (m[1] > arms[1])

    def even(n: int) -> list[np.ndarray]:
        return [_even(marks, n) for marks in places]

    def graded(n: int) -> list[np.ndarray]:
        return [_graded(marks, n, n) for marks in places]

    name = f"bracket-{seed}"
    given = material, held
    tetrahedra = _boxes(folder, f"{name}-t", *given, map(even, (1, 2, 3)), patches, hollow)
    hexahedra = _boxes(
        folder, f"{name}-h", *given, map(even, (1, 2, 3)), patches, hollow, bricks=True
    )
    bricks = _boxes(folder, f"{name}-x", *given, map(graded, (2, 3)), patches, hollow, bricks=True)
    meshes = [Mesh(scene, "tet10", {}) for scene in tetrahedra]
    meshes += [Mesh(scene, "hex20", {}) for scene in hexahedra]
    return Part("bracket", meshes, BRICKS, bricks)


def _even(marks: Sequence[float], cells: int) -> np.ndarray:
    """Lines at some places, and evenly between."""
    parts = [np.linspace(a, b, cells + 1) for a, b in zip(marks, marks[1:])]
    return np.unique(np.concatenate(parts))


def _graded(marks: Sequence[float], layers: int, cells: int) -> np.ndarray:
    """Lines at some places, and ever closer ones towards each."""
    near = NEAR * RATIO ** np.arange(layers - 1, -1, -1)
    inner = np.linspace(NEAR, 1 - NEAR, cells + 1)
    own = np.unique(np.round([0, *near, *inner, *1 - near, 1], 12))
    return np.unique(np.concatenate([a + (b - a) * own for a, b in zip(marks, marks[1:])]))


def _boxes(
    folder: Path,
    name: str,
    material: str,
    held: str,
    levels: Iterable[list[np.ndarray]],
    patches: dict[str, Callable],
    hollow: Callable | None = None,
    bricks: bool = False,
) -> list[Scene]:
    """A scene of every mesh between lines along x, y and z."""
    scenes = []
    for k, lines in enumerate(levels):
        file = folder / f"{name}{k}.msh"
        write_boxes(file, lines, patches, hollow, bricks)
        body = f'body = {{ mesh = "{file.name}", unit = "mm", axis = "none" }}\n'
        scenes.append(_loaded(file.with_suffix(".toml"), material + body + held))
    return scenes


#: of a seed and a folder of files, by what bodies are called
PARTS: dict[str, Callable[[int, Path], Part]] = {
    "step": step_part,
    "mesh": mesh_part,
    "cut": cut_part,
    "sector": sector_part,
    "block": block_part,
    "bracket": bracket_part,
}
