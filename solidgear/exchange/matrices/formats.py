"""Formats of matrices, each a line of ``FORMATS``."""

from __future__ import annotations

import os
import zlib
from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple
from zipfile import BadZipFile

from solidgear.core import SceneError, SolidgearError, listed, nearest, show
from solidgear.core.machine.whole_file import write_files
from solidgear.core.reduction.matrix_units import SI, MatrixUnits, matrix_units
from solidgear.core.reduction.port_matrices import PortMatrices, named_once
from solidgear.exchange.matrices import (
    abaqus,
    arrays,
    calculix,
    dmig,
    matrix_market,
    plain_text,
)
from solidgear.exchange.matrices.nodes import NodeMatrices

#: what readers raise on a file that is damaged
BROKEN = (
    *(OSError, EOFError, ValueError, TypeError, LookupError, AttributeError, ArithmeticError),
    *(NotImplementedError, BadZipFile, zlib.error),
)
Writer = Callable[[PortMatrices, Path, MatrixUnits], dict[Path, bytes]]
#: returns arrays by name, or matrices by nodes
Reader = Callable[[Path, str], "Mapping[str, Any] | NodeMatrices"]


class Format(NamedTuple):
    """A format: words, endings of its files, and how it is written and read."""

    about: str
    endings: tuple[str, ...]  #: the first is that of a written file
    write: Writer
    read: Reader | None = None


FORMATS = {
    "npz": Format("NumPy", (".npz",), arrays.write_npz, arrays.read_npz),
    "mat": Format("MATLAB", (".mat",), arrays.write_mat),
    "matrix-market": Format(
        "Matrix Market with a sidecar", (".json",), matrix_market.write, matrix_market.read
    ),
    "nastran": Format(
        "Nastran DMIG", (".bdf", ".dat", ".nas", ".pch", ".dmig"), dmig.write, dmig.read
    ),
    "abaqus": Format(
        "Abaqus *MATRIX INPUT", (".inp", ".mtx", ".sti", ".mas"), abaqus.write, abaqus.read
    ),
    "calculix": Format("CalculiX masses, springs and equations", (), calculix.write),
    "text": Format("plain text", (".txt",), plain_text.write, plain_text.read),
}
READABLE = tuple(ending for f in FORMATS.values() if f.read for ending in f.endings)


def write_matrices(
    matrices: PortMatrices, path: str | os.PathLike, to: str = "", units: str = SI.name
) -> list[Path]:
    """Write the files of a format, all whole or none; see :meth:`PortMatrices.write`."""
    return write_files(format_of(path, to).write(matrices, Path(path), matrix_units(units)))


def format_of(path: str | os.PathLike, to: str = "", others: Iterable[str] = ()) -> Format:
    """Return a format by name, or by the ending of a file; a refusal names `others` as well."""
    names = [*FORMATS, *others]
    ending = Path(path).suffix.lower()
    if not to:
        to = next((name for name, f in FORMATS.items() if ending in f.endings), "")
        if not to:
            raise SolidgearError(
                f"{path}: the ending {ending or 'none'!r} is of no format; name one of "
                f"{listed(names)}"
            )
    if to not in FORMATS:
        raise SolidgearError(
            f"format {show(to, 30)} is unknown{nearest(to, names)}; use {listed(names)}"
        )
    return FORMATS[to]


def read_matrices(
    path: str | os.PathLike, points: Mapping[str, Any] | None = None, units: str = ""
) -> PortMatrices:
    """Read mass and stiffness of a body from a file of another program or of :func:`export`.

    Parameters
    ----------
    path : str or path
        ``.npz``, ``.json`` with Matrix Market files, ``.bdf`` and others with DMIG,
        ``.inp``, ``.mtx``, ``.sti`` of Abaqus or CalculiX, ``.txt``.
    points : mapping of str to int or dict, optional
        Nodes by the names of points, or for each a table of ``node`` and ``position``; of CalculiX
        ``node = [REF NODE, ROT NODE]``. By default as the file has them.
    units : str, optional
        ``m-kg-N``, ``mm-t-N`` or ``in-lbf-s``; by default those that the file states, or SI.

    Returns
    -------
    PortMatrices
        In SI. Unknowns beside points that are no modes are condensed.

    Raises
    ------
    SceneError
        The file, and what is wrong with it.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> import solidgear as sg
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     files = sg.export("geometry/gear_shaft.toml", Path(folder) / "gear.npz", modes=3)
    ...     gear = sg.read_matrices(files[0])
    >>> gear.modes, gear.rigid_share < 1e-6
    (3, True)
    """
    source = os.fspath(path)
    file = Path(path)
    chosen = next(
        (f for f in FORMATS.values() if f.read and file.suffix.lower() in f.endings), None
    )
    if chosen is None or chosen.read is None:
        raise SceneError(
            f"matrices are read from files that end in {listed(READABLE)}", where=source
        )
    try:
        content = chosen.read(file, source)
    except BROKEN as error:
        if isinstance(error, SceneError):
            raise
        if isinstance(error, FileNotFoundError):
            raise SceneError("there is no such file", where=source) from None
        cause = getattr(error, "strerror", None) or f"not a file of {chosen.about}"
        raise SceneError(f"the matrices cannot be read: {cause}", where=source) from None
    given = {"points": points, "units": units}
    keys = {key: value for key, value in given.items() if value}
    if isinstance(content, NodeMatrices):
        return replace(content.matrices(points, units), keys=keys)
    matrices = arrays.from_arrays(content, source, units)
    return replace(_renamed(matrices, points) if points else matrices, keys=keys)


def _renamed(matrices: PortMatrices, points: Mapping[str, Any]) -> PortMatrices:
    """Return the points of arrays under the names that a user gives them, by number from one."""
    names = [*matrices.positions]
    for name, entry in points.items():
        node = entry.get("node") if isinstance(entry, Mapping) else entry
        if not isinstance(node, int) or not 1 <= node <= len(names):
            raise matrices.wrong(
                f"point {name!r}: {show(node, 20)} is no number of a point, 1 to {len(names)}"
            )
        names[node - 1] = name
    named_once(names, matrices.source)
    return matrices.with_names(names)
