"""Is a bearing's stiffness within its own interval? Random shafts, their resonances with noise, and
entries that begin away from the truth; also sets that no resonance can tell apart.
"""

from __future__ import annotations

import math
import tempfile
from pathlib import Path

import numpy as np

import solidgear as sg
from solidgear.core.errors import SolidgearError
from solidgear.measured.data import Measured
from solidgear.measured.identify import identify
from validation.campaign.case import Case, Run
from validation.campaign.rows import CLAIM, Found, Row

#: of the logarithm of a measured frequency, and of what a stiffness begins away from the truth
NOISE, AWAY = 1e-3, 0.3
#: shapes that are measured
SHAPES = 16
#: of every so many seeds one asks for what cannot be told
OPEN = 5
STIFFNESS = ("bearing.A.stiffness.kzz", "bearing.B.stiffness.kzz")
EVERY = (
    "material.E",
    "material.density",
    *(f"bearing.{name}.stiffness.k{motion}" for name in "AB" for motion in ("xx", "yy", "zz")),
)


class Identification(Case):
    """Intervals of 95 % of two stiffnesses; half of one is the bar of the logarithm of its entry.

    Where other values are told to fit as well, those nearest to the truth are judged, apart.
    """

    name, question = "identification", "intervals of identified bearing stiffness"
    parts = ((), ("answer",))
    seeds = (1, 250)

    def judge(self, run: Run, seed: int) -> Found:
        return run.found(f"seed {seed}", judged, seed)


def judged(seed: int) -> Found:
    """Errors of what is identified beside their intervals."""
    rng = np.random.default_rng([seed, 4])
    text, true = shaft(rng)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "shaft.toml"
        path.write_text(text.format(*true), encoding="utf-8")
        scene = sg.load(path)
        modes = sg.modes(sg.build(scene, "harmonic", order=4), scene, n=SHAPES).modes
        peaks = sorted(
            (mode.frequency_hz * math.exp(NOISE * rng.standard_normal()), mode.multiplicity)
            for mode in modes
            if mode.frequency_hz > 0
        )
        listed = [{"frequency": f, "multiplicity": count} for f, count in peaks]
        measured = Measured(uncertainty=NOISE, mode=listed)
        begun = [k * math.exp(rng.uniform(-AWAY, AWAY)) for k in true]
        path.write_text(text.format(*begun), encoding="utf-8")
        open_ = seed % OPEN == 0
        # E, density and all springs together leave every frequency as it is
        entries = EVERY if open_ else STIFFNESS
        try:
            found = identify(path, measured, entries, tol=1e-3)
        except SolidgearError as error:
            told = str(error)
            if open_ and "cannot separate" in told:
                return Found()
            return Found(problems=[f"seed {seed}: refused: {told}"])
    if open_:
        known = max(entry.deviation for entry in found.entries)
        told = f"seed {seed}: what cannot be told is told, deviation {known:.2g}"
        return Found(failures=[told])
    answers = [[entry.value for entry in found.entries], *found.alike]
    best = min(answers, key=lambda values: sum(abs(math.log(v / t)) for v, t in zip(values, true)))
    rows = [
        Row(
            body=f"seed {seed}",
            quantity=entry.path,
            tags={"answer": "one of several" if found.alike else "the only one"},
            bar=math.log(entry.high / entry.low) / 2,
            error=math.log(value / truth),
            how=f"{truth:.4g} N/m",
            rule=CLAIM,
        )
        for entry, value, truth in zip(found.entries, best, true)
    ]
    return Found(rows)


def shaft(rng: np.random.Generator) -> tuple[str, tuple[float, float]]:
    """A file of a shaft on two bearings with both stiffnesses left open, and their true values."""
    d = float(rng.uniform(0.02, 0.08))
    count = int(rng.integers(3, 6))
    lengths, sizes = d * rng.uniform(1.0, 3.0, count), d * rng.uniform(0.7, 1.4, count)
    segments = "\n".join(
        f'  {{{{ kind = "cylinder", name = "s{k}", length = {one:.6g}, diameter = {size:.6g} }}}},'
        for k, (one, size) in enumerate(zip(lengths, sizes))
    )
    width = 0.4 * d
    bearings = "\n".join(
        f'  {{{{ name = "{name}", position = 0, from = "s{k}.middle", seat_width = {width:.6g}, stiffness = '
        f"{{{{ kxx = {10 ** rng.uniform(7.5, 9):.4g}, kyy = 2e8, kzz = {{{slot}}} }}}} }}}},"
        for slot, (name, k) in enumerate((("A", 0), ("B", count - 1)))
    )
    text = (
        'material = {{ E = "207 GPa", nu = 0.3, density = "7850 kg/m^3" }}\n'
        f"segment = [\n{segments}\n]\nbearing = [\n{bearings}\n]\n"
        'port = {{ at = "s1.middle", attach_to = "s1" }}\n'
    )
    a, b = 10 ** rng.uniform(7.5, 9.0, 2)
    return text, (float(a), float(b))
