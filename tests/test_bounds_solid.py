"""Bounds of 3D solids by the error in one order more: the functions that it adds, the energy that they
find, and bars against references that share no code with them.
"""

from functools import cache

import numpy as np
import pytest
import scipy.linalg as sla
import scipy.sparse as sp

import solidgear as sg
from solidgear import STEEL, Bearing, Material, Port, Scene, Segment
from solidgear.core.body import as_supports
from solidgear.core.bounds import solid as bounds_solid
from solidgear.core.bounds.solid import _converged, _Search, enriched_errors, solid_bounds
from solidgear.core.errors import NoBounds
from solidgear.core.judge.bounded import _between, bounded
from solidgear.core.judge.quantities import size
from solidgear.core.judge.solving import Statics, numbers, search_modes
from solidgear.core.kernel.assembly import reference
from solidgear.core.models.solid.enriched import Further
from solidgear.core.models.solid.mesh import basis_of
from solidgear.core.quantity import Quantity
from solidgear.core.safety import LOCAL
from solidgear.core.solve.factor import factorise
from tests.test_holds import ON_FACE, on_face
from validation.mesh_files import write_boxes

ELEMENTS = ("tet4", "tet10", "hex8", "hex20", "hex27")
NAMES = [Quantity(name) for name in ("C_zz", "C_thx", "C_yy", "bending 1", "axial 1", "torsion 1")]
#: meshes of some thousands of unknowns
COARSE = {
    "tet10": {"refinement": 0.35},
    "hex20": {"layers": 1, "radial_layers": 1, "edge_layers": 0, "relative_size": 2.0, "around": 8},
}


def stepped(tie="average"):
    """A shaft with one shoulder on two bearings."""
    segments = [
        Segment.cylinder("thick", length=0.06, diameter=0.05),
        Segment.cylinder("thin", length=0.08, diameter=0.03, y0=0.06),
    ]
    springs = np.diag([2e8, 1e8, 2e8, 1e4, 0.0, 1e4]).tolist()
    bearings = [
        Bearing(name=name, y=y, seat_width=0.01, attachment=tie, matrix=springs)
        for name, y in (("A", 0.015), ("B", 0.12))
    ]
    port = Port(name="gear", y=0.04, lo=0.035, hi=0.045)
    return Scene.from_parts(segments, bearings=bearings, port=port)


#: next to incompressible: some thirty steps of conjugate gradients
RUBBER = Material(E=5e6, nu=0.499, density=1200.0)


def stub(tie="average", material=STEEL):
    """A short shaft with one shoulder on one bearing, for matrices that are factored whole."""
    segments = [
        Segment.cylinder("thick", length=0.03, diameter=0.05, material=material),
        Segment.cylinder("thin", length=0.03, diameter=0.03, y0=0.03, material=material),
    ]
    springs = np.diag([2e8, 1e8, 2e8, 1e4, 0.0, 1e4]).tolist()
    bearing = Bearing(name="A", y=0.05, seat_width=0.02, attachment=tie, matrix=springs)
    port = Port(name="gear", y=0.01, lo=0.0, hi=0.02)
    return Scene.from_parts(segments, bearings=[bearing], port=port)


@pytest.mark.parametrize("element", ELEMENTS)
def test_functions_and_their_slopes_agree(element):
    further = Further.beyond(element)
    points = np.random.default_rng(1).uniform(0.1, 0.3, (3, 7))
    value, slope = further.at(points)
    for axis in range(3):
        step = np.zeros((3, 1))
        step[axis] = 1e-6
        numeric = (further.at(points + step)[0] - further.at(points - step)[0]) / 2e-6
        assert np.allclose(slope[:, axis], numeric, atol=1e-8)


@pytest.mark.parametrize("element", ELEMENTS)
def test_with_those_of_the_mesh_they_hold_all_polynomials_of_an_order_more(element):
    order = {"tet4": 1, "tet10": 2, "hex8": 1, "hex20": 2, "hex27": 2}[element]
    points = np.random.default_rng(2).uniform(0.0, 1.0, (3, 300))
    if element.startswith("tet"):
        points = points / 3
    held = np.vstack(
        [reference(basis_of(element), points)[0], Further.beyond(element).at(points)[0]]
    )
    assert np.linalg.matrix_rank(held, tol=1e-6) == len(held)  # none is there twice
    powers = [p for p in np.ndindex(*[order + 2] * 3) if sum(p) <= order + 1]
    monomials = np.array([np.prod(points ** np.array(p)[:, None], axis=0) for p in powers])
    fit = np.linalg.lstsq(held.T, monomials.T, rcond=None)[0]
    assert np.abs(held.T @ fit - monomials.T).max() < 1e-9


@pytest.mark.parametrize("element", ["tet10", "hex20"])
def test_a_function_is_one_function_on_both_sides_of_a_face(element):
    body = sg.build(stub(), "solid", element=element, **COARSE[element])
    m, further = body.geometry, Further.beyond(element)
    numbers_, signs = further.numbered(m)
    inner = np.flatnonzero(m.mesh.f2t[1] >= 0)[:60]
    rng = np.random.default_rng(3)
    weights = rng.uniform(0.1, 1.0, len(m.mesh.refdom.facets[0]))
    for facet in inner:
        sides = []
        for cell in m.mesh.f2t[:, facet]:
            # one point of the face, by its corners in the order of their numbers
            corners = sorted(m.mesh.facets[:, facet])
            place = [list(m.mesh.t[:, cell]).index(c) for c in corners]
            point = m.mesh.refdom.p[:, place] @ weights[:, None] / weights.sum()
            if element == "hex20":  # no affine point but the middle is the same from both sides
                point = _on_quadrilateral(m, cell, corners, (0.3, 0.2))
            value = np.zeros(numbers_.max() + 1)
            value[numbers_[:, cell]] = further.at(point)[0][:, 0] * signs[:, cell]
            sides.append(value)
        assert np.allclose(*sides, atol=1e-12)


def _on_quadrilateral(m, cell, corners, coordinates):
    """The point of a face of a cell by coordinates from its least corner, towards the lesser of its
    neighbours first.
    """
    p = {c: m.mesh.refdom.p[:, list(m.mesh.t[:, cell]).index(c)].astype(float) for c in corners}
    start = p[corners[0]]
    neighbours = [c for c in corners[1:] if np.abs(p[c] - start).sum() == 1]
    s, t = (p[c] - start for c in neighbours)
    return (start + coordinates[0] * s + coordinates[1] * t)[:, None]


@pytest.mark.parametrize(
    "element, tie, material",
    [
        ("tet10", "average", STEEL),
        ("tet10", "average", RUBBER),
        ("tet10", "rigid", STEEL),
        pytest.param("hex20", "average", STEEL, marks=pytest.mark.slow),
        pytest.param("hex20", "rigid", STEEL, marks=pytest.mark.slow),
    ],
    ids=["tet10", "tet10 of rubber", "tet10 on a rigid seat", "hex20", "hex20 on a rigid seat"],
)
def test_the_energy_is_that_of_solving_in_both_spaces_at_once(element, tie, material):
    # in one block, of hexahedra too
    body = sg.build(stub(tie, material), "solid", element=element, half=False, **COARSE[element])
    block = body.blocks[0]
    more = block.enrich()
    free = np.flatnonzero(more.moves)
    expand = sp.identity(block.size) if block.expand is None else block.expand
    coupling = (more.coupling @ expand)[free]
    k = sp.bmat(
        [[block.stiffness, coupling.T], [coupling, more.stiffness.tocsr()[free][:, free]]]
    ).tocsc()
    # pulled apart along the axis at two ports, which inertia need not balance
    forces = np.zeros(block.ports.shape[0])
    forces[[1, 7]] = 1.0, -1.0
    load = np.r_[block.ports.T @ forces, more.ports.T[free] @ forces]
    # six unknowns held, where a balanced load needs nothing to hold it
    held = sla.qr(block.rigid.T, mode="r", pivoting=True)[1][:6]

    def solved(matrix, load):
        moves = np.setdiff1d(np.arange(len(load)), held)
        out = np.zeros(len(load))
        out[moves] = factorise(matrix.tocsr()[moves][:, moves]).solve(load[moves])
        return out

    both = solved(k, load)
    u = solved(block.stiffness, block.ports.T @ forces)
    gained = load @ both - (block.ports.T @ forces) @ u
    zero = np.zeros((block.size, 1))
    errors = enriched_errors(body, 0, u[:, None], forces[:, None], zero)
    # conjugate gradients end where some per cent may be missing, and add what they expect
    assert errors.energies[0, 0] == pytest.approx(gained, rel=0.03)


def judged(scene, element, names=NAMES, **options):
    """Numbers of a 3D solid with their error bars."""
    body = sg.build(scene, "solid", element=element, **options)
    supports = as_supports(scene)
    statics = Statics.for_quantities(scene, body, supports, names)
    modes = search_modes(body, supports, 10, [q for q in names if q.is_frequency], spare=True)
    values = numbers(statics, modes)
    bars = bounded(scene, body, supports, statics, modes, names, values.solver).error_bars
    return {q: (values.quantities[q], bars[q], size(values.quantities, q)) for q in names}


@cache
def truth(tie="average"):
    """The numbers of the stepped shaft by the harmonic solid, which shares no mesh and no function
    with it.
    """
    return {v.quantity: v.value for v in sg.answer(stepped(tie), 3e-5, ask=NAMES).values}


def over_error(found, exact):
    """Half-widths of error bars about the middle over the error of the middle, and of one side."""
    about, one_side = [], []
    for name, (value, bar, scale) in found.items():
        middle = value if bar.middle is None else bar.middle
        about.append(bar.about_middle / (abs(middle - exact[name]) / scale))
        one_side.append(bar.width / (abs(value - exact[name]) / scale))
    return np.array(about), np.array(one_side)


@pytest.mark.long
@pytest.mark.parametrize("element", ["tet10", "hex20"])
def test_bars_hold_and_are_hardly_wider_than_errors(element):
    about, one_side = over_error(judged(stepped(), element, **COARSE[element]), truth())
    assert np.all(about > 1)
    # the share of the sharpest edge goes to all of the error, which is more than it lacks elsewhere
    assert np.all(one_side > 1) and np.median(one_side) < 2 and np.all(one_side < 3)


@pytest.mark.slow
def test_bars_hold_at_rigid_seats():
    found = judged(stepped("rigid"), "tet10", **COARSE["tet10"])
    _, one_side = over_error(found, truth("rigid"))
    assert np.all(one_side > 1) and np.median(one_side) < 2.5


@pytest.mark.parametrize(("element", "refinement"), [("tet10", 0.7), ("hex20", 0.6)])
def test_bars_hold_on_a_clamped_face(element, refinement):
    """Its rim is as sharp as Williams says of a held face at right angles to a free one."""
    right = {Quantity(name): value for name, value in ON_FACE[0.0].items()}
    found = judged(on_face(), element, tuple(right), refinement=refinement)
    _, one_side = over_error(found, right)
    assert np.all(one_side > 1) and np.all(one_side < 2.5)


def test_the_truth_lies_beyond_the_least_growth():
    scene = stepped()
    exact = truth()
    body = sg.build(scene, "solid", element="tet10", **COARSE["tet10"])
    bounds = solid_bounds(scene, body, statics=True)
    ends = [
        sg.condense(bounds.softer(m), scene, "gear").compliance for m in (bounds.least, bounds.more)
    ]
    for name, place in (("C_zz", 2), ("C_thx", 3), ("C_yy", 1)):
        near, far = (end[place, place] for end in ends)
        assert near < exact[Quantity(name)] < far + (LOCAL - 1) * (far - near)


def test_what_did_not_converge_is_refused(monkeypatch):
    scene = stub()
    body = sg.build(scene, "solid", element="tet10", **COARSE["tet10"])
    monkeypatch.setattr(bounds_solid, "MOST_STEPS", 2)
    with pytest.raises(sg.SolidgearError, match="one order more"):
        solid_bounds(scene, body, statics=True)


def test_a_coupling_that_only_rounding_moves_has_a_bar_of_nothing():
    """Of a point in the seat of the only bearing: the larger of both ends is either one."""
    names = [Quantity(name) for name in ("C_zz", "C_thx", "C_z,thx")]
    ulp = np.finfo(float).eps
    stiff = dict(zip(names, (1.0, 1.0, 0.5)))
    far = dict(zip(names, (1.0 + ulp, 1.0 + 4 * ulp, 0.5)))
    near = dict(zip(names, (1.0 + 2 * ulp, 1.0, 0.5)))
    bar = _between(names[2], stiff, far, stiff, near, 0.0)
    assert 0 <= bar.about_middle < 1e-8 and 0 <= bar.width < 1e-8


def test_columns_that_were_found_long_ago_keep_none_waiting():
    """Gains of the first ones are rounding when the last one is found, and rise as often as they fall."""
    size = 80
    chain = sp.diags([2.0, -1.0, -1.0], [0, 1, -1], (size, size)).tocsr()
    own = np.linalg.eigh(chain.toarray())[1]
    loads = np.column_stack([own[:, k : k + 3].sum(axis=1) for k in range(0, size - 3, 3)])
    slow = np.eye(size)[:, :1]
    search = _Search(chain.__matmul__, np.ones(size), np.hstack([loads, slow]))
    steps = _converged(search)
    # with the one that shows what is softest
    alone = _converged(_Search(chain.__matmul__, np.ones(size), np.hstack([loads[:, :1], slow])))
    assert steps < alone + 3
    exact = np.einsum("ij,ij->j", loads, np.linalg.solve(chain.toarray(), loads))
    assert search.energy[:-1] == pytest.approx(exact, rel=1e-9)


@pytest.mark.slow
def test_half_a_part_has_the_bars_of_the_whole():
    scene = sg.load("geometry/pinion_keyed.toml")
    widths = []
    for half in (True, False):
        found = judged(scene, "tet10", NAMES[:3], refinement=0.2, half=half)
        widths.append([bar.width for _, bar, _ in found.values()])
    # other meshes: their errors differ by a quarter
    assert np.allclose(*widths, rtol=0.4)


def bush(thickness):
    """Two steel bars with a layer of rubber between them."""
    parts, y = [], 0.0
    for name, length, material in (
        ("a", 0.03, STEEL),
        ("layer", thickness, RUBBER),
        ("b", 0.03, STEEL),
    ):
        parts.append(Segment.cylinder(name, y0=y, length=length, diameter=0.04, material=material))
        y += length
    return Scene.from_parts(parts, port=Port(y=0.008, lo=0.003, hi=0.013), bearings=[])


def test_a_bonded_layer_of_rubber_one_cell_thick_has_no_bar():
    """Its frequencies had bars of 0.02 to 0.4 of their errors: it locks in one order more too."""
    coarse = {"element": "hex20", "layers": 0, "radial_layers": 0, "edge_layers": 0, "around": 8}
    scene = bush(0.004)
    body = sg.build(scene, "solid", relative_size=1.5, **coarse)
    with pytest.raises(NoBounds, match="'layer', of Poisson's ratio 0.499") as refused:
        solid_bounds(scene, body, statics=False)
    assert refused.value.finer_helps
    # a thick piece has several cells
    scene = bush(0.06)
    body = sg.build(scene, "solid", relative_size=1.5, **coarse)
    assert solid_bounds(scene, body, statics=False).share > 1


def web(folder, thick):
    """A web of 60 x 40 mm, mm thick, of six bricks that are as wide as 20 mm: held at one narrow face."""
    lines = [np.linspace(0, 0.06, 4), np.linspace(0, 0.04, 3), np.array([0, 1e-3 * thick])]
    ends = {"foot": lambda m: m[0] < 1e-9, "gear": lambda m: m[0] > 0.06 - 1e-9}
    write_boxes(folder / "web.msh", lines, ends, bricks=True)
    (folder / "web.toml").write_text(
        'material = "steel"\nbody = { mesh = "web.msh", unit = "mm", axis = "none" }\n'
        '[[bearing]]\nname = "foot"\npatch = "foot"\nhold = "clamped"\n'
        '[[port]]\nname = "gear"\npatch = "gear"\n'
    )
    scene = sg.load(folder / "web.toml")
    return scene, sg.build(scene, "solid")


def test_energy_of_slender_cells_is_found_where_gains_rest(tmp_path, monkeypatch):
    """Gains of conjugate gradients rest where cells are twenty times as wide as thick, with two thirds of
    the energy found; the safety covers a quarter.
    """
    scene, body = web(tmp_path, 1.0)
    found = solid_bounds(scene, body, statics=True).reached.diagonal()
    monkeypatch.setattr(bounds_solid, "MISSING", 1e-8)
    monkeypatch.setattr(bounds_solid, "MOST_STEPS", 2000)
    whole = solid_bounds(scene, body, statics=True).reached.diagonal()
    assert found == pytest.approx(whole, rel=1 - 1 / LOCAL)


def test_cells_too_slender_for_that_are_refused_with_the_way_out(tmp_path):
    """Forty times as wide as thick: bars of a tilt were 0.73 of its error."""
    with pytest.raises(NoBounds, match="very slender cells, .*; use shorter cells there"):
        solid_bounds(*web(tmp_path, 0.5), statics=True)


def test_what_may_be_missing_at_most_is_more_than_what_is():
    """With eigenvalues over four decades, by steps: the least of Lanczos' matrix tells how soft it is."""
    rng = np.random.default_rng(3)
    values = np.geomspace(1e-4, 1, 60)
    basis = np.linalg.qr(rng.standard_normal((60, 60)))[0]
    matrix = basis @ np.diag(values) @ basis.T
    load = rng.standard_normal((60, 3))
    whole = np.einsum("ij,ij->j", load, np.linalg.solve(matrix, load))
    search = _Search(lambda x: matrix @ x, np.ones(60), load)
    over = []
    search.advance()
    while search.softest > 2e-4:  # half of which is what is softest
        search.advance()
    for _ in range(10):
        search.advance()
        over.append(search.most_missing / (whole - search.energy))
    assert 1 <= np.min(over) and np.max(over) < 20
