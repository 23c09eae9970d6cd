"""Peers of the race in validation/: what CalculiX is told is our problem, what it prints is read
right, failures stay failures.
"""

import sys
import time
from pathlib import Path

import numpy as np
import pytest

import solidgear as sg
from validation.race import calculix, ross_peer, sfepy_peer
from validation.race.answers import compliance_gap, frequency_gap, paired
from validation.race.heat import Check, Heat, Sample
from validation.race.installed import present
from validation.race.ours import held, solve
from validation.race.problem import problem_of
from validation.race.process import PeerError, called, run

ROOT = Path(__file__).parent.parent

SCENE = ROOT / "geometry" / "pinion_overhung.toml"
TET = {"element": "tet10", "size": 0.07, "graded_size": 0.06}
HEX = {
    "element": "hex20",
    "size": 0.08,
    "around": 8,
    "layers": 0,
    "edge_layers": 0,
    "radial_layers": 0,
}
# Pairs of corners whose middles the nodes after the corners are, from the user's manual.
EDGES = {
    "C3D10": ((1, 2), (2, 3), (3, 1), (1, 4), (2, 4), (3, 4)),
    "C3D20": (
        *((1, 2), (2, 3), (3, 4), (4, 1)),
        *((5, 6), (6, 7), (7, 8), (8, 5)),
        *((1, 5), (2, 6), (3, 7), (4, 8)),
    ),
}


@pytest.fixture(
    scope="module",
    params=[
        pytest.param(("rigid", TET, "C3D10"), marks=pytest.mark.long),
        ("average", HEX, "C3D20"),
    ],
    ids=["rigid tet", "average hex"],
)
def case(request):
    attachment, options, kind = request.param
    scene = held(SCENE, attachment)
    done = solve(scene, "solid", options)
    problem = problem_of(done.body, scene)
    return scene, done, problem, kind, Deck(calculix.deck(problem, kind, modes=10, loads=True))


class Deck:
    """A deck read back, by its own small reader."""

    def __init__(self, text):
        self.node, self.element, self.equation, self.spring, self.step = {}, {}, [], {}, []
        self.numbers = []
        owner, card, held, stiff = {}, "", [], {}
        for line in text.splitlines():
            if line.startswith("*"):
                card = line
                held = []
                if line == "*STEP":
                    self.step.append([])
                continue
            fields = line.rstrip(",").split(",")
            self.numbers += fields
            if card.startswith("*NODE,") or card == "*NODE":
                if len(fields) == 4:
                    self.node[int(fields[0])] = np.array(fields[1:], float)
            elif card.startswith("*ELEMENT, TYPE=C3D"):
                held += [int(x) for x in fields]
                if not line.endswith(","):
                    self.element[held[0]] = held[1:]
                    held = []
            elif card.startswith("*ELEMENT, TYPE=SPRING1"):
                owner[card.split("ELSET=")[1]] = int(fields[1])
            elif card.startswith("*SPRING"):
                stiff.setdefault(card.split("ELSET=")[1], []).append(float(fields[0]))
            elif card == "*EQUATION":
                if len(fields) == 1:
                    self.equation.append((int(line), []))
                else:
                    self.equation[-1][1].extend(
                        (int(a), int(b) - 1, float(c))
                        for a, b, c in zip(fields[::3], fields[1::3], fields[2::3])
                    )
            elif card.startswith("*CLOAD"):
                self.step[-1].append((int(fields[0]), int(fields[1]) - 1, float(fields[2])))
        # The line after *SPRING names the degree of freedom, the next one the stiffness.
        self.spring = {owner[name]: values for name, values in stiff.items()}


def test_middle_nodes_lie_between_their_corners(case):
    # The classic fault of written decks: two edge nodes swapped. An element is then wrong by its
    # own length, not by its curvature.
    *_, kind, deck = case
    assert deck.element
    for nodes in deck.element.values():
        at = np.array([deck.node[i] for i in nodes])
        corners = 4 if kind == "C3D10" else 8
        for k, (a, b) in enumerate(EDGES[kind]):
            chord = np.linalg.norm(at[a - 1] - at[b - 1])
            assert np.linalg.norm(at[corners + k] - (at[a - 1] + at[b - 1]) / 2) < 0.25 * chord


def test_elements_are_right_handed(case):
    *_, kind, deck = case
    third = 3 if kind == "C3D10" else 4
    for nodes in deck.element.values():
        a, b, c, d = (deck.node[nodes[k]] for k in ((0, 1, 2, 3) if third == 3 else (0, 1, 3, 4)))
        assert np.linalg.det([b - a, c - a, d - a]) > 0


def test_no_field_is_longer_than_calculix_reads(case):
    assert max(len(x.strip()) for x in case[-1].numbers) <= 20


def test_springs_store_the_energy_of_the_bearings_in_a_rigid_motion(case):
    # A rigid motion must satisfy every equation of a seat, and what the springs then hold must be
    # d' K d of the bearing's 6x6.
    scene, _, problem, _, deck = case
    d, th = np.array([1e-6, -2e-6, 3e-6]), np.array([2e-5, 1e-5, -3e-5])
    u = {i: d + np.cross(th, at) for i, at in deck.node.items()}
    extra = sorted(i for i in deck.node if i > len(problem.nodes))
    # Of two nodes of a rigid seat at one place the second turns.
    turning = {
        i
        for k, i in enumerate(extra)
        if i not in deck.spring
        and extra[k - 1] not in deck.spring
        and k
        and np.allclose(deck.node[i], deck.node[extra[k - 1]])
    }
    for i in turning:
        u[i] = th
    for count, terms in deck.equation:
        assert count == len(terms)
        node, component, factor = terms[0]
        value = -sum(a * u[i][c] for i, c, a in terms[1:]) / factor
        if node in deck.spring:
            u[node] = np.array([value, 0.0, 0.0])
        else:
            assert value == pytest.approx(u[node][component], abs=1e-15)
    stored = sum(values[1] * u[i][0] ** 2 for i, values in deck.spring.items())
    expected = 0.0
    for bearing in scene.bearings:
        motion = np.concatenate([d + np.cross(th, [0.0, bearing.y, 0.0]), th])
        expected += motion @ bearing.stiffness @ motion
    assert stored == pytest.approx(expected, rel=1e-9)  # printed digits


def test_nodal_forces_are_unit_wrenches_about_the_lumped_point(case):
    scene, *_, deck = case
    steps = [step for step in deck.step if step]
    assert len(steps) == 6
    about = np.array([0.0, scene.port.y, 0.0])
    for k, step in enumerate(steps):
        wrench = np.zeros(6)
        for i, c, value in step:
            force = np.zeros(3)
            force[c] = value
            wrench += np.concatenate([force, np.cross(deck.node[i] - about, force)])
        # Forces of a unit moment are some 1/radius large and cancel in the sum.
        np.testing.assert_allclose(wrench, np.eye(6)[k], atol=1e-8)


@pytest.mark.skipif(not present("CalculiX"), reason="CalculiX is not installed")
def test_calculix_gives_our_frequencies_and_compliance(case):
    _, done, problem, kind, _ = case
    answer = calculix.solve(problem, kind, modes=6, loads=True, limit=120, threads=1)
    # Quadrature on elements as large as the shaft: 4 points (C3D10) or 27 (C3D20) against exact.
    assert frequency_gap(answer.frequency_hz, done.modes) < 5e-3
    assert compliance_gap(answer.compliance, done.compliance) < 5e-3


def test_dat_file_is_read():
    text = """
     E I G E N V A L U E   O U T P U T

 MODE NO    EIGENVALUE                       FREQUENCY
                                     REAL PART            IMAGINARY PART
                           (RAD/TIME)      (CYCLES/TIME     (RAD/TIME)

      1   0.7590855E+08   0.8712551E+04   0.1386646E+04   0.0000000E+00
      2  -0.9403403E-02   0.0000000E+00   0.1543344E+04   0.9697115E-01

     P A R T I C I P A T I O N   F A C T O R S

      1   0.1000000E+01   0.2000000E+01   0.3000000E+01   0.4000000E+01

 displacements (vx,vy,vz) for set LOADED and time  0.1000000E+01

         2  1.000000E-10 -2.000000E-10  3.000000E-10

 displacements (vx,vy,vz) for set LOADED and time  0.2000000E+01

         1  4.000000E-10  5.000000E-10  6.000000E-10
"""
    np.testing.assert_allclose(calculix.frequencies(text, 2), [1386.646, 1543.344])
    with pytest.raises(PeerError, match="2 frequencies of 3"):
        calculix.frequencies(text, 3)
    first, second = calculix.displacements(text, 2)
    np.testing.assert_allclose(first, [[0, 0, 0], [1e-10, -2e-10, 3e-10]])
    np.testing.assert_allclose(second, [[4e-10, 5e-10, 6e-10], [0, 0, 0]])


def test_a_deck_of_the_wrong_element_is_refused(case):
    _, _, problem, kind, _ = case
    with pytest.raises(ValueError, match="does not fit"):
        calculix.deck(problem, "C3D20" if kind == "C3D10" else "C3D10")


def test_a_peer_that_takes_too_long_is_ended_with_its_children(tmp_path):
    code = "import subprocess, sys; p = subprocess.Popen(['sleep', '60']); open('pid', 'w').write(str(p.pid)); p.wait()"
    with pytest.raises(PeerError, match="was ended after"):
        run([sys.executable, "-c", code], tmp_path, limit=3)
    child = Path("/proc") / (tmp_path / "pid").read_text()

    def state():
        try:
            return (child / "stat").read_text().split()[2]
        except OSError:
            return "gone"

    # a signal that was sent is heard when the system comes to it
    for _ in range(1000):
        if state() in ("gone", "Z"):
            break
        time.sleep(0.01)
    assert state() in ("gone", "Z")


def test_a_peer_that_fails_says_its_last_words(tmp_path):
    with pytest.raises(PeerError, match="returned 3.*no licence"):
        run(
            [sys.executable, "-c", "import sys; print('no licence'); sys.exit(3)"],
            tmp_path,
            limit=60,
        )


def test_pairs_are_compared_as_pairs():
    np.testing.assert_allclose(paired([1.0, 2.0, 4.0, 7.0], [1, 2]), [1.0, np.sqrt(10.0)])
    # a pair cut in half by the number asked for is left out
    np.testing.assert_allclose(paired([1.0, 2.0], [1, 2]), [1.0])


def sample(seconds, answer=0.0):
    return lambda: Sample({"mesh": 9.0, "modes": seconds}, seconds, answer)


def test_times_are_not_compared_unless_answers_agree():
    heat, kept = Heat(), []
    fast = heat.add("ours", sample(1.0), counted=["modes"])
    wrong = heat.add("theirs", sample(2.0, 2e-3), checks=[Check("C_zz", abs, 1e-3, "a reason")])
    right = heat.add("others", sample(5.0, 5e-4), checks=[Check("C_zz", abs, 1e-3, "a reason")])
    heat.ratio("wrong", wrong, fast, 4.0)
    heat.ratio("right", [wrong, right], fast, 4.0, ["modes"])
    heat.ratio("slow", right, fast, 40.0)
    heat.run(2, lambda: kept.append(heat.record()))
    no, yes, slow = (ratio.row() for ratio in heat.ratios)
    assert no["measured"] is None and "differ" in no["met"]
    # of the fast lane modes count, of the others all of 14 s
    assert yes["measured"] == slow["measured"] == 14.0
    assert (yes["met"], slow["met"]) == ("yes", "NO")
    assert [row["agree"] for row in heat.answers] == ["NO", "yes"]
    # rows are kept as they come
    assert len(kept) == 5 and len(kept[0]["lanes"]) == 1
    # rounds the other did not run in do not count
    fast.samples += [sample(100.0)()] * 3
    assert heat.ratios[1].row()["measured"] == 14.0


def test_a_lane_that_has_run_long_enough_runs_no_more():
    heat = Heat()
    long = heat.add("long", sample(3.0), enough=5.0)
    quick = heat.add("quick", sample(1.0), enough=5.0, repeats=2)
    heat.run(3)
    assert (len(long.samples), len(quick.samples), len(quick.times())) == (2, 6, 3)


def test_a_race_that_resumes_runs_what_is_missing(tmp_path, monkeypatch):
    from validation import common
    from validation.race.race import Race

    monkeypatch.setattr(common, "RESULTS", tmp_path)
    ran = []

    def entered(heat, names="abc"):
        lanes = [heat.add(name, lambda name=name: ran.append(name)) for name in names]
        heat.ratio("a / b", lanes[0], lanes[1])
        heat.ratio("a / c", lanes[0], lanes[2])

    race = Race("a question", {"heat": entered}, resumes=True)
    first = race.run("race", ["heat"], 1, Heat(), only="b")["heat"]
    # of what was not to be run nothing is said
    assert [row["ratio"] for row in first["ratios"]] == ["a / b"]
    found = race.run("race", ["heat"], 1, Heat())["heat"]
    assert ran == ["b", "a", "c"]
    assert [row["lane"] for row in found["lanes"]] == ["a", "b", "c"]
    assert common.read_result("race")["heat"]["lanes"] == found["lanes"]
    assert found["date"] and found["machine"]["cores"]


def test_a_function_answers_from_a_process_of_its_own():
    mesh = {"scene": str(SCENE), "attachment": "average", "fidelity": "euler", "options": {}}
    answer = called("validation.race.ours:answered", **mesh).answer
    here = solve(held(SCENE, "average"), "euler", {})
    np.testing.assert_allclose(answer["frequency_hz"], here.modes.frequency_hz, rtol=1e-9)


def test_rotor_for_ross_has_our_sections_and_bearings():
    scene = ross_peer.on_nodes(held(SCENE, "average"))
    body = sg.build(scene, "timoshenko")
    data = ross_peer.rotor(scene, body)
    volume = sum(
        length * np.pi / 12 * (a * a + a * b + b * b) for length, _, a, _, b, *_ in data["elements"]
    )
    assert volume * 7850 == pytest.approx(body.mass_matrix()[0, 0], rel=1e-9)
    assert [k[1:] for k in data["bearings"]] == [
        [b.stiffness[c, c] for c in range(3)] for b in scene.bearings
    ]
    assert all(
        abs(body.geometry.nodes[k[0]] - b.y) < 1e-12
        for k, b in zip(data["bearings"], scene.bearings)
    )


def test_bearings_hold_one_node_of_the_beam_as_in_ross():
    """A seat that is averaged over its width moves the third bending mode by 3.8 %."""
    scene = ross_peer.on_nodes(held(SCENE, "average"))
    body = sg.build(scene, "timoshenko")
    for block in body.blocks:
        rows = np.abs(block.ports.toarray()) > 1e-12
        for bearing in scene.bearings:
            first = len(block.components) * body.port_index(bearing.name)
            assert np.all(rows[first : first + len(block.components)].sum(axis=1) == 1)


@pytest.mark.long
def test_straight_tetrahedra_are_stiffer_by_the_volume_they_miss():
    scene = held(SCENE, "average")
    body = solve(scene, "solid", TET, free=True).body
    straight = sfepy_peer.straightened(body, scene)
    # chords of a circle: lighter, and rigid motions stay free of strain
    assert 0.7 < straight.mass_matrix()[0, 0] / body.mass_matrix()[0, 0] < 1.0
    block = straight.blocks[0]
    scale = abs(block.stiffness).max() * abs(block.rigid).max()
    assert abs(block.stiffness @ block.rigid).max() < 1e-9 * scale


@pytest.mark.slow
@pytest.mark.skipif(not present("ROSS"), reason="ROSS is not installed")
def test_ross_agrees():
    scene = ross_peer.on_nodes(held(SCENE, "average"))
    body = sg.build(scene, "timoshenko", kappa="cowper")
    answer = ross_peer.solve(ross_peer.rotor(scene, body))
    assert frequency_gap(np.array(answer["frequency_hz"]), sg.modes(body, scene, n=10)) < 1e-3


@pytest.mark.slow
@pytest.mark.skipif(not present("sfepy"), reason="sfepy is not installed")
def test_sfepy_agrees():
    scene = held(SCENE, "average")
    body = solve(scene, "solid", TET, free=True).body
    answer = sfepy_peer.solve(body, scene, 6)
    expected = sg.modes(sfepy_peer.straightened(body, scene), (), n=6)
    assert frequency_gap(np.array(answer["frequency_hz"]), expected) < 1e-6
