"""What `compare` and `check` say of a scene, as plain data: the one place that knows how their
results are built.
"""

from __future__ import annotations

import hashlib
from pathlib import Path

import numpy as np

import solidgear
from solidgear.judge.quantities import QUANTITIES, size
from solidgear.ladder import build
from solidgear.scene import Scene
from solidgear.studies.check import check_scene
from solidgear.studies.comparison import compare

SOLIDS = ("harmonic", "solid")


def stamp() -> str:
    """Changes with the source of the product, so that results of another version are not taken
    for this one's.
    """
    told = hashlib.sha256()
    folder = Path(solidgear.__file__).parent
    for path in sorted(folder.rglob("*.py")):
        told.update(str(path.relative_to(folder)).encode() + path.read_bytes())
    return told.hexdigest()[:10]


def outcome(
    scene: Scene, models: tuple[str, ...], settings: dict | None = None, check: bool = True
) -> dict:
    """Verdicts, values and bands of every model, and what `check` says.

    Returns
    -------
    dict
        ``models``: by name ``values``, ``bands`` (absolute), ``steps`` (values of the sequence
        behind a band), ``modes``, ``gram``, ``valid``, ``why_not``, ``seconds``, ``unknowns``;
        ``check``: by name what `check` says; ``warnings``.
    """
    comparison = compare(scene, models=models, settings=settings)
    results = comparison.results
    out = {
        name: _model(record, comparison.rungs.get(name))
        for name, record in results["models"].items()
    }
    said = {}
    if check:
        found = check_scene(scene, build(scene, "timoshenko"))
        said = {name: verdict["verdict"] for name, verdict in found["verdicts"].items()}
    return {
        "models": out,
        "check": said,
        "warnings": results["warnings"],
        "trust": results["verdict"].get("trust"),
    }


def _model(record: dict, rung) -> dict:
    out = {
        "valid": record["valid"],
        "why_not": record["why_not"],
        "values": {},
        "bands": {},
        "steps": {},
        "modes": [],
    }
    if record["compliance"] is None:
        return out
    out["values"] = values(record)
    each = (record.get("band") or {}).get("each") or {}
    for name, band in each.items():
        if name in out["values"] and band is not None:
            out["bands"][name] = float(band) * size(out["values"], name)
    for name in out["bands"]:
        found = (record["convergence"] or {}).get("quantities", {}).get(name)
        if found:
            out["steps"][name] = {
                k: found.get(k)
                for k in ("values", "observed_order", "used_order", "plausible", "factor")
            }
    out["seconds"] = (
        sum(v for v in record["seconds"].values() if isinstance(v, float))
        if record.get("seconds")
        else None
    )
    out["unknowns"] = record.get("dofs")
    if rung is not None:
        out["modes"] = [_shape(m) for m in rung.modes.modes]
    else:
        out["modes"] = [
            {k: m[k] for k in ("name", "family", "frequency_hz", "multiplicity")}
            for m in record["modes"]
        ]
    return out


def _shape(mode) -> dict:
    return {
        "name": mode.name,
        "family": mode.family,
        "frequency_hz": float(mode.frequency_hz),
        "multiplicity": mode.multiplicity,
        "motions": np.round(mode.motions / max(np.abs(mode.motions).max(), 1e-300), 9).tolist(),
    }


def values(record: dict) -> dict[str, float]:
    """Compared numbers of a model's record; those that do not exist are left out."""
    named = {m["name"]: m["frequency_hz"] for m in record["modes"]}
    out = {}
    for name, (kind, place, _) in QUANTITIES.items():
        value = named.get(place) if kind == "frequency" else record[kind][place[0]][place[1]]
        if value:
            out[name] = float(value)
    return out
