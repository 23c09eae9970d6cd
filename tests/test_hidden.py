"""What a mesh hides: a count is true of the mesh, a list complete of the body only below the lower
ends of what lies above it.
"""

import numpy as np
import pytest

import solidgear as sg
from solidgear.core.body import as_supports
from solidgear.core.bounds import harmonic
from solidgear.core.judge import study
from solidgear.core.judge.bounded import mode_bars
from solidgear.core.judge.completeness import completeness
from solidgear.core.judge.hidden import COMPLETE, COUNTED, complete_list, less_bars
from solidgear.core.safety import ROOM
from solidgear.core.scene import Bearing, Material, Scene
from solidgear.core.solve.modes import Mode
from tests.shafts import shaft

RUBBER = Material(E=1e7, nu=0.49, density=1100.0)
COARSE = {"order": 3, "layers": 0, "edge_layers": 0, "relative_size": 4.0}
FINE = {"order": 7, "layers": 0, "edge_layers": 0, "relative_size": 4.0}


def shapes(found, below):
    """Elastic shapes below a frequency, Hz."""
    return sum(m.multiplicity for m in found.modes if 0 < m.frequency_hz < below)


@pytest.fixture(scope="module")
def rubber_tail():
    """A steel rod with a rubber one behind, whose short waves a mesh made for steel cannot follow."""
    steel, tail = shaft((0.1, 0.02, 0.02), (0.12, 0.01, 0.01)).segments
    stiff = np.diag([2e8, 7e7, 2e8, 0.0, 0.0, 0.0])
    bearings = [
        Bearing(name=name, y=y, seat_width=0.01, matrix=stiff)
        for name, y in (("A", 0.02), ("B", 0.08))
    ]
    parts = [steel, tail.model_copy(update={"material": RUBBER})]
    return Scene.from_parts(parts, bearings=bearings)


def test_a_list_is_complete_below_the_lower_ends_of_what_lies_above(rubber_tail):
    scene = rubber_tail
    body = sg.build(scene, "harmonic", **COARSE)
    found = sg.modes(body, scene, 24, count=True, ovalising=False, room=ROOM)
    truth = sg.modes(sg.build(scene, "harmonic", **FINE), scene, 40, ovalising=False)
    told = complete_list(scene, body, as_supports(scene), found).evidence
    # the mesh counts right, and the body has a pair more below, which lies 6 % higher on the mesh
    assert shapes(truth, told[COUNTED]) > shapes(found, told[COUNTED])
    assert shapes(truth, told[COMPLETE]) <= shapes(found, told[COMPLETE])
    assert "No mode missed below" in completeness(told, "harmonic")
    assert "No mode of this mesh missed below" in completeness(found.evidence, "harmonic")


def test_what_bounds_the_end_of_a_list_is_solved_with_the_error_bars(monkeypatch):
    """The last mesh solves its local problems once, for numbers, section ties and the end of the list."""
    solved, at_end = [], []
    local_energies, bound = harmonic.local_energies, study.complete_list
    monkeypatch.setattr(
        harmonic, "local_energies", lambda *a: solved.append(a[0]) or local_energies(*a)
    )

    def complete(*args):
        before = len(solved)
        listed = bound(*args)
        at_end.append(len(solved) - before)
        return listed

    monkeypatch.setattr(study, "complete_list", complete)
    scene = sg.load("geometry/shaft_stepped.toml")
    solution = study.study(scene, "harmonic", {"order": 3, "layers": 0, "relative_size": 2.0})
    assert COMPLETE in solution.modes.evidence and at_end == [0]
    # one round: bending, axial, torsion
    assert len(solved) == 3


def test_bars_of_what_lies_above_a_list_are_taken_off_a_count():
    counted = {COUNTED: 1000.0}
    listed = {"bending 1": 0.01, "axial 1": 0.2}
    own = ({0: np.zeros(1)},), np.zeros((1, 1, 6)), 1.0
    above = [Mode(name, "m", hz, 1, *own) for name, hz in (("m 1", 1010.0), ("m 2", 1200.0))]
    ends = less_bars(counted, listed | {"m 1": 0.05, "m 2": 0.3}, above)
    assert ends[COMPLETE] == pytest.approx(1200 * 0.7)
    # without the first of them the widest of all
    assert less_bars(counted, listed | {"m 2": 0.01}, above)[COMPLETE] == pytest.approx(800.0)
    assert less_bars(counted, listed)[COMPLETE] == pytest.approx(800.0)
    # nothing is claimed where no bar is known; what the bars of every family have told stays
    assert less_bars(counted, {}) == counted
    assert less_bars(counted | {COMPLETE: 900.0}, {"bending 1": 0.2})[COMPLETE] == 900.0


def test_modes_of_a_cluster_rest_on_the_distance_to_what_lies_beyond_it():
    """Equal thin webs have their ovalising modes side by side: the bar of one must not rest on the gap
    to the other, for what was solved above both has room enough.
    """
    web, neck = (0.001, 0.075, 0.075), (0.03, 0.015, 0.015)
    scene = shaft(neck, web, neck, web, neck)
    body = sg.build(scene, "harmonic", order=4, layers=0, relative_size=4.0)
    found = sg.modes(body, scene, 10)
    twins = [m for m in found.modes if m.name.startswith("ovalising n=2")]
    assert len(twins) == 2 and twins[1].frequency_hz < 1.001 * twins[0].frequency_hz
    bars = mode_bars(scene, body, as_supports(scene), found)
    assert max(bars[m.name] for m in twins) < 0.03
