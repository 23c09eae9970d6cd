"""Do the bands of the solids hold the true errors? Hit rates, tightness, and every miss with what
it looks like.
"""

from __future__ import annotations

from collections import Counter, defaultdict

import numpy as np

from solidgear.judge.quantities import QUANTITIES
from validation.attack.judge import Band, band_of, called, rate


def judge_bands(row: dict, reference, model: str) -> list[Band]:
    """All bands of one model in one outcome."""
    found = row["models"].get(model)
    judged = [band_of(name, found, reference) for name in QUANTITIES] if found else []
    return [b for b in judged if b is not None]


def explained(band: Band, model: dict) -> tuple[str, str]:
    """What a missed band looks like, from the meshes behind it: a class, and the figures."""
    found = model["steps"].get(band.quantity) or {}
    three = found.get("values") or ()
    if "there called" in band.how:
        return "another mode by name", band.how
    if len(three) == 1:
        return "beyond the richer space", "by local problems on one mesh"
    if len(three) < 3:
        return "no sequence told", ""
    first, second = three[-2] - three[-3], three[-1] - three[-2]
    size = abs(three[-1]) or 1.0
    steps = f"steps {first / size:.1e}, {second / size:.1e}"
    if first * second < 0:
        return "the sequence turns", steps
    # a sequence that converges from one side has its error opposite to its steps
    if band.error * second > 0:
        return "the error has changed sign", f"the last value is beyond the truth; {steps}"
    if abs(second) > abs(first):
        return "steps grow", steps
    left = abs(band.error) / (abs(second) / size) if second else np.inf
    return (
        "slower than the order used",
        f"order {found.get('used_order') or 0:.2g}, "
        f"yet the error is {left:.2g} times the last step; {steps}",
    )


class BandTable:
    """Gathers bands by model, quantity and sort of ties."""

    def __init__(self):
        self.bands: dict[tuple[str, str, str], list[Band]] = defaultdict(list)
        self.misses: list[str] = []
        self.classes: Counter = Counter()

    def add(self, row: dict, traits: dict, reference, model: str, label: str | None = None) -> None:
        """All bands of one model in one outcome."""
        for band in judge_bands(row, reference, model):
            self.bands[label or model, band.quantity, traits["ties"]].append(band)
            if band.judged and not band.held:
                why, figures = explained(band, row["models"][model])
                self.classes[label or model, traits["ties"], why] += 1
                self.misses.append(
                    f"{called(row['seed'], traits)}, {label or model}, {band.quantity}: "
                    f"band {band.band:.1e}, error {band.error:+.1e} +- {band.doubt:.0e}: "
                    f"{why} ({figures})"
                )

    def lines(self) -> list[str]:
        """Markdown: a table per model by quantity, one by ties, and the misses."""
        out = []
        for model in dict.fromkeys(key[0] for key in self.bands):
            mine = {key[1:]: value for key, value in self.bands.items() if key[0] == model}
            out += [
                "",
                f"### {model}",
                "",
                "| quantity | held | band / error, median | 5 % | 95 % | largest band | left out |",
                "| --- | --- | --- | --- | --- | --- | --- |",
            ]
            names = [q for q in QUANTITIES if any(k[0] == q for k in mine)]
            out += [_line(q, [b for k, v in mine.items() if k[0] == q for b in v]) for q in names]
            out += [_line("**all**", [b for v in mine.values() for b in v])]
            out += [
                _line(f"ties {t}", [b for k, v in mine.items() if k[1] == t for b in v])
                for t in sorted({k[1] for k in mine})
            ]
        out += [
            "",
            f"### Misses: {len(self.misses)}",
            "",
            "| model | ties | what it looks like | misses |",
            "| --- | --- | --- | --- |",
        ]
        out += [
            f"| {model} | {ties} | {why} | {n} |"
            for (model, ties, why), n in self.classes.most_common()
        ]
        out += ["", *(f"- {m}" for m in self.misses)]
        return out

    def hits(self, model: str) -> tuple[int, int]:
        """Held and judged bands of a model."""
        judged = [b for key, v in self.bands.items() if key[0] == model for b in v if b.judged]
        return sum(b.held for b in judged), len(judged)


def _line(name: str, bands: list[Band]) -> str:
    judged = [b for b in bands if b.judged]
    if not judged:
        return f"| {name} | none judged | | | | | {len(bands)} |"
    ratio = [b.band / abs(b.error) for b in judged]
    low, middle, high = np.quantile(ratio, [0.05, 0.5, 0.95])
    held = rate(sum(b.held for b in judged), len(judged))
    largest, left_out = max(b.band for b in judged), len(bands) - len(judged)
    ratios = f"{middle:.3g} | {low:.3g} | {high:.3g}"
    return f"| {name} | {held} | {ratios} | {largest:.1e} | {left_out} |"
