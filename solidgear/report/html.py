"""One self-contained HTML page about one run.

`write_report` turns the results of a run (the dict that is also ``results.json``) into tables and
charts and fills ``report.html``, the template beside this file. The page needs no network, no
script and no other file.
"""

from __future__ import annotations

import base64
import functools
import logging
import os
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from solidgear.frames import DOF_NAMES
from solidgear.report import charts, speed_accuracy
from solidgear.report.lumped import lumped_tables
from solidgear.report.table import Table
from solidgear.report.words import (
    BEAMS,
    BLOCK_UNITS,
    MODEL_NAMES,
    answer_seconds,
    band_percent,
    engineering,
    entry,
    first_mode,
    headline,
    hertz,
    is_number,
    is_resolved,
    model_name,
    percent,
    plain,
    reference_of,
    seconds,
    validity,
)
from solidgear.whole_file import whole

log = logging.getLogger(__name__)
DASH = "–"
#: below this share of the geometric mean of its diagonal entries a coupling is printed faint
FAINT = 1e-6


def write_report(
    results: Mapping,
    folder: str | os.PathLike,
    images: Mapping[str, bytes | str | os.PathLike] | None = None,
) -> Path:
    """Write ``report.html`` into `folder`.

    Parameters
    ----------
    results : mapping
        What a run found, as in ``results.json``; parts that are missing are said to be missing.
    folder : path
        Made if it is not there.
    images : mapping, optional
        Renders by model key: PNG, JPEG or SVG, as bytes or as a path. Without it the files that
        ``results["images"]`` names are taken from `folder`.

    Returns
    -------
    Path
        Of the page. It appears whole or not at all: an earlier one is replaced in one step.
    """
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    target = folder / "report.html"
    with whole(target) as partial:
        partial.write_text(render_page(results, folder, images), encoding="utf-8")
    return target


def render_page(
    results: Mapping,
    folder: str | os.PathLike | None = None,
    images: Mapping[str, bytes | str | os.PathLike] | None = None,
) -> str:
    """The page as text; the parameters are those of `write_report`."""
    from markupsafe import Markup

    r = plain(results)
    r = {
        **r,
        "models": r.get("models") or {},
        "scene": r.get("scene") or {},
        "verdict": r.get("verdict") or {},
    }
    warnings = [str(w) for w in r.get("warnings") or []]
    drawn = {}
    for name, chart in charts.CHARTS.items():
        try:
            svg = chart(r)
        except Exception as error:  # a picture must never cost the reader the numbers
            log.warning("chart %s: %s", name, error, exc_info=True)
            warnings.append(f"the chart of {name} could not be drawn: {error}")
            svg = None
        drawn[name] = Markup(svg.decode()) if svg else None
    reference = reference_of(r)
    return _template().render(
        title=r["scene"].get("title") or r["scene"].get("name") or "shaft",
        scene=r["scene"],
        verdict=r["verdict"],
        port=r.get("port") or r["scene"].get("port") or {},
        warnings=warnings,
        complete=r.get("complete", True),
        missing=[model_name(k) for k in MODEL_NAMES if k not in r["models"] and k != "lumped"],
        trusted=model_name(r["verdict"].get("trust")) if r["verdict"].get("trust") else None,
        cheapest=model_name(r["verdict"].get("cheapest")) if r["verdict"].get("cheapest") else None,
        tolerance=_short_percent(r["verdict"].get("tolerance")),
        reference=model_name(reference) if reference else None,
        distrusted=[
            (model_name(k), m.get("why_not") or "not valid for this scene")
            for k, m in r["models"].items()
            if validity(m) == "no"
        ],
        undecided=[
            (model_name(k), m.get("why_not") or "it cannot be told")
            for k, m in r["models"].items()
            if validity(m) == "open"
        ],
        charts=drawn,
        renders=_renders(r, folder, images),
        scene_facts=_scene_facts(r),
        segments=_segments(r["scene"]),
        bearings=_bearings(r["scene"]),
        summary=_summary(r),
        # The lumped model stands on the matrix of another model, shown there.
        matrices=[
            (model_name(k), [_matrix(r, k, m, kind) for kind in BLOCK_UNITS if m.get(kind)])
            for k, m in r["models"].items()
            if k != "lumped"
        ],
        frequencies=_frequencies(r),
        deviations=_deviations(r),
        causes=_causes(r),
        lumped=lumped_tables(r),
        attachments=_attachments(r),
        levels=_levels(r),
        orders=_orders(r),
        algebra=_algebra(r),
        pairs=_pairs(r),
        cost=_cost(r),
        race=speed_accuracy.section(folder, r["scene"]),
        provenance=_provenance(r),
        environment=_pairs_of(r.get("environment"), "Environment of the run"),
        mesh=_mesh(r),
        total=seconds(r.get("seconds_total"), DASH),
    )


@functools.cache
def _template():
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    loader = FileSystemLoader(Path(__file__).parent)
    return Environment(
        loader=loader,
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    ).get_template("report.html")


# ------------------------------------------------------------------------------------------------- figures
def _eng(value: Any, digits: int = 5) -> str:
    return engineering(value, digits, DASH)


def _pct(value: Any, signed: bool = True) -> str:
    return percent(value, signed, DASH)


def _short_percent(value: Any) -> str | None:
    return f"{100 * value:.4g} %" if is_number(value) else None


def _mm(value: Any) -> str:
    return f"{1e3 * value:.6g}" if is_number(value) else DASH


def _small(value: Any) -> str:
    return f"{value:.2g}" if is_number(value) else DASH


def _unit(quantity: str) -> str:
    return "Hz" if not quantity.startswith(("C_", "K_")) else ""


# ------------------------------------------------------------------------------------------------- scene
def _scene_facts(r: Mapping) -> Table:
    scene, port = r["scene"], r["scene"].get("port") or r.get("port") or {}
    material, ask = scene.get("material") or {}, scene.get("ask") or {}
    rows = [
        ["source", scene.get("source") or "not given"],
        ["length", f"{_mm(scene.get('length'))} mm"],
        [
            "material",
            f"E = {_eng(material.get('E'), 4)} Pa, nu = {material.get('nu', DASH)}, density = {material.get('density', DASH)} kg/m³",
        ],
        [
            "lumped point",
            f"{port.get('name', '')} on the axis at y = {_mm(port.get('y'))} mm, carried by the outer surface from {_mm(port.get('lo'))} to {_mm(port.get('hi'))} mm, "
            f"attachment {port.get('attachment', DASH)}",
        ],
        ["free motions there", ", ".join((r.get("port") or {}).get("free") or []) or "none"],
        [
            "housing spring along y",
            f"{_eng(scene.get('housing_axial'))} N/m"
            if is_number(scene.get("housing_axial"))
            else "none",
        ],
        [
            "asked for",
            f"{ask.get('modes', DASH)} modes"
            + (
                f" up to {format(ask['max_frequency'], 'g')} Hz"
                if is_number(ask.get("max_frequency"))
                else ""
            )
            + (
                f", to a tolerance of {_short_percent(ask['tolerance'])}"
                if is_number(ask.get("tolerance"))
                else ""
            ),
        ],
    ]
    return Table("Scene", ["item", "value"], rows if scene else [], css="facts")


def _segments(scene: Mapping) -> Table:
    default = scene.get("material") or {}
    rows = []
    for s in scene.get("segments") or []:
        own = s.get("material") or default
        inner = (
            DASH
            if not (s.get("inner0") or s.get("inner1"))
            else f"{_mm(2 * s['inner0'])} → {_mm(2 * s['inner1'])}"
        )
        rows.append(
            [
                str(s.get("name", "")),
                (s.get("part", "shaft"), "word text"),
                _mm(s.get("y0")),
                _mm(s.get("y1")),
                _mm(s.get("length", s["y1"] - s["y0"])),
                f"{_mm(2 * s['outer0'])} → {_mm(2 * s['outer1'])}",
                inner,
                (
                    "default"
                    if own == default
                    else f"E {_eng(own.get('E'), 4)}, nu {own.get('nu')}, density {own.get('density')}",
                    "word text",
                ),
            ]
        )
    return Table(
        "Shaft segments, from the first end face (y = 0)",
        [
            "segment",
            "part",
            "from y, mm",
            "to y, mm",
            "length, mm",
            "outer diameter, mm",
            "bore, mm",
            "material",
        ],
        rows,
    )


def _bearings(scene: Mapping) -> Table:
    rows = []
    for b in scene.get("bearings") or []:
        K = b.get("stiffness") or [[None] * 6] * 6
        status = b.get("status") or "not stated"
        rows.append(
            [
                str(b.get("name", "")),
                _mm(b.get("y")),
                _mm(b.get("seat_width")),
                (b.get("attachment", DASH), "word text"),
                *(_eng(K[i][j], 4) for i, j in ((0, 0), (1, 1), (2, 2), (2, 3), (3, 3), (5, 5))),
                (status, f"word text mark {status}"),
                (str(b.get("note") or ""), "text"),
            ]
        )
    head = [
        "bearing",
        "y, mm",
        "seat, mm",
        "attachment",
        "K_xx, N/m",
        "K_yy, N/m",
        "K_zz, N/m",
        "K_z,thx, N/rad",
        "K_thx, N m/rad",
        "K_thz, N m/rad",
        "status",
        "note",
    ]
    return Table(
        "Bearings, series springs included",
        head,
        rows,
        note="Status says where the stiffness comes from: published, measured, identified (fitted), or assumed.",
    )


# ------------------------------------------------------------------------------------------------- results
def _summary(r: Mapping) -> Table:
    """Quantities down, models across: four models fit a page, thirteen columns do not."""
    models, reference = r["models"], reference_of(r)

    def row(label, cell):
        return [label, *(cell(k, m) for k, m in models.items())]

    def frequency(family):
        return lambda k, m: hertz((first_mode(m, family) or {}).get("frequency_hz"), DASH)

    def apart(quantity):
        def cell(key, m):
            found = headline(r, key, quantity)
            if key == reference:
                return ("reference", "quiet")
            return (
                DASH
                if found is None
                else _pct(found.get("relative"))
                if is_resolved(found)
                else (f"not resolved ({_pct(found.get('relative'))})", "quiet")
            )

        return cell

    def band(name):
        return lambda k, m: (
            band_percent((m.get("band") or {}).get(name), DASH)
            if m.get("band")
            else ("none given", "quiet")
            if k in BEAMS
            else DASH
        )

    valid = {
        "yes": ("yes", "good"),
        "no": ("no", "bad"),
        "open": ("not judged", "quiet"),
        "unknown": DASH,
    }
    rows = [
        row("valid for this scene", lambda k, m: valid[validity(m)]),
        row("K_zz, N/m", lambda k, m: _eng(entry(m, "stiffness", 2, 2))),
        row("C_zz, m/N", lambda k, m: _eng(entry(m, "compliance", 2, 2))),
        row("K_yy, N/m", lambda k, m: _eng(entry(m, "stiffness", 1, 1))),
        row("K_thx, N m/rad", lambda k, m: _eng(entry(m, "stiffness", 3, 3))),
        row("first bending, Hz", frequency("bending")),
        row("first axial, Hz", frequency("axial")),
        row("first torsion, Hz", frequency("torsion")),
        row("C_zz against reference", apart("C_zz")),
        row("first bending against reference", apart("bending 1")),
        row("band of the worst compliance (mesh)", band("compliance")),
        row("band of first bending (mesh)", band("bending_1")),
        row(
            "degrees of freedom",
            lambda k, m: f"{m['dofs']:,}".replace(",", " ") if is_number(m.get("dofs")) else DASH,
        ),
        row("building and solving, s", lambda k, m: seconds(answer_seconds(m), DASH)),
        row(
            "peak memory, MB",
            lambda k, m: f"{m['peak_mb']:.0f}" if is_number(m.get("peak_mb")) else DASH,
        ),
    ]
    note = "Stiffness and compliance with the attachments of the scene. “Against reference” compares beams with section ties on both sides, where they have a like-for-like partner, and solids as the scene has them."
    return Table(
        "Results at the lumped point",
        ["quantity", *(_capital(model_name(k)) for k in models)],
        rows if models else [],
        note,
        css="summary",
    )


def _capital(text: str) -> str:
    return text[:1].upper() + text[1:]


def _matrix(r: Mapping, key: str, model: Mapping, kind: str) -> dict:
    """A 6x6 with a unit over each of its four blocks."""
    free = (r.get("port") or {}).get("free") or []
    values = model[kind]
    rows = []
    for i, name in enumerate(DOF_NAMES):
        cells = []
        for j, other in enumerate(DOF_NAMES):
            value = entry(model, kind, i, j)
            if value is None or name in free or other in free:
                cells.append((DASH, "quiet"))
                continue
            own = [values[k][k] for k in (i, j)]
            faint = (
                i != j
                and all(is_number(v) for v in own)
                and abs(value) <= FAINT * abs(own[0] * own[1]) ** 0.5
            )
            cells.append((_eng(value), "faint" if faint else ""))
        rows.append((name, cells))
    same, mixed, turn = BLOCK_UNITS[kind]
    return {
        "caption": f"{_capital(model_name(key))}: {kind}",
        "names": DOF_NAMES,
        "blocks": [((same, mixed), rows[:3]), ((mixed, turn), rows[3:])],
    }


def _frequencies(r: Mapping) -> Table:
    models, reference = r["models"], reference_of(r)
    by_name = {
        k: {str(m.get("name")): m for m in model.get("modes") or []} for k, model in models.items()
    }
    ordered: dict[str, Mapping] = {}
    for key in sorted(models, key=lambda k: k != reference):
        for name, mode in by_name[key].items():
            ordered.setdefault(name, mode)
    rows = []
    for name, mode in sorted(ordered.items(), key=lambda item: item[1].get("frequency_hz") or 0.0):
        cells: list[Any] = [
            name,
            (mode.get("family", DASH), "word text"),
            str(mode.get("multiplicity") or 1),
        ]
        base = (by_name.get(reference, {}).get(name) or {}).get("frequency_hz")
        for key in models:
            f = (by_name[key].get(name) or {}).get("frequency_hz")
            apart = f" ({_pct(f / base - 1)})" if key != reference and is_number(f) and base else ""
            cells.append("0 (rigid)" if f == 0 else hertz(f, DASH) + apart)
        rows.append(cells)
    return Table(
        "Natural frequencies in Hz, attachments as in the scene",
        ["mode", "family", "shapes", *(_capital(model_name(k)) for k in models)],
        rows,
        f"In brackets: against the {model_name(reference)}. Two shapes: a pair of the same frequency in two planes. A dash: not among the modes asked for."
        if reference
        else "",
    )


def _renders(r: Mapping, folder: Any, images: Mapping | None) -> list[tuple[str, str | None]]:
    """(caption, data URI or None when the picture could not be had)."""
    if images is None and folder is not None:
        # only names inside the folder of the report: a results file must not pull in others
        images = {
            k: Path(folder) / Path(str(name)).name for k, name in (r.get("images") or {}).items()
        }
    out = []
    for key, image in (images or {}).items():
        try:
            data = (
                bytes(image)
                if isinstance(image, (bytes, bytearray, memoryview))
                else Path(image).read_bytes()
            )
        except OSError as error:
            log.warning("render of %s: %s", key, error)
            data = b""
        kind = (
            "png"
            if data[:4] == b"\x89PNG"
            else "jpeg"
            if data[:2] == b"\xff\xd8"
            else "svg+xml"
            if b"<svg" in data[:1000]
            else None
        )
        uri = f"data:image/{kind};base64,{base64.b64encode(data).decode()}" if kind else None
        out.append((_capital(model_name(key)), uri))
    return out


# ------------------------------------------------------------------------------------------------- evidence
def _rank(quantity: str) -> int:
    return 0 if quantity.startswith("C_") else 1 if quantity.startswith("K_") else 2


def _deviations(r: Mapping) -> list[Table]:
    """One table for each (model, attachment), compliances first."""
    tolerance = r["verdict"].get("tolerance")
    groups: dict[tuple, list] = {}
    for row in r.get("deviations") or []:
        groups.setdefault(
            (row.get("model"), row.get("reference"), row.get("attachment")), []
        ).append(row)
    tables = []
    for (model, reference, attachment), rows in groups.items():
        ties = (
            "attachments as in the scene"
            if attachment == "as scene"
            else f"{attachment} ties on both sides"
        )
        like = ", like for like" if attachment == "section" and model in BEAMS else ""
        table = Table(
            f"{_capital(model_name(model))} against {model_name(reference)}, {ties}{like}",
            [
                "quantity",
                "unit",
                model_name(model),
                model_name(reference),
                "difference",
                "band",
                "resolved?",
                f"within {_short_percent(tolerance)}"
                if is_number(tolerance)
                else "within tolerance",
            ],
        )
        for row in sorted(rows, key=lambda q: _rank(str(q.get("quantity", "")))):
            quantity = str(row.get("quantity", ""))
            figure = hertz if _rank(quantity) == 2 else engineering
            inside = (
                abs(row["relative"]) <= tolerance
                if is_number(row.get("relative")) and is_number(tolerance)
                else None
            )
            table.rows.append(
                [
                    quantity,
                    (str(row.get("unit") or _unit(quantity)), "word text"),
                    figure(row.get("value"), nothing=DASH),
                    figure(row.get("reference_value"), nothing=DASH),
                    _pct(row.get("relative")),
                    _pct(row.get("band"), signed=False),
                    (str(row.get("verdict") or "resolved"), "word text")
                    if is_resolved(row)
                    else ("not resolved", "word text unresolved"),
                    {True: ("yes", "good"), False: ("no", "bad"), None: DASH}[inside],
                ]
            )
        tables.append(table)
    return tables


def _causes(r: Mapping) -> Table:
    rows = [
        [
            str(c.get("cause", "")),
            (str(c.get("change", "")), "text"),
            ({"beam": "beam"}.get(c.get("model"), model_name(c.get("model"))), "text"),
            *(_pct(c.get(q)) for q in ("c_zz", "k_zz", "bending_1")),
        ]
        for c in r.get("causes") or []
    ]
    return Table(
        "One assumption switched at a time",
        ["cause", "what is switched", "in", "C_zz", "K_zz", "first bending"],
        rows,
    )


def _attachments(r: Mapping) -> Table:
    rows = []
    for key, ties in (r.get("attachments") or {}).items():
        average = (ties or {}).get("average") or {}
        for tie, v in (ties or {}).items():
            if not v:
                continue
            cells: list[Any] = [f"{_capital(model_name(key))}, {tie}"]
            for name, figure in (
                ("c_zz", engineering),
                ("k_zz", engineering),
                ("bending_1_hz", hertz),
            ):
                base = average.get(name)
                cells += [
                    figure(v.get(name), nothing=DASH),
                    _pct(v[name] / base - 1)
                    if is_number(v.get(name)) and is_number(base) and base
                    else DASH,
                ]
            rows.append(cells)
    return Table(
        "Three ways to hold the same surfaces",
        [
            "model, ties",
            "C_zz, m/N",
            "against average",
            "K_zz, N/m",
            "against average",
            "first bending, Hz",
            "against average",
        ],
        rows,
    )


def _levels(r: Mapping) -> Table:
    rows = []
    for key, model in r["models"].items():
        for n, v in enumerate((model.get("convergence") or {}).get("levels") or [], start=1):
            dofs = f"{v['dofs']:,}".replace(",", " ") if is_number(v.get("dofs")) else DASH
            rows.append(
                [
                    f"{_capital(model_name(key))}, {n}",
                    dofs,
                    _mm(v.get("h")),
                    str(v.get("order") or DASH),
                    _eng(v.get("c_zz"), 7),
                    f"{v['bending_1_hz']:.3f}" if is_number(v.get("bending_1_hz")) else DASH,
                ]
            )
    return Table(
        "The discretisations",
        [
            "model",
            "degrees of freedom",
            "element size h, mm",
            "element order",
            "C_zz, m/N",
            "first bending, Hz",
        ],
        rows,
    )


def _orders(r: Mapping) -> Table:
    rows = []
    for key, model in r["models"].items():
        for name, e in (model.get("convergence") or {}).items():
            if name == "levels" or not e:
                continue
            stiff = name.startswith(("c_", "k_"))
            label = _capital(name) if stiff else f"{name.replace('_', ' ')}, Hz"
            order = (
                f"{e['observed_order']:.2f} of {e['expected_order']:.2f}"
                if is_number(e.get("observed_order")) and is_number(e.get("expected_order"))
                else DASH
            )
            reduction = f"{e['reduction']:.2g}" if is_number(e.get("reduction")) else DASH
            rows.append(
                [
                    f"{_capital(model_name(key))}: {label}",
                    (str(e.get("method") or DASH), "word text"),
                    _pct(e.get("change"), signed=False),
                    reduction,
                    order,
                    str(e.get("factor") or DASH),
                    _pct(e.get("solver"), signed=False),
                    band_percent(e.get("gci"), DASH),
                ]
            )
    return Table(
        "Changes and bands",
        [
            "quantity",
            "band from",
            "last change",
            "over the one before",
            "order observed, expected",
            "factor",
            "of the solver",
            "band",
        ],
        rows,
        "Layers: every mesh adds layers towards corners as well as order or cells, so errors shrink by a nearly fixed share; the factor is measured on random shafts. "
        "A coupling's numbers are shares of the geometric mean of its two diagonal entries.",
    )


def _algebra(r: Mapping) -> Table:
    names = {
        "asymmetry": "asymmetry of the flexibility",
        "rigid_residual": "rigid motion, residual",
        "modal_residual": "modes, residual",
        "orthogonality": "modes, M-orthogonality",
        "rigid_modes": "rigid modes found",
    }
    rows = [
        [_capital(model_name(k)), *(_small(e.get(n)) for n in names), *_counted(e)]
        for k, m in r["models"].items()
        if (e := m.get("evidence"))
    ]
    return Table(
        "Algebraic checks of this run (relative; the smaller the better, but for the counts)",
        ["model", *names.values(), "eigensolver", "no mode missed below, Hz"],
        rows,
        "No mode missed: as many eigenvalues lie below as were found, by the inertia of a second factor (Sylvester).",
    )


def _counted(e: Mapping) -> list:
    """Eigensolver, and the frequency up to which the inertia of a factor confirms that every mode
    was found.
    """
    parts = e.get("mode_count") or []
    sure = parts and all(p.get("checked") for p in parts)
    return [
        (str(e.get("eigensolver") or DASH), "text"),
        f"{min(p['below_hz'] for p in parts):.0f}" if sure else "not counted",
    ]


def _pairs(r: Mapping) -> list[Table]:
    mac = r.get("mac") or {}
    reference = model_name(mac.get("reference"))
    tables = []
    for key, m in (mac.get("models") or {}).items():
        rows = [
            [
                str(p.get("mode", "")),
                (str(p.get("partner") or "none"), "text"),
                f"{p['mac']:.4f}" if is_number(p.get("mac")) else DASH,
                hertz(p.get("frequency_hz"), DASH),
                hertz(p.get("reference_hz"), DASH),
                _pct(p.get("relative")),
            ]
            for p in m.get("pairs") or []
        ]
        if rows:
            tables.append(
                Table(
                    f"{_capital(model_name(key))}: modes and their partners in the {reference}",
                    ["mode", "partner", "MAC", "frequency, Hz", f"{reference}, Hz", "difference"],
                    rows,
                )
            )
    return tables


def _cost(r: Mapping) -> Table:
    stages: list[str] = []
    for m in r["models"].values():
        stages += [s for s in m.get("seconds") or {} if s not in stages and s != "total"]
    rows = [
        [
            _capital(model_name(k)),
            *(seconds((m.get("seconds") or {}).get(s), DASH) for s in [*stages, "total"]),
            f"{m['peak_mb']:.0f}" if is_number(m.get("peak_mb")) else DASH,
            (str(m.get("backend") or DASH), "text"),
        ]
        for k, m in r["models"].items()
    ]
    return Table(
        "Wall time in s and peak memory",
        ["model", *stages, "total", "peak MB", "linear algebra"],
        rows,
        "Times of a single run on the machine named below: good for orders of magnitude.",
    )


# ------------------------------------------------------------------------------------------------- provenance
def _provenance(r: Mapping) -> Table:
    models, reference = r["models"], model_name(reference_of(r))
    ran = ", ".join(model_name(k) for k in models) or "no model"
    rows: list[list[Any]] = [
        [
            "geometry, material, bearings",
            f"input: {r['scene'].get('source') or 'source not given'}; each bearing carries its status, section 1",
        ],
        ["stiffness, compliance, frequencies, mode shapes", f"computed in this run, by: {ran}"],
        [
            "differences",
            f"this run against another model of this run ({reference}); a model-form comparison, not an error against reality",
        ],
        ["mode correlation", f"this run; partners in the {reference}"],
        ["causes, attachments", "this run; the same model solved again with one thing switched"],
        [
            "bands, observed orders",
            "this run; solution verification on similar meshes of the same model",
        ],
        [
            "expected orders",
            "closed form: the corner singularities of the geometry and the element order",
        ],
        ["free motions", "closed form: exact zeros of the formulation, not small computed numbers"],
        ["times, memory", "measured in this run"],
        ["experiment", ("none: nothing in this report is validated against experiment", "strong")],
    ]
    return Table(
        "Where each class of number comes from",
        ["class", "origin"],
        [[a, b if isinstance(b, tuple) else (b, "text")] for a, b in rows],
        css="facts",
    )


def _flat(value: Any) -> str:
    if isinstance(value, Mapping):
        return ", ".join(f"{k} {_flat(v)}" for k, v in value.items())
    if isinstance(value, list):
        return ", ".join(_flat(v) for v in value)
    return f"{value:.5g}" if isinstance(value, float) else DASH if value is None else str(value)


def _pairs_of(mapping: Mapping | None, caption: str) -> Table:
    items: Iterable = (mapping or {}).items()
    return Table(
        caption, ["item", "value"], [[str(k), (_flat(v), "text")] for k, v in items], css="facts"
    )


def _mesh(r: Mapping) -> list[Table]:
    return [
        t
        for k, m in r["models"].items()
        if (t := _pairs_of(m.get("mesh"), f"{_capital(model_name(k))}: mesh"))
    ]
