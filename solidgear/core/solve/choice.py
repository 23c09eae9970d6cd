"""Choice of the back end that factors a matrix, with the reason."""

from __future__ import annotations

import os

from solidgear.core.factoring import Factoring
from solidgear.core.solve.backends import BACKENDS, INSTALL, OUT_OF_CORE, SINGLE, missing
from solidgear.core.solve.backends.matrix import FactorError

# SuperLU's indices overflow on the factors of planar meshes of very high order ("not enough
# memory").
LARGE_PLANAR = 30_000_000  # entries
# Solids below this size: PARDISO gains no more than loading MKL costs (0.2 s, once). A corrected
# solid of four halves of 4,000 to 5,000 unknowns gains 0.25 s.
SMALL = 3_500
# Fastest first, for solids. Factorisation against PARDISO at 41 000 (HEX20) and 93 000 unknowns
# (TET10), two runs in turn on two busy cores: CHOLMOD 0.65 to 1.3, MUMPS 1.4 to 1.8 with OpenBLAS;
# 2.7 and 5 with the reference BLAS (TET10, one run); SuperLU about 14 (HEX20, one run apart from
# these).
FASTEST = ("pardiso", "cholmod", "mumps", "superlu")
#: a factor in double precision, in memory
USUAL = Factoring()
FORCED = "asked for"


def choice(
    unknowns: int,
    entries: int,
    backend: str | None = None,
    planar: bool = False,
    factoring: Factoring = USUAL,
) -> tuple[str, str]:
    """Choose the back end that will factor a matrix of so many rows and entries, and return the
    reason; otherwise parameters as for :func:`solidgear.core.solve.factor.factorise`. FactorError if the
    one asked for is unknown, not there, or cannot do it.

    Examples
    --------
    >>> choice(100, 100, backend="superlu")
    ('superlu', 'asked for')
    """
    backend = backend or os.environ.get("SOLIDGEAR_BACKEND") or None
    if backend is not None:
        if backend not in BACKENDS:
            raise FactorError(
                f"unknown back end {backend!r}; use " + ", ".join(map(repr, BACKENDS))
            )
        reason = missing(backend)
        if reason:
            raise FactorError(f"back end {backend} was asked for but {reason}")
        if backend not in _able(factoring):
            raise FactorError(
                f"back end {backend} was asked for but makes no factor in {factoring.words}; "
                f"{' or '.join(_able(factoring)) or 'none'} does"
            )
        return backend, FORCED
    if factoring.out_of_core:
        return _out_of_core(factoring)
    if planar and entries < LARGE_PLANAR:
        return "superlu", "a planar mesh fills in little"
    if unknowns <= SMALL:
        return "superlu", f"{unknowns} unknowns are not above {SMALL}"
    absent = []
    for name in (name for name in FASTEST if name in _able(factoring)):
        reason = missing(name)
        if not reason:
            break
        absent.append(f"{INSTALL[name]} ({reason})")
    return name, f"{unknowns} unknowns are above {SMALL}" + "".join(
        f"; faster: {way}" for way in absent
    )


def _able(factoring: Factoring) -> tuple[str, ...]:
    """Return back ends that make such a factor, fastest first."""
    single, out_of_core = factoring.precision == "single", factoring.out_of_core
    return tuple(
        name
        for name in FASTEST
        if (not single or name in SINGLE) and (not out_of_core or name in OUT_OF_CORE)
    )


def _out_of_core(factoring: Factoring) -> tuple[str, str]:
    absent = []
    for name in _able(factoring):
        reason = missing(name)
        if not reason:
            return name, "it keeps its factor in files"
        absent.append(f"{reason}: {INSTALL[name]}")
    raise FactorError(f"no back end here makes a factor in {factoring.words}: {'; '.join(absent)}")
