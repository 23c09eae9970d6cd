"""pyHarm (Apache 2.0) as a peer for branches of periodic motion: one gap on a linear system."""

from __future__ import annotations

import time
from typing import Any

from validation.race.process import ALONE, peer

RUNS = 3


def solve(*, limit: float = 900.0, **given: Any) -> dict:
    """Run pyHarm in a process of its own, as :func:`followed`, with ``cpu`` of the whole process.

    Raises
    ------
    PeerError
    """
    alone = {"limit": limit, "threads": 1, "extra": ALONE}
    return peer("pyHarm", "validation.race.pyharm_peer:followed", **alone, **given)


def followed(
    mass: list,
    damping: list,
    load: list,
    stiffness: list,
    error: float,
    begin: float,
    end: float,
    harmonics: int,
    instants: int,
    step: float,
) -> dict:
    """A branch with teeth of stiffness one and half gap one between the first unknown and the last,
    which moves as the transmission error does.

    Parameters
    ----------
    mass, damping, stiffness : (n, n) list
        Without the teeth, of unknowns scaled so that a half gap is one.
    error : float
        Amplitude at order one.
    begin, end : float
        rad/s.
    step : float
        Longest.

    Returns
    -------
    dict
        ``seconds`` of processor time of the fastest of three, ``omega`` (p,) and ``stretch``
        (p, 2 H + 1): mean, cosines and sines in turns.
    """
    import contextlib
    import importlib.metadata
    import io
    import logging
    import os
    import tempfile

    import numpy as np

    # it leaves a folder of its own where it is loaded
    home = tempfile.TemporaryDirectory(prefix="race-")
    os.chdir(home.name)
    from pyHarm import Maestro

    logging.disable(logging.CRITICAL)
    m, c, k = (np.array(x, float) for x in (mass, damping, stiffness))
    n = len(m)
    touching = k.copy()
    touching[np.ix_([0, -1], [0, -1])] += [[1.0, -1.0], [-1.0, 1.0]]
    inner = slice(0, n - 1)
    start = np.zeros((2 * harmonics + 1, n - 1))
    start[0] = np.linalg.solve(touching[inner, inner], np.array(load)[inner] + np.eye(n - 1)[0])
    dynamic = touching - begin**2 * m + 1j * begin * c
    first = np.linalg.solve(dynamic[inner, inner], -error * dynamic[inner, -1])
    start[1], start[2] = first.real, -first.imag
    means = {
        f"load {i}": {"type": "GOForcing", "dto": 0, "ho": 0, "amp": f}
        | {"connect": {"train": [i]}, "dirs": [0]}
        for i, f in enumerate(load)
        if f
    }
    last = {"train": [n - 1]}
    scene = {
        "system": {"type": "Base", "nh": harmonics, "nti": instants},
        "substructures": {
            "train": {"matrix": {"M": m, "C": c, "K": k, "G": np.zeros((n, n))}, "ndofs": 1}
        },
        "connectors": {
            "teeth": {"type": "PenaltyBilateralGap", "g": 1.0, "k": 1.0, "dirs": [0]}
            | {"connect": {"train": [0], "INTERNAL": [n - 1]}},
            **means,
        },
        "kinematics": {
            "error": {"type": "DispImposed", "amp": error, "connect": last, "dirs": [0]}
        },
        "analysis": {
            "branch": {"study": "frf", "puls_inf": min(begin, end), "puls_sup": max(begin, end)}
            | {"puls_start": begin, "sign_ds": int(np.sign(end - begin)), "verbose": False}
            | {"ds_max": step, "ds0": step, "ds_min": 1e-8, "solver": "NewtonRaphson"}
            | {"corrector": "pseudo_arc_length"}
        },
    }
    seconds = []
    for _ in range(RUNS):  # the first run pays for what is compiled late
        with contextlib.redirect_stdout(io.StringIO()):
            pyharm = Maestro(scene)
            clock = time.process_time()
            pyharm.operate(x0=start.ravel())
            seconds.append(time.process_time() - clock)
    found = np.array([one.x for one in pyharm.nls["branch"].SolList if one.flag_accepted])
    parts = found[:, :-1].reshape(len(found), -1, n - 1)[:, :, 0]
    parts[:, 1] -= error
    return {
        "seconds": min(seconds),
        "omega": found[:, -1].tolist(),
        "stretch": parts.tolist(),
        "version": importlib.metadata.version("pyharm-os"),
    }
