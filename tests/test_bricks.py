"""Bodies from mesh files of eight-node bricks, which lock in bending, against beams and finer meshes."""

import json

import numpy as np
import pytest

import solidgear as sg
from solidgear.core.judge.settle import settle
from solidgear.core.quantity import Quantity
from solidgear.guards.check import check_scene
from tests.command import command
from validation.mesh_files import write_mesh

E, NU, DENSITY = 207e9, 0.29, 7850.0
MATERIAL = f"material = {{ E = {E}, nu = {NU}, density = {DENSITY} }}\n"
LENGTH, WIDTH, HEIGHT = EDGES = 0.24, 0.012, 0.006
PATCHES = """
[[bearing]]
name = "wall"
patch = "foot"
attachment = "rigid"
hold = "clamped"

[[port]]
name = "tip"
patch = "eye"
"""


def bricks(counts):
    """Corners (n, 3) of a bar along x, mm, and its cells (ne, 8), with so many along every edge."""
    lines = [np.linspace(0, 1e3 * edge, count + 1) for edge, count in zip(EDGES, counts)]
    x, y, z = np.meshgrid(*lines, indexing="ij")
    number = np.arange(x.size).reshape(x.shape)
    low = [number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]]
    cells = [layer[..., k : k + counts[2]] for k in (0, 1) for layer in low]
    points = np.column_stack([x.ravel(), y.ravel(), z.ravel()])
    return points, np.column_stack([cell.ravel() for cell in cells])


def bar(folder, *meshes, ending="inp", kind="C3D8", more=""):
    """A scene file of the bar from mesh files, each with so many cells along every edge."""
    files = []
    for counts in meshes:
        files.append("x".join(map(str, counts)) + f".{ending}")
        points, cells = bricks(counts)
        write_mesh(folder / files[-1], points, "hexahedron", cells, {"all": range(len(cells))})
        if ending == "inp":
            text = (folder / files[-1]).read_text().replace("TYPE=C3D8", f"TYPE={kind}")
            x = points[cells, 0].mean(axis=1)
            for name, side, ends in (
                ("foot", 6, x < x.min() + 1e-6),
                ("eye", 4, x > x.max() - 1e-6),
            ):
                text += f"*SURFACE, NAME={name}, TYPE=ELEMENT\n"
                text += "".join(f"{k + 1}, S{side}\n" for k in np.flatnonzero(ends))
            (folder / files[-1]).write_text(text)
    path = folder / "bar.toml"
    listed = ", ".join(f'"{file}"' for file in files)
    path.write_text(
        f'{MATERIAL}[body]\nmesh = [{listed}]\nunit = "mm"\naxis = "none"\n[ask]\nmodes = 2\n{more}'
    )
    return path


def free_beam(inertia):
    """Lowest frequency of the free bar as an Euler beam, Hz."""
    mass = DENSITY * WIDTH * HEIGHT
    return 4.73004**2 / 2 / np.pi / LENGTH**2 * (E * inertia / mass) ** 0.5


WEAK = WIDTH * HEIGHT**3 / 12


@pytest.mark.parametrize(
    "ending, kind",
    [("inp", "C3D8"), ("inp", "C3D8R"), ("inp", "C3D8I"), ("bdf", ""), ("unv", ""), ("vtu", "")],
)
def test_eight_node_bricks_of_every_format_bend_as_a_beam(tmp_path, ending, kind):
    """Shear and rotatory inertia lower the beam's frequency by 0.3 %, cells of 24 mm raise it by
    0.1 %; in bricks of first order it is twice as high.
    """
    scene = sg.load(bar(tmp_path, (10, 1, 2), ending=ending, kind=kind))
    body = sg.build(scene, "solid")
    assert (scene.body.element, body.mesh["element"]) == ("hex8", "hex20")
    found = sg.modes(body, scene, n=1).frequency_hz[6]
    assert found == pytest.approx(free_beam(WEAK), rel=5e-3)


def test_a_clamped_bar_of_bricks_is_as_soft_as_a_beam(tmp_path):
    """The wall holds the width of the section too, which stiffens the first width or so, of twenty,
    by the square of nu: a seventh of the deflection is of that width, and 8 % of it are lost at most.
    """
    scene = sg.load(bar(tmp_path, (10, 2, 2), more=PATCHES))
    found = sg.condense(sg.build(scene, "solid"), scene, "tip").compliance[2, 2]
    assert found == pytest.approx(LENGTH**3 / 3 / E / WEAK, rel=0.02)


@pytest.mark.parametrize("cells", [(5, 1, 1), (5, 2, 2), (8, 2, 2)])
def test_the_bar_of_one_mesh_holds_the_beam(tmp_path, cells):
    """Whichever way the cells are long: a second mesh with cells as long would say nothing of that."""
    scene = sg.load(bar(tmp_path, cells))
    settled = settle(scene, 0.2, "modes")
    found = sg.modes(settled.body, scene, n=2).modes[6:]
    fine = sg.load(bar(tmp_path, (24, 2, 2)))
    exact = sg.modes(sg.build(fine, "solid"), fine, n=2).modes[6:]
    for mode, finer in zip(found, exact):
        off = mode.frequency_hz / finer.frequency_hz - 1
        assert 0 < off < settled.bars[Quantity(mode.name)] < 0.1
    assert settled.reached


def test_a_block_of_first_order_has_no_bar_narrower_than_it_locks(tmp_path):
    """A quarter too stiff, it resolves no mode beyond, on which a bar could rest."""
    path = tmp_path / "block.toml"
    edges = [WIDTH, LENGTH / 2, HEIGHT]
    path.write_text(f"{MATERIAL}body = {{ block = {edges} }}\nask = {{ modes = 2 }}\n")
    first = command("modes", path, "-f", "solid", "--set", "element=hex8", "--json")
    second = command("modes", path, "--json")
    for own, right in zip(elastic(first), elastic(second)):
        off = own["frequency_hz"] / right["frequency_hz"] - 1
        assert off > 0.05 and (own["bar"] is None or own["bar"] > off)


def elastic(told):
    return [row for row in json.loads(told.stdout)["modes"] if row["frequency_hz"] > 0]


def test_check_looks_at_the_elements_of_a_body_without_an_axis(tmp_path):
    path = bar(tmp_path, (4, 1, 1))
    scene = sg.load(path)
    said = check_scene(scene, sg.build(scene, "solid"))
    assert any("are hex8, which lock in bending, and are solved as hex20" in f for f in said.facts)
    path.write_text(path.read_text().replace(f"nu = {NU}", "nu = 0.499"))
    told = command("check", path).stdout
    assert "nu = 0.499 of 4x1x1.inp: element hex20 locks" in told and "Will not hold" in told
