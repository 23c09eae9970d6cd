"""Bodies beside those of revolution, and seats at every edge of them, drawn by seeds.

    part = FAMILIES["web"](7, folder)

Keyed, splined and crossed shafts and webs with holes as STEP files and as coarse meshes of gmsh; halves of
sleeves, plates, and blocks with two patches side by side as meshes alone; bevel heads, tapered bores,
pairs of rigid seats and seats at edges as scenes.  Of each a seat or the point ends at an edge that only
such a body has: the end of a keyway or of a slot, the rim of a hole, a gap between two seats.  Meshes are
coarse: one cell across a web is among them.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Sequence
from dataclasses import replace
from math import pi
from pathlib import Path
from typing import Any

import numpy as np

import solidgear as sg
from solidgear.core.meshing.gmsh_session import Session, import_gmsh
from solidgear.core.scene import Ask, Bearing, Port, Scene, Segment
from validation.campaign.scenes.ends import seat_at_edge
from validation.campaign.scenes.solids import ELSEWHERE, HARMONIC, MATERIAL, STEEL, Mesh, Part
from validation.campaign.truths.elsewhere import Drawing, Seat

#: refinements of the program's tetrahedra in STEP files and of revolution
REFINEMENTS = (0.12, 0.3)
#: hexahedra of shafts, one cell a band and strip, and the same with cells half as large
PLAIN = {"layers": 0, "radial_layers": 0, "edge_layers": 0, "around": 8}
#: cells of gmsh around a full circle
AROUND = 12
#: endings of files of meshes, by turns
ENDINGS = (".msh", ".inp", ".unv")
#: cylinders of a shaft: diameter, start, end, mm
Cylinders = list[tuple[float, float, float]]
#: a place where a seat may end: y, the cylinder, and whether the seat lies beyond it (1) or before it
Edge = tuple[float, int, int]


# ------------------------------------------------------------------------------------------------
# - shafts as STEP files
def keyed(seed: int, folder: Path) -> Part:
    """A stepped shaft with a keyway, of round or square ends."""
    dice = random.Random(f"keyed {seed}")
    shaft = _shaft(dice)
    k = dice.randrange(len(shaft))
    d, start, end = shaft[k]
    width, deep = dice.uniform(0.25, 0.35) * d, dice.uniform(0.12, 0.2) * d
    length = dice.uniform(0.45, 0.7) * (end - start)
    a = start + dice.choice((0.0, 0.3, 0.6)) * (end - start - length)
    b, floor = a + length, d / 2 - deep
    shapes = _turned(shaft)
    is_round = dice.random() < 0.5
    inset = width / 2 if is_round else 0.0
    shapes.append(("cut", "Box", (-width / 2, a + inset, floor, width, length - 2 * inset, d), 0.0))
    if is_round:
        for y in (a + inset, b - inset):
            shapes.append(("cut", "Cylinder", (0, y, floor, 0, 0, d, width / 2), 0.0))
    edges = [(y, k, way) for y in (a, b) for way in (-1, 1)]
    return _step(dice, "keyed", seed, folder, shaft, shapes, edges)


def splined(seed: int, folder: Path) -> Part:
    """A stepped shaft with slots at its end."""
    dice = random.Random(f"splined {seed}")
    shaft = _shaft(dice)
    d, start, end = shaft[-1]
    count, length = dice.choice((4, 6, 8)), dice.uniform(0.4, 0.7) * (end - start)
    width, deep = dice.uniform(0.3, 0.45) * pi * d / count, dice.uniform(0.08, 0.14) * d
    box = (-width / 2, end - length, d / 2 - deep, width, length + 1.0, d)
    shapes = _turned(shaft)
    shapes += [("cut", "Box", box, 2 * pi * k / count) for k in range(count)]
    last = len(shaft) - 1
    edges = [(end - length, last, -1), (end - length, last, 1), (end, last, -1)]
    return _step(dice, "splined", seed, folder, shaft, shapes, edges)


def crossed(seed: int, folder: Path) -> Part:
    """A stepped shaft with a cross hole."""
    dice = random.Random(f"crossed {seed}")
    shaft = _shaft(dice)
    k = dice.randrange(len(shaft))
    d, start, end = shaft[k]
    radius, middle = dice.uniform(0.08, 0.2) * d, dice.uniform(0.4, 0.6) * (start + end)
    middle = min(max(middle, start + 0.3 * d), end - 0.3 * d)
    shapes = _turned(shaft)
    shapes.append(("cut", "Cylinder", (-d, middle, 0, 2 * d, 0, 0, radius), 0.0))
    edges = [(middle - radius, k, -1), (middle + radius, k, 1)]
    return _step(dice, "crossed", seed, folder, shaft, shapes, edges)


def web(seed: int, folder: Path) -> Part:
    """A gear body: a hub, a web with holes or without any, and a rim that carries the point."""
    dice = random.Random(f"web {seed}")
    d, length = dice.uniform(24, 36), dice.uniform(60, 80)
    rim, width = dice.uniform(45, 60), dice.uniform(12, 20)
    inner, thick = rim - dice.uniform(5, 9), dice.choice((2.0, 3.0, 5.0, 8.0))
    middle, count = length / 2, dice.choice((0, 3, 4, 6))
    hole = dice.uniform(0.2, 0.32) * (inner - d / 2)
    shapes = [
        ("add", "Cylinder", (0, middle - width / 2, 0, 0, width, 0, rim), 0.0),
        ("cut", "Cylinder", (0, middle - width, 0, 0, 2 * width, 0, inner), 0.0),
        ("add", "Cylinder", (0, middle - thick / 2, 0, 0, thick, 0, inner), 0.0),
        ("add", "Cylinder", (0, 0, 0, 0, length, 0, d / 2), 0.0),
    ]
    at = ("cut", "Cylinder", (0, 0, (inner + d / 2) / 2, 0, length, 0, hole))
    shapes += [(*at, 2 * pi * k / count) for k in range(count)]
    share = dice.choice((1.0, 0.5))
    point = Seat("p", _tie(dice), 2 * rim, (middle - width / 2, middle + (share - 0.5) * width))
    wide = 0.12 * length
    held = [(d, (0.0, wide)), (d, (length - 2 * wide, length - wide))]
    seats = (*_bearings(dice, held), point)
    size = dice.choice((2.0, 3.0, 5.0)) * thick
    return _in_files("web", seed, folder, Drawing(tuple(shapes), seats, 2.5 * thick), size)


def _tie(dice: random.Random) -> str:
    return dice.choice(("average", "rigid"))


def _shaft(dice: random.Random) -> Cylinders:
    """Two or three cylinders, no two neighbours of one diameter."""
    out: Cylinders = []
    y, d = 0.0, dice.uniform(20, 40)
    for _ in range(dice.choice((2, 2, 3))):
        length = dice.uniform(0.9, 1.5) * d
        out.append((d, y, y + length))
        y += length
        d *= dice.choice((0.7, 0.8, 1.2, 1.4))
    return out


def _turned(shaft: Cylinders) -> list[tuple]:
    return [("add", "Cylinder", (0, a, 0, 0, b - a, 0, d / 2), 0.0) for d, a, b in shaft]


def _bearings(
    dice: random.Random, places: Sequence[tuple[float, tuple[float, float]]]
) -> list[Seat]:
    """Springs at places, of a diameter and two ends each; the first holds along and around too."""
    seats = []
    for k, (d, ends) in enumerate(places):
        firm = 10 ** dice.uniform(7.5, 9.5)
        more = (0.5 * firm, 2e4 * (d / 30) ** 3) if not k else (0.0, 0.0)
        springs = (firm, more[0], dice.uniform(0.5, 1) * firm, 0.0, more[1], 0.0)
        seats.append(Seat("AB"[k], _tie(dice), d, ends, springs=springs))
    return seats


def _step(
    dice: random.Random,
    sort: str,
    seed: int,
    folder: Path,
    shaft: Cylinders,
    shapes: list[tuple],
    edges: list[Edge],
) -> Part:
    """A part with the point or the second bearing at one of its own edges, at a shoulder or an end."""
    last = len(shaft) - 1
    usual = [(0.0, 0, 1), (shaft[0][2], 0, -1), (shaft[last][1], last, 1)]
    for _ in range(200):
        y, k, way = dice.choice([*edges, *edges, *usual])
        d, start, end = shaft[k]
        width = dice.uniform(0.25, 0.5) * d
        special = tuple(sorted((y, y + way * width)))
        others = [
            (shaft[j][0], (middle - 0.12 * shaft[j][0], middle + 0.12 * shaft[j][0]))
            for j, share in ((0, 0.3), (last, 0.65))
            for middle in [shaft[j][1] + share * (shaft[j][2] - shaft[j][1])]
        ]
        spans = [special, *(ends for _, ends in others)]
        apart = all(a[1] < b[0] - 1 for a, b in zip(sorted(spans), sorted(spans)[1:]))
        if apart and start - 1e-9 <= special[0] and special[1] <= end + 1e-9:
            break
    else:
        raise ValueError(f"no room for three seats on {sort} {seed}")
    three = [(d, special), *others]
    if dice.random() < 0.6:
        point, held = three[0], three[1:]
    else:
        held, point = [three[1], three[0]], three[2]
    seats = (*_bearings(dice, held), Seat("p", _tie(dice), *point))
    smallest = min(d for d, *_ in shaft)
    size = dice.uniform(0.3, 0.6) * smallest
    return _in_files(sort, seed, folder, Drawing(tuple(shapes), seats, 0.5 * smallest), size)


def _in_files(sort: str, seed: int, folder: Path, drawing: Drawing, size: float) -> Part:
    """A part by its STEP file and by a coarse mesh of gmsh, curved, in turns in other formats."""
    step = folder / f"{sort}-{seed}.step"
    given = folder / f"{sort}-{seed}{ENDINGS[seed % len(ENDINGS)]}"
    if not given.exists():
        _write(step, drawing)
        _write(given, drawing, size, cut=any(seat.tie == "rigid" for seat in drawing.seats))
    seats = "\n".join(map(_of_axis, drawing.seats))
    body = '[body]\n{} = "{}"\nunit = "mm"\naxis = "y"\n'
    scenes = [
        _loaded(
            folder / f"{sort}-{seed}-{kind}.toml", f"{STEEL}{body.format(kind, path.name)}{seats}\n"
        )
        for kind, path in (("step", step), ("mesh", given))
    ]
    meshes = [Mesh(scenes[0], "tet10", {"refinement": r}) for r in REFINEMENTS]
    meshes.append(Mesh(scenes[1], "tet10", {}))
    return Part(sort, meshes, ELSEWHERE, scenes[:1], drawing=drawing)


def _of_axis(seat: Seat) -> str:
    """A seat of a part with an axis, as text."""
    low, high = seat.ends
    where = (
        f'seat = {{ diameter = "{seat.diameter:.9g} mm", from = "{low:.9g} mm", '
        f'to = "{high:.9g} mm" }}'
    )
    return _table(seat, where)


def _table(seat: Seat, where: str) -> str:
    head = f'name = "{seat.name}"\nattachment = "{seat.tie}"\n{where}\n'
    if seat.clamped:
        return f'[[bearing]]\n{head}hold = "clamped"\n'
    if not any(seat.springs):
        return f"[[port]]\n{head}"
    names = ("kxx", "kyy", "kzz", "kthx", "kthy", "kthz")
    springs = ", ".join(f"{name} = {k:.9g}" for name, k in zip(names, seat.springs))
    return f"[[bearing]]\n{head}stiffness = {{ {springs} }}\n"


def _loaded(path: Path, text: str) -> Scene:
    path.write_text(text)
    return sg.load(path)


def _write(path: Path, drawing: Drawing, size: float | None = None, cut: bool = False) -> None:
    """Write a drawing, or its mesh with cells of a size, mm; with nodes where seats end, and groups of
    those that are patches.
    """
    gmsh = import_gmsh()
    with Session(gmsh):
        solids = drawing.imprinted(gmsh.model.occ) if cut else drawing.draw(gmsh.model.occ)
        gmsh.model.occ.synchronize()
        if size is not None:
            gmsh.option.setNumber("Mesh.MeshSizeMax", size)
            gmsh.option.setNumber("Mesh.SaveGroupsOfElements", 1)
            gmsh.model.addPhysicalGroup(3, [tag for _, tag in solids], 1, "body")
            for k, seat in enumerate((s for s in drawing.seats if s.plane >= 0), 2):
                faces = [t for _, t in gmsh.model.getEntities(2) if _lies(gmsh, t, seat)]
                gmsh.model.addPhysicalGroup(2, faces, k, seat.name)
            gmsh.option.setNumber("Mesh.MeshSizeFromCurvature", AROUND)
            gmsh.option.setNumber("Mesh.HighOrderOptimize", 2)  # no cell is turned inside out
            gmsh.model.mesh.generate(3)
        gmsh.write(str(path))


def _lies(gmsh: Any, face: int, seat: Seat) -> bool:
    """Whether a plane face lies on a patch."""
    middle = np.array(gmsh.model.occ.getCenterOfMass(2, face))
    return bool(seat.has(middle[:, None])[0])


# ------------------------------------------------------------------------------------------------
# - bodies without an axis, as meshes
def half(seed: int, folder: Path) -> Part:
    """Half a sleeve, held at one of its cut faces and loaded at the other."""
    dice = random.Random(f"half {seed}")
    outer, length = dice.uniform(15, 30), dice.uniform(10, 40)
    inner = outer * (1 - dice.choice((0.08, 0.15, 0.3)))
    far = 2 * outer
    shapes = (
        ("add", "Cylinder", (0, 0, 0, 0, length, 0, outer), 0.0),
        ("cut", "Cylinder", (0, -1, 0, 0, length + 2, 0, inner), 0.0),
        ("cut", "Box", (-far, -1, -far, 2 * far, length + 2, far), 0.0),
    )
    sides = (((-outer, 0, 0), (-inner, length, 0)), ((inner, 0, 0), (outer, length, 0)))
    seats = _patches(dice, [(2, 0.0, side) for side in sides])
    wall = outer - inner
    drawing = Drawing(shapes, seats, 1.5 * wall)
    return _of_meshes("half", seed, folder, drawing, [4 * wall, 2 * wall, wall])


def plate(seed: int, folder: Path) -> Part:
    """A plate with holes or without any, held at one narrow face, loaded at the one opposite."""
    dice = random.Random(f"plate {seed}")
    long, wide = dice.uniform(40, 60), dice.uniform(15, 40)
    thick, count = dice.choice((1.5, 3.0, 6.0)), dice.choice((0, 1, 2))
    shapes = [("add", "Box", (0, 0, 0, long, wide, thick), 0.0)]
    for k in range(count):
        x = long * (k + 1) / (count + 1)
        radius = dice.uniform(0.15, 0.3) * wide
        shapes.append(("cut", "Cylinder", (x, wide / 2, -1, 0, 0, thick + 2, radius), 0.0))
    seats = _patches(dice, [(0, x, None) for x in (0.0, long)])
    sizes = [c * thick for c in (4.0, 2.0, 1.0)]
    return _of_meshes("plate", seed, folder, Drawing(tuple(shapes), seats, 2 * thick), sizes)


def patches(seed: int, folder: Path) -> Part:
    """A block with two patches side by side on one face, held at one and loaded at the other."""
    dice = random.Random(f"patches {seed}")
    x, y, z = dice.uniform(25, 45), dice.uniform(10, 20), dice.uniform(10, 30)
    gap, at = dice.choice((0.5, 1.0, 1.0, 3.0)), dice.uniform(0.4, 0.6) * x
    lines = (((0, y, 0), (at - gap / 2, y, z)), ((at + gap / 2, y, 0), (x, y, z)))
    shapes = (("add", "Box", (0, 0, 0, x, y, z), 0.0),)
    seats = _patches(dice, [(1, y, box) for box in lines])
    sizes = [c * y for c in (1.0, 0.6, 0.35)]
    return _of_meshes("patches", seed, folder, Drawing(shapes, seats, 0.6 * y), sizes)


def _patches(dice: random.Random, places: Sequence[tuple]) -> tuple[Seat, ...]:
    """A clamped patch or one on springs, and a loaded one."""
    foot, eye = (
        Seat(name, _tie(dice), plane=plane, at=at, box=box)
        for name, (plane, at, box) in zip(("foot", "eye"), places)
    )
    if dice.random() < 0.6:
        return replace(foot, tie="rigid", clamped=True), eye
    firm = 10 ** dice.uniform(7.5, 9.5)
    return replace(foot, springs=(firm, firm, firm, *(1e-4 * firm,) * 3)), eye


def _of_meshes(
    sort: str, seed: int, folder: Path, drawing: Drawing, sizes: Sequence[float]
) -> Part:
    """A part as meshes of some sizes of cells, mm, curved."""
    scenes = []
    for k, size in enumerate(sizes):
        file = folder / f"{sort}-{seed}-{k}.msh"
        if not file.exists():
            _write(file, drawing, size, cut=True)
        body = f'body = {{ mesh = "{file.name}", unit = "mm", axis = "none" }}\n'
        seats = "\n".join(_table(seat, f'patch = "{seat.name}"') for seat in drawing.seats)
        scenes.append(_loaded(file.with_suffix(".toml"), f"{STEEL}{body}{seats}\n"))
    meshes = [Mesh(scene, "tet10", {}) for scene in scenes]
    return Part(sort, meshes, ELSEWHERE, scenes[-1:], drawing=drawing)


# ------------------------------------------------------------------------------------------------
# - bodies of revolution
def bevel(seed: int, folder: Path) -> Part:
    """An overhung bevel head, with a tapered bore or none."""
    dice = random.Random(f"bevel {seed}")
    d = dice.uniform(20, 40)
    head, back = dice.uniform(1.6, 2.4) * d, dice.uniform(0.3, 0.6) * d
    face, bore = dice.uniform(0.3, 0.7) * d, dice.choice((0.0, 0.3)) * d
    pieces = [(2.5 * d, d, d, bore, bore)]
    pieces += [(back, dice.uniform(1.0, 1.5) * d, head, bore, bore)]
    pieces += [(face, head, 0.7 * head, bore, 1.3 * bore)]
    tie = _tie(dice)
    y = 2.5 * d
    point = (y + back, y + back + dice.choice((0.5, 1.0)) * face)
    if dice.random() < 0.4:
        point = (y - 0.3 * d, y)
    return _revolved(dice, "bevel", pieces, [(0.1 * d, 0.4 * d), (1.5 * d, 1.9 * d)], point, tie)


def bore(seed: int, folder: Path) -> Part:
    """A sleeve with a tapered bore, its wall thin at one end."""
    dice = random.Random(f"bore {seed}")
    d = dice.uniform(25, 50)
    lengths = [dice.uniform(0.6, 1.2) * d for _ in range(2)]
    small, large = dice.uniform(0.2, 0.4) * d, dice.uniform(0.6, 0.9) * d
    outer = dice.choice((1.0, 1.0, 1.25)) * d
    pieces = [(lengths[0], outer, outer, small, small), (lengths[1], d, d, small, large)]
    y, whole = lengths[0], sum(lengths)
    point = dice.choice([(y, y + 0.3 * d), (whole - 0.2 * d, whole)])
    held = [(0.0, 0.15 * d), (lengths[0] - 0.3 * d, lengths[0] - 0.1 * d)]
    return _revolved(dice, "bore", pieces, held, point, _tie(dice))


def pair(seed: int, folder: Path) -> Part:
    """Two rigid seats a small gap apart, with a shoulder before them or in a hollow shaft."""
    dice = random.Random(f"pair {seed}")
    d, gap = dice.uniform(20, 60), dice.choice((0.3, 1.0, 1.0, 2.0))
    first, second = (dice.uniform(0.15, 0.6) * d for _ in range(2))
    hollow = dice.choice((0.0, 0.4, 0.8)) * d
    shoulder = dice.choice((1.0, 1.4))
    pieces = [(0.8 * d, shoulder * d, shoulder * d, hollow, hollow)]
    pieces += [(first + gap + second + 0.7 * d, d, d, hollow, hollow)]
    y = 0.8 * d + dice.choice((0.0, 0.3 * d))
    held = [(0.1 * d, 0.3 * d), (y, y + first)]
    point = (y + first + gap, y + first + gap + second)
    return _revolved(dice, "pair", pieces, held, point, "rigid", second="rigid")


def _revolved(
    dice: random.Random,
    sort: str,
    pieces: Sequence[tuple[float, float, float, float, float]],
    held: Sequence[tuple[float, float]],
    point: tuple[float, float],
    tie: str,
    second: str | None = None,
) -> Part:
    """A shaft of pieces, each of a length, outer diameters and bores at both ends, mm."""
    segments, y = [], 0.0
    for k, (length, *diameters) in enumerate(pieces):
        radii = dict(zip(("outer0", "outer1", "inner0", "inner1"), (v / 2e3 for v in diameters)))
        place = {"y0": y / 1e3, "y1": (y + length) / 1e3}
        segments.append(Segment(name=f"s{k}", material=MATERIAL, **place, **radii))
        y += length
    bearings = []
    for seat, ends in zip(_bearings(dice, [(2 * pieces[0][1], e) for e in held]), held):
        names = ("kxx", "kyy", "kzz", "kthx", "kthy", "kthz")
        springs = {name: k for name, k in zip(names, seat.springs) if k}
        width = (ends[1] - ends[0]) / 1e3
        given = {"seat_width": width, "stiffness": springs, "y": sum(ends) / 2e3}
        bearings.append(Bearing(name=seat.name, attachment=second or seat.tie, **given))
    lo, hi = (v / 1e3 for v in point)
    port = Port(name="p", y=(lo + hi) / 2, lo=lo, hi=hi, attachment=tie)
    return of_scene(
        sort, Scene.from_parts(segments, MATERIAL, bearings, port, ask=Ask(modes=6), name=sort)
    )


def edge(seed: int, folder: Path) -> Part:
    """A seat of some kind that ends at an edge of some kind of a shaft."""
    return of_scene("edge", seat_at_edge(seed))


def of_scene(sort: str, scene: Scene) -> Part:
    """A shaft of revolution on meshes that somebody set too coarse."""
    meshes = [Mesh(scene, "tet10", {"element": "tet10", "refinement": r}) for r in REFINEMENTS]
    meshes += [
        Mesh(scene, "hex20", {"element": "hex20", "relative_size": size, **PLAIN})
        for size in (2.0, 0.5)
    ]
    return Part(sort, meshes, HARMONIC, [scene])


#: of a seed and a folder of files, by what bodies are called
FAMILIES: dict[str, Callable[[int, Path], Part]] = {
    function.__name__: function
    for function in (keyed, splined, crossed, web, half, plate, patches, bevel, bore, pair, edge)
}
