"""Are valid models valid? Each verdict of `compare` against the true errors, and `check` against
`compare`.
"""

from __future__ import annotations

from collections import Counter

from validation.attack.judge import called, errors_of, rate, within

RUNGS = ("lumped", "euler", "timoshenko", "harmonic")
#: what a lumped model answers for
LUMPED = ("C_zz", "C_thx", "C_yy", "C_z,thx", "bending 1")


class VerdictTable:
    """Counts verdicts by model and tolerance.

    *False valid*: called valid, and a judged quantity of the scene as it stands is further off
    than the tolerance. *False invalid*: called not valid, and all are within it, both as the
    scene stands and with section ties everywhere, so that no cancellation and no effect of a tie
    explains the refusal. A solid has ties of its own and is judged on the scene alone.
    """

    def __init__(self):
        self.counts: Counter = Counter()
        self.cases: list[str] = []

    def add(self, row: dict, traits: dict, reference, fair) -> None:
        """One outcome; `fair` is the reference with section ties everywhere, or None."""
        tolerance = traits["tolerance"]
        where = f"{called(row['seed'], traits)}, {100 * tolerance:g} %"
        for model in RUNGS:
            found = row["models"].get(model)
            if not found or not found["values"]:
                self.counts[model, tolerance, "not solved"] += 1
                continue
            names = {"names": LUMPED} if model == "lumped" else {}
            errors = errors_of(found, reference, **names)
            scene_true = within(errors, tolerance)
            # a lumped model has no shapes of its own: its frequencies are paired by name
            fair_true = (
                model == "harmonic"
                or fair is not None
                and within(errors_of(found, fair, **names), tolerance)
            )
            self.counts[model, tolerance, self._sort(found["valid"], scene_true, fair_true)] += 1
            if found["valid"] and scene_true is False:
                worst = max(errors, key=lambda q: abs(errors[q][0]))
                self.cases.append(
                    f"false valid: {where}, {model}: {worst} is {100 * errors[worst][0]:+.2f} % off"
                )
            if not found["valid"] and scene_true and fair_true:
                self.cases.append(f"false invalid: {where}, {model}: {found['why_not']}")
        self._check(row, where)

    @staticmethod
    def _sort(valid: bool, scene_true: bool | None, fair_true: bool | None) -> str:
        if scene_true is None:
            return "on the edge"
        if valid:
            return "valid, true" if scene_true else "false valid"
        if not scene_true:
            return "not valid, true"
        return "false invalid" if fair_true else "not valid like for like only"

    def _check(self, row: dict, where: str) -> None:
        for model, verdict in row.get("check", {}).items():
            found = row["models"].get(model)
            if found is None:
                continue
            flat = {"holds": True, "will not hold": False}.get(verdict)
            kind = (
                "uncertain"
                if flat is None
                else "agree"
                if flat == bool(found["valid"])
                else "contradict"
            )
            self.counts["check", model, kind] += 1
            if kind == "contradict":
                said = "valid" if found["valid"] else f"not valid ({found['why_not']})"
                self.cases.append(
                    f"check against compare: {where}, {model}: "
                    f"check says {verdict!r}, compare {said}"
                )

    def lines(self) -> list[str]:
        """Markdown: verdicts by model and tolerance, check against compare, and every case."""
        sorts = (
            "valid, true",
            "not valid, true",
            "false valid",
            "false invalid",
            "not valid like for like only",
            "on the edge",
            "not solved",
        )
        out = [
            "| model | tolerance | " + " | ".join(sorts) + " |",
            "| --- " * (len(sorts) + 2) + "|",
        ]
        keys = sorted(
            {k[:2] for k in self.counts if k[0] != "check"}, key=lambda k: (RUNGS.index(k[0]), k[1])
        )
        for model, tolerance in keys:
            out.append(
                f"| {model} | {100 * tolerance:g} % | "
                + " | ".join(str(self.counts[model, tolerance, s]) for s in sorts)
                + " |"
            )
        wrong, missed, of = (self.total(*k) for k in (sorts[2:3], sorts[3:4], sorts[:5]))
        trusted = rate(wrong, self.total(sorts[0], sorts[2]))
        out += ["", f"False valid: {rate(wrong, of)} of pairs, {trusted} of what was called valid."]
        out += [f"False invalid: {rate(missed, of)} of pairs."]
        out += ["", "| check of | agrees | uncertain | contradicts |", "| --- | --- | --- | --- |"]
        for model in dict.fromkeys(k[1] for k in self.counts if k[0] == "check"):
            out.append(
                f"| {model} | "
                + " | ".join(
                    str(self.counts["check", model, s])
                    for s in ("agree", "uncertain", "contradict")
                )
                + " |"
            )
        return [*out, "", f"### Cases: {len(self.cases)}", "", *(f"- {c}" for c in self.cases)]

    def total(self, *sorts: str) -> int:
        """Number of verdicts of some sorts."""
        return sum(n for key, n in self.counts.items() if key[0] != "check" and key[2] in sorts)
