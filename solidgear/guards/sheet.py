"""Sheet of a check: verdicts, faults, cautions and facts of a shaft, or of a train and its shafts."""

from __future__ import annotations

from collections.abc import Sequence

from solidgear.core.judge.record import GuardRecord
from solidgear.guards.check import BEST, Check
from solidgear.show.command import FAULTY, caution
from solidgear.show.sheet import Sheet, Terminal
from solidgear.show.table import Column, Table
from solidgear.show.units import ENGINEERING, Units

#: not capitalised where it begins a sentence
COMMAND = "solidgear"


def check_sheet(check: Check, units: Units = ENGINEERING) -> Sheet:
    """Return the sheet of a check, which has no numbers with units."""
    sentences = _sentences(check)
    for side, of_shaft in check.shafts.items():
        sentences += [f"== {side}", *_verdicts(of_shaft), *_sentences(of_shaft)]
    return Sheet(
        name="check",
        title=check.name,
        lead="",
        tables=(),
        data=check.as_dict(),
        verdict=_verdicts(check),
        notes=sentences,
        lines={"verdicts": _table(check)},
        terminal=Terminal(heading=["== train"] if check.shafts else [], lines="hanging"),
        exit_code=FAULTY if check.faulty else 0,
    )


def _table(check: Check) -> Table:
    """Return the verdict on every model of a shaft, or of each shaft of a train."""
    parts = {side: of_shaft.verdicts for side, of_shaft in check.shafts.items()}
    rows = [
        (side, model, verdict.verdict, ", ".join(verdict.reasons))
        for side, verdicts in (parts or {check.name: check.verdicts}).items()
        for model, verdict in verdicts.items()
    ]
    heads = (Column("shaft", axis=True), Column("model", axis=True), "verdict", "because of")
    return Table("Verdicts", heads, rows)


def _verdicts(check: Check) -> list[str]:
    """Return a sentence for each verdict, with the models that have it and their reasons."""
    sentences = []
    for verdict in BEST:
        models = []
        for model, value in check.verdicts.items():
            if value.verdict == verdict:
                models.append(model + _in_brackets(value.reasons, bool(check.shafts)))
        if models:
            sentences.append(f"{verdict.capitalize()}: {', '.join(models)}.")
    return sentences


def _in_brackets(reasons: Sequence[str], are_shafts: bool) -> str:
    """Return guards, or shafts, in brackets; empty without any."""
    words = " and ".join(reasons) if are_shafts else ", ".join(reasons).replace("_", " ")
    return f" ({words})" if words else ""


def _sentences(check: Check) -> list[str]:
    """Return faults, cautions with their models, and facts, a thought a sentence."""
    records = [record for record in check.records if not _left_to_json(record, check)]
    cautions = [
        ": ".join(filter(None, (", ".join(record.models), record.sentence)))
        for level in ("caution", "open", "avoid")
        for record in records
        if record.level == level
    ]
    facts = [record.sentence for record in records if record.level == "fact"]
    faults = [f"fault: {sentence}" for sentence in check.faults]
    return [thoughts(sentence) for sentence in [*faults, *map(caution, cautions), *facts]]


def _left_to_json(record: GuardRecord, check: Check) -> bool:
    """Return True for a sound mesh, or a caution on a model that is out anyway."""
    if record.guard == "mesh":
        return record.level == "fact"
    refused = [check.verdicts[m].reasons if m in check.verdicts else () for m in record.models]
    refusals = {"features"} | ({"beam_against_solid"} if record.guard == "slenderness" else set())
    return (
        bool(refused)
        and record.guard not in refusals
        and record.level in ("caution", "open")
        and all(refusals & set(guards) for guards in refused)
    )


def thoughts(text: str) -> str:
    """Return a text in which each part before a semicolon becomes a sentence.

    Examples
    --------
    >>> thoughts("too soft (1 N/m; 2 N/m); use a beam")
    'too soft (1 N/m; 2 N/m). Use a beam.'
    """
    parts, depth = [""], 0
    for k, letter in enumerate(text):
        depth += (letter in "([{") - (letter in ")]}")
        if text[k : k + 2] == "; " and depth == 0:
            parts.append("")
        else:
            parts[-1] += letter
    first, *following = (part.strip() for part in parts)
    begun = [
        part if part.startswith(COMMAND) else part[:1].upper() + part[1:] for part in following
    ]
    return ". ".join([first, *begun]) + ("." if not text.endswith(".") else "")
