"""Factors and modes by PETSc and SLEPc in processes of their own, under ``mpirun``.

The matrix goes over as files, so that PETSc may belong to another interpreter than this program
(Debian's packages belong to ``/usr/bin/python3``), and to other machines that see the same folder.
Everything that makes a result trustworthy stays here: statics are corrected on the stiffness
itself, and modes refined and judged, with solutions that the ranks give.
"""

from __future__ import annotations

import json
import os
import shlex
import shutil
import subprocess
import tempfile
import time
import weakref
from functools import lru_cache
from pathlib import Path

import numpy as np
import scipy.sparse as sp

from solidgear.core import Block
from solidgear.core.body.mass import ScalarMass
from solidgear.core.factoring import Factoring
from solidgear.core.solve.backends.matrix import FactorError
from solidgear.core.solve.backends.memory_law import MB, law
from solidgear.core.solve.choice import FORCED
from solidgear.core.solve.factor import Planned
from solidgear.core.solve.factored import Factor
from solidgear.core.solve.schur import bordered, definite_corner

WORKER = Path(__file__).parent / "worker.py"
INSTALL = "apt-get install python3-petsc4py-real python3-slepc4py-real openmpi-bin"
PROBE = "import worker; worker.libraries()"


def python() -> str:
    """Return the interpreter that PETSc belongs to."""
    return os.environ.get("SOLIDGEAR_PETSC_PYTHON") or "/usr/bin/python3"


def launcher() -> list[str]:
    """Return the command that starts ranks: ``SOLIDGEAR_MPIRUN``, such as ``mpirun --hostfile
    hosts``.
    """
    return shlex.split(os.environ.get("SOLIDGEAR_MPIRUN") or "mpirun")


def on_other_machines() -> bool:
    """Return whether ranks may run on other machines, so that their memory is not that of this one."""
    return bool(os.environ.get("SOLIDGEAR_MPIRUN"))


@lru_cache(maxsize=1)
def missing() -> str:
    """Return the reason why PETSc cannot be used, empty if it can."""
    if shutil.which(launcher()[0]) is None:
        return f"{launcher()[0]} is not there"
    if shutil.which(python()) is None:
        return f"{python()} is not there"
    tried = subprocess.run(
        [python(), "-c", PROBE], cwd=WORKER.parent, env=_environment(), capture_output=True
    )
    return "" if tried.returncode == 0 else f"{python()} has no petsc4py and slepc4py"


def _environment() -> dict[str, str]:
    """Return the environment of the ranks: one thread each, and none of this interpreter's paths."""
    out = {k: v for k, v in os.environ.items() if not k.startswith(("PYTHON", "VIRTUAL_ENV"))}
    out |= {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    out["OMPI_MCA_rmaps_base_oversubscribe"] = "1"
    # ranks that wait leave the processor to those that work
    out["OMPI_MCA_mpi_yield_when_idle"] = "1"
    if hasattr(os, "geteuid") and os.geteuid() == 0:
        # whoever runs this program as root has decided that already
        out |= {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
    return out


class Ranks:
    """A matrix (n, n) factored on some ranks, which wait for right-hand sides; FactorError if PETSc
    is not there or ends.

    The mass is for modes, the rigid motions (n, r) are for multigrid; `nodal` says that unknowns
    come in threes, node by node.
    """

    def __init__(self, matrix, mass, rigid: np.ndarray, factoring: Factoring, nodal: bool):
        reason = missing()
        if reason:
            raise FactorError(f"engine = {factoring.engine} was asked for but {reason}: {INSTALL}")
        self.n, self._number = matrix.shape[0], 0
        self.steps = 0  #: most iterations of a solution; 0 for a direct factor
        self.peak_mb = 0.0  #: most memory of all ranks together so far, MB
        self.direct = factoring.engine == "petsc"
        self.folder = Path(tempfile.mkdtemp(prefix="solidgear-petsc-"))
        weakref.finalize(self, shutil.rmtree, self.folder, ignore_errors=True)
        self._save("a", matrix)
        self._mass = mass
        np.save(self.folder / "rigid.npy", rigid)
        block = 3 if nodal and self.n % 3 == 0 else 1
        task = {"n": self.n, "block": block, "method": "mumps" if self.direct else "gamg"}
        (self.folder / "task.json").write_text(json.dumps(task), encoding="utf-8")
        self._log = open(self.folder / "log", "w+", encoding="utf-8", errors="replace")
        command = [*launcher(), "-n", str(factoring.ranks), python(), str(WORKER), str(self.folder)]
        self._process = subprocess.Popen(
            command, env=_environment(), stdout=self._log, stderr=subprocess.STDOUT
        )
        weakref.finalize(self, _end, self._process, self._log)
        self._wait()

    def _save(self, name: str, matrix) -> None:
        matrix = sp.csr_matrix(matrix)
        for part in ("indptr", "indices", "data"):
            np.save(self.folder / f"{name}_{part}.npy", getattr(matrix, part))

    def _wait(self) -> dict:
        done_file = self.folder / f"{self._number}.done"
        while not done_file.exists():
            if self._process.poll() is not None and not done_file.exists():
                self._log.seek(0)
                lines = [x.strip() for x in self._log.read().splitlines() if "Error" in x]
                raise FactorError(
                    f"PETSc ended without an answer: {(lines or ['killed'])[-1][:200]}"
                )
            time.sleep(0.002)
        answer = json.loads(done_file.read_text(encoding="utf-8"))
        self.peak_mb = max(self.peak_mb, answer["peak_mb"])
        self.steps = max(self.steps, answer.get("steps", 0))
        return answer

    def _ask(self, task: str, columns: int, arrays: dict[str, np.ndarray], **more) -> tuple:
        self._number += 1
        for name, array in arrays.items():
            np.save(self.folder / f"{self._number}_{name}.npy", array)
        out = self.folder / f"{self._number}_out.npy"
        np.lib.format.open_memmap(out, "w+", float, (self.n, columns)).flush()
        order = self.folder / "order.tmp"
        order.write_text(json.dumps({"what": task, **more}), encoding="utf-8")
        order.rename(self.folder / f"{self._number}.json")
        answer = self._wait()
        result = np.load(out)
        for path in self.folder.glob(f"{self._number}_*.npy"):
            path.unlink()
        return result, answer

    def solve(self, rhs: np.ndarray) -> np.ndarray:
        """Solve for one (n,) or several (n, k) right-hand sides."""
        if rhs.ndim == 1:
            return self.solve(rhs[:, None])[:, 0]
        if not rhs.shape[1]:
            return np.zeros(rhs.shape)
        return self._ask("solve", rhs.shape[1], {"in": np.ascontiguousarray(rhs, float)})[0]

    def modes(
        self, wanted: int, load, through, inner, free, tolerance: float
    ) -> tuple[np.ndarray, np.ndarray]:
        """Find the lowest eigenpairs of the matrix with springs, by SLEPc's Krylov-Schur: (k,)
        values, ascending, of the shifted matrix, fewer than wanted if it did not converge, and (n,
        k) mass-orthonormal vectors.

        `load` and `through` (n, r) are the root of the springs and the solution for it, `inner` (r,
        r) is ``I + load' through``, `free` (n, k) are rigid motions that nothing resists, to be
        excluded.
        """
        if self._mass is not None:
            self._save("m", self._mass.tocsr())
            self._mass = None
        arrays = {"load": load, "through": through, "inner": inner, "free": free}
        u, answer = self._ask("modes", wanted, arrays, wanted=wanted, tolerance=tolerance)
        value = np.array(answer["values"])
        order = np.argsort(value)
        return value[order], u[:, : len(value)][:, order]


#: MB of a rank by itself: libraries, rows and numbering; bytes of multigrid by the entry. Seen in three
#: runs of 14,000 and 57,000 unknowns, and in one
OF_A_RANK, MULTIGRID = 90.0, 440.0


def needed_mb(unknowns: float, entries: float, factoring: Factoring) -> float:
    """Estimate the memory of all ranks, as far as it is of this machine, and of the files' copies
    here, MB.
    """
    copies = 24.0 * entries / MB
    if on_other_machines():
        return copies
    direct = factoring.engine == "petsc"
    factor = law("mumps", unknowns, entries) if direct else MULTIGRID * entries / MB
    return copies + factor + OF_A_RANK * factoring.ranks


def plan_on_ranks(block: Block, matrix: sp.csr_matrix, factoring: Factoring) -> Planned:
    """Plan the factor of the shifted stiffness of a block by PETSc, which has no separate analysis."""
    name = "mumps" if factoring.engine == "petsc" else "gamg-cg"
    nodal = isinstance(block.mass, ScalarMass)

    def factor(inner: sp.csr_matrix) -> Factor:
        is_whole = inner.shape[0] == block.size
        ranks = Ranks(
            inner, block.mass if is_whole else None, block.rigid[: inner.shape[0]], factoring, nodal
        )
        direct_ranks = ranks if is_whole and ranks.direct else None
        return Factor(name, FORCED, ranks.solve, factoring=factoring, ranks=direct_ranks)

    def make() -> Factor:
        if not block.border:
            return factor(matrix)
        return bordered(matrix, block.border, factor, definite_corner)

    n = matrix.shape[0]
    return Planned(n, name, needed_mb(n, matrix.nnz, factoring), make)


def _end(process: subprocess.Popen, log) -> None:
    process.terminate()
    try:
        process.wait(10)
    except subprocess.TimeoutExpired:
        process.kill()
    log.close()
