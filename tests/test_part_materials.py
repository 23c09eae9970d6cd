"""Parts of several materials by volume: groups of mesh files and solids of STEP files."""

import numpy as np
import pytest

import solidgear as sg
from solidgear.core.bounds.solid import solid_bounds
from solidgear.core.errors import NoBounds
from solidgear.core.ladder.registry import LADDER
from solidgear.core.machine.isolated import isolated
from validation.mesh_files import rod, write_mesh, written_by_gmsh
from validation.step_parts import write_solids

STEEL = {"E": 200e9, "nu": 0.3, "density": 7800.0}
LIGHT = {"E": 70e9, "nu": 0.3, "density": 2700.0}
GIVEN = 'E = "{E} Pa"\nnu = {nu}\ndensity = {density}'


def inline(material):
    return "{{E = {E}, nu = {nu}, density = {density}}}".format(**material)


def scene_of(folder, file, materials, usual=STEEL, *, seats="", more="", length=200.0, port=None):
    """A scene with one part, in mm; materials by group."""
    key = "step" if file.endswith("step") else "mesh"
    lines = [f"[material]\n{GIVEN.format(**usual)}"] if usual else []
    lines += [f'[body]\n{key} = "{file}"\nunit = "mm"', more]
    if materials:
        lines += ["[body.materials]", *(f'"{k}" = {inline(v)}' for k, v in materials.items())]
    port = port or f'position = "{length} mm"\nspan = ["0 mm", "{length} mm"]'
    lines += [seats, f'[port]\nname = "end"\n{port}']
    path = folder / "scene.toml"
    path.write_text("\n".join(lines))
    return sg.load(path)


ENDINGS = ("inp", "bdf", "unv", "msh", "vtu")
#: what the first and the second group are called in each format
NAMED = {"inp": ("first", "second"), "msh": ("first", "second")}
#: the section port at the far end, the other end clamped
HELD = """
[[bearing]]
name = "wall"
face = "start"
seat_width = "10 mm"
attachment = "section"
hold = "clamped"
"""
END = 'position = "{} mm"\nspan = ["{} mm", "{} mm"]\nattachment = "section"'


def series(folder, ending, first, second, planes=(0, 20, 40, 60, 80, 120, 160, 200)):
    """A prism of two materials end to end, cut at 80 mm; its section has area 3 r^2."""
    points, cells = rod((0.0, 10.0), planes)
    middle = points[cells].mean(axis=1)[:, 1]
    groups = {"first": np.flatnonzero(middle < 80), "second": np.flatnonzero(middle > 80)}
    write_mesh(folder / f"part.{ending}", points, "tetra", cells, groups)
    names = NAMED.get(ending, ("1", "2"))
    return scene_of(
        folder,
        f"part.{ending}",
        dict(zip(names, (first, second))),
        None,
        seats=HELD,
        port=END.format(200, 190, 200),
    )


def test_a_rigid_seat_between_the_nodes_of_a_file_is_refused(tmp_path):
    """Its faces reach beyond it, and it would hold none of their nodes."""
    points, cells = rod((0.0, 10.0), (0, 100, 200))
    write_mesh(tmp_path / "part.msh", points, "tetra", cells, {"all": range(len(cells))})
    port = 'position = "{} mm"\nspan = ["{} mm", "{} mm"]\nattachment = "rigid"'
    scene = scene_of(tmp_path, "part.msh", {}, port=port.format(25, 20, 30))
    with pytest.raises(
        sg.SolidgearError, match="'end': no node lies between the ends of its rigid"
    ):
        sg.build(scene, "solid")
    # those of half its length
    scene = scene_of(tmp_path, "part.msh", {}, port=port.format(50, 25, 75))
    body = sg.build(scene, "solid")
    with pytest.raises(NoBounds, match="the rigid seat of 'end' ends between nodes"):
        solid_bounds(scene, body, statics=True)
    scene = scene_of(tmp_path, "part.msh", {}, port=port.format(50, 0, 100))
    bounds = solid_bounds(scene, sg.build(scene, "solid"), statics=True)
    assert np.linalg.eigvalsh(bounds.reached)[-1] > 0


@pytest.mark.parametrize(
    "ending",
    # the other formats are read in the last test here
    ["msh", pytest.param("inp", marks=pytest.mark.long)]
    + [pytest.param(e, marks=pytest.mark.slow) for e in ENDINGS if e not in ("inp", "msh")],
)
def test_a_rod_of_two_materials_in_series(ending, tmp_path):
    """C = L1 / (E1 A) + L2 / (E2 A), exactly: where lateral strains are the same, which they are at
    nu / E alike, stress is uniform and second-order tetrahedra hold it.
    """
    first = dict(STEEL)
    second = {**LIGHT, "nu": STEEL["nu"] * LIGHT["E"] / STEEL["E"]}
    scene = series(tmp_path, ending, first, second)
    body = sg.build(scene, "solid")
    area = 3 * 0.01**2  # of twelve sides: 12 / 2 r^2 sin 30 deg
    closed = 0.08 / (first["E"] * area) + 0.12 / (second["E"] * area)
    found = sg.condense(body, scene, port="end").compliance[1, 1]
    assert found == pytest.approx(closed, rel=1e-8)
    mass = area * (0.08 * first["density"] + 0.12 * second["density"])
    assert body.mass_matrix()[0, 0] == pytest.approx(mass, rel=1e-9)
    assert scene.body.mass(scene.material) == pytest.approx(mass, rel=1e-9)
    # end to end is a shaft of segments, each of one material
    assert [s.material.E for s in scene.segments] == [first["E"], second["E"]]
    assert [s.y1 for s in scene.segments] == pytest.approx([0.08, 0.2])
    assert not scene.body.mixed


def tets(points, cells, members):
    """Volume, and second moments about z of some tetrahedra, in closed form."""
    p = points[cells[members]]
    volume = np.linalg.det(p[:, 1:] - p[:, :1]) / 6
    squares = volume / 20 * ((p**2).sum(axis=1) + p.sum(axis=1) ** 2).T
    return volume.sum(), squares.sum(axis=1)  # of x^2, y^2, z^2


@pytest.mark.long
def test_a_sleeve_on_a_core(tmp_path):
    """Curvature M / (E1 I1 + E2 I2): between two lengths ends make no difference; mass and inertia
    are those of the tetrahedra.
    """
    turned, closed = [], 0.0
    for length in (120, 160):
        points, cells = rod((0.0, 6.0, 10.0), np.linspace(0, length, length // 5 + 1))
        radius = np.hypot(*points[cells].mean(axis=1)[:, [0, 2]].T)
        # the sides of the inner prism lie at 6 cos 15 deg or further in
        groups = {"core": np.flatnonzero(radius < 5.5), "sleeve": np.flatnonzero(radius > 5.5)}
        assert len(groups["core"]) == 12 * 3 * (length // 5)
        write_mesh(tmp_path / "part.inp", points, "tetra", cells, groups)
        scene = scene_of(
            tmp_path,
            "part.inp",
            {"core": STEEL, "sleeve": LIGHT},
            None,
            seats=HELD,
            port=END.format(length, length - 10, length),
        )
        body = sg.build(scene, "solid")
        turned.append(sg.condense(body, scene, port="end").compliance[3, 3])
        parts = [tets(1e-3 * points, cells, groups[name]) for name in ("core", "sleeve")]
        stiff = sum(m["E"] * s[2] / (1e-3 * length) for m, (_, s) in zip((STEEL, LIGHT), parts))
        closed = 0.04 / stiff
    assert turned[1] - turned[0] == pytest.approx(closed, rel=2e-4)
    weights = [m["density"] for m in (STEEL, LIGHT)]
    matrix = body.mass_matrix()
    mass = sum(w * v for w, (v, _) in zip(weights, parts))
    polar = sum(w * (s[0] + s[2]) for w, (_, s) in zip(weights, parts))
    assert matrix[0, 0] == pytest.approx(mass, rel=1e-9)
    assert matrix[4, 4] == pytest.approx(polar, rel=1e-9)
    # side by side no segment can hold them
    assert scene.body.mixed == ("s1",) and not scene.body.round
    for name in ("euler", "timoshenko", "harmonic"):
        assert "it would answer for the plain part" in LADDER[name].unfit(scene)
    (mean,) = scene.segments
    share = parts[0][0] / (parts[0][0] + parts[1][0])
    assert mean.material.E == pytest.approx(share * 200e9 + (1 - share) * 70e9, rel=5e-3)


@pytest.mark.long
def test_one_material_by_groups_changes_nothing(tmp_path):
    """To the last bit but the order of sums."""
    plain = series(tmp_path, "inp", STEEL, STEEL)
    by_groups = sg.condense(sg.build(plain, "solid"), plain, port="end").compliance
    one = scene_of(tmp_path, "part.inp", {}, STEEL, seats=HELD, port=END.format(200, 190, 200))
    assert not one.body.groups and one.body.told == ("of_first", "of_second")
    whole = sg.condense(sg.build(one, "solid"), one, port="end").compliance
    assert by_groups == pytest.approx(whole, rel=1e-9, abs=1e-12 * whole.max())
    assert [s.y1 for s in plain.segments] == [s.y1 for s in one.segments]


def test_constants_are_replaced_in_groups_too(tmp_path):
    scene = series(tmp_path, "inp", STEEL, LIGHT)
    softer = scene.with_material(E=1e11)
    assert {m.E for m in softer.body.materials(softer.material)} == {1e11}
    assert {m.density for m in softer.body.materials(softer.material)} == {7800.0, 2700.0}
    assert sg.build(softer, "solid").size == sg.build(scene, "solid").size


def groups_file(folder, groups):
    points, cells = rod((0.0, 10.0), (0, 50, 100, 150, 200))
    level = points[cells].mean(axis=1)[:, 1] // 50
    write_mesh(
        folder / "part.inp",
        points,
        "tetra",
        cells,
        {name: np.flatnonzero(np.isin(level, levels)) for name, levels in groups.items()},
    )


REFUSED = {
    "unknown": (
        {"sleve": LIGHT},
        STEEL,
        'has no group "sleve"; did you mean "sleeve"?; there are "EALL", "core", "sleeve"',
    ),
    "nothing": ({"sleeve": LIGHT}, None, "the rest (EALL, core, of_core), 45 cm^3, has no mat"),
    "overlap": (
        {"EALL": STEEL, "sleeve": LIGHT},
        STEEL,
        '36 elements are in both "EALL" and "sleeve", one of them in line 106: element 37',
    ),
    "constants": ({"core": {**STEEL, "nu": 0.7}}, STEEL, "nu"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_groups_that_are_refused(case, tmp_path):
    """One sentence with the groups there are."""
    materials, usual, sentence = REFUSED[case]
    groups_file(tmp_path, {"core": (0, 2, 3), "sleeve": (1,)})
    with pytest.raises(sg.SceneError) as error:
        scene_of(tmp_path, "part.inp", materials, usual)
    assert sentence in str(error.value)
    assert "body.materials" in str(error.value) or "body.mesh" in str(error.value)
    assert len(error.value.problems) == 1


def test_a_scene_without_material_at_all(tmp_path):
    groups_file(tmp_path, {"core": (0, 1, 2, 3)})
    with pytest.raises(sg.SceneError, match="material: this key is missing"):
        scene_of(tmp_path, "part.inp", {}, None)


def two_solids(folder, solids, materials, usual=None, **more):
    isolated(write_solids, str(folder / "part.step"), solids, seconds=60)
    return scene_of(folder, "part.step", materials, usual, **more)


SEATS = """
[[bearing]]
name = "A"
position = "15 mm"
seat_width = "20 mm"
stiffness = {kxx = 4e8, kyy = 2e8, kzz = 4e8}
[[bearing]]
name = "B"
position = "185 mm"
seat_width = "20 mm"
stiffness = {kxx = 3e8, kzz = 3e8}
"""
MIDDLE = 'position = "110 mm"\nspan = ["95 mm", "125 mm"]'
SHAFT = f"""
[material]
{GIVEN.format(**STEEL)}
[[segment]]
kind = "cylinder"
name = "first"
length = "80 mm"
diameter = "40 mm"
[[segment]]
kind = "cylinder"
name = "second"
length = "120 mm"
diameter = "30 mm"
material = {inline(LIGHT)}
{SEATS}
[port]
name = "end"
{MIDDLE}
"""


def numbers(body, scene):
    compliance = sg.condense(body, scene, port="end").compliance
    return np.array([compliance[2, 2], *sg.modes(body, scene, n=4).frequency_hz[1:2]])


@pytest.mark.slow
def test_two_solids_are_a_shaft_of_two_segments(tmp_path):
    """A STEP file of two solids end to end against the harmonic solid of a file of segments: what
    is left is the coarse mesh of tetrahedra, which is too stiff.
    """
    scene = two_solids(
        tmp_path,
        [(0, 80, 20, 0), (80, 200, 15, 0)],
        {"1": STEEL, "2": LIGHT},
        seats=SEATS,
        port=MIDDLE,
    )
    path = tmp_path / "segments.toml"
    path.write_text(SHAFT)
    drawn = sg.load(path)
    for name in ("y0", "y1", "outer0", "outer1"):
        found = [getattr(s, name) for s in scene.segments]
        assert found == pytest.approx([getattr(s, name) for s in drawn.segments], abs=1e-8)
    assert [s.material for s in scene.segments] == [s.material for s in drawn.segments]
    assert scene.body.round and not LADDER["harmonic"].unfit(scene)
    exact = numbers(sg.build(drawn, "harmonic", order=4, layers=2, edge_layers=2), drawn)
    of_part = numbers(sg.build(scene, "harmonic", order=4, layers=2, edge_layers=2), scene)
    assert of_part == pytest.approx(exact, rel=1e-6)
    body = sg.build(scene, "solid", refinement=0.25)
    error = numbers(body, scene) / exact - 1
    assert -1.5e-2 < error[0] < 0 and (0 < error[1:]).all() and (error[1:] < 5e-3).all()
    assert body.mass_matrix()[0, 0] == pytest.approx(scene.body.mass(scene.material), rel=2e-3)


@pytest.mark.slow
def test_a_sleeve_shrunk_on_a_shaft(tmp_path):
    """Shorter than the shaft: cut where it begins and ends, and mixed in between; the solid shares
    its nodes, so that pushing one turns the other.
    """
    solids = [(0, 200, 15, 0), (60, 140, 25, 15)]
    held = {"seats": SEATS, "port": MIDDLE}
    scene = two_solids(tmp_path, solids, {"2": LIGHT}, STEEL, **held)
    assert [s.y1 for s in scene.segments] == pytest.approx([0.06, 0.14, 0.2])
    assert scene.body.mixed == ("s2",)
    assert [g.label for g in scene.body.groups] == ['"2"', "the rest (1)"]
    share = 15**2 / 25**2
    mean = share * STEEL["E"] + (1 - share) * LIGHT["E"]
    assert scene.segments[1].material.E == pytest.approx(mean, rel=1e-2)
    again = tmp_path / "again"
    again.mkdir()
    loose = two_solids(again, solids, {"2": {**LIGHT, "E": 1e3}}, STEEL, **held)
    soft, stiff = (
        sg.condense(sg.build(s, "solid", refinement=0.25), s, port="end").stiffness[2, 2]
        for s in (loose, scene)
    )
    assert soft < 1e-3 * stiff  # the port sits on the sleeve


@pytest.mark.parametrize(
    "solids, materials, sentence",
    [
        (
            [(0, 80, 20, 0), (70, 200, 15, 0)],
            {"2": LIGHT},
            "its solids 1 and 2 overlap in 7069 mm^3",
        ),
        ([(0, 80, 20, 0), (81, 200, 15, 0)], {"2": LIGHT}, "its solid 2 of 84.12 cm^3 at"),
    ],
    ids=["overlap", "gap"],
)
def test_solids_that_are_refused(solids, materials, sentence, tmp_path):
    with pytest.raises(sg.SceneError) as error:
        two_solids(tmp_path, solids, materials, STEEL)
    assert sentence in str(error.value) and len(error.value.problems) == 1


def said(scene):
    from solidgear.guards.round_part import described

    return [n.sentence for n in described(scene)]


@pytest.mark.long
def test_check_tells_materials(tmp_path):
    """Nothing of two materials goes for one in silence."""
    scene = series(tmp_path, "inp", STEEL, LIGHT)
    assert any('"first" 24 cm^3, 0.1872 kg, E 200 GPa; "second" 36 cm^3' in t for t in said(scene))
    silent = scene_of(tmp_path, "part.inp", {}, STEEL)
    assert any("has groups of_first, of_second, and all of it is taken" in t for t in said(silent))
    sleeve = two_solids(tmp_path, [(0, 200, 15, 0), (0, 200, 25, 15)], {"2": LIGHT}, STEEL)
    assert any("several materials lie side by side" in t for t in said(sleeve))


@pytest.mark.long
def test_gmsh_writes_what_is_read_here(tmp_path):
    """Order of nodes and numbers of groups, as another program writes them: the same volumes from
    every format, second-order tetrahedra and bricks.
    """
    from solidgear.core.meshing.placing import TURNS, Placing
    from solidgear.parts.mesh_file import mesh_from

    place = Placing(1e-3, TURNS["y"], (0.0, 0.0, 0.0))
    for hexes, kind in ((False, "tet10"), (True, "hex20")):
        isolated(written_by_gmsh, str(tmp_path / "part"), hexes, seconds=60)
        names = {".msh": "sleeve", ".inp": "sleeve", ".bdf": "2", ".unv": "sleeve"}
        for ending, name in names.items():
            found = mesh_from(str(tmp_path / "part") + ending, place, (name,))
            assert found.element == kind
            sleeve, core = found.volumes(2)[0]
            # quarters of tubes, arcs by quadratic sides
            assert sleeve == pytest.approx(1e-9 * np.pi / 4 * (20**2 - 12**2) * 30, rel=1e-3), (
                ending
            )
            assert core == pytest.approx(1e-9 * np.pi / 4 * (12**2 - 6**2) * 30, rel=1e-3), ending
