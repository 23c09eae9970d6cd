"""Bounds of harmonic solids by local problems, on first meshes of a dozen cells, against meshes so fine
that their own error is a few hundredths of what is bounded.

The fine meshes have the cells of the first ones, cut towards their corners, and order 7: on cells with
parallel sides they can do what a first mesh can, and differences have a sign.
"""

from dataclasses import dataclass

import numpy as np
import pytest

import solidgear as sg
from solidgear import Bearing, Port, Scene, Segment
from solidgear.core.body import Body, as_supports
from solidgear.core.bounds import richer_space as meridian_pieces
from solidgear.core.bounds.clusters import lower_ends
from solidgear.core.bounds.harmonic import (
    HarmonicBounds,
    harmonic_bounds,
    lower_ends_of,
    richer_space,
    with_tail,
)
from solidgear.core.judge.bars import ErrorBar
from solidgear.core.judge.bounded import bounded
from solidgear.core.judge.quantities import measure, size
from solidgear.core.judge.solving import Statics, search_modes
from solidgear.core.meshing.meridian import CUT_RATIO
from solidgear.core.quantity import Quantity
from solidgear.core.safety import LOCAL
from solidgear.core.scene import STEEL, Fillet, Housing, Material
from solidgear.core.scene.coned import coned
from solidgear.core.solve.modes import Mode
from solidgear.core.solve.statics import condense, flexibility

MM = 1e-3
ALUMINIUM = Material(E=7e10, nu=0.34, density=2700)
#: one cell a band and strip of order 3, and no layers
FIRST = {"order": 3, "layers": 0, "edge_layers": 0, "relative_size": 4.0, "plain": True}
#: what cuts of fine meshes leave of what a corner costs, at most
LEFT = 0.01
MODES = tuple(map(Quantity, ("bending 1", "axial 1", "torsion 1")))
#: widest that a bound may be, in errors: by what hats overlap and orders do not see, of modes also by
#: the gap to the next one; 0.9 to 1.1 is measured
WIDEST = 1.6
#: errors that bars do not follow, beside the rounding that they hold
UNSEEN = 1e-9
#: compliances are inverses of stiffnesses, and lose a few of their sixteen digits
ROUNDING = 1e-11


def shaft(*parts, port=(80, 100), seat=(20, 40), tie="average", held="average", **rest):
    """Parts of (length, start diameter, end diameter, bore, material), as far as given, mm."""
    segments, y = [], 0.0
    for k, part in enumerate(parts):
        length, start, end, bore, material = (*part, *(part[1], 0.0, STEEL)[len(part) - 2 :])
        radii = {"outer0": start / 2 * MM, "outer1": end / 2 * MM}
        radii |= {"inner0": bore / 2 * MM, "inner1": bore / 2 * MM}
        segments.append(
            Segment(name=f"s{k}", y0=y * MM, y1=(y + length) * MM, material=material, **radii)
        )
        y += length
    springs = dict.fromkeys(("kxx", "kyy", "kzz"), 1e9) | dict.fromkeys(
        ("kthx", "kthy", "kthz"), 1e5
    )
    place = {"y": sum(seat) / 2 * MM, "seat_width": (seat[1] - seat[0]) * MM}
    bearing = Bearing(name="b", **place, stiffness=springs, attachment=held)
    lo, hi = (one * MM for one in port)
    middle = hi if tie == "section" else (lo + hi) / 2
    loaded = Port(name="p", y=middle, lo=lo, hi=hi, attachment=tie)
    return Scene.from_parts(segments, bearings=[bearing], port=loaded, **rest)


SHAFTS = {
    "step": lambda: shaft((60, 40), (60, 60)),
    "rigid seat at a shoulder": lambda: shaft(
        (60, 40), (60, 60), port=(40, 60), seat=(80, 100), tie="rigid"
    ),
    "tube": lambda: shaft((120, 60, 60, 54)),
    "bore step": lambda: shaft((60, 60, 60, 40), (60, 60, 60, 20)),
    "cone": lambda: shaft((50, 40), (20, 40, 80), (50, 80)),
    "section tie": lambda: shaft((60, 40), (60, 60), port=(50, 60), tie="section", held="section"),
    "fillet": lambda: shaft(
        (60, 40), (60, 60), blends=[Fillet(name="f", y=60 * MM, radius=4 * MM)]
    ),
    "steel on aluminium": lambda: shaft((60, 40), (60, 40, 40, 0, ALUMINIUM)),
    "thin disc": lambda: shaft((40, 40), (5, 200), (40, 40), port=(40, 45), seat=(15, 25)),
}


@dataclass
class Solved:
    """A shaft on its first mesh with its bars, and what a far finer one says."""

    scene: Scene
    body: Body
    values: dict[str, float]
    bars: dict[str, ErrorBar]
    bounds: HarmonicBounds
    fine: Body
    truth: dict[str, float]

    @property
    def soft(self):
        """The softest body that the exact one may be."""
        return self.bounds.softer(LOCAL * self.bounds.more)


def fine_mesh(scene, body, **options):
    space = richer_space(coned(scene), body)
    cuts = tuple(
        (
            float(space.flat.points[1, v]),
            float(space.flat.points[0, v]),
            int(np.ceil(np.log(LEFT) / (2 * place.exponent * np.log(CUT_RATIO)))),
        )
        for v, place in space.corners.items()
    )
    return sg.build(scene, "harmonic", **{**FIRST, "order": 7}, cuts=cuts, **options)


@pytest.fixture(scope="module")
def one(request):
    """A shaft, solved once for all tests that ask for it; one at a time is held in memory."""
    scene = SHAFTS[request.param]()
    supports, body = as_supports(scene), sg.build(scene, "harmonic", **FIRST)
    fine = fine_mesh(scene, body)
    found, truth = (
        search_modes(one, supports, 8, MODES, spare=True, ovalising=False) for one in (body, fine)
    )
    here, there = (condense(one, supports, "p") for one in (body, fine))
    # what the solver leaves of such small bodies is far below
    judged = bounded(scene, body, supports, Statics(here), found, MODES, {})
    bounds = harmonic_bounds(coned(scene), body, statics=True)
    values, exact = measure(here, found), measure(there, truth)
    return Solved(scene, body, values, judged.error_bars, bounds, fine, exact)


def compliances(scene, *bodies):
    return [condense(body, scene, "p").compliance for body in bodies]


def within(low, high, scale):
    """Whether a quadratic form is nowhere above another, but for rounding on the scale of a third."""
    size = np.sqrt(np.diag(scale))
    size[size == 0] = 1.0
    return np.linalg.eigvalsh((high - low) / np.outer(size, size))[0] >= -ROUNDING


# --------------------------------------------------------------------------- bodies
#: a step of the bore is one of the surface from inside; a cone's corners are blunter than a step's,
#: and a tube has none
MILD = ("bore step", "cone", "tube")
#: a step, a fillet and seats that average tell what these do
DEAR = ("rigid seat at a shoulder", "thin disc", "steel on aluminium")
MARKS = dict.fromkeys(DEAR, pytest.mark.long) | dict.fromkeys(MILD, pytest.mark.slow)
MOST = [pytest.param(s, marks=MARKS.get(s, ())) for s in SHAFTS]


@pytest.mark.parametrize("one", MOST, indirect=True)
def test_errors_are_within_bars_and_bars_hardly_wider(one):
    """Of compliances, stiffnesses with all else held, and frequencies."""
    assert set(MODES) < set(one.bars) and {"C_zz", "K_thx", "C_thy", "K_x,thz"} < set(one.bars)
    for q, bar in one.bars.items():
        value, scale = one.values[q], size(one.truth, q)
        error = abs(value - one.truth[q]) / scale
        assert error <= bar.width, q
        if q.diagonals is None and error > UNSEEN:
            # compliances from below, all else from above
            assert (value < one.truth[q]) == q.startswith("C_"), q
            assert bar.width <= LOCAL * WIDEST * error, q
        elif q.diagonals is not None:
            # about the middle of what is open there is half as much on either side
            assert abs(bar.middle - one.truth[q]) <= bar.about_middle * scale < bar.width * scale


@pytest.mark.parametrize("one", ["section tie"], indirect=True)
def test_a_plane_that_turns_as_a_whole_twists_exactly_and_says_so(one):
    assert one.values["C_thy"] == pytest.approx(one.truth["C_thy"], rel=1e-10)
    assert one.bars["C_thy"].width < UNSEEN


@pytest.mark.parametrize("one", MOST, indirect=True)
def test_the_exact_flexibility_lies_between_two_matrices(one):
    """No load whatever makes the exact body stiffer than the mesh, or softer than the bound."""
    stiff, exact, soft = (flexibility(body).matrix for body in (one.body, one.fine, one.soft))
    assert within(stiff, exact, exact) and within(exact, soft, exact)


@pytest.mark.parametrize("one", ["step"], indirect=True)
def test_bounds_come_from_where_the_stress_is_sharpest(one):
    """Of a stepped shaft from the cells at the shoulder and at the ends of loaded seats."""
    by_cell = one.bounds.of_ports.trace(axis1=1, axis2=2)
    corners = richer_space(one.scene, one.body).corners
    names = {place.what for place in corners.values()}
    assert names == {"shoulder", "seat end of p", "seat end of b"}
    near = np.isin(one.body.geometry.meridian.cells, list(corners)).any(axis=0)
    assert not near.all() and by_cell[near].sum() > 0.95 * by_cell.sum()
    assert by_cell.sum() == pytest.approx(np.trace(one.bounds.more), rel=1e-12)


# --------------------------------------------------------------------------- supports
@pytest.mark.parametrize("one", ["step", "rigid seat at a shoulder"], indirect=True)
def test_the_same_bound_holds_on_any_bearings(one):
    """From springs that hide the mesh to a grip that shows nothing else; nothing is solved again."""
    opened = []
    for k in 10.0 ** np.arange(4, 12):
        (bearing,) = one.scene.bearings
        held = bearing.with_changes(stiffness=k * np.diag([1, 2, 0.5, 1e-4, 1e-4, 1e-4]))
        scene = one.scene.with_changes(bearings=(held,))
        stiff, exact, soft = compliances(scene, one.body, one.fine, one.soft)
        assert within(stiff, exact, exact) and within(exact, soft, exact)
        opened.append((soft[2, 2] - stiff[2, 2]) / stiff[2, 2])
    # 1e7 times as stiff a bearing, and the share of the mesh is of the size of the shaft's own
    assert opened[0] < 1e-6 and opened[-1] > 1e-4


@pytest.fixture(scope="module")
def two_points():
    """A stepped shaft with two lumped points, on two seats."""
    scene = shaft((60, 40), (60, 60))
    far = scene.bearings[0].with_changes(name="far", y=0.07, seat_width=0.01)
    ports = (scene.port, Port(name="q", y=0.11, lo=0.1, hi=0.12))
    first = scene.port.with_changes(y=0.055, lo=0.05, hi=0.06)
    scene = Scene.from_parts(
        scene.segments, bearings=[*scene.bearings, far], port=first, further_ports=ports[1:]
    )
    body = sg.build(scene, "harmonic", **FIRST)
    bounds = harmonic_bounds(scene, body, statics=True)
    return scene, body, fine_mesh(scene, body), bounds.softer(LOCAL * bounds.more)


SUPPORTED = {
    "both bearings": lambda scene: scene,
    "a housing that gives": lambda scene: scene.with_changes(
        housing=Housing(stiffness={"kxx": 3e8, "kyy": 2e8, "kzz": 3e8, "kthx": 1e6}, y=0.06)
    ),
    "one bearing": lambda scene: scene.with_changes(bearings=scene.bearings[:1]),
    "nothing at all": lambda scene: scene.with_changes(bearings=()),
}


@pytest.mark.parametrize("how", SUPPORTED)
def test_stiffness_between_two_held_points_lies_between_that_of_both_bodies(two_points, how):
    """However the shaft is supported, in all directions at once."""
    scene, *bodies = two_points
    supports = as_supports(SUPPORTED[how](scene))
    found = [condense(body, supports, ("p", "q")) for body in bodies]
    stiff, exact, soft = (one.stiffness for one in found)
    assert exact[2, 2] > 0 and within(exact, stiff, exact) and within(soft, exact, exact)
    if how != "nothing at all":
        stiff, exact, soft = (one.compliance for one in found)
        assert within(stiff, exact, exact) and within(exact, soft, exact)


# --------------------------------------------------------------------------- modes
@pytest.mark.long
@pytest.mark.parametrize("one", ["step"], indirect=True)
def test_frequencies_of_a_body_that_nothing_holds_lie_within_bounds(one):
    free = [
        search_modes(body, as_supports(()), 8, MODES, spare=True) for body in (one.body, one.fine)
    ]
    bounds = harmonic_bounds(one.scene, one.body, statics=False, modes=free[0], wanted=MODES)
    for name in MODES:
        value, exact = (found.named(name) for found in free)
        error = value.frequency_hz**2 - exact.frequency_hz**2
        bound = value.frequency_hz**2 - bounds.frequency(value) ** 2
        assert 0 < error <= LOCAL * bound <= LOCAL * WIDEST * error, name


def test_waves_that_no_port_moves_with_have_bounds_too():
    """A ring bends in its own plane before all else, without a bearing that would feel it."""
    scene = shaft((30, 200, 200, 180), port=(10, 20), seat=(0, 5))
    body = sg.build(scene, "harmonic", **FIRST)
    fine = fine_mesh(scene, body)
    found, truth = (sg.modes(one, scene, 8, ovalising=True) for one in (body, fine))
    oval = next(m for m in found.modes if m.waves == 2)
    exact = next(m for m in truth.modes if m.waves == 2)
    bounds = harmonic_bounds(scene, body, statics=False, modes=found, wanted=[oval.name])
    error = oval.frequency_hz**2 - exact.frequency_hz**2
    bound = oval.frequency_hz**2 - bounds.frequency(oval) ** 2
    assert 0 < error <= LOCAL * bound <= LOCAL * WIDEST * error


@pytest.mark.parametrize("left", [0.02, 0.3, 0.7])
def test_orders_that_take_like_shares_are_summed_up_to_the_end(left):
    """Where an order leaves a share of an error, two of them see all but its square."""
    assert with_tail(1 - left**2, 1 - left) == pytest.approx(1.0)
    # orders that see less of each other are not extrapolated without end
    assert with_tail(1.0, 0.3) <= 5.0 and with_tail(1.0, 1.2) == 1.0


def made_up(values):
    """Modes of one eigenproblem with these eigenvalues, rad^2/s^2."""
    hz = np.sqrt(values) / (2 * np.pi)
    own = ({0: np.zeros(1)},), np.zeros((1, 1, 6)), 1.0
    return [Mode(f"m {k}", "m", float(one), 1, *own) for k, one in enumerate(hz)]


def ritz(eigenvalues, trial):
    """Ritz values of a diagonal matrix in a space, and products of energy of their residuals."""
    q = np.linalg.qr(trial)[0]
    values, turn = np.linalg.eigh(q.T @ (eigenvalues[:, None] * q))
    shapes = q @ turn
    left = eigenvalues[:, None] * shapes - shapes * values
    return values, left.T @ (left / eigenvalues[:, None])


@pytest.mark.parametrize("angle", [0.05, 0.1, 0.2, 0.3])
def test_the_next_mode_widens_a_bound_as_far_as_it_is_near(angle):
    """A shape mixed with that of a mode 8 % above: its residual alone says little of its error."""
    eigenvalues = np.array([1.0, 1.08])
    value, energy = ritz(eigenvalues, np.array([[np.cos(angle)], [np.sin(angle)]]))
    own, above = made_up([value[0], 1.08])
    ends = lower_ends_of([own], [own, above], energy)
    assert value[0] - energy[0, 0] > 1.0 >= ends[own.name]


def test_modes_that_may_change_places_share_their_lower_ends():
    """The first of two is exact, and the second one in truth lies below it."""
    eigenvalues = np.array([0.95, 1.0, 2.0, 30.0])
    trial = np.zeros((4, 3))
    trial[0, 0], trial[3, 0] = 1.0, 0.08
    trial[1, 1] = trial[2, 2] = 1.0
    values, energy = ritz(eigenvalues, trial)
    assert values[0] == pytest.approx(1.0) and values[1] > 1.06 and energy[0, 0] < 1e-20
    first, second, third = made_up(values)
    ends = lower_ends_of([first, second], [first, second, third], energy[:2, :2])
    # a millionth for what rounding makes of the exact one
    assert ends[first.name] <= 0.95 and ends[first.name] <= ends[second.name] <= 1.0 + 1e-6
    # of one block as of several
    assert np.diff(lower_ends(values[:2], energy[:2, :2], values[2])) > 0


def test_the_space_of_an_order_less_is_that_of_a_mesh_an_order_lower(monkeypatch):
    """One elimination gives both: what is the lower one of three orders more is the higher one of
    two, where the last functions are eliminated in a step of their own.
    """
    scene = SHAFTS["steel on aluminium"]()
    body = sg.build(scene, "harmonic", **FIRST)
    two = harmonic_bounds(coned(scene), body, statics=True)
    body.cache.clear()
    monkeypatch.setattr(meridian_pieces, "EXTRA", 3)
    three = harmonic_bounds(coned(scene), body, statics=True)
    # the richer of both integrates what is divided by r with more points
    assert np.trace(three.less) == pytest.approx(np.trace(two.more), rel=1e-3)
    assert np.trace(two.more) > 1.01 * np.trace(two.less)
