"""Local problems under the hats of a mesh, on bars of linear elements: how the sum of their energies
bounds an error, and what it takes for that.
"""

import numpy as np
import pytest

from solidgear.core.kernel.local_problems import Cell, condensed, energies
from solidgear.core.meshing.lobatto import at_nodes, gauss, lobatto, products

#: pull of distributed forces per length, N/m, on bars whose stiffness E A is 1 N
PULLS = (lambda x: 1 - 3 * x, lambda x: 5 * x**3 - x, lambda x: np.sin(7 * x))
#: ends of the elements, m: lengths differ by eight
ENDS = np.array([0.0, 0.1, 0.35, 0.4, 0.8, 1.0])
NODES = len(ENDS)
#: order of the functions against which linear ones are held
RICH = 5
#: sixteen digits, of which a system of thirty equations takes a few
ROUNDING = 1e-10


class Bar:
    """A bar on an elastic bed (N/m per m), held at one end or free, under distributed forces.

    An element is a cell; its unknowns in the richer space are its two ends and its bubbles.
    """

    def __init__(self, bed=0.0, held=True):
        x, w = gauss(RICH + 4)
        value, slope = lobatto(RICH, x)
        keep = np.arange(1 if held else 0, NODES + (RICH - 1) * (NODES - 1))
        stiffness, load = (
            np.zeros((len(keep) + held,) * 2),
            np.zeros((len(keep) + held, len(PULLS))),
        )
        self.pieces = []
        for k, (a, b) in enumerate(zip(ENDS, ENDS[1:])):
            ids = np.concatenate([[k, k + 1], NODES + k * (RICH - 1) + np.arange(RICH - 1)])
            rate, weight = slope / (b - a), (b - a) * w
            own = (rate.T * weight) @ rate + bed * (value.T * weight) @ value
            pull = np.array([f(a + (b - a) * x) for f in PULLS]).T
            stiffness[np.ix_(ids, ids)] += own
            load[ids] += (value.T * weight) @ pull
            self.pieces.append((ids, own, value, rate, weight, pull))
        if not held:  # balanced by a uniform force
            uniform = np.zeros(len(load))
            for ids, _, value, _, weight, _ in self.pieces:
                uniform[ids] += value.T @ weight
            total = load[:NODES].sum(axis=0)
            load -= np.outer(uniform, total)
            self.pieces = [(*p[:5], p[5] - total) for p in self.pieces]
        linear = keep[keep < NODES]
        self.u = np.zeros_like(load)
        self.u[linear] = np.linalg.lstsq(
            stiffness[np.ix_(linear, linear)], load[linear], rcond=1e-12
        )[0]
        left = (load - stiffness @ self.u)[keep]
        #: products of energy of the errors, in the richer space
        self.error = left.T @ np.linalg.lstsq(stiffness[np.ix_(keep, keep)], left, rcond=1e-12)[0]
        self.bed, self.held = bed, held
        # nodes alone move as a rigid body; bubbles vanish there
        self.rigid = (np.arange(len(stiffness)) < NODES)[:, None].astype(float)
        if held or bed:
            self.rigid = self.rigid[:, :0]

    def cells(self, weights=((1, -1), (0, 1)), inside=True):
        """Cells under hats of value and slope at the start of every element, bubbles condensed if
        ``inside``.
        """
        out = []
        for k, (ids, own, value, rate, weight, pull) in enumerate(self.pieces):
            x, length = gauss(RICH + 4)[0], ENDS[k + 1] - ENDS[k]
            strain, here = rate @ self.u[ids], self.bed * (value @ self.u[ids])
            loads = []
            for start, rise in weights:
                hat = weight * (start + rise * x)
                loads.append(
                    (value.T * hat) @ (pull - here)
                    - (rate.T * hat) @ strain
                    - (value.T * weight * rise / length) @ strain
                )
            free = ~((ids == 0) & self.held)
            hats = [k, k + 1] if len(loads) == 2 else [0]
            none = np.zeros((len(PULLS), len(PULLS)))
            cell = Cell(hats, ids[free], own[np.ix_(free, free)], np.array(loads)[:, free], none)
            out.append(condensed(cell, inside & (cell.unknowns >= NODES)))
        return out


def within(low, high, scale):
    """Whether a quadratic form is nowhere above another, but for rounding."""
    size = 1 / np.sqrt(np.diag(scale))
    return np.linalg.eigvalsh((high - low) * np.outer(size, size))[0] >= -ROUNDING


@pytest.mark.parametrize(
    "kind", [{"bed": 100.0}, {"bed": 3.0, "held": False}, {}, {"held": False}], ids=str
)
def test_the_sum_of_local_energies_is_between_the_error_and_twice_it(kind):
    """As quadratic forms, of three forces at once."""
    bar = Bar(**kind)
    bound = energies(bar.cells(), bar.rigid).sum(axis=0)
    assert within(bar.error, bound, bar.error) and within(bound, 2 * bar.error, bar.error)
    if kind.get("bed"):  # elements without one are exact at their nodes, and bounds are errors
        assert (np.diag(bound) > (1 + 1e-6) * np.diag(bar.error)).all()


def test_one_hat_over_all_tells_the_error_itself():
    bar = Bar(bed=100.0)
    bound = energies(bar.cells(weights=((1, 0),)), bar.rigid).sum(axis=0)
    assert bound == pytest.approx(bar.error, rel=1e-9)


@pytest.mark.parametrize("weights", [((1, -1), (0, 0.5)), ((0.5, -0.5), (0, 1))], ids=str)
def test_hats_that_do_not_sum_up_to_one_do_not_bound(weights):
    bar = Bar(bed=100.0)
    assert not within(bar.error, energies(bar.cells(weights), bar.rigid).sum(axis=0), bar.error)


def test_what_was_condensed_and_what_was_not_bound_the_same():
    bar = Bar(bed=100.0)
    alike = [energies(cells, bar.rigid) for cells in (bar.cells(), bar.cells(inside=False))]
    assert alike[1] == pytest.approx(alike[0], rel=ROUNDING, abs=ROUNDING * alike[0].max())


@pytest.mark.parametrize("stiffness", [0.7, 3.0, 110.0])
@pytest.mark.parametrize("pull", [(1.0, 0.3), (0.1, -0.7), (1.0, 1.0)], ids=str)
def test_what_does_not_balance_moves_a_patch_as_a_rigid_body_and_costs_nothing(stiffness, pull):
    """A spring that floats: of two forces on its ends half the difference stretches it."""
    matrix, none = stiffness * np.array([[1.0, -1.0], [-1.0, 1.0]]), np.zeros((1, 1))
    cell = Cell([0], np.array([0, 1]), matrix, np.array(pull).reshape(1, 2, 1), none)
    (found,) = energies([cell], np.ones((2, 1))).ravel()
    stretches = (pull[0] - pull[1]) / 2
    # what keeps nearly dependent functions apart is 1e-12 of the stiffness
    assert found == pytest.approx(stretches**2 / stiffness, rel=ROUNDING, abs=ROUNDING / stiffness)


@pytest.mark.parametrize("rounding", [-2e-13, 2e-13])
def test_what_rounding_leaves_a_rigid_motion_is_no_stiffness(rounding):
    """A spring whose first unknown moves both ends: condensing leaves it a sixteenth digit of what was
    there, of either sign.
    """
    stiffness, none = 3.0, np.zeros((1, 1))
    matrix = stiffness * np.array([[rounding, 0.0], [0.0, 1.0]])
    cell = Cell([0], np.array([0, 1]), matrix, np.array([[[0.4], [1.0]]]), none)
    (found,) = energies([cell], np.array([[1.0], [0.0]])).ravel()
    assert found == pytest.approx(1 / stiffness, rel=ROUNDING)


# --------------------------------------------------------------------------- functions of cells
def test_functions_of_a_cell_are_told_by_their_values_and_have_these_slopes():
    """A polynomial of the order in both directions, and another one by its derivatives."""
    points, inverse = at_nodes(4)

    def shape(x, y):
        return (1 + x) ** 4 * (2 - y) ** 3

    at = np.random.default_rng(1).uniform(size=(20, 2))
    value, slope = products(4, at)
    c = inverse @ shape(*points.T)
    x, y = at.T
    assert c @ value == pytest.approx(shape(x, y), rel=1e-12)
    assert c @ slope[0] == pytest.approx(4 * (1 + x) ** 3 * (2 - y) ** 3, rel=1e-12)
    assert c @ slope[1] == pytest.approx(-3 * (1 + x) ** 4 * (2 - y) ** 2, rel=1e-12)
