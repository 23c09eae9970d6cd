"""A gearbox, or the matrices of a body, written for another program in one call."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from solidgear.core import SolidgearError, listed
from solidgear.core.reduction.matrix_units import SI
from solidgear.exchange.matrices.formats import format_of, write_matrices
from solidgear.exchange.matrices.ross import write_ross
from solidgear.exchange.matrices.source import port_matrices
from solidgear.exchange.rexs.export.exporting import write_rexs
from solidgear.exchange.rexs.writing import ENDINGS

#: formats beside those of matrices
OTHERS = ("ross", "rexs")


def is_rexs(path: str | os.PathLike, to: str = "") -> bool:
    """Return True where a file is to be one of REXS, by the format or by the ending of its name."""
    return to == "rexs" or (not to and Path(path).suffix.lower() in ENDINGS)


def refuse_options(path: str | os.PathLike, wanted: Mapping[str, Any], units: str) -> None:
    """Refuse options of matrices for a gearbox."""
    words = [*wanted, *(["units"] if units != SI.name else [])]
    if words:
        raise SolidgearError(
            f"{path}: REXS holds a gearbox as it is, in its units; leave out {listed(words)}"
        )


def export(
    source: Any, path: str | os.PathLike, to: str = "", *, units: str = SI.name, **wanted: Any
) -> list[Path]:
    """Write the matrices of a body, or a gearbox in REXS, for another program.

    Parameters
    ----------
    source : path, dict, Scene, Train, Body, Superelement, System or PortMatrices
    path : str or path
    to : str, optional
        ``npz``, ``mat``, ``matrix-market``, ``nastran``, ``abaqus``, ``calculix``, ``ross`` or
        ``text``, for matrices; ``rexs`` for a scene or a train as it is, in a file that ends in
        ``.rexs``, ``.rexsj`` (JSON) or ``.rexsz`` (zipped), of which what REXS has no place for
        stands in attributes of its own. By default that of the ending.
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
        As of :func:`port_matrices`, for an unknown format, options of matrices for REXS, or a file
        that cannot be written.

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
    if is_rexs(path, to):
        refuse_options(path, wanted, units)
        write_rexs(source, path)
        return [Path(path)]
    if to == "ross":
        return write_ross(source, path, units, **wanted)
    format_of(path, to, OTHERS)
    return write_matrices(port_matrices(source, **wanted), path, to, units)
