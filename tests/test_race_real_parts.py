"""Speed against accuracy on real parts: what an error costs along a line, how rows are read, and a
slice of the measurements. No time is asserted.
"""

import math
from dataclasses import replace

import numpy as np
import pytest

from validation.common import read_result
from validation.race import real_costs as ratios
from validation.race import real_lines as lines
from validation.race import real_parts as measure
from validation.race.heat import Heat
from validation.race.installed import missing, present
from validation.race.real_lines import CALCULIX, GRADED, PLAIN, REFERENCE, UNIFORM, Job

# unknowns of made-up meshes, coarse to fine
SIZES = np.array([1e3, 4e3, 2e4])


def made_up(order, *, floor=0.0, seconds=1e-4, growth=1.3):
    """Errors and costs that are powers of the unknowns."""
    error = floor + 0.02 * (SIZES / SIZES[0]) ** -order
    return error, np.column_stack([seconds * SIZES**growth, SIZES, 10 * SIZES**0.5])


def rows_of(part, line, error, costs, truth=(2e-10, 3000.0)):
    return [
        {
            "part": part,
            "line": line,
            "lane": f"{line}: {i}",
            "cpu s": c[0],
            "cpu_of_modes_s": 0.4 * c[0],
            "unknowns": c[1],
            "peak_MB": c[2],
            # compliance from below, frequency from above and nearer
            "C_zz": truth[0] * (1 - e),
            "bending_1": truth[1] * (1 + e / 2),
        }
        for i, (e, c) in enumerate(zip(error, costs))
    ]


def reference_rows(part):
    exact = [4e-6, 2e-6, 1e-6]
    return rows_of(part, REFERENCE, exact, np.ones((3, 3)))


@pytest.mark.parametrize("target", [5e-3, 1e-4])
def test_cost_of_an_error_is_exact_where_all_are_powers(target):
    # 5e-3 lies between two meshes, 1e-4 beyond the last: both on the same straight line.
    error, costs = made_up(0.7)
    found = ratios.cost(error, costs, target)
    unknowns = SIZES[0] * (target / 0.02) ** (-1 / 0.7)
    assert found.how == ("between" if target > error[-1] else "beyond")
    assert found.unknowns == pytest.approx(unknowns, rel=1e-9)
    assert found.cpu_s == pytest.approx(1e-4 * unknowns**1.3, rel=1e-9)
    assert found.peak_MB == pytest.approx(10 * unknowns**0.5, rel=1e-9)


def test_a_line_that_meets_the_error_at_once_costs_at_most_its_first_mesh():
    error, costs = made_up(0.7)
    found = ratios.cost(error, costs, 0.5)
    assert (found.how, found.unknowns) == ("at most", pytest.approx(1e3))


def test_error_of_the_model_itself_is_never_met():
    error, costs = made_up(0.7, floor=0.5)
    assert ratios.cost(error, costs, 1e-3) is ratios.NEVER


def test_an_error_that_is_small_by_its_sign_alone_does_not_count():
    _, costs = made_up(0.7)
    # as if the second mesh erred by as much as the third
    for target, how in ((5e-3, "between"), (1e-3, "beyond")):
        found = ratios.cost([1e-2, 1e-5, 4e-3], costs, target)
        assert found == ratios.cost([1e-2, 4e-3, 4e-3], costs, target)
        assert found.how == how


def test_limit_of_a_sequence():
    values = [7.0 * (1 + 0.01 * 0.6**k) for k in range(3)]
    found = ratios.limit(values)
    assert found.value == pytest.approx(7.0, rel=1e-12)
    assert found.doubt == pytest.approx(0.01 * 0.6**2, rel=1e-9)
    # changes that grow, or turn back, are no convergence
    for values in ([1.0, 1.01, 1.03], [1.0, 1.01, 1.0]):
        found = ratios.limit(values)
        assert found.value == values[-1]
        assert found.doubt == pytest.approx(np.ptp(values) / values[-1])


def test_ratios_of_a_part():
    # Raw 3D and CalculiX on meshes of one order, CalculiX five times as dear; the line judged is
    # of twice the order. The larger error, that of C_zz, decides.
    raw, cost = made_up(0.5, seconds=1e-3)
    quick, cheap = made_up(1.0, seconds=1e-3)
    rows = reference_rows("step") + rows_of("step", GRADED, raw, cost)
    rows += rows_of("step", "quick", quick, cheap)
    rows += rows_of("step", CALCULIX, raw[:2], cost[:2] * [5, 1, 2])
    rows += rows_of("step", PLAIN, [0.02, 0.02, 0.02], cheap)
    found = {row["line"]: row for row in ratios.table(rows, "step", 1e-3)}
    assert REFERENCE not in found
    # 20 times smaller an error takes 400 times the unknowns, or 20
    expected = (400 / 20) ** 1.3
    # the reference is right to 1e-6, an error of 1e-3 so to a thousandth
    assert found["quick"]["raw / this"] == pytest.approx(expected, rel=1e-2)
    assert found["quick"]["CalculiX / this"] == pytest.approx(5 * expected, rel=1e-2)
    assert found["quick"]["its modes / this"] == pytest.approx(2 * expected, rel=1e-2)
    assert found[GRADED]["raw / this"] == pytest.approx(1.0)
    assert math.isnan(found[PLAIN]["raw / this"])
    half = {row["line"]: row for row in ratios.table(rows, "step", 1e-3, "bending_1")}
    assert half["quick"]["raw / this"] == pytest.approx((100 / 10) ** 1.3, rel=1e-2)


def test_a_reference_is_made_of_three_rows():
    with pytest.raises(ValueError, match="step: 2 rows of the reference, three are needed"):
        ratios.references(reference_rows("step")[1:], "step")


@pytest.mark.slow
def test_a_slice_of_the_step_part():
    # Two coarse meshes of the part from its file: compliance rises and frequency falls as a mesh of
    # displacements is refined, and the plain part is stiffer, for it has no keyway.
    coarse, fine = (
        measure.run(Job("step", UNIFORM, {"size": s, "graded_size": s})) for s in (0.016, 0.009)
    )
    plain = measure.run(Job("step", PLAIN, {"order": 3, "layers": 1, "relative_size": 4.0}))
    assert fine.unknowns > 1.2 * coarse.unknowns
    assert coarse.C_zz < fine.C_zz and coarse.bending_1 > fine.bending_1
    assert plain.C_zz < 0.98 * fine.C_zz and plain.bending_1 > fine.bending_1
    rows = [
        {"part": "step", "line": UNIFORM, "lane": str(i), "peak_MB": 1.0, "cpu s": 1.0}
        | {"unknowns": f.unknowns, "C_zz": f.C_zz, "bending_1": f.bending_1}
        for i, f in enumerate((coarse, fine))
    ]
    rows += rows_of("step", REFERENCE, np.zeros(3), np.ones((3, 3)), (3.3825e-9, 2599.0))
    error = ratios.errors(rows, "step", UNIFORM)
    assert error[1] < error[0] < 0.1
    # The same shaft by segments and a keyway, on a mesh of like size: what the keyway changes is
    # ten times as much.
    twin = lines.as_features(lines.scene_of("step"))
    size = {"size": 0.016, "graded_size": 0.016}
    other = measure.solved(twin, "solid", element="tet10", half=False, **size)
    assert other.C_zz == pytest.approx(coarse.C_zz, rel=3e-3)
    assert other.bending_1 == pytest.approx(coarse.bending_1, rel=3e-3)


@pytest.mark.slow
@pytest.mark.skipif(not present("CalculiX"), reason=missing("CalculiX"))
def test_calculix_answers_as_our_solid_on_its_mesh(monkeypatch):
    monkeypatch.setattr(lines, "jobs", lambda part: [Job(part, CALCULIX, {"refinement": 0.15})])
    heat = Heat()
    measure.part(heat, "step")
    (lane,) = heat.lanes
    heat.run(1)
    # CalculiX takes fewer points of quadrature, more so on coarse curved elements
    assert not lane.error and 0 < lane.answer["from_ours"] < measure.SAME


def test_rows_that_are_shipped_have_all_lines_and_references_that_decide():
    rows = ratios.rows_of(read_result("real_parts"))
    places = [(row["part"], row["lane"]) for row in rows]
    jobs = {(j.part, j.name) for part in lines.PARTS for j in lines.jobs(part)}
    assert len(set(places)) == len(places) and set(places) == jobs
    for part in lines.PARTS:
        # the reference is better than the error that ratios are taken at
        assert max(q.doubt for q in ratios.references(rows, part).values()) < 5e-4


def test_jobs_are_told_apart_by_their_names():
    jobs = [job for part in lines.PARTS for job in lines.jobs(part)]
    assert len({(j.part, j.name) for j in jobs}) == len(jobs)
    with pytest.raises(ValueError, match="no line"):
        measure.run(replace(jobs[0], line="beam"))
