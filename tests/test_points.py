"""Several lumped points on one shaft: what condensation says between them, against closed forms,
against single points, between models.
"""

import io
import json
from pathlib import Path

import numpy as np
import pytest
from rich.console import Console

import solidgear as sg
from solidgear.app.application import app
from solidgear.comparison.page.sheet import final_table
from solidgear.comparison.recording import Findings, recorded
from solidgear.core.judge.quantities import change
from solidgear.core.judge.record import Record
from solidgear.core.judge.study import study
from solidgear.core.scene import Bearing, Port, Scene, Segment
from tests.dense import rigid_at
from tests.plain import render_page

GEOMETRY = Path(__file__).parent.parent / "geometry"
#: quick meshes; two points that both see the same mesh error are compared on them
OPTIONS = {"euler": {}, "timoshenko": {}, "harmonic": {"order": 3, "layers": 1}}
E, NU, D, L = sg.STEEL.E, sg.STEEL.nu, 0.04, 0.8
INERTIA, AREA, POLAR = np.pi * D**4 / 64, np.pi * D**2 / 4, np.pi * D**4 / 32
A, B = 0.25, 0.6


def at(name, y):
    return Port(name=name, y=y, lo=y - 0.01, hi=y + 0.01, attachment="section")


def rod(*bearings):
    """A uniform rod with points at A and B."""
    rod = Segment.cylinder("rod", length=L, diameter=D)
    return Scene.from_parts([rod], bearings=bearings, port=at("a", A), further_ports=(at("b", B),))


def end(face, hold):
    y = {"start": 0.0, "end": L}[face]
    return Bearing(name=face, y=y, seat_width=0.02, hold=hold, face=face, attachment="section")


def relative(a, b):
    """Largest difference, of the geometric means of the diagonal of b."""
    d = np.sqrt(np.abs(np.diag(b)))
    d[d == 0] = 1.0  # of a free motion, whose entries are all zero
    return np.nanmax(np.abs(a - b) / np.outer(d, d))


@pytest.fixture(scope="module")
def shaft():
    return sg.load(GEOMETRY / "intermediate_shaft.toml")


@pytest.fixture(scope="module", params=list(OPTIONS))
def both(request, shaft):
    body = sg.build(shaft, request.param, **OPTIONS[request.param])
    return body, sg.condense(body, shaft, port=("wheel", "pinion"))


# --------------------------------------------------------------------------- closed forms
def test_simply_supported_beam():
    scene = rod(end("start", "pinned"), end("end", "pinned"))
    found = sg.condense(sg.build(scene, "euler"), scene, port=("a", "b"))
    cross = found.between("a", "b")

    def deflection(x, p):  # Roark, simply supported, x on the left of the load at p
        return (L - p) * x * (L**2 - (L - p) ** 2 - x**2) / (6 * E * INERTIA * L)

    # exact elements; pins of 1e22 N/m give 1e-12, rounding of the free beam the rest
    assert cross[2, 2] == pytest.approx(deflection(A, B), rel=1e-9)
    assert cross[0, 0] == pytest.approx(deflection(A, B), rel=1e-9)
    slope = (L - B) * (L**2 - (L - B) ** 2 - 3 * A**2) / (6 * E * INERTIA * L)
    assert cross[3, 2] == pytest.approx(slope, rel=1e-9)  # z rises with thx
    assert cross[5, 0] == pytest.approx(-slope, rel=1e-9)  # x falls with thz
    # held along the axis at both ends
    assert cross[1, 1] == pytest.approx(A * (L - B) / (E * AREA * L), rel=1e-9)
    # nothing holds the turning, but the rod between the points twists
    twist = E / (2 * (1 + NU)) * POLAR / (B - A)
    assert found.stiffness[4, 10] == pytest.approx(-twist, rel=1e-9)
    assert found.stiffness[4, 4] == pytest.approx(twist, rel=1e-9)
    assert found.free_names == ("thy",) and np.isnan(found.compliance[4]).all()


def test_cantilever():
    scene = rod(end("start", "clamped"))
    found = sg.condense(sg.build(scene, "euler"), scene, port=("b", "a"))
    cross = found.between("a", "b")
    ei = E * INERTIA
    assert cross[2, 2] == pytest.approx(A**2 * (3 * B - A) / (6 * ei), rel=1e-9)
    assert cross[2, 3] == pytest.approx(A**2 / (2 * ei), rel=1e-9)  # a moment at b lifts a
    assert cross[3, 3] == pytest.approx(A / ei, rel=1e-9)
    assert found.between("b", "a")[3, 2] == pytest.approx(A**2 / (2 * ei), rel=1e-9)
    assert found.between("b", "b")[2, 2] == pytest.approx(B**3 / (3 * ei), rel=1e-9)
    assert cross[4, 4] == pytest.approx(2 * (1 + NU) * A / (E * POLAR), rel=1e-9)
    assert found.free_names == ()


def test_a_free_rod_is_stiff_between_its_points_only():
    scene = rod()
    found = sg.condense(sg.build(scene, "euler"), scene, port=("a", "b"))
    assert found.stiffness[1, 7] == pytest.approx(-E * AREA / (B - A), rel=1e-9)
    rigid = np.vstack([rigid_at(y) for y in (A, B)])
    size = np.abs(found.stiffness) @ np.abs(rigid)
    # as a rigid body it goes freely: what is left is rounding of twelve columns
    assert np.abs(found.stiffness @ rigid).max() < 1e-9 * size.max()
    assert np.isnan(found.compliance).all()


# --------------------------------------------------------------------------- one point and two
def test_blocks_are_those_of_single_points(both, shaft):
    body, found = both
    assert found.evidence["asymmetry"] < 1e-10  # reciprocity, before anything is symmetrised
    for k, name in enumerate(found.ports):
        alone = sg.condense(body, shaft, name)
        own = found.between(name, name)
        assert (np.isnan(own) == np.isnan(alone.compliance)).all()
        assert relative(own, alone.compliance) < 1e-12  # the same formula on the same numbers
        # with the other point let go, what holds this one is its own stiffness: Schur's complement
        on, off = (6 * i + np.delete(np.arange(6), 4) for i in (k, 1 - k))
        k_on, k_off = found.stiffness[np.ix_(on, on)], found.stiffness[np.ix_(off, off)]
        cross = found.stiffness[np.ix_(on, off)]
        freed = k_on - cross @ np.linalg.solve(k_off, cross.T)
        kept = np.delete(np.delete(alone.stiffness, 4, 0), 4, 1)
        # two stiffnesses of 2e9 leave one of 3e8: a digit, of those the evidence tells of
        assert relative(freed, kept) < 100 * max(found.evidence["stiffness_error"], 1e-13)
    assert relative(found.stiffness, found.stiffness.T) == 0.0


def test_stiffness_is_the_inverse_where_there_is_one(both):
    _, found = both
    on = np.delete(np.arange(12), [4, 10])
    product = found.stiffness[np.ix_(on, on)] @ found.compliance[np.ix_(on, on)]
    size = np.sqrt(np.diag(found.compliance)[on])
    left = np.abs(product * size / size[:, None] - np.eye(10)).max()
    assert left < 1e3 * found.evidence["stiffness_error"]


def test_order_of_names_is_order_of_blocks(both, shaft):
    body, found = both
    other = sg.condense(body, shaft, port=("pinion", "wheel"))
    swap = np.r_[6:12, 0:6]
    assert relative(other.compliance[np.ix_(swap, swap)], found.compliance) < 1e-13
    assert (found.between("wheel", "pinion") == found.between("pinion", "wheel").T)[:4, :4].all()


def test_mirrored_points_see_mirrored_shafts():
    """A shaft that is its own mirror image: the points swap, and what is odd changes sign."""
    steps = [("l", 0.1, 0.04), ("m", 0.2, 0.06), ("r", 0.1, 0.04)]
    parts, y = [], 0.0
    for name, length, diameter in steps:
        parts.append(Segment.cylinder(name, length=length, diameter=diameter, y0=y))
        y += length
    spring = {"kxx": 4e8, "kyy": 1e8, "kzz": 4e8, "kz_thx": 2e6, "kthx": 1e5}
    other = spring | {"kz_thx": -2e6}
    bearings = [
        Bearing(name="A", y=0.03, seat_width=0.02, stiffness=spring),
        Bearing(name="B", y=0.37, seat_width=0.02, stiffness=other),
    ]
    ports = [Port(name=n, y=v, lo=v - 0.02, hi=v + 0.02) for n, v in (("p", 0.15), ("q", 0.25))]
    scene = Scene.from_parts(parts, bearings=bearings, port=ports[0], further_ports=(ports[1],))
    mirror = np.diag([1.0, -1.0, 1.0, -1.0, -1.0])  # x y z thx thz
    for model, options in OPTIONS.items():
        found = sg.condense(sg.build(scene, model, **options), scene, port=("p", "q"))
        on = [0, 1, 2, 3, 5]  # thy is free
        p, q, cross = (
            found.between(a, b)[np.ix_(on, on)] for a, b in (("p", "p"), ("q", "q"), ("p", "q"))
        )
        # cells are placed from one end on: the two halves differ in the last digits
        assert relative(mirror @ q @ mirror, p) < 1e-9
        size = np.sqrt(np.outer(np.diag(p), np.diag(q)))
        assert (np.abs(cross - mirror @ cross.T @ mirror) < 1e-9 * size).all()
        assert abs(cross[2, 3]) > 1e-3 * size[2, 3]  # which is odd


@pytest.mark.long
def test_models_agree_on_what_is_between(shaft):
    solid = sg.condense(sg.build(shaft, "solid", refinement=0.7), shaft, port=("wheel", "pinion"))
    harmonic = sg.condense(
        sg.build(shaft, "harmonic", **OPTIONS["harmonic"]), shaft, port=("wheel", "pinion")
    )
    # the mesh of the hexahedra leaves 2 % in the worst compliance; the twist between the gears is
    # a difference of two shoulders, which they are stiffer in
    assert relative(solid.compliance, harmonic.compliance) < 0.025
    assert solid.stiffness[4, 10] == pytest.approx(harmonic.stiffness[4, 10], rel=0.05)
    beam = sg.condense(sg.build(shaft, "timoshenko"), shaft, port=("wheel", "pinion"))
    assert 0.01 < relative(beam.compliance, harmonic.compliance) < 0.3  # shoulders and a disc


# --------------------------------------------------------------------------- scenes
def test_the_main_point_is_that_of_a_scene_of_its_own(shaft):
    """Another station on the shaft adds nothing to what the first one sees."""
    one = shaft.with_changes(further_ports=())
    a = sg.condense(sg.build(one, "timoshenko"), one, "wheel")
    b = sg.condense(sg.build(shaft, "timoshenko"), shaft, "wheel")
    # a node more at the pinion, in exact elements: rounding
    assert relative(b.compliance, a.compliance) < 1e-10
    turned = shaft.with_main_port("pinion")
    assert [p.name for p in turned.ports] == ["pinion", "wheel"]
    with pytest.raises(sg.SceneError, match='no lumped point "pnion"; did you mean "pinion"'):
        shaft.with_main_port("pnion")


def test_points_on_one_surface_have_no_stiffness_between_them():
    port = at("a", A)
    here = rod(end("start", "pinned"), end("end", "pinned"))
    scene = here.with_changes(further_ports=(port.with_changes(name="b"),))
    found = sg.condense(sg.build(scene, "timoshenko"), scene, port=("a", "b"))
    assert np.isnan(found.stiffness).all()
    assert relative(found.between("a", "b"), found.between("a", "a")) < 1e-12
    near = here.with_changes(further_ports=(at("b", A + 0.02),))
    apart = sg.condense(sg.build(near, "timoshenko"), near, port=("a", "b"))
    assert np.isfinite(apart.stiffness).all()


def test_bad_names(shaft):
    body = sg.build(shaft, "timoshenko")
    with pytest.raises(sg.SolidgearError, match="name each port once"):
        sg.condense(body, shaft, port=("wheel", "wheel"))
    with pytest.raises(sg.SolidgearError, match="has no port whel"):
        sg.condense(body, shaft, port=("wheel", "whel"))
    found = sg.condense(body, shaft, port=("wheel", "pinion"))
    with pytest.raises(sg.SolidgearError, match="condensed to wheel, pinion, and not to"):
        found.between("wheel", "A")


# --------------------------------------------------------------------------- answers and commands
def test_an_answer_at_a_further_point(shaft):
    found = sg.answer(shaft, tol=0.05, ask="C_zz@pinion,C_zz@wheel,bending")
    assert [v.quantity for v in found.values] == ["C_zz@pinion", "C_zz", "bending 1"]
    turned = sg.answer(shaft.with_main_port("pinion"), tol=0.05, ask="C_zz,C_zz@wheel,bending")
    assert found["C_zz@pinion"] == pytest.approx(turned["C_zz"], rel=1e-9)  # the same mesh
    assert found["C_zz"] == pytest.approx(turned["C_zz@wheel"], rel=1e-9)
    assert all(0 < v.bar <= 0.05 for v in found.values)
    with pytest.raises(sg.SolidgearError, match="no lumped point"):
        sg.answer(shaft, ask="C_zz@gear")
    with pytest.raises(sg.SolidgearError, match="a frequency belongs to the whole shaft"):
        sg.answer(shaft, ask="bending@pinion")


def test_changes_of_couplings_at_a_point_are_of_its_own_diagonal():
    old = {"C_zz": 4.0, "C_thx": 9.0, "C_z,thx": 1.0}
    old |= {"C_zz@p": 16.0, "C_thx@p": 25.0, "C_z,thx@p": 1.0}
    assert change(old | {"C_z,thx@p": 3.0}, old, "C_z,thx@p") == pytest.approx(2 / 20)
    assert change(old | {"C_z,thx": 3.0}, old, "C_z,thx") == pytest.approx(2 / 6)


@pytest.mark.long
def test_models_are_judged_at_every_point():
    """A head at the second point that no beam can know: it is out there, and only there."""
    parts = [Segment.cylinder("rod", length=0.6, diameter=0.03)]
    parts.append(Segment.cylinder("disc", length=0.01, diameter=0.2, y0=0.6))
    ends = [
        Bearing(name=n, y=y, seat_width=0.02, stiffness={"kxx": 1e8, "kyy": 1e8, "kzz": 1e8})
        for n, y in (("A", 0.02), ("B", 0.5))
    ]
    gear = Port(name="gear", y=0.26, lo=0.23, hi=0.29, attachment="section")
    disc = Port(name="disc", y=0.605, lo=0.6, hi=0.61)
    scene = Scene.from_parts(parts, bearings=ends, port=gear, further_ports=(disc,))
    solutions = {
        "timoshenko": study(scene, "timoshenko", evidence=False),
        "harmonic": study(scene, "harmonic", {"order": 3, "layers": 1}, evidence=False),
    }
    record = recorded(scene, Findings(solutions))
    assert "C_thx@disc" in record.verdict.judged and record.verdict.trust == "harmonic"
    beam = record.models["timoshenko"]
    assert beam.valid is False and " at disc is " in beam.why_not
    assert "Compliances are judged at gear and disc." in record.verdict.sentences
    rows = [r for r in record.deviations if r.quantity == "C_zz@disc"]
    assert rows and all(r.band is not None for r in rows)
    asked = scene.with_changes(ask=sg.Ask(quantities=["C_zz"]))
    only = recorded(asked, Findings(solutions))
    assert only.verdict.judged == ["C_zz"] and only.models["timoshenko"].valid
    assert "Compliances are judged at gear; not at disc." in only.verdict.sentences
    coupled = record.models["harmonic"].coupled
    assert coupled.ports == ["gear", "disc"] and len(coupled.compliance) == 12
    point = record.models["harmonic"].points["disc"]
    assert point.compliance[2][2] == pytest.approx(coupled.compliance[8][8], rel=1e-12)
    page = render_page(record)
    for words in ("Further lumped points", "At disc", "Between gear and disc", "C_zz at disc"):
        assert words in page
    terminal = Console(width=200, file=io.StringIO())
    terminal.print(final_table(record))
    assert "C_zz at disc, um/kN: Timoshenko" in terminal.file.getvalue()
    again = Record.model_validate(json.loads(json.dumps(record.as_dict())))
    assert again.further_ports[0].name == "disc" and again.further_ports[0].free == ["thy"]


def run(*args):
    from typer.testing import CliRunner

    return CliRunner().invoke(app, [str(a) for a in args])


@pytest.mark.long
def test_the_command(shaft):
    path = GEOMETRY / "intermediate_shaft.toml"
    mesh = ("-f", "harmonic", "--set", "order=2", "--set", "layers=0")
    found = json.loads(run("stiffness", path, *mesh, "--port", "wheel,pinion", "--json").stdout)
    body = sg.build(shaft, "harmonic", order=2, layers=0)
    both = sg.condense(body, shaft, port=("wheel", "pinion"))
    assert found["order"][9] == "pinion thx"
    assert found["stiffness"][2][8] == pytest.approx(both.stiffness[2, 8], rel=1e-12)
    assert found["compliance"][4][4] is None
    alone = json.loads(run("stiffness", path, *mesh, "--port", "pinion", "--json").stdout)
    assert alone["compliance"][2][2] == pytest.approx(both.compliance[8, 8], rel=1e-12)
    told = run("stiffness", path, *mesh, "--port", "pinion,wheel").stdout
    for words in (
        "motion of pinion, load on wheel",
        "Stiffness is with both points held",
        "Free: thy",
    ):
        assert words in told
    wrong = run("stiffness", path, "--port", "wheel,axle")
    assert wrong.exit_code == 1 and 'no lumped point "axle"' in str(wrong.exception)
