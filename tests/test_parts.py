"""Parts from STEP and mesh files: what went out comes in again, whatever unit, axis and format."""

import functools
import math
import pickle
from dataclasses import replace
from pathlib import Path

import meshio
import numpy as np
import pytest
import skfem

import solidgear as sg
from solidgear.core.elements import ELEMENTS
from solidgear.core.ladder.registry import LADDER
from solidgear.core.machine.isolated import isolated
from solidgear.core.meshing.placing import TURNS, Placing
from solidgear.core.scene.closed_form import volume_of
from solidgear.core.scene.outline import Frustum, Outline
from solidgear.cuts.features import Keyway
from solidgear.guards import check, round_part
from solidgear.parts.mesh_file import mesh_from
from solidgear.parts.own_mesh import solid_body
from solidgear.parts.round_part import _evened as round_radii
from solidgear.parts.round_part import _joined as joined
from solidgear.show.outputs import node_order
from validation.step_parts import shaft_step, with_unit, write_step

ROOT = Path(__file__).parent.parent
SCENE = ROOT / "geometry" / "shaft_step.toml"
COARSE = {"refinement": 0.25}


def numbers(body, scene):
    """C_zz, and the first elastic frequencies."""
    compliance = sg.condense(body, scene, port=scene.port.name).compliance
    return np.array([compliance[2, 2], *sg.modes(body, scene, n=4).frequency_hz[1:4]])


def scene_text(**body):
    """The shipped scene with another [body]."""
    head, rest = SCENE.read_text().split("\n[body]\n")
    tail = rest[rest.index("# A seat is") :]
    lines = "".join(f"{k} = {v if isinstance(v, list) else repr(v)}\n" for k, v in body.items())
    return f"{head}\n[body]\n{lines.replace(chr(39), chr(34))}\n{tail}"


def load(folder, **body):
    path = folder / "scene.toml"
    path.write_text(scene_text(**body))
    return sg.load(path)


@pytest.fixture(scope="module")
def stepped(tmp_path_factory):
    """The plain shaft of the shipped scene as STEP, drawn once."""
    path = tmp_path_factory.mktemp("drawn") / "part.step"
    write_step(path, shaft_step()[0])
    return path.read_bytes()


@pytest.fixture(scope="module")
def shipped():
    scene = sg.load(SCENE)
    return scene, sg.build(scene, "solid", **COARSE)


def test_the_round_part_is_what_was_drawn():
    """Segments to 1e-6 of the true ones, a keyway or not; volume as the kernel has it."""
    segments, (key,) = shaft_step()
    scene = sg.load(SCENE)
    for name in ("y0", "y1", "outer0", "outer1", "inner0", "inner1"):
        found = [getattr(s, name) for s in scene.segments]
        true = [getattr(s, name) for s in segments]
        assert found == pytest.approx(true, abs=1e-6 * 0.02), name

    # the kernel integrates to 1e-6
    assert scene.body.volume == pytest.approx(
        volume_of(Outline(segments)) - key.volume(0.02, 0.0), rel=2e-6
    )
    assert not scene.body.round
    (told,) = [
        n.sentence for n in check._beyond_the_segments(scene) if n.sentence.startswith("not of rev")
    ]
    assert "plain part" in told
    round_body = scene.body.model_copy(update={"round_share": 1.0, "round_volume": 1 + 1e-15})
    plain = scene.model_copy(update={"body": round_body})
    assert not list(check._beyond_the_segments(plain))
    assert "segments is that of the part" in next(round_part.described(plain)).sentence
    assert scene.body.round_volume == pytest.approx(
        volume_of(Outline(segments)) / scene.body.volume
    )


PINION = sg.load(ROOT / "geometry" / "pinion_keyed.toml")


@pytest.mark.parametrize(
    "unit, axis, shift",
    [
        ("inch", "z", (0.05, 0.3, -0.02)),
        pytest.param("m", "-x", (0, 0, 0), marks=pytest.mark.slow),
        pytest.param("mm", "y", (0.05, 0.3, -0.02), marks=pytest.mark.slow),
    ],
)
def test_a_pinion_out_and_in_again(unit, axis, shift, tmp_path):
    """Cone, backcone, shaft and keyway, in three units, turned and shifted."""
    path = tmp_path / "part.step"
    turn = np.array(TURNS[axis]).T
    volume = write_step(path, PINION.segments, PINION.features, unit=unit, turn=turn, shift=shift)
    at = [f"{1e3 * v} mm" for v in shift]
    scene = load_pinion(
        tmp_path, unit=unit, axis=axis, origin=at, size_check=["276.2 mm", "134 mm"]
    )
    true = np.array([(s.y1, s.outer0, s.outer1) for s in PINION.segments])
    # the backcone goes on as a cylinder, the shaft is another
    found = np.array([(s.y1, s.outer0, s.outer1) for s in scene.segments])
    assert found == pytest.approx(true, abs=1e-6 * 0.067)
    assert scene.body.volume == pytest.approx(volume, rel=1e-6)


def load_pinion(folder, **body):
    given = "".join(
        f"{k} = {v if isinstance(v, list) else repr(v)}\n" for k, v in body.items()
    ).replace("'", '"')
    text = f"""
        [material]
        E = "207 GPa"
        nu = 0.3
        density = 7850
        [body]
        step = "part.step"
        {given}
        [port]
        at = "s1.middle"
        attach_to = "s1"
        """
    path = folder / "pinion.toml"
    path.write_text("\n".join(line.strip() for line in text.splitlines()))
    return sg.load(path)


@pytest.mark.parametrize("axis", TURNS)
def test_the_axis_named_is_turned_to_y(axis):
    """By a rotation: a mirror image would have keyways on the other side."""
    turn, named = np.array(TURNS[axis]), np.zeros(3)
    named["xyz".index(axis[-1])] = -1.0 if axis.startswith("-") else 1.0
    assert (turn @ named == [0, 1, 0]).all()
    assert (turn @ turn.T == np.eye(3)).all() and np.linalg.det(turn) == pytest.approx(1.0)


@pytest.mark.slow
@pytest.mark.parametrize("unit, axis", [("inch", "z"), ("m", "-x")])
def test_unit_and_axis_change_no_number(unit, axis, shipped, tmp_path):
    """The same cuts and sizes: what differs is the mesher's way around a turned part, less than
    the mesh leaves, which is 1 % here.
    """
    write_step(tmp_path / "part.step", *shaft_step(), unit=unit, turn=np.array(TURNS[axis]).T)
    scene = load(tmp_path, step="part.step", axis=axis)
    own = numbers(sg.build(scene, "solid", **COARSE), scene)
    assert own == pytest.approx(numbers(shipped[1], shipped[0]), rel=5e-3)


@pytest.mark.slow
def test_a_part_of_revolution_is_its_segments(tmp_path):
    """Every model fits, and 3D tetrahedra meet the harmonic solid: what is left is their coarse
    mesh, half a per cent of C_zz and a quarter of a frequency, and always too stiff.
    """
    segments, _ = shaft_step()
    write_step(tmp_path / "part.step", segments)
    scene = load(tmp_path, step="part.step")
    assert scene.body.round
    assert not LADDER["harmonic"].unfit(scene)
    assert LADDER["corrected"].unfit(scene)
    # the first axial mode and the first bending pair, of which the harmonic solid has one
    exact = numbers(sg.build(scene, "harmonic", order=4, layers=2, edge_layers=2), scene)[:3]
    part = numbers(sg.build(scene, "solid", **COARSE), scene)[:3]
    error = part / exact - 1
    assert -7e-3 < error[0] < 0 and (0 < error[1:]).all() and (error[1:] < 4e-3).all()


@pytest.mark.long
def test_rungs_say_whether_they_hold_a_part(shipped):
    scene, _ = shipped
    for name in ("euler", "timoshenko", "harmonic"):
        assert "it would answer for the plain part" in LADDER[name].unfit(scene)
    assert "needs features" in LADDER["corrected"].unfit(scene)
    assert not LADDER["solid"].unfit(scene)
    assert scene.plain.body is None and scene.plain.segments == scene.segments
    with pytest.raises(sg.SolidgearError, match="use solid$"):
        sg.build(scene, "harmonic")
    with pytest.raises(sg.SolidgearError, match='hex20 cannot hold part "shaft_step.step"'):
        sg.build(scene, "solid", element="hex20")


def written(body, path, digits=9):
    """The mesh of a body in a file, in mm."""
    volume = body.geometry.volume()
    element = ELEMENTS[body.geometry.name]
    order = node_order(volume.local, element.vtk)
    points = np.round(1e3 * volume.nodes.T, digits) + 0.0
    form = {".msh": {"file_format": "gmsh", "binary": False}}.get(path.suffix, {})
    meshio.write(path, meshio.Mesh(points, [(element.cell, volume.cells[order].T)]), **form)


# a Nastran field holds ten digits
@pytest.mark.parametrize(
    "ending, digits",
    [
        ("msh", 9),
        pytest.param("inp", 9, marks=pytest.mark.slow),
        pytest.param("vtu", 9, marks=pytest.mark.slow),
        pytest.param("bdf", 8, marks=pytest.mark.slow),
    ],
)
def test_a_mesh_file_gives_the_same_numbers(ending, digits, shipped, tmp_path):
    scene, body = shipped
    written(body, tmp_path / f"part.{ending}", digits)
    from_file = load(tmp_path, mesh=f"part.{ending}", unit="mm")
    own = sg.build(from_file, "solid")
    assert own.size == body.size
    assert numbers(own, from_file) == pytest.approx(numbers(body, scene), rel=1e-9)
    assert [s.outer0 for s in from_file.segments] == pytest.approx(
        [s.outer0 for s in scene.segments], rel=1e-8
    )


@pytest.mark.slow
def test_twenty_node_hexahedra_of_a_mesh_file(stepped, tmp_path):
    """The same as the in-memory mesh, whose seats are whole faces."""
    (tmp_path / "part.step").write_bytes(stepped)
    plain = load(tmp_path, step="part.step").plain
    coarse = {"layers": 0, "edge_layers": 0, "radial_layers": 0, "relative_size": 1.0}
    body = sg.build(plain, "solid", element="hex20", **coarse, around=8)
    # no twins are promised by a file
    body = replace(body, mesh=body.mesh | {"round": False, "pair_tolerance": 0.0})
    written(body, tmp_path / "part.vtu")
    scene = load(tmp_path, mesh="part.vtu", unit="mm")
    assert scene.body.element == "hex20"
    own = sg.build(scene, "solid")
    assert numbers(own, scene) == pytest.approx(numbers(body, plain), rel=1e-7)


@pytest.mark.long
def test_first_order_tetrahedra_of_a_file_are_solved_as_second_order_ones(stepped, tmp_path):
    """Same cells and so the same mass, and softer: what locks in bending does so no more."""
    (tmp_path / "part.step").write_bytes(stepped)
    plain = load(tmp_path, step="part.step").plain
    first = sg.build(plain, "solid", element="tet4", refinement=0.2)
    written(first, tmp_path / "part.vtu")
    scene = load(tmp_path, mesh="part.vtu", unit="mm")
    own = sg.build(scene, "solid")
    assert scene.body.element == own.mesh["file_element"] == "tet4"
    assert own.mesh["element"] == "tet10" and own.mesh["elements"] == first.mesh["elements"]
    assert own.mesh["volume"] == pytest.approx(first.mesh["volume"], rel=1e-7)
    soft, stiff = (
        sg.condense(b, s, port="gear").compliance[2, 2] for b, s in ((own, scene), (first, plain))
    )
    assert soft > 1.02 * stiff  # 8 % on a rod


@pytest.mark.long
def test_a_seat_ends_where_it_is_said_to(stepped, tmp_path):
    """On a mesh that knows nothing of the seats: integrals that stop at their ends agree with
    faces cut there to what two meshes differ by, whole faces miss by more.
    """
    (tmp_path / "part.step").write_bytes(stepped)
    scene = load(tmp_path, step="part.step")
    from solidgear.core.meshing.tetrahedra import tetrahedra

    cuts = sorted({y for s in scene.stations for y in (s.lo, s.hi)})
    sizes = {"size": 0.012, "graded_size": 0.006}
    cut, uncut = (tetrahedra(scene.outline, (), c, **sizes).mesh for c in (cuts, ()))

    def compliance(mesh, clipped):
        body = solid_body(mesh, scene, element="tet10", clipped=clipped)
        return sg.condense(body, scene, port="gear").compliance[2, 2]

    reference = compliance(cut, True)
    assert abs(compliance(uncut, True) / reference - 1) < 1.5e-3
    assert abs(compliance(uncut, False) / reference - 1) > 1e-2
    # where faces end at the seats there is nothing to clip
    assert compliance(cut, False) == pytest.approx(reference, rel=1e-9)


def test_straight_tetrahedra_may_have_their_corners_in_any_order():
    """scikit-fem orders them as it likes; the mass of the rod is that of its volume."""
    box = skfem.MeshTet.init_tensor([-0.02, 0, 0.02], [0, 0.1, 0.2], [-0.02, 0, 0.02])
    corners = box.p.copy()
    across, along = np.hypot(*corners[[0, 2]]), abs(corners[[0, 2]]).max(axis=0)
    corners[[0, 2]] *= np.divide(along, across, out=np.zeros_like(across), where=across > 0)
    mesh = skfem.MeshTet(corners, box.t)
    rod = sg.Scene.from_parts([sg.Segment.cylinder("rod", length=0.2, diameter=0.04)])
    body = sg.solid_body(mesh, rod, element="tet10")
    octagon = 4 * np.sin(np.pi / 4) * 0.02**2
    assert body.mass_matrix()[0, 0] == pytest.approx(7850 * octagon * 0.2, rel=1e-12)


def test_the_area_of_a_clipped_seat(tmp_path):
    """2 pi r b to what curved faces leave of the circle, wherever faces end."""
    from solidgear.core.meshing.tetrahedra import tetrahedra
    from solidgear.core.models.solid.mesh import _isoparametric
    from solidgear.core.models.solid.seat_faces import Seats

    rod = sg.Segment.cylinder("rod", length=0.2, diameter=0.06)
    mesh = _isoparametric(tetrahedra(Outline([rod]), size=0.02).mesh, "tet10", np.zeros(0))
    for lo, hi in ((0.0, 0.2), (0.031, 0.0777), (0.1, 0.105)):
        scene = sg.Scene.from_parts([rod], port=sg.Port(y=0.1, lo=lo, hi=hi))
        facets = Seats(mesh, [rod], True)(scene.port, "average")
        area = sum(a.sum() for _, _, a, _ in mesh.over_facets(facets, (lo, hi)))
        # the ends, cut across pieces of a twelfth of a face
        assert area == pytest.approx(2 * math.pi * 0.03 * (hi - lo), rel=2e-3 if lo else 2e-4)


def test_a_seat_goes_on_where_a_hole_begins_within_the_part():
    """The round part inside one with a cross hole has a bore there, and its surface no line: the seat lost
    the faces across, up to two thirds of it, and meshes of one part excluded each other.
    """
    from solidgear.core.meshing.tetrahedra import tetrahedra
    from solidgear.core.models.solid.mesh import _isoparametric
    from solidgear.core.models.solid.seat_faces import Seats

    rod = sg.Segment.cylinder("rod", length=0.2, diameter=0.06)
    mesh = _isoparametric(tetrahedra(Outline([rod]), size=0.02).mesh, "tet10", np.zeros(0))
    parts = [
        rod.with_changes(y1=0.0463),
        rod.with_changes(y0=0.0463, y1=0.07, inner0=0.01, inner1=0.01),
        rod.with_changes(y0=0.07),
    ]
    scene = sg.Scene.from_parts([rod], port=sg.Port(y=0.05, lo=0.031, hi=0.0777))
    whole, same = (Seats(mesh, cut, True)(scene.port, "rigid") for cut in ([rod], parts))
    assert np.array_equal(np.sort(whole), np.sort(same))


def test_what_identifies_a_part_is_its_content(shipped, tmp_path):
    scene, _ = shipped
    (tmp_path / "part.step").write_bytes((ROOT / "geometry" / "shaft_step.step").read_bytes())
    moved = load(tmp_path, step="part.step")
    assert moved.body.sha256 == scene.body.sha256
    assert str(tmp_path) not in str(moved.as_dict())
    assert pickle.loads(pickle.dumps(moved)) == moved
    (tmp_path / "part.step").write_bytes(b"ISO-10303-21; of another day END-ISO-10303-21;")
    with pytest.raises(sg.SolidgearError, match="has changed since the scene was read"):
        sg.build(moved, "solid", **COARSE)


STEP = (ROOT / "geometry" / "shaft_step.step").read_text()
BROKEN = {
    "cut off": (STEP[:20000], {}, "is cut off"),
    "no step": ("solid cube\n", {}, "is no STEP file"),
    "wrong unit": (STEP, {"unit": "inch"}, "the file itself says mm"),
    "metres": (with_unit(STEP, "m"), {}, "outside 1 mm to 20 m"),
    "inches": (
        with_unit(STEP, "inch"),
        {"size_check": ["180 mm", "56 mm"]},
        "4572 mm, as if mm taken for inch",
    ),
    "wrong axis": (
        STEP,
        {"axis": "x"},
        'of the surface is round about this axis, and 97 % about "y"',
    ),
    "off axis": (STEP, {"origin": ["30 mm", "0 mm", "0 mm"]}, "write that point as origin"),
    "heavy": (STEP, {"mass_check": "2 kg"}, "the part has 1.732 kg"),
    "no unit": (STEP.replace("LENGTH_UNIT", "LENGHT_UNIT"), {}, "no unit of length"),
}


#: a unit and an axis that are wrong are told as others that are
SELDOM = {"metres", "wrong axis"}


@pytest.mark.parametrize(
    "case", [pytest.param(c, marks=pytest.mark.slow if c in SELDOM else ()) for c in BROKEN]
)
def test_a_part_that_is_refused(case, tmp_path):
    """One sentence with the key of the scene file."""
    content, more, sentence = BROKEN[case]
    (tmp_path / "part.step").write_text(content)
    with pytest.raises(sg.SceneError) as error:
        load(tmp_path, step="part.step", **more)
    assert sentence in str(error.value)
    assert "body." in str(error.value) and len(error.value.problems) == 1


def test_seats_that_are_not_there(tmp_path):
    text = SCENE.read_text().replace("shaft_step.step", str(SCENE.with_suffix(".step")))
    for old, new, sentence in (
        ('"155 mm", to', '"172 mm", to', None),
        ('diameter = "30 mm"', 'diameter = "31 mm"', "it has 30 mm, 40 mm, 56 mm"),
        ('from = "60 mm", to = "84 mm"', 'from = "45 mm", to = "60 mm"', "only 20 % of this"),
        (
            "[ask]",
            '[[feature]]\nkind = "flat"\nsegment = "s1"\nlength = 0.01\ndepth = 0.002\n[ask]',
            "leave one of them out",
        ),
    ):
        path = tmp_path / "scene.toml"
        assert old in text
        path.write_text(text.replace(old, new))
        if sentence is None:
            sg.load(path)
            continue
        with pytest.raises(sg.SceneError, match=sentence):
            sg.load(path)


@pytest.mark.long
def test_two_solids_and_an_open_shell(tmp_path):
    """Named by number and place."""
    from validation.step_parts import write_open, write_two

    write_two(str(tmp_path / "part.step"))
    with pytest.raises(sg.SceneError, match="holds 2 separate solids .at .0, 50, 0. mm"):
        load(tmp_path, step="part.step")
    write_open(str(tmp_path / "part.step"))
    with pytest.raises(sg.SceneError, match="the shell is open at face 1 at .0, 50, "):
        load(tmp_path, step="part.step")


def tets(points, cells, path, kind="tetra"):
    meshio.write(path, meshio.Mesh(np.asarray(points, float), [(kind, np.asarray(cells))]))


CORNERS = [[0, 0, 0], [100, 0, 0], [0, 0, 100], [0, 100, 0]]
BAD_MESHES = {
    "left": (CORNERS, [[0, 1, 2, 3]], "tetra", "left-handed"),
    "surface": (CORNERS, [[0, 1, 2]], "triangle", r"holds no volume elements \(1 triangle\)"),
    "twice": (CORNERS, [[0, 2, 1, 3]] * 2, "tetra", "an element is there twice"),
    "same node": (CORNERS, [[0, 2, 1, 1]], "tetra", "element 1 has a node twice"),
    "pieces": (
        [*CORNERS, *(np.array(CORNERS) + 300).tolist()],
        [[0, 2, 1, 3], [4, 6, 5, 7]],
        "tetra",
        "falls into 2 pieces",
    ),
    "nan": ([[np.nan, 0, 0], *CORNERS[1:]], [[0, 2, 1, 3]], "tetra", "is no number"),
    "wedge": (
        [*CORNERS, [100, 100, 0], [0, 100, 100]],
        [[0, 2, 1, 3, 5, 4]],
        "wedge",
        "holds 1 wedge; write one kind",
    ),
}


@pytest.mark.parametrize("case", BAD_MESHES)
def test_a_mesh_that_is_refused(case, tmp_path):
    points, cells, kind, sentence = BAD_MESHES[case]
    tets(points, cells, tmp_path / "part.vtu", kind)
    with pytest.raises(sg.SceneError, match=sentence):
        load(tmp_path, mesh="part.vtu", unit="mm")


def test_mesh_files_that_are_not_read(tmp_path):
    for name, sentence in (
        ("part.unv", "no dataset 2411 of nodes"),
        ("part.stl", "ends in .stl is unknown.*known are .msh"),
        ("part.inp", "cannot be opened"),
    ):
        if name != "part.inp":
            (tmp_path / name).write_text("nothing")
        with pytest.raises(sg.SceneError, match=sentence):
            load(tmp_path, mesh=name, unit="mm")
    (tmp_path / "part.msh").write_text("nothing")
    with pytest.raises(sg.SceneError, match="part.msh does not give the unit"):
        load(tmp_path, mesh="part.msh")


@pytest.mark.long
def test_a_mesh_file_has_one_mesh_and_its_bar(shipped, tmp_path):
    """The bar holds the step to a finer mesh of the same part; of two files the last is taken where
    the first is too coarse.
    """
    scene, body = shipped
    coarse = sg.build(scene, "solid", refinement=0.15)
    before, after = numbers(coarse, scene)[0], numbers(body, scene)[0]
    written(body, tmp_path / "part.vtu")
    written(coarse, tmp_path / "coarse.vtu")
    one = load(tmp_path, mesh="coarse.vtu", unit="mm")
    plan = LADDER["solid"].meshes_of(one, {})
    assert len(plan.levels) == 1
    found = sg.answer(one, tol=1e-3, ask=["C_zz"])
    (value,) = found.values
    assert not found.reached and "list a finer mesh" in found.steps[-1].why
    assert value.how == "one order more" and abs(after / before - 1) < value.bar < 0.5
    two = load(tmp_path, mesh=["coarse.vtu", "part.vtu"], unit="mm")
    assert sg.answer(two, tol=1e-3, ask=["C_zz"]).steps[-1].setting == "the last mesh file"


def test_left_handed_hexahedra_are_told(tmp_path):
    """Mirrored in the file, its elements are left-handed in the scene."""
    cube = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], float)
    points = 100 * np.vstack([cube, cube + [0, 0, 1]])
    tets(points * [1, 1, -1], [list(range(8))], tmp_path / "part.vtu", "hexahedron")
    with pytest.raises(sg.SolidgearError, match="left-handed"):
        mesh_from(str(tmp_path / "part.vtu"), Placing(1e-3, TURNS["y"], (0.0, 0.0, 0.0)))


def test_a_keyed_mesh_has_no_seat_on_the_floor_of_the_key():
    """Floors and walls of a keyway that crosses a seat are none of it: its area is that of the
    cylinder less the opening.
    """
    from solidgear.core.models.solid.mesh import _isoparametric
    from solidgear.core.models.solid.plan import tetrahedra_plan
    from solidgear.core.models.solid.seat_faces import Seats
    from solidgear.cuts.solid.featured import meshed
    from solidgear.cuts.solid.meshing import submesh

    rod = sg.Segment.cylinder("rod", length=0.2, diameter=0.06)
    key = Keyway(
        name="key", segment="rod", y=0.07, length=0.06, width=0.018, depth=0.007, ends="square"
    )
    port = sg.Port(y=0.1, lo=0.07, hi=0.13)
    scene = sg.Scene.from_parts([rod], port=port, features=(key,))
    wanted = [(port, "average")]
    plan = tetrahedra_plan(scene, wanted, size=None, graded_size=None, refinement=0.5, around=16)
    made = meshed(scene, plan, 0.5, half=False)
    mesh = _isoparametric(submesh(made.mesh, ~made.cut), "tet10", made.segment[~made.cut])
    facets = Seats(mesh, [rod], True)(port, "average")
    area = sum(a.sum() for _, _, a, _ in mesh.over_facets(facets))
    opening = 2 * math.asin(0.009 / 0.03) * 0.03 * 0.06
    assert area == pytest.approx(2 * math.pi * 0.03 * 0.06 - opening, rel=1e-3)


def test_the_shipped_scene_has_a_sequence_of_meshes(shipped):
    plan = LADDER["solid"].meshes_of(shipped[0], {})
    assert len(plan.levels) > 3
    assert all(level["element"] == "tet10" for level in plan.levels)


@pytest.mark.parametrize(
    "cases, seed",
    [pytest.param(2, 7, marks=pytest.mark.long), pytest.param(30, 8, marks=pytest.mark.slow)],
    ids=["few", "many"],
)
def test_broken_files_end_in_a_sentence(cases, seed):
    """Nothing that a process of its own does not catch, and no traceback."""
    from validation.fuzz.case import run
    from validation.fuzz.parts import PARTS, cut_off, emptied, garbled, lines_left_out, rescaled

    quick = (cut_off, emptied, garbled, lines_left_out, rescaled)
    make = functools.partial(PARTS.make, changes=quick)
    # limits are set on the process that runs them
    found = isolated(run, replace(PARTS, make=make), cases, seed, seconds=200)
    assert not [one.told() for one in found if one.kind == "finding"]
    assert sum(one.kind == "refused" for one in found) > cases / 2


FOUND = ROOT / "tests" / "found" / "parts"


def test_a_slot_in_the_middle_leaves_the_round_part(tmp_path):
    """More than half of the section in the middle is gone, where the round part was looked for."""
    scene = sg.load(FOUND / "slot_deep.toml")
    (segment,) = scene.segments
    assert (segment.y0, segment.y1) == pytest.approx((0.0, 0.1), abs=1e-9)
    assert segment.outer0 == segment.outer1 == pytest.approx(0.02, rel=1e-6)
    assert not scene.body.round
    # of the STEP file, whose slot is 4 mm wide
    assert scene.body.uneven == (pytest.approx((0.048, 0.052), abs=1e-9),)
    body = sg.build(scene, "solid", **COARSE)
    # the kernel has the volume to 1e-6, the arcs of a coarse mesh to 2e-3
    assert body.mass_matrix()[0, 0] == pytest.approx(7850 * scene.body.volume, rel=3e-3)
    # the mesh of it, as another program writes it
    written(body, tmp_path / "slot.msh")
    text = (FOUND / "slot_deep.toml").read_text()
    text = text.replace('step="slot_deep.step"', 'mesh="slot.msh"')
    (tmp_path / "mesh.toml").write_text(text)
    again = sg.load(tmp_path / "mesh.toml")
    assert again.length == pytest.approx(0.1, abs=1e-9)
    assert again.body.centre == pytest.approx(scene.body.centre, abs=2e-6)


def test_pins_between_discs_are_no_solid_cylinder():
    """Volume and centre of the kernel; the round part has the area of the pins between the discs."""
    scene = sg.load(FOUND / "pins_load.toml")
    assert scene.body.volume == pytest.approx(185.0712e-6, rel=1e-6)
    assert scene.body.round_volume == pytest.approx(1.0, abs=2e-3)  # two degrees between rays
    pins = scene.segments_at(0.08)[0]
    # three of 12 mm
    assert math.pi * pins.outer0**2 == pytest.approx(3 * math.pi * 6e-3**2, rel=5e-3)
    assert scene.body.uneven == (pytest.approx((0.07, 0.09), abs=1e-9),)
    # discs of 10 mm, pins of 20, ends of 60 and 50
    y, area = np.array([30, 65, 80, 95, 125]), np.array([15**2, 40**2, 3 * 6**2, 40**2, 15**2])
    volumes = area * np.array([60, 10, 20, 10, 50])
    assert scene.body.centre == pytest.approx((0, 1e-3 * volumes @ y / volumes.sum(), 0), abs=1e-7)


@pytest.mark.parametrize("axis, centre", [("y", 39.31e-3), ("-y", 55.69e-3)])
def test_pins_before_a_shaft_are_of_its_length(axis, centre):
    """No wall stands on the axis where the part begins: 95 mm and 0.978 kg of steel by the kernel."""
    tables = sg.load(FOUND / "pins_start.toml").to_dict()
    tables["body"] = {"step": str(FOUND / "pins_start.step"), "axis": axis}
    scene = sg.load(tables)
    assert scene.length == pytest.approx(95e-3, abs=1e-6)
    assert 7850 * scene.body.volume == pytest.approx(0.978, abs=5e-4)
    assert scene.body.centre[1] == pytest.approx(centre, abs=1e-5)


def test_a_shallow_slot_leaves_the_round_part_as_well():
    scene = sg.load(FOUND / "slot_shallow.toml")
    (segment,) = scene.segments
    assert segment.outer0 == pytest.approx(0.02, rel=1e-6)
    assert scene.length == pytest.approx(0.1, abs=1e-9)
    assert scene.body.volume == pytest.approx(123.786e-6, rel=1e-4)


def test_a_seat_on_no_cylinder_is_refused(tmp_path):
    """A port over three pins has no surface to hold."""
    text = (FOUND / "pins_load.toml").read_text()
    text = text.replace('position = "50 mm"', 'position = "80 mm"')
    text = text.replace('["45 mm", "55 mm"]', '["75 mm", "85 mm"]')
    text = text.replace("pins_between.step", str(FOUND / "pins_between.step"))
    (tmp_path / "scene.toml").write_text(text)
    with pytest.raises(sg.SceneError, match="no face of the part is round about its axis"):
        sg.load(tmp_path / "scene.toml")


def test_slices_of_one_section_are_one_segment():
    """A splined sleeve has the same section all along, whatever the triangles of its slices say."""
    radii = np.array([[30.0, 16.4075], [30.0, 16.4063], [30.0, 16.4081]])
    walls = [Frustum(k, k + 1.0, o, o, i, i) for k, (o, i) in enumerate(round_radii(radii))]
    assert len(joined(walls, 1e-6)) == 1
    # a taper is none
    assert not np.ptp(round_radii(np.array([[30.0, 16.0], [29.0, 16.0]]))[:, 0]) == 0


def test_mean_radii_that_differ_by_rounding_are_one():
    """A splined bore under two shoulders: slices of one section left a step of 1 nm, which no mesh holds."""
    bores = (0.0168983, 0.0168983 + 1e-9, 0.0168983 - 3e-9)
    outer, places = (0.03, 0.05, 0.03), (0.0, 0.015, 0.025, 0.045)
    walls = [
        Frustum(y0, y1, radius, radius, bore, bore)
        for y0, y1, radius, bore in zip(places, places[1:], outer, bores)
    ]
    walls = joined(walls, near=2e-6 * 0.045)
    assert {wall.inner0 for wall in walls} | {wall.inner1 for wall in walls} == {bores[0]}
    assert [wall.outer0 for wall in walls] == [*outer]
