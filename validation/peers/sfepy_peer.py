"""sfepy as a peer for modes of a free shaft on quadratic tetrahedra.

sfepy maps its tetrahedra linearly, so both sides take the mesh with straight sides; ours is then
assembled by scikit-fem's own forms, for the check of the frequencies only.  Run in a process of its
own:  python sfepy_peer.py problem.npz shift modes
"""

from __future__ import annotations

import importlib.util
import json
import sys
import tempfile
import time
from dataclasses import replace
from pathlib import Path


def present() -> str:
    """Empty if sfepy can be run, else the reason why not."""
    return "" if importlib.util.find_spec("sfepy") else "no package sfepy (pip install sfepy)"


def straightened(body, scene):
    """The same quadratic tetrahedra with straight sides, free, assembled by scikit-fem.

    Parameters
    ----------
    body : Body
        TET10, of one material.
    scene : Scene
    """
    import numpy as np
    import scipy.sparse as sp
    from skfem import Basis, BilinearForm, ElementTetP2, MeshTet1

    from solidgear.body import Block
    from solidgear.body.cache import Cache

    curved = body.geometry.mesh
    basis = Basis(MeshTet1(curved.p[:, : curved.t.max() + 1], curved.t), ElementTetP2(), intorder=4)
    material = scene.segments[0].material
    mu, lame = (
        material.E / (2 * (1 + material.nu)),
        material.E * material.nu / ((1 + material.nu) * (1 - 2 * material.nu)),
    )
    gram = [
        [
            BilinearForm(lambda u, v, w, a=a, b=b: v.grad[a] * u.grad[b]).assemble(basis)
            for b in range(3)
        ]
        for a in range(3)
    ]
    trace = sum(gram[a][a] for a in range(3))
    k = sum(
        sp.kron(
            lame * gram[a][b] + mu * gram[b][a] + (mu * trace if a == b else 0 * trace), _unit(a, b)
        )
        for a in range(3)
        for b in range(3)
    )
    m = sp.kron(material.density * BilinearForm(lambda u, v, w: u * v).assemble(basis), sp.eye(3))
    x, y, z = basis.doflocs
    zero, one = 0 * x, 0 * x + 1
    fields = (
        (one, zero, zero),
        (zero, one, zero),
        (zero, zero, one),
        (zero, -z, y),
        (z, zero, -x),
        (-y, x, zero),
    )
    rigid = np.column_stack([np.column_stack(f).ravel() for f in fields])
    block = Block(
        "full",
        tuple(range(6)),
        k.tocsr(),
        m.tocsr(),
        rigid,
        np.repeat(y, 3),
        sp.csr_matrix((0, 3 * len(x))),
        None,
        False,
    )
    return replace(body, blocks=(block,), ports=(), geometry=None, cache=Cache())


def _unit(a, b):
    import scipy.sparse as sp

    return sp.csr_matrix(([1.0], ([a], [b])), shape=(3, 3))


def solve(body, scene, modes: int, *, limit: float = 600.0) -> dict:
    """Run sfepy: ``seconds`` per stage, ``whole`` of the process, ``frequency_hz`` of the elastic
    modes, ``unknowns``, ``version``.

    Raises
    ------
    PeerError
    """
    import numpy as np

    from validation.peers.process import PeerError, last_words, run

    mesh, material = body.geometry.mesh, scene.segments[0].material
    with tempfile.TemporaryDirectory(prefix="sfepy-") as name:
        folder = Path(name)
        count = mesh.t.max() + 1
        np.savez(
            folder / "problem.npz",
            points=mesh.p[:, :count].T,
            cells=mesh.t.T,
            material=[material.E, material.nu, material.density],
        )
        command = [
            sys.executable,
            str(Path(__file__).resolve()),
            "problem.npz",
            repr(float(-1e-3 * body.scale)),
            str(modes),
        ]
        whole, cpu, out = run(command, folder, limit=limit, extra={"OPENBLAS_NUM_THREADS": "1"})
        if not (folder / "answer.json").exists():
            raise PeerError("sfepy gave no answer: " + last_words(out))
        return json.loads((folder / "answer.json").read_text()) | {"whole": whole, "cpu": cpu}


def _child(path: str, shift: float, modes: int) -> None:
    import numpy as np
    import sfepy
    from sfepy.base.base import Struct
    from sfepy.discrete import Equation, Equations, FieldVariable, Integral, Material, Problem
    from sfepy.discrete.fem import FEDomain, Field, Mesh
    from sfepy.mechanics.matcoefs import stiffness_from_youngpoisson
    from sfepy.solvers import Solver
    from sfepy.terms import Term

    data = np.load(path)
    young, poisson, density = data["material"]
    clock = [time.perf_counter()]
    cells = np.ascontiguousarray(data["cells"], np.int32)
    mesh = Mesh.from_data(
        "race", data["points"], None, [cells], [np.zeros(len(cells), np.int32)], ["3_4"]
    )
    omega = FEDomain("domain", mesh).create_region("Omega", "all")
    field = Field.from_args("fu", np.float64, "vector", omega, approx_order=2)
    u, v = (
        FieldVariable("u", "unknown", field),
        FieldVariable("v", "test", field, primary_var_name="u"),
    )
    steel = Material("m", D=stiffness_from_youngpoisson(3, young, poisson), rho=density)
    integral = Integral("i", order=4)
    stiff = Equation(
        "stiffness", Term.new("dw_lin_elastic(m.D, v, u)", integral, omega, m=steel, v=v, u=u)
    )
    heavy = Equation("mass", Term.new("dw_dot(m.rho, v, u)", integral, omega, m=steel, v=v, u=u))
    problem = Problem("modal", equations=Equations([stiff, heavy]))
    problem.time_update()
    problem.update_materials()
    k = stiff.evaluate(mode="weak", dw_mode="matrix", asm_obj=problem.mtx_a)
    m = k.copy()
    m.data[:] = 0.0
    m = heavy.evaluate(mode="weak", dw_mode="matrix", asm_obj=m)
    clock.append(time.perf_counter())
    settings = Struct(
        name="eigs",
        kind="eig.scipy",
        method="eigsh",
        tol=1e-10,
        maxiter=1000,
        which="LM",
        sigma=shift,
    )
    value, _ = Solver.any_from_conf(settings)(k, m, modes + 6, eigenvectors=True)
    clock.append(time.perf_counter())
    frequency = np.sqrt(np.sort(value)[6:].clip(min=0.0)) / (2 * np.pi)
    answer = {
        "seconds": {"assembly": clock[1] - clock[0], "modes": clock[2] - clock[1]},
        "frequency_hz": frequency.tolist(),
        "unknowns": k.shape[0],
    }
    Path("answer.json").write_text(json.dumps(answer | {"version": sfepy.__version__}))


if __name__ == "__main__":
    _child(sys.argv[1], float(sys.argv[2]), int(sys.argv[3]))
