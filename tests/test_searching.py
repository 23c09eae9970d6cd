"""Searches of spaces whose best is known: valleys, limits that are active, lists, fronts, and what is
claimed of them.
"""

import itertools

import numpy as np
import pytest

import solidgear as sg
from solidgear.variants.optimise.front import search_front
from solidgear.variants.optimise.pool import Pool
from solidgear.variants.optimise.search import FINE, Aim, search
from solidgear.variants.optimise.wish import limit_of, wish_of
from solidgear.variants.sweep.entries import entries_of

#: a shaft with a disc at either end: bending 2 is high where bearing B stands beside either
DISCS = {
    "material": {"E": "207 GPa", "nu": 0.3, "density": "7850 kg/m^3"},
    "segment": [
        {"kind": "cylinder", "name": name, "length": f"{length} mm", "diameter": f"{diameter} mm"}
        for name, length, diameter in [("left", 60, 120), ("mid", 500, 40), ("right", 60, 110)]
    ],
    "bearing": [
        {
            "name": name,
            "position": f"{position} mm",
            "seat_width": "20 mm",
            "stiffness": {"kxx": "2e8 N/m", "kzz": "2e8 N/m"} | along,
        }
        for name, position, along in [("A", 250, {"kyy": "2e8 N/m"}), ("B", 350, {})]
    ],
    "port": {"at": "left.middle", "attach_to": "left"},
}


class Formula:
    """Designs whose numbers are functions of the values."""

    def __init__(self, vary, tables, **numbers):
        self.entries = entries_of(vary, {"": tables}, lambda path: ("", path), search=True)
        self.numbers = numbers
        self.asked = 0

    def solve(self, values):
        self.asked += 1
        varied = {e.label: e.in_row(value) for e, value in zip(self.entries, values)}
        numbers = {name: float(of(*varied.values())) for name, of in self.numbers.items()}
        return varied, [{"status": "ok"} | numbers]

    def names(self, row):
        return [*row]


def searched(tried, *goals, keep=(), most=500):
    """Return the pool and the record of a search."""
    limits = [limit_of(text) for text in keep]
    pool = Pool(tried, [wish_of(text) for text in goals], limits, most, lambda text: None)
    first = pool.solve_file()
    trace = search(Aim(pool), [first]) if len(goals) == 1 else search_front(pool)
    return pool, trace


def best_of(pool):
    return Aim(pool).best([d for d in pool.designs if d.kept])


def valleys(x):
    """The deeper valley is narrow and far from where the search begins."""
    return 1 + min(4 * (x - 0.2) ** 2, 6 * (x - 0.85) ** 2 - 0.1)


@pytest.mark.parametrize("keep", [[], ["c < 2"]], ids=["free", "limit"])
def test_the_deeper_of_two_valleys_is_found_from_the_other(keep):
    tried = Formula(["x=0:1"], {"x": 0.2}, g=valleys, c=lambda x: x)
    pool, trace = searched(tried, "min g", keep=keep)
    assert best_of(pool).value == pytest.approx(0.9, abs=1e-6)
    assert best_of(pool).values["x"] == pytest.approx(0.85, abs=1e-3)
    assert tried.asked < 110 and len(trace.ends) >= 2 and not trace.cut


def test_a_search_goes_up_to_limits_that_are_active():
    """Least x + y with x y >= 1/4: both are one half there, and the limit holds the search."""
    tried = Formula(
        ["x=0:1", "y=0:1"],
        {"x": 0.9, "y": 0.9},
        g=lambda x, y: x + y,
        c=lambda x, y: x * y,
    )
    pool, _ = searched(tried, "min g", keep=["c > 0.25"])
    assert best_of(pool).value == pytest.approx(1.0, abs=4 * FINE)
    assert best_of(pool).place.x == pytest.approx([0.5, 0.5], abs=0.05)  # flat along the limit


def test_an_end_that_is_best_is_reached_to_the_last_digit():
    tried = Formula(
        ["x=0:1", "y=0:1"],
        {"x": 0.5, "y": 0.5},
        g=lambda x, y: 1 + y - 0.05 * x,
        c=lambda x, y: y,
    )
    pool, _ = searched(tried, "min g", keep=["c > 0.3"])
    x, y = best_of(pool).place.x
    assert x == 1.0 and y == pytest.approx(0.3, abs=2 * FINE)


#: centre, depth of a valley in two ranges by the word of a list
BOWLS = {"a": (0.2, 0.0), "b": (0.8, 0.3), "c": (0.5, 0.29), "d": (0.9, -0.2)}


def bowl(word, x, y):
    centre, depth = BOWLS[word]
    return 2 - depth + 3 * (x - centre) ** 2 + 5 * (y - 0.4 - 0.3 * x) ** 2


def test_every_value_of_a_list_has_its_own_best_place():
    """Two of the valleys are within half a per cent, which samples alone do not tell."""
    tried = Formula(["w=a,b,c,d", "x=0:1", "y=0:1"], {"w": "a", "x": 0.2, "y": 0.5}, g=bowl)
    pool, trace = searched(tried, "min g")
    assert best_of(pool).values["w"] == "b" and best_of(pool).value == pytest.approx(1.7, rel=1e-5)
    assert trace.missed == 0 and not trace.cut


def test_lists_alone_are_solved_completely_and_large_ones_are_exchanged():
    lists = [f"{name}=1:12:12" for name in "pqr"]
    tables = dict.fromkeys("pqr", 1)

    def g(p, q, r):
        return 10 + (p - 7) ** 2 + (q - p) ** 2 + 3 * (r - 2) ** 2 + 0.5 * ((p + q + r) % 3)

    tried = Formula(lists, tables, g=g)
    pool, trace = searched(tried, "min g", most=400)
    whole = min(g(*place) for place in itertools.product(range(1, 13), repeat=3))
    assert best_of(pool).value == whole and trace.missed > 0 and tried.asked <= 400
    few = Formula(lists[:2], tables, g=lambda p, q: g(p, q, 2))
    pool, trace = searched(few, "min g")
    assert trace.whole and few.asked == 1 + 144 - 1  # the file is one of them


def test_a_search_that_is_cut_says_so():
    tried = Formula(["x=0:1", "y=0:1"], {"x": 0.9, "y": 0.9}, g=lambda x, y: 1 + x * y)
    pool, trace = searched(tried, "min g", most=12)
    assert trace.cut and tried.asked == 12 == len(pool.designs)


@pytest.mark.long
def test_a_front_holds_no_beaten_design_and_lies_on_the_known_curve():
    """Of the distances from two places the front is the line between them, y = 0."""
    tried = Formula(
        ["x=0:1", "y=-0.5:0.5"],
        {"x": 0.3, "y": 0.3},
        near=lambda x, y: 1 + x**2 + y**2,
        far=lambda x, y: 1 + (x - 1) ** 2 + y**2,
    )
    pool, trace = searched(tried, "min near", "min far", most=1000)
    front = trace.front(pool)
    assert len(front) > 8 and trace.open < 0.05
    line = np.linspace(0, 1, 2001)
    for design in front:
        near, far = (number.value for number in design.goals)
        beaten = np.minimum(1 - (1 + line**2) / near, 1 - (1 + (line - 1) ** 2) / far)
        assert beaten.max() < 1e-3
    for a, b in itertools.permutations(front, 2):
        assert a.goals[0].value > b.goals[0].value or a.goals[1].value > b.goals[1].value


@pytest.mark.long
def test_the_best_seat_of_a_shaft_is_beside_the_other_disc():
    """Going up from the file ends beside the right disc, at 510 Hz; beside the left one there is more."""
    beam = {"model": "timoshenko"}
    ends = sg.sweep(DISCS, "bearing.B.position=75 mm,540 mm", n=4, one_at_a_time=True, **beam)
    left, right = (
        next(ends[f"f{j}_hz"][k] for j in range(1, 5) if ends[f"mode{j}"][k] == "bending 2")
        for k in (1, 2)
    )
    found = sg.optimise(DISCS, ["bearing.B.position=75 mm:540 mm"], "max bending 2", **beam)
    assert found.best.value == pytest.approx(left, rel=1e-9) and left > 1.03 * right
    assert found.at_end == ("bearing.B.position",)
    assert "across the range, then" in " ".join(found.sentences)
