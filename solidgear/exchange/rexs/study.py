"""A gearbox in REXS as files of a train with its shafts."""

from __future__ import annotations

import os
from collections.abc import Mapping
from contextlib import ExitStack
from pathlib import Path

from solidgear.core import SolidgearError, whole
from solidgear.exchange.rexs.document import RexsError
from solidgear.exchange.rexs.importing import Imported, imported, name_of
from solidgear.exchange.rexs.loadable import with_loadable
from solidgear.exchange.rexs.reading import read


def import_rexs(
    file: str | os.PathLike, out: str | os.PathLike, *, force: bool = False
) -> Imported:
    """Write the train of a gearbox in REXS with its shafts into a folder.

    Parameters
    ----------
    file : str or path
        REXS file: ``.rexs``, ``.rexsj``, ``.rexsz``, or a zip of one.
    out : str or path
        Folder for the train and its shafts.
    force : bool
        Replace files that are there.

    Returns
    -------
    Imported
        ``paths`` of the files, the train first where there is one, which `solidgear.load_train` reads;
        ``has_train``; ``facts``; and ``notes``, what is assumed, contradictory or left out.

    Raises
    ------
    SolidgearError
        A file that is no REXS, of which no train can be made, or whose train could not be loaded, a
        file that is there, or a folder that cannot be written.

    Examples
    --------
    >>> import tempfile
    >>> import solidgear as sg
    >>> folder = tempfile.mkdtemp()
    >>> _ = sg.export("geometry/gearbox_train.toml", f"{folder}/gearbox.rexs")
    >>> gearbox = sg.import_rexs(f"{folder}/gearbox.rexs", f"{folder}/train")
    >>> [*sg.load_train(gearbox.paths[0]).shafts]
    ['pinion', 'gear']
    """
    file, folder = Path(file), Path(out)
    document = read(file)
    try:
        gearbox = imported(document, name_of(file))
    except RexsError as error:
        raise RexsError(f"{file}: {error}") from None
    gearbox = with_loadable(gearbox, str(file))
    texts = {folder / name: text for name, text in gearbox.files.items()}
    for path in texts:
        if path.exists() and not force:
            raise SolidgearError(
                f"{path}: there is such a file already; give another `out`, or `force`"
            )
    _write(texts)
    return gearbox.lying_in(folder)


def _write(texts: Mapping[Path, str]) -> None:
    """Write all files or none."""
    try:
        with ExitStack() as stack:
            for path, text in texts.items():
                path.parent.mkdir(parents=True, exist_ok=True)
                stack.enter_context(whole(path)).write_text(text, encoding="utf-8")
    except OSError as error:
        reason = error.strerror or error
        folder = next(iter(texts)).parent
        raise SolidgearError(
            f"{folder}: cannot be written ({reason}); name a folder you may write"
        ) from error
