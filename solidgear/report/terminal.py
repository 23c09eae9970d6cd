"""The run in a terminal: the final table, the verdict, matrices and modes; and the figures and
words they share with the HTML.

Everything fits 80 columns and says the same without colour. Texts out of a scene go through
`rich.text.Text`, so that a name with brackets in it stays a name.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypeGuard

from rich import box
from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from solidgear.frames import DOF_NAMES

if TYPE_CHECKING:
    import numpy as np

#: key -> name in a sentence, cheapest first
MODEL_NAMES = {
    "lumped": "lumped",
    "euler": "Euler beam",
    "timoshenko": "Timoshenko beam",
    "harmonic": "harmonic solid",
    "solid": "3D solid",
}
BEAMS = ("euler", "timoshenko")
#: kind -> unit of the blocks (translation, translation), (mixed), (rotation, rotation)
BLOCK_UNITS = {
    "stiffness": ("N/m", "N/rad", "N m/rad"),
    "compliance": ("m/N", "rad/N", "rad/(N m)"),
}
NOTHING = "-"


# ------------------------------------------------------------------------------------------------- figures and words
def plain(value: Any) -> Any:
    """The same data as dicts, lists, texts and finite numbers; NaN and infinities become None.

    Everything in the report reads its input through this, so that a result straight from numpy and
    one read back from JSON give the same page.
    """
    if isinstance(value, Mapping):
        return {str(k): plain(v) for k, v in value.items()}
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, (list, tuple)):
        return [plain(v) for v in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value


def is_number(value: Any) -> TypeGuard[float]:
    """Whether `value` is a finite number (a truth value is none)."""
    return isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)


def engineering(value: float | None, digits: int = 5, nothing: str = NOTHING) -> str:
    """`value` with an exponent that is a multiple of three, such as ``240.05e6``; exact zeros are
    ``0``.
    """
    if not is_number(value):
        return nothing
    if value == 0:
        return "0"
    # rounded first: 999.999 is 1.0000e3, not 1000.0
    value = float(f"{value:.{digits - 1}e}")
    exponent = 3 * (math.floor(math.log10(abs(value)) + 1e-12) // 3)
    mantissa = value / 10.0**exponent
    decimals = max(digits - 1 - math.floor(math.log10(abs(mantissa)) + 1e-12), 0)
    return f"{mantissa:.{decimals}f}" + (f"e{exponent}" if exponent else "")


def percent(value: float | None, signed: bool = True, nothing: str = NOTHING) -> str:
    """A fraction in per cent, to a resolution that suits its size."""
    if not is_number(value):
        return nothing
    p = 100 * value
    size = abs(p)
    if size < 1e-6:
        return "0 %" if p == 0 else "<1e-6 %"  # rounding; its figures mean nothing
    decimals = 1 if size >= 9.995 else 2 if size >= 0.0995 else 1 - math.floor(math.log10(size))
    return f"{p:{'+' if signed else ''}.{decimals}f} %"


def hertz(value: float | None, nothing: str = NOTHING) -> str:
    """A frequency to five or six figures, without its unit."""
    return (
        nothing if not is_number(value) else f"{value:.1f}" if abs(value) >= 100 else f"{value:.5g}"
    )


def seconds(value: float | None, nothing: str = NOTHING) -> str:
    """A duration in s, to about three figures, without its unit."""
    if not is_number(value):
        return nothing
    return (
        f"{value:.0f}"
        if value >= 100
        else f"{value:.1f}"
        if value >= 10
        else f"{value:.2f}"
        if value >= 0.01
        else f"{value:.1g}"
    )


def count(value: float | None, nothing: str = NOTHING) -> str:
    """A large number in a small cell, such as ``94.1k``."""
    if not is_number(value):
        return nothing
    for size, mark in ((1e6, "M"), (1e3, "k")):
        if value >= 9.9995 * size / 10:
            return f"{value / size:.3g}{mark}"
    return f"{value:.0f}"


def model_name(key: str | None) -> str:
    """The name of a model in a sentence; an unknown key stays itself."""
    return MODEL_NAMES.get(key or "", str(key or NOTHING))


def entry(model: Mapping, kind: str, i: int, j: int) -> float | None:
    """One entry of a model's 'stiffness' or 'compliance'; None if there is none."""
    try:
        value = model[kind][i][j]
    except (KeyError, IndexError, TypeError):
        return None
    return value if is_number(value) else None


def first_mode(model: Mapping, family: str) -> dict | None:
    """The lowest elastic mode of a family ('bending', 'axial', 'torsion'), or None."""
    for mode in model.get("modes") or ():
        name = str(mode.get("name", ""))
        if (
            (mode.get("family") == family or name.startswith(family))
            and not name.startswith("rigid")
            and is_number(mode.get("frequency_hz"))
        ):
            return mode
    return None


def quantity_key(quantity: str) -> str:
    """One spelling for a quantity: ``bending_1``, ``f_bending_1_hz`` and ``bending 1`` are the
    same.
    """
    text = str(quantity).lower().replace("_", " ").removesuffix(" hz").strip()
    return "bending 1" if text in ("f bending 1", "f1") else text


def headline(results: Mapping, model: str, quantity: str) -> dict | None:
    """The deviation that stands for a model where there is room for one.

    A beam has no seat surface: its fair partner is the solid with section ties ('section'). A solid
    is compared as the scene has it.
    """
    rows = [
        r
        for r in results.get("deviations") or ()
        if r.get("model") == model and quantity_key(r.get("quantity", "")) == quantity_key(quantity)
    ]
    wanted = "section" if model in BEAMS else "as scene"
    return next((r for r in rows if r.get("attachment") == wanted), rows[0] if rows else None)


def is_resolved(row: Mapping) -> bool:
    """Whether a deviation may be read as one: False only where it lies inside the bands of the
    models compared.
    """
    verdict = row.get("verdict")
    if verdict is not None:
        return verdict != "not resolved"
    return not (
        is_number(row.get("band"))
        and is_number(row.get("relative"))
        and abs(row["relative"]) <= row["band"]
    )


def answer_seconds(model: Mapping) -> float | None:
    """What an answer costs: building and solving. Bands and variants are evidence on top, and in
    the total only.
    """
    times = model.get("seconds") or {}
    stages = [times.get(s) for s in ("build", "statics", "modes")]
    known = [s for s in stages if is_number(s)]
    return sum(known) if len(known) == len(stages) else times.get("total")


#: how the worth of a model is told in a narrow column
VALID = {"yes": "yes", "no": "NO", "open": "?", "unknown": "?"}


def validity(model: Mapping) -> str:
    """``yes``, ``no``, ``open`` (not judged, or not to be told) or ``unknown`` where the record
    says nothing.
    """
    if model.get("valid") is True:
        return "yes"
    if model.get("open"):
        return "open"
    return "no" if model.get("valid") is False else "unknown"


def band_percent(value: float | None, nothing: str = NOTHING) -> str:
    """A band in per cent; one beyond 100 % says nothing but that."""
    return (
        "> 100 %"
        if is_number(value) and value > 1
        else percent(value, signed=False, nothing=nothing)
    )


def reference_of(results: Mapping) -> str | None:
    """The key of the model that the others are measured against."""
    return (results.get("verdict") or {}).get("reference") or (results.get("mac") or {}).get(
        "reference"
    )


# ------------------------------------------------------------------------------------------------- renderables
def final_table(results: Mapping) -> RenderableType:
    """One line a model: validity, K_zz, C_zz, first bending, deviation from the reference, band,
    size, time.

    Parameters
    ----------
    results : mapping
        The results of a run, as in ``results.json``; missing parts show as a dash.

    Returns
    -------
    rich renderable
        A table of at most 80 columns, and below it what its marks mean and why a model must not be
        trusted.
    """
    results = plain(results)
    reference = reference_of(results)
    table = Table(box=box.SIMPLE_HEAD, padding=0, pad_edge=False)
    table.add_column("model", no_wrap=True)
    table.add_column("valid", justify="center", no_wrap=True)
    for head in (
        "K_zz\nN/m",
        "C_zz\nm/N",
        "f1\nHz",
        "dC_zz\n",
        "df1\n",
        "band\nC",
        "DOFs\n",
        "time\ns",
    ):
        table.add_column(head, justify="right", no_wrap=True)
    unresolved, reasons = False, []
    for key, model in (results.get("models") or {}).items():
        cells = []
        for quantity in ("C_zz", "bending 1"):
            row = headline(results, key, quantity)
            if key == reference:
                cells.append("ref.")
            elif row is not None and not is_resolved(row):
                cells.append("n.r.")
                unresolved = True
            else:
                cells.append(percent(row.get("relative")) if row else NOTHING)
        bending = first_mode(model, "bending") or {}
        table.add_row(
            Text(
                {"euler": "Euler", "timoshenko": "Timoshenko", "harmonic": "harmonic"}.get(
                    key, model_name(key)
                )[:10]
            ),
            VALID[validity(model)],
            engineering(entry(model, "stiffness", 2, 2), 4),
            engineering(entry(model, "compliance", 2, 2), 4),
            hertz(bending.get("frequency_hz")),
            *cells,
            band_percent((model.get("band") or {}).get("compliance")),
            count(model.get("dofs")),
            seconds(answer_seconds(model)),
        )
        if validity(model) in ("no", "open"):
            reasons.append(
                Text(
                    f"{VALID[validity(model)]:<4}{model_name(key)}: {model.get('why_not') or 'not valid for this scene'}"
                )
            )
    notes = []
    if reference:
        notes.append(
            Text(
                f"d: difference from the {model_name(reference)} (ref.); a beam's is taken with section ties on both sides"
            )
        )
    if any(validity(m) == "open" for m in (results.get("models") or {}).values()):
        notes.append(Text("?: not judged, or too close to the tolerance to tell"))
    if unresolved:
        notes.append(
            Text("n.r.: not resolved, the difference lies inside the bands of the two models")
        )
    if table.row_count:
        notes.append(
            Text(
                "band: mesh uncertainty of the worst compliance; time: building and solving, without the evidence"
            )
        )
    if results.get("complete") is False:
        notes.append(Text("INCOMPLETE: the run was interrupted; what is missing shows as a dash"))
    return Group(table, *notes, *reasons)


def closing_lines(results: Mapping) -> list[str]:
    """What else a reader must know: cautions, which modes were counted, seconds and peak memory
    (plain text).
    """
    results = plain(results)
    lines = [f"caution: {w}" for w in results.get("warnings") or ()]
    trusted = (results.get("verdict") or {}).get("trust")
    evidence = ((results.get("models") or {}).get(trusted) or {}).get("evidence") or {}
    if evidence.get("complete"):
        lines.append(
            f"{model_name(trusted)[0].upper()}{model_name(trusted)[1:]}: {evidence['complete'][0].lower()}{evidence['complete'][1:]}"
        )
    if is_number(results.get("seconds_total")):
        peak = (
            f", peak memory {results['peak_mb']:.0f} MB"
            if is_number(results.get("peak_mb"))
            else ""
        )
        if peak and is_number(results.get("expected_peak_mb")):
            peak += f" ({results['expected_peak_mb']:.0f} MB estimated)"
        lines.append(f"Solved in {seconds(results['seconds_total'])} s{peak}.")
    return lines


def verdict_text(results: Mapping) -> str:
    """The verdict in plain words, one statement a line (plain text: print it without markup)."""
    verdict = plain(results).get("verdict") or {}
    if not verdict:
        return "No verdict: the run did not get that far."
    lines = [
        f"Trust: {model_name(verdict['trust'])}"
        if verdict.get("trust")
        else "Trust: none of the models that ran"
    ]
    if is_number(verdict.get("tolerance")):
        tolerance = f"{100 * verdict['tolerance']:.4g} %"
        cheapest = verdict.get("cheapest")
        lines.append(
            f"Cheapest model within {tolerance}: {model_name(cheapest) if cheapest else 'none below the reference'}"
        )
    return "\n".join(lines + [f"- {s}" for s in verdict.get("sentences") or ()])


def matrix_table(matrix: np.ndarray | Sequence[Sequence[float | None]], kind: str) -> Table:
    """A 6x6 with its units; free components (None or NaN) show as a dash.

    Parameters
    ----------
    matrix : (6, 6) array_like
        SI, order x y z thx thy thz.
    kind : {'stiffness', 'compliance'}

    Returns
    -------
    rich.table.Table
    """
    same, mixed, turn = BLOCK_UNITS[kind]
    rows = plain(matrix) or [[None] * 6] * 6
    table = Table(
        box=box.SIMPLE_HEAD, padding=0, pad_edge=False, title=f"{kind}, SI", title_justify="left"
    )
    table.add_column("")
    for name in DOF_NAMES:
        table.add_column(name, justify="right", no_wrap=True)
    for block, (left, right) in enumerate(((same, mixed), (mixed, turn))):
        table.add_row("", "", left, "", "", right, "", style="dim")
        for i in range(3 * block, 3 * block + 3):
            table.add_row(DOF_NAMES[i], *(engineering(v) for v in rows[i]), end_section=i == 2)
    return table


def modes_table(modes: Sequence[Mapping]) -> Table:
    """Natural frequencies with names and multiplicity."""
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False)
    table.add_column("mode")
    table.add_column("family")
    table.add_column("frequency, Hz", justify="right")
    table.add_column("shapes", justify="right")
    for mode in plain(list(modes or ())):
        table.add_row(
            Text(str(mode.get("name", NOTHING))),
            Text(str(mode.get("family", NOTHING))),
            hertz(mode.get("frequency_hz")),
            str(mode.get("multiplicity") or 1),
        )
    return table
