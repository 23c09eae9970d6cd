"""The first answer for a part of another program: a coarse mesh with its bar, then finer ones."""

import re

import numpy as np
import pytest

import solidgear as sg
from solidgear.core.errors import SolidgearError
from solidgear.core.judge.question import FamilySolver
from solidgear.core.judge.refinement import INTERRUPTED, Interrupted, Refinement, refine
from solidgear.core.ladder.registry import LADDER
from solidgear.core.meshing.gmsh_session import Session, import_gmsh
from solidgear.core.meshing.quality import MeshError
from solidgear.core.quantity import Quantity
from solidgear.parts import step

HUB = "tests/found/parts/flanged_hub.toml"
ASKED = Quantity("C_thx")


@pytest.fixture(scope="module")
def hub():
    return sg.load(HUB)


def test_a_hub_is_answered_coarse_first_and_finer_answers_never_exclude_it(hub):
    """The first mesh, without layers, has its bar shown before the next is solved, and the
    fewest unknowns; both bars hold the truth, so that they overlap.
    """
    model, said = LADDER["solid"], []
    plan = model.meshes_of(hub, {})
    refinement = Refinement(hub, model, (ASKED,), 1e-6, plan=plan, most=2)
    refine(refinement, FamilySolver(refinement), said.append, model.title)
    first, second = refinement.steps
    assert first.unknowns < second.unknowns and "layers" not in first.setting
    begun, shown, *_ = said
    assert begun == f"3D solid: {first.setting}" and second.setting in said[2]
    number, per_cent = re.search(r"so far C_thx (\S+) rad/\(N m\) \+- (\S+) %", shown).groups()
    value, bar = float(number), float(per_cent) / 100
    assert bar == pytest.approx(first.bar, rel=0.05)
    (finer,) = refinement.values()
    assert finer.bar < bar
    assert abs(value - finer.value) < bar * value + finer.bar * finer.value


def test_what_a_coarser_mesh_gave_is_kept_at_ctrl_c():
    """A harmonic solid, which costs least."""
    meshes = []

    def interrupted(sentence):
        meshes.append(sentence)
        if "so far" not in sentence and len(meshes) > 1:
            raise KeyboardInterrupt

    # a KeyboardInterrupt to whatever asks for several answers, which ends
    with pytest.raises(Interrupted) as stop:
        sg.answer("geometry/shaft_stepped.toml", tol=1e-6, ask="C_zz", progress=interrupted)
    found = stop.value.result
    (value,) = found.values
    assert not found.reached and 1e-6 < value.bar < 0.1
    assert found.steps[-1].chosen and found.steps[-1].why == INTERRUPTED
    assert meshes[1].endswith(f"+- {100 * value.bar:.2g} %")


def test_a_mesh_that_cannot_be_made_is_followed_by_a_finer_one(hub):
    """Edges that are long beside a small fillet cross: no size of the part says so beforehand. Layers
    are made of a mesh that is there, so the same size is not tried with them.
    """
    model, tried = LADDER["solid"], []

    class Solver:
        def next_quantities(self):
            return (ASKED,)

        def solve(self, options):
            tried.append({name: options.get(name) for name in ("refinement", "layers")})
            if len(tried) == 3:
                raise SolidgearError("enough is seen")
            raise MeshError("edges share nodes")

    refinement = Refinement(hub, model, (ASKED,), 0.01, plan=model.meshes_of(hub, {}))
    with pytest.raises(SolidgearError, match="enough"):
        refine(refinement, Solver(), lambda _: None, "")
    assert tried == [{"refinement": r, "layers": None} for r in (0.45, 0.65, 0.95)]


def test_edges_are_concave_where_the_material_takes_three_quarters_of_a_turn():
    """Of an angle with a hole through its foot the inner edge alone; and half of a turn is smooth, as
    where a round joins a face.
    """
    gmsh = import_gmsh()
    with Session(gmsh):
        occ = gmsh.model.occ
        foot, wall = (3, occ.addBox(0, 0, 0, 4, 1, 4)), (3, occ.addBox(0, 0, 0, 1, 4, 4))
        angle, _ = occ.fuse([foot], [wall])
        angle, _ = occ.cut(angle, [(3, occ.addCylinder(2.5, -1, 2, 0, 3, 0, 0.5))])
        occ.synchronize()
        edges = [tag for _, tag in gmsh.model.getEntities(1)]
        (inner,) = (edge for edge in edges if step._concave(gmsh, edge))
        assert np.allclose(occ.getCenterOfMass(1, inner), [1, 1, 2])
        occ.fillet([angle[0][1]], [inner], [0.3])
        occ.synchronize()
        assert not any(step._concave(gmsh, tag) for _, tag in gmsh.model.getEntities(1))
