"""Program of every rank: a matrix from files, factored by MUMPS or set up for multigrid, then
solutions and modes on request.

    mpirun -n 2 /usr/bin/python3 worker.py FOLDER

Run by the interpreter that PETSc belongs to, which knows nothing of solidgear. Requests are files
(``1.json``, ``2.json``, ...) that all ranks see, so that nothing but PETSc is needed for ranks to
talk; numbers come and go as arrays in files of which each rank reads and writes its own rows.
"""

import glob
import json
import os
import resource
import sys
import time

import numpy as np

#: where Debian keeps the modules of its variants of PETSc
DEBIAN = (
    "/usr/lib/petscdir/*/*-real/lib/python3/dist-packages",
    "/usr/lib/slepcdir/*/*-real/lib/python3/dist-packages",
)
#: seconds between two looks for a request
PAUSE = 0.002
#: of conjugate gradients on multigrid, in the norm of the residual
CLOSE = 1e-11


def libraries():
    """Return ``PETSc`` and ``SLEPc``, initialised."""
    for pattern in DEBIAN:
        sys.path.extend(sorted(glob.glob(pattern)))
    import slepc4py

    slepc4py.init([sys.argv[0]])
    from petsc4py import PETSc
    from slepc4py import SLEPc

    return PETSc, SLEPc


class Rank:
    """The rows of one rank."""

    def __init__(self, folder):
        self.folder = folder
        self.petsc, self.slepc = libraries()
        self.comm = self.petsc.COMM_WORLD
        self.task = self.read("task.json")
        self.n = self.task["n"]
        self.a = self.matrix("a")
        self.lo, self.hi = self.a.getOwnershipRange()
        self.ksp = self.solver()

    def path(self, name):
        return os.path.join(self.folder, name)

    def read(self, name):
        """Return the data of a file."""
        with open(self.path(name), encoding="utf-8") as file:
            return json.load(file)

    def rows(self, name):
        """Return this rank's rows of an array in a file."""
        return np.load(self.path(name), mmap_mode="r")[self.lo : self.hi]

    def matrix(self, name):
        block = self.task["block"]
        nodes, rank, size = self.n // block, self.comm.getRank(), self.comm.getSize()
        lo, hi = (block * (nodes * k // size) for k in (rank, rank + 1))
        if rank + 1 == size:
            hi = self.n
        indptr = np.load(self.path(f"{name}_indptr.npy"), mmap_mode="r")[lo : hi + 1]
        entries = slice(int(indptr[0]), int(indptr[-1]))
        indices, data = (
            np.array(np.load(self.path(f"{name}_{part}.npy"), mmap_mode="r")[entries])
            for part in ("indices", "data")
        )
        local = (indptr - indptr[0]).astype(self.petsc.IntType)
        out = self.petsc.Mat().createAIJ(
            ((hi - lo, self.n), (hi - lo, self.n)),
            bsize=block,
            csr=(local, indices.astype(self.petsc.IntType), data),
            comm=self.comm,
        )
        out.setOption(self.petsc.Mat.Option.SYMMETRIC, True)
        out.setOption(self.petsc.Mat.Option.SPD, True)
        return out

    def solver(self):
        ksp = self.petsc.KSP().create(self.comm)
        ksp.setOperators(self.a)
        pc = ksp.getPC()
        if self.task["method"] == "mumps":
            ksp.setType("preonly")
            pc.setType("cholesky")
            pc.setFactorSolverType("mumps")
            pc.setFactorSetUpSolverType()
            # room for fronts that grow beyond what the analysis foresaw, per cent
            pc.getFactorMatrix().setMumpsIcntl(14, 40)
        else:
            ksp.setType("cg")
            ksp.setNormType(self.petsc.KSP.NormType.UNPRECONDITIONED)
            ksp.setTolerances(rtol=CLOSE, max_it=500)
            pc.setType("gamg")
            rigid = self.rows("rigid.npy")
            near = [self.vector(rigid[:, k]) for k in range(rigid.shape[1])]
            for k, v in enumerate(near):
                for w in near[:k]:
                    v.axpy(-v.dot(w), w)
                v.normalize()
            self.a.setNearNullSpace(self.petsc.NullSpace().create(vectors=near, comm=self.comm))
        ksp.setUp()
        return ksp

    def vector(self, values):
        out = self.a.createVecRight()
        out.setArray(np.array(values, float))
        return out

    def solve(self, number, ask):
        """Solve for some right-hand sides."""
        rhs = self.rows(f"{number}_in.npy")
        steps = 0
        if self.task["method"] == "mumps":
            shape = ((self.hi - self.lo, self.n), (self.petsc.DECIDE, rhs.shape[1]))
            b = self.petsc.Mat().createDense(shape, comm=self.comm)
            x = self.petsc.Mat().createDense(shape, comm=self.comm)
            for m in (b, x):
                m.setUp()
            b.getDenseArray()[:] = rhs
            for m in (b, x):
                m.assemble()
            self.ksp.getPC().getFactorMatrix().matSolve(b, x)
            out = np.array(x.getDenseArray())
            b.destroy(), x.destroy()
        else:
            out = np.empty(rhs.shape)
            for k in range(rhs.shape[1]):
                x = self.a.createVecRight()
                self.ksp.solve(self.vector(rhs[:, k]), x)
                if self.ksp.getConvergedReason() <= 0:
                    raise RuntimeError(
                        f"multigrid did not converge within {self.ksp.getIterationNumber()} steps"
                    )
                steps = max(steps, self.ksp.getIterationNumber())
                out[:, k] = x.getArray()
        self.write(f"{number}_out.npy", out)
        return {"steps": steps}

    def write(self, name, rows):
        """Write this rank's rows into an array in a file."""
        np.load(self.path(name), mmap_mode="r+")[self.lo : self.hi] = rows

    def modes(self, number, ask):
        """Find the lowest modes of the matrix with springs by Krylov-Schur on the inverse at hand."""
        mass = self.matrix("m")
        load = [self.vector(c) for c in self.rows(f"{number}_load.npy").T]
        through = [self.vector(c) for c in self.rows(f"{number}_through.npy").T]
        inner = np.load(self.path(f"{number}_inner.npy"))
        ksp = self.ksp

        class Inverse:
            """Woodbury: the factor knows nothing of springs."""

            def apply(self, pc, x, y):
                ksp.solve(x, y)
                if load:
                    pulled = np.linalg.solve(inner, [v.dot(y) for v in load])
                    y.maxpy(-pulled, through)

        a = self.a

        class Sprung:
            def mult(self, matrix, x, y):
                a.mult(x, y)
                for v in load:
                    y.axpy(v.dot(x), v)

        size = (self.hi - self.lo, self.n)
        sprung = self.petsc.Mat().createPython((size, size), Sprung(), comm=self.comm)
        sprung.setUp()
        eps = self.slepc.EPS().create(self.comm)
        eps.setOperators(sprung, mass)
        eps.setProblemType(self.slepc.EPS.ProblemType.GHEP)
        eps.setType("krylovschur")
        eps.setDimensions(ask["wanted"])
        eps.setTolerances(ask["tolerance"], 200)
        eps.setTarget(0.0)
        eps.setWhichEigenpairs(self.slepc.EPS.Which.TARGET_MAGNITUDE)
        st = eps.getST()
        st.setType("sinvert")
        st.setMatMode(self.slepc.ST.MatMode.SHELL)
        st.setShift(0.0)
        inverse = st.getKSP()
        inverse.setType("preonly")
        inverse.getPC().setType("python")
        inverse.getPC().setPythonContext(Inverse())
        free = [self.vector(c) for c in self.rows(f"{number}_free.npy").T]
        if free:
            eps.setDeflationSpace(free)
        eps.solve()
        count = min(eps.getConverged(), ask["wanted"])
        shape, values = self.a.createVecRight(), []
        out = np.zeros((self.hi - self.lo, ask["wanted"]))
        for k in range(count):
            values.append(eps.getEigenpair(k, shape).real)
            out[:, k] = shape.getArray()
        self.write(f"{number}_out.npy", out)
        return {"values": values, "steps": eps.getIterationNumber()}

    def peak_mb(self):
        """Return the most memory that all ranks took, MB."""
        # of this interpreter, which need not have psutil; macOS counts bytes, Linux 1024 of them
        unit = 1 if sys.platform == "darwin" else 1024
        rank_mb = unit * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20
        v = self.petsc.Vec().createMPI((1, None), comm=self.comm)
        v.setValue(self.comm.getRank(), rank_mb)
        v.assemble()
        return v.sum()


def main(folder):
    """Serve until a request to stop."""
    rank = Rank(folder)
    number, serving = 0, True
    while serving:
        ask = rank.path(f"{number}.json")
        if number and not os.path.exists(ask):
            time.sleep(PAUSE)
            continue
        answer = {}
        if number:
            order = rank.read(f"{number}.json")
            serving = order["what"] != "stop"
            if serving:
                answer = getattr(rank, order["what"])(number, order)
        answer["peak_mb"] = rank.peak_mb()
        rank.comm.barrier()
        if rank.comm.getRank() == 0:
            with open(rank.path("said.tmp"), "w", encoding="utf-8") as file:
                json.dump(answer, file)
            os.replace(rank.path("said.tmp"), rank.path(f"{number}.done"))
        number += 1


if __name__ == "__main__":
    main(sys.argv[1])
