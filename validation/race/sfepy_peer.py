"""sfepy as a peer for modes of a free shaft on quadratic tetrahedra.

sfepy maps its tetrahedra linearly, so both sides take the mesh with straight sides; ours is then
assembled by scikit-fem's own forms, for the check of the frequencies only.
"""

from __future__ import annotations

import tempfile
from dataclasses import replace
from pathlib import Path

from validation.race.heat import Clock
from validation.race.process import peer


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
    from skfem import Basis, BilinearForm, ElementTetP2, ElementVector, MeshTet1
    from skfem.helpers import ddot, dot, sym_grad, trace

    from solidgear.core.body import Block
    from solidgear.core.body.cache import Cache

    curved = body.geometry.mesh
    straight = MeshTet1(curved.p[:, : curved.t.max() + 1], curved.t)
    basis = Basis(straight, ElementVector(ElementTetP2()), intorder=4)
    material = scene.segments[0].material
    mu = material.E / (2 * (1 + material.nu))
    lame = 2 * mu * material.nu / (1 - 2 * material.nu)

    @BilinearForm
    def stiffness(u, v, w):
        shear = ddot(sym_grad(u), sym_grad(v))
        return lame * trace(sym_grad(u)) * trace(sym_grad(v)) + 2 * mu * shear

    @BilinearForm
    def mass(u, v, w):
        return material.density * dot(u, v)

    at = basis.doflocs
    # numbered as nodes are, three components each
    turn = np.cross(np.eye(3)[:, None], at[:, ::3].T[None])
    shift = np.broadcast_to(np.eye(3)[:, None], turn.shape)
    rigid = np.vstack([shift, turn]).reshape(6, -1).T
    block = Block(
        "full",
        tuple(range(6)),
        stiffness.assemble(basis).tocsr(),
        mass.assemble(basis).tocsr(),
        rigid,
        at[1],
        sp.csr_matrix((0, at.shape[1])),
        None,
        False,
    )
    return replace(body, blocks=(block,), ports=(), geometry=None, cache=Cache())


def solve(body, scene, modes: int, *, limit: float = 600.0) -> dict:
    """Run sfepy in a process of its own: wall seconds of ``stages``, ``cpu`` seconds of the
    process, ``frequency_hz`` of the elastic modes, ``unknowns``, ``version``.

    Raises
    ------
    PeerError
    """
    import numpy as np

    mesh, material = body.geometry.mesh, scene.segments[0].material
    with tempfile.TemporaryDirectory(prefix="sfepy-") as name:
        path = Path(name) / "mesh.npz"
        np.savez(path, points=mesh.p[:, : mesh.t.max() + 1].T, cells=mesh.t.T)
        return peer(
            "sfepy",
            "validation.race.sfepy_peer:solved",
            limit=limit,
            extra={"OPENBLAS_NUM_THREADS": "1"},
            mesh=str(path),
            material=[material.E, material.nu, material.density],
            shift=float(-1e-3 * body.scale),
            modes=modes,
        )


def solved(mesh: str, material: list[float], shift: float, modes: int) -> dict:
    """What sfepy answers, as plain data."""
    import numpy as np
    import sfepy
    from sfepy.base.base import Struct
    from sfepy.solvers import Solver

    data, clock = np.load(mesh), Clock()
    matrices = clock.stage("assembly", lambda: _assembled(data["points"], data["cells"], *material))
    settings = Struct(
        name="eigs",
        kind="eig.scipy",
        method="eigsh",
        tol=1e-10,
        maxiter=1000,
        which="LM",
        sigma=shift,
    )
    solver = Solver.any_from_conf(settings)
    values, _ = clock.stage("modes", lambda: solver(*matrices, modes + 6, eigenvectors=True))
    frequency = np.sqrt(np.sort(values)[6:].clip(min=0.0)) / (2 * np.pi)
    answer = {"frequency_hz": frequency.tolist(), "unknowns": matrices[0].shape[0]}
    return answer | {"stages": clock.stages, "version": sfepy.__version__}


def _assembled(points, cells, young: float, poisson: float, density: float):
    """Stiffness and mass."""
    import numpy as np
    from sfepy.discrete import Equation, Equations, FieldVariable, Integral, Material, Problem
    from sfepy.discrete.fem import FEDomain, Field, Mesh
    from sfepy.mechanics.matcoefs import stiffness_from_youngpoisson
    from sfepy.terms import Term

    cells = np.ascontiguousarray(cells, np.int32)
    groups = [np.zeros(len(cells), np.int32)]
    mesh = Mesh.from_data("race", points, None, [cells], groups, ["3_4"])
    omega = FEDomain("domain", mesh).create_region("Omega", "all")
    field = Field.from_args("fu", np.float64, "vector", omega, approx_order=2)
    u = FieldVariable("u", "unknown", field)
    v = FieldVariable("v", "test", field, primary_var_name="u")
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
    return k, m
