"""Check of a shaft or a train, from a path, tables or an object."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from solidgear.core import (
    HARMONIC,
    LADDER,
    SolidgearError,
    Source,
    build,
    is_train,
    load,
    name_of_source,
)
from solidgear.core.loading import under_case
from solidgear.core.registry import needed
from solidgear.guards.check import Check, check_scene
from solidgear.show.options import MODEL


def check(
    source: Source,
    model: str = MODEL,
    options: Mapping[str, Any] | None = None,
    *,
    case: str | int | None = None,
) -> Check:
    """Which models hold for a scene or train, which do not, and why; solves light meshes only.

    Parameters
    ----------
    source : path, dict, Scene or Train
        A scene or train: its file (TOML), the tables of one, or an object.
    model : str
        Of one shaft: the model whose mesh is looked at.
    options : mapping, optional
        Builder options of the model.
    case : str, optional
        Of one shaft: case of the loads under which bearings settle, by name or number; by default
        the first.

    Returns
    -------
    Check
        ``verdicts`` by model, ``facts``, ``cautions`` and ``faults``.

    Raises
    ------
    SolidgearError
        For a model or options given for a train.

    Examples
    --------
    >>> import solidgear as sg
    >>> found = sg.check("geometry/pinion_overhung.toml")
    >>> found.verdicts["harmonic"].verdict, found.faults
    ('holds', [])
    """
    usual = model == MODEL and not options
    if is_train(source):
        under_case(source, case)
        if not usual:
            option = "`options`" if options else "`model`"
            raise SolidgearError(
                f"{option} is for one shaft, and {name_of_source(source)} is a train: for other "
                "models and meshes run check on the file of a shaft"
            )
        return needed("check", "train", name_of_source(source))(source)
    scene = load(under_case(source, case))
    # a model of revolution is looked at on the plain part, and the check says so
    part = scene if LADDER[model].can_model(scene) else scene.plain
    chosen = dict(HARMONIC) if usual else LADDER[model].checked(dict(options or {}))
    return check_scene(scene, build(part, model, **chosen))
