"""Eigenvectors as another machine might give them: ``python -m pytest -p tests.turned_vectors``.

The sign of an eigenvector, the mix of two of equal values and the basis of a null space are anybody's
choice: a processor's, a library's. With this plugin solvers give others than they would, and the same
ones for the same problem.
"""

import functools
import zlib

import numpy as np
import pytest
import scipy.linalg as sla
import scipy.sparse.linalg as spla

from solidgear.core.machine.threads import pin

pin()
#: Values so near, relative to the largest, are equal: what rounding leaves between them.
EQUAL = 8 * np.finfo(float).eps
#: Eigenvalues of twins of a block, relative to each other; shapes are good to 1e-7.
TWINS = 1e-10
QR = np.linalg.qr


def chance(of):
    """Random numbers that follow from an array."""
    return np.random.default_rng(zlib.crc32(np.ascontiguousarray(of).tobytes()))


def basis(random, size, field=float):
    """(k, k) orthogonal matrix."""
    drawn = random.standard_normal((size, size))
    if np.issubdtype(field, np.complexfloating):
        drawn = drawn + 1j * random.standard_normal((size, size))
    return QR(drawn)[0]


def turn(value, near, field=float):
    """(k, k) orthogonal matrix that flips the vectors of values and mixes those of equal ones."""
    random = chance(value)
    out = np.diag(random.choice([-1.0, 1.0], len(value))).astype(field)
    ends = np.flatnonzero(np.abs(np.diff(value)) > near) + 1
    for alike in np.split(np.arange(len(value)), ends):
        if len(alike) > 1:
            out[np.ix_(alike, alike)] = basis(random, len(alike), field)
    return out


def near_largest(value):
    return EQUAL * np.abs(value).max(initial=0.0)


def symmetric(solver):
    @functools.wraps(solver)
    def turned(*arguments, **options):
        found = solver(*arguments, **options)
        alone = options.get("eigvals_only") or options.get("return_eigenvectors") is False
        if alone or found[1].ndim > 2:
            return found
        value, vector = found
        vector = vector @ turn(value, near_largest(value), vector.dtype.type)
        return type(found)(value, vector) if hasattr(found, "_fields") else (value, vector)

    return turned


def singular(solver):
    @functools.wraps(solver)
    def turned(a, full_matrices=True, compute_uv=True, **options):
        found = solver(a, full_matrices, compute_uv, **options)
        if not compute_uv or found[1].ndim > 1:
            return found
        left, size, right = found
        both, sides = turn(size, near_largest(size), left.dtype.type), []
        for vectors in (left, right.conj().T):
            rest = vectors[:, len(size) :]
            rest = rest @ basis(chance(size), rest.shape[1])
            sides.append(np.hstack([vectors[:, : len(size)] @ both, rest]))
        return type(found)(sides[0], size, sides[1].conj().T)

    return turned


def null(solver):
    @functools.wraps(solver)
    def turned(a, *arguments, **options):
        found = solver(a, *arguments, **options)
        return found @ basis(chance(a), found.shape[1], found.dtype.type)

    return turned


def general(solver):
    """Phases of complex vectors; those of conjugate values stay conjugate."""

    @functools.wraps(solver)
    def turned(*arguments, **options):
        found = solver(*arguments, **options)
        value, vector = found
        if vector.ndim > 2:
            return found
        angle = {abs(v.imag): chance(abs(v.imag)).uniform(0, 2 * np.pi) for v in value}
        phase = np.array(
            [np.exp(1j * np.sign(v.imag) * angle[abs(v.imag)]) if v.imag else -1 for v in value]
        )
        return type(found)(value, vector * (phase if np.iscomplexobj(vector) else phase.real))

    return turned


def refined(refine):
    @functools.wraps(refine)
    def turned(*arguments, **options):
        found = refine(*arguments, **options)
        found.vectors[:] = found.vectors @ turn(found.value, TWINS * np.abs(found.value[:-1]))
        return found

    return turned


@pytest.fixture(scope="session", autouse=True)
def turned_vectors():
    from solidgear.core.solve import eigen

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(np.linalg, "eigh", symmetric(np.linalg.eigh))
        patch.setattr(np.linalg, "eig", general(np.linalg.eig))
        patch.setattr(np.linalg, "svd", singular(np.linalg.svd))
        patch.setattr(sla, "eigh", symmetric(sla.eigh))
        patch.setattr(sla, "null_space", null(sla.null_space))
        patch.setattr(spla, "eigsh", symmetric(spla.eigsh))
        patch.setattr(eigen, "refine", refined(eigen.refine))
        yield
