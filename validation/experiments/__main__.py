"""Measured resonances of free solids against the harmonic solid, and of blocks
against the 3D solid: `python -m validation.experiments`.

Two numbers of each body are identified, E and Poisson's ratio. What tells is how well all resonances
follow from them, how well each follows from all others, and, where some were kept back, how well
those were foretold. Predictions stay in `*_predicted.csv` as they were written before they were
compared with anything.
"""

from __future__ import annotations

import re
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

import solidgear as sg
from solidgear.core.scene.file import scene_of
from solidgear.measured.data import load_measured
from solidgear.measured.identify import Identification, identify
from solidgear.show.words import percent

HERE = Path(__file__).parent
PAGE = HERE.parents[1] / "docs" / "validation" / "experiments.md"
ENTRIES = ("material.E", "material.nu")
BODIES = (
    "steel_cylinder",
    "aluminium_rod",
    "macor_cylinder",
    "aluminium_block",
    "titanium_block",
)
#: relative, of the length of the steel cylinder, to see what that does
CHANGE = 1e-3
#: modes that were kept back, of which a prediction is filed
KEPT_BACK = {"steel_cylinder": 20, "aluminium_block": 20, "titanium_block": 20}
BEAMS = ("euler", "timoshenko")
#: meshes of the 3D solid, and shapes that are compared
SOLIDS: dict[str, dict[str, Any]] = {
    "default: hexahedra, 12 around": {},
    "hexahedra, 24 around": {"around": 24},
    "tetrahedra": {"element": "tet10"},
}
COMPARED = 38


def main() -> None:
    """Write the page, and predictions that are not there yet."""
    rows, found = [], {}
    for name in BODIES:
        measured = load_measured(HERE / f"{name}.csv")
        one = identify(HERE / f"{name}.toml", measured, ENTRIES, predict=KEPT_BACK.get(name, 0))
        found[name] = one
        rows.append(_row(name, one))
        _file(name, one)
    text = PAGE_TEXT.format(
        table="\n".join(rows),
        longer=percent(_with_length(1 + CHANGE), False),
        shorter=percent(_with_length(1 - CHANGE), False),
        beams="\n".join(_beams(found["aluminium_rod"])),
        solids="\n".join(_solids()),
        predicted=KEPT_BACK["steel_cylinder"],
        doubtful=" and ".join(f"{_doubtful(found[name])}" for name in BODIES[-2:]),
    )
    PAGE.write_text(text, encoding="utf-8")
    print(text)


def _row(name: str, one: Identification) -> str:
    worst = max((abs(f.computed / f.measured - 1), f.name) for f in one.fitted)
    numbers = [
        f"{one['material.E'].value / 1e9:.1f} GPa ± {percent(one['material.E'].deviation, False)}",
        f"{one['material.nu'].value:.4f} ± {percent(one['material.nu'].deviation, False)}",
    ]
    told = [percent(one.rms, False), percent(one.rms_left_out, False)]
    last = f"{percent(worst[0], False)}, {worst[1]}"
    return f"| {one.scene} | {len(one.fitted)} | {' | '.join(numbers + told)} | {last} |"


def _doubtful(one: Identification) -> str:
    """Resonances without a sure mode, of all."""
    return f"{len(one.unpaired)} of {len(one.unpaired) + len(one.fitted)}"


def _file(name: str, one: Identification) -> None:
    """File predictions, once."""
    path = HERE / f"{name}_predicted.csv"
    if one.predicted and not path.exists():
        lines = [
            f"{p.name},{p.multiplicity},{p.frequency_hz:.1f},{p.deviation_hz:.1f}"
            for p in one.predicted
        ]
        head = "mode,shapes,frequency [Hz],standard deviation [Hz]"
        path.write_text("\n".join([head, *lines]) + "\n", encoding="utf-8")


def _with_length(factor: float) -> float:
    """Rms of the fit of the steel cylinder where its length is a little wrong."""
    text = (HERE / "steel_cylinder.toml").read_text(encoding="utf-8")
    length = re.search(r'length = "([\d.]+) mm"', text)
    assert length is not None
    changed = text.replace(length[1], f"{float(length[1]) * factor:.8g}")
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "changed.toml"
        path.write_text(changed, encoding="utf-8")
        return identify(path, load_measured(HERE / "steel_cylinder.csv"), ENTRIES).rms


def _solids() -> list[str]:
    """Rows of meshes of the 3D solid beside the harmonic one, shape by shape in ascending order."""
    scene = sg.load(HERE / "steel_cylinder.toml")

    def listed(model: str, **options: Any) -> tuple[int, np.ndarray]:
        body = sg.build(scene, model, **options)
        modes = sg.modes(body, scene, n=COMPARED + 2).modes
        each = [[m.frequency_hz] * m.multiplicity for m in modes if m.frequency_hz > 0]
        return body.size, np.sort(np.concatenate(each))[:COMPARED]

    _, exact = listed("harmonic", order=7)
    rows = []
    for words, options in SOLIDS.items():
        size, hertz = listed("solid", **options)
        off = hertz / exact - 1
        told = percent(float(np.sqrt(np.mean(off**2))), False), percent(float(off.max()), False)
        rows.append(f"| {words} | {size} | {' | '.join(told)} |")
    return rows


def _beams(one: Identification) -> list[str]:
    """Rows of beams beside the harmonic solid, of modes that all have."""
    scene = scene_of(dict(one.tables), str(HERE / "aluminium_rod.toml"))
    hertz = {}
    for model in BEAMS:
        modes = sg.modes(sg.build(scene, model), scene, n=40).modes
        hertz[model] = {str(mode.name): mode.frequency_hz for mode in modes}
    rows = []
    for fit in one.fitted:
        off = [fit.computed / fit.measured - 1]
        off = [hertz[model].get(fit.name, np.nan) / fit.measured - 1 for model in BEAMS] + off
        rows.append(f"| {fit.name} | {fit.measured:.0f} | {' | '.join(map(percent, off))} |")
    return rows


PAGE_TEXT = """# Measured bodies

Free vibration of solids is validated against measured resonances, by `python -m validation.experiments`. Bearing stiffness, seats, keyways, teeth and trains are not.

Of each body E and Poisson's ratio are identified from its resonances. *Left out*: each resonance predicted from all others.

| body | resonances | E | nu | fit, rms | left out, rms | worst |
| --- | --- | --- | --- | --- | --- | --- |
{table}

Dimensions are as their sources print them; of the steel cylinder a length 0.1 % longer would leave a fit of {longer} rms, one 0.1 % shorter {shorter}.

Of the steel cylinder and of both blocks the lower half of the measured resonances was fitted. The {predicted} modes above the highest fitted one were predicted, with standard deviations, before any comparison: `validation/experiments/*_predicted.csv`.

Resonances whose mode is not sure are left out: of the blocks {doubtful}, whose neighbours lie too near to tell which is which. Of a block nothing is assumed but its edges and density.

## Beams beside the solid

The aluminium rod is 2.8 diameters long. With E and nu as identified, computed over measured:

| mode | measured, Hz | Euler | Timoshenko | harmonic solid |
| --- | --- | --- | --- | --- |
{beams}

## 3D solid beside the harmonic solid

The steel cylinder as its file says, its lowest 38 shapes in ascending order; all frequencies of the 3D solid lie above.

| mesh | unknowns | off, rms | off, worst |
| --- | --- | --- | --- |
{solids}

Worst is n = 4, of which twelve cells around leave three to a wave. `modes -f solid` shows error bars by one order more; `correlate` and `-f auto` take the harmonic solid.

Sources: steel cylinder, dimensions and mass as measured with the resonances; aluminium rod, B. Zadler and J. H. L. Le Rousseau, Installation and Help Guide to Fitspectra and RUS-inverse, Table 3.1; Macor, B. Zadler, J. H. L. Le Rousseau, J. A. Scales and M. L. Smith, Geophys. J. Int. 156 (2004) 154, section 10.1. Aluminium and Ti-6Al-4V blocks, dimensions and density as measured with the resonances. Numbers are cited as facts.
"""


if __name__ == "__main__":
    main()
