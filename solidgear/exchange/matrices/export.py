"""Matrices of a body written for another program, in one call."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

from solidgear.core.reduction.matrix_units import SI
from solidgear.exchange.matrices.formats import format_of, write_matrices
from solidgear.exchange.matrices.ross import write_ross
from solidgear.exchange.matrices.source import port_matrices


def export(
    source: Any, path: str | os.PathLike, to: str = "", *, units: str = SI.name, **wanted: Any
) -> list[Path]:
    """Write the matrices of a body for another program.

    Parameters
    ----------
    source : path, dict, Scene, Train, Body, Superelement, System or PortMatrices
    path : str or path
    to : str, optional
        ``npz``, ``mat``, ``matrix-market``, ``nastran``, ``abaqus``, ``calculix``, ``ross`` or
        ``text``; by default that of the ending.
    units : str
        ``m-kg-N``, ``mm-t-N`` or ``in-lbf-s``.
    **wanted
        As of :func:`port_matrices`.

    Returns
    -------
    list of Path
        Files, whole ones or none.

    Raises
    ------
    SolidgearError
        As of :func:`port_matrices`, for an unknown format, or a file that cannot be written.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> import solidgear as sg
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     files = sg.export("geometry/gear_shaft.toml", Path(folder) / "gear.bdf", modes=6)
    ...     again = sg.read_matrices(files[0])
    >>> again.size, [*again.positions]
    (24, ['gear', '3', '4'])
    """
    if to == "ross":
        return write_ross(source, path, units, **wanted)
    format_of(path, to)
    return write_matrices(port_matrices(source, **wanted), path, to, units)
