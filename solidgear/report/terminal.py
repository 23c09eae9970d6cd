"""The run in a terminal: the final table, the verdict, matrices and modes.

Everything fits 80 columns and says the same without colour. Texts out of a scene go through
`rich.text.Text`, so that a name with brackets in it stays a name.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from rich import box
from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from solidgear.frames import DOF_NAMES
from solidgear.report.words import (
    BLOCK_UNITS,
    NOTHING,
    answer_seconds,
    band_percent,
    count,
    engineering,
    entry,
    first_mode,
    heading,
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

if TYPE_CHECKING:
    import numpy as np

NOT_RESOLVED = "n.r."
#: how the worth of a model is told in a narrow column
VALID = {"yes": "yes", "no": "NO", "open": "?", "unknown": "?"}


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
    models = results.get("models") or {}
    unresolved, reasons = False, []
    for key, model in models.items():
        cells = [_against_reference(results, key, quantity) for quantity in ("C_zz", "bending 1")]
        unresolved = unresolved or NOT_RESOLVED in cells
        bending = first_mode(model, "bending") or {}
        table.add_row(
            Text(heading(key)[:10]),
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
            why = model.get("why_not") or "not valid for this scene"
            reasons.append(Text(f"{VALID[validity(model)]:<4}{model_name(key)}: {why}"))
    notes = []
    if reference:
        notes.append(
            Text(
                f"d: difference from the {model_name(reference)} (ref.); a beam's is taken with section ties on both sides"
            )
        )
    if any(validity(m) == "open" for m in models.values()):
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


def _against_reference(results: Mapping, key: str, quantity: str) -> str:
    """The difference of a model from the reference, for one cell."""
    if key == reference_of(results):
        return "ref."
    row = headline(results, key, quantity)
    if row is None:
        return NOTHING
    return percent(row.get("relative")) if is_resolved(row) else NOT_RESOLVED


def closing_lines(results: Mapping) -> list[str]:
    """What else a reader must know: cautions, which modes were counted, seconds and peak memory
    (plain text).
    """
    results = plain(results)
    lines = [f"caution: {w}" for w in results.get("warnings") or ()]
    trusted = (results.get("verdict") or {}).get("trust")
    evidence = ((results.get("models") or {}).get(trusted) or {}).get("evidence") or {}
    if evidence.get("complete"):
        name, counted = model_name(trusted), evidence["complete"]
        lines.append(f"{name[0].upper()}{name[1:]}: {counted[0].lower()}{counted[1:]}")
    if is_number(results.get("seconds_total")):
        peak = ""
        if is_number(results.get("peak_mb")):
            peak = f", peak memory {results['peak_mb']:.0f} MB"
        if peak and is_number(results.get("expected_peak_mb")):
            peak += f" ({results['expected_peak_mb']:.0f} MB estimated)"
        lines.append(f"Solved in {seconds(results['seconds_total'])} s{peak}.")
    return lines


def verdict_text(results: Mapping) -> str:
    """The verdict in plain words, one statement a line (plain text: print it without markup)."""
    verdict = plain(results).get("verdict") or {}
    if not verdict:
        return "No verdict: the run did not get that far."
    trusted = verdict.get("trust")
    lines = [f"Trust: {model_name(trusted) if trusted else 'none of the models that ran'}"]
    if is_number(verdict.get("tolerance")):
        tolerance = f"{100 * verdict['tolerance']:.4g} %"
        cheapest = verdict.get("cheapest")
        name = model_name(cheapest) if cheapest else "none below the reference"
        lines.append(f"Cheapest model within {tolerance}: {name}")
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
