"""The overhung bevel pinion against another program's solution of the same scene."""

from __future__ import annotations

import json

import solidgear as sg
from solidgear.core.judge.quantities import measure
from solidgear.core.judge.ties import attached
from validation.common import ROOT
from validation.manual.case import Answer, Case, Model, Reference, references
from validation.manual.models import frequencies

SCENE = ROOT / "geometry" / "pinion_overhung.toml"
GEOMETRY = """
geometry/pinion_overhung.toml: pitch-cone head of 67 mm radius at the heel, 63 mm face width, 10 mm
backcone; solid shaft of 90 mm, 208 mm long, with a sharp shoulder.

      __
    /   |
   |    |___________________________
   |    |___________________________|
    \\   |      ^              ^
      ^^         bearing 1      bearing 2
   pinion
"""
MATERIAL = "E 207 GPa, Poisson's ratio 0.3, density 7850 kg/m^3."
SUPPORTS = (
    "Published 6x6 of two tapered roller bearings after Hua (2010), Table 1, a spring in series "
    "with the axial stiffness of the second; no housing spring."
)
#: the setting at which attachments and theories are compared: 1e-4 at the port
FINE = {"order": 4, "layers": 3, "edge_layers": 1, "ratio": 0.2}


# --------------------------------------------------------------------------- every model
#: name here -> name in the baselines of the tests, where the numbers are kept with their source
STIFFNESSES = {
    "K_zz": "stiffness[z,z]",
    "K_z,thx": "stiffness[z,thx]",
    "K_thx": "stiffness[thx,thx]",
    "K_yy": "stiffness[y,y]",
}
FREQUENCIES = {
    "bending 1": "frequency of bending 1",
    "bending 2": "frequency of bending 2",
    "bending 3": "frequency of bending 3",
    "axial 1": "frequency of axial 1",
}


def _baselines(file: str, key: str) -> dict[str, dict]:
    entries = json.loads((ROOT / "tests" / "baselines" / file).read_text())
    return {entry[key]: entry for entry in entries}


def _second_code() -> tuple[Reference, ...]:
    entries = _baselines("overhung_pinion_reference.json", "quantity")
    out = []
    for name, quantity in (STIFFNESSES | FREQUENCIES).items():
        entry = entries[quantity]
        value, unit, kind, source = (entry[k] for k in ("value", "unit", "kind", "source"))
        limits = "digits given; orders 6 to 10 agree"
        out.append(Reference(name, value, unit, kind, source, 4e-6, limits))
    return tuple(out)


def _pinion(fidelity: str, **options) -> Answer:
    scene = sg.load(SCENE)
    body = sg.build(scene, fidelity, **options)
    found = sg.modes(body, scene, n=9)
    values = measure(sg.condense(body, scene, scene.port.name), found)
    third = found.named("bending 3")
    if third:
        values["bending 3"] = third.frequency_hz
    return Answer(values, body.size)


def _tolerance(stiffness: float, frequency: float) -> dict[str, float]:
    return dict.fromkeys(STIFFNESSES, stiffness) | dict.fromkeys(FREQUENCIES, frequency)


def _known(*per_cent: float) -> dict[str, float]:
    return {q: p / 100 for q, p in zip(STIFFNESSES | FREQUENCIES, per_cent, strict=True)}


CORNER = "displacement elements are stiff, most at the sharp shoulder and the ends of the seats"

PINION = Case(
    name="overhung_pinion",
    title="Overhung pinion: every model against a second program",
    problem="Stiffness at the pinion and first modes of a stubby overhung pinion, where neither "
    "shear nor the shape of the head is small.",
    geometry=GEOMETRY,
    material=MATERIAL,
    supports=SUPPORTS + " Attachments averaged over the seats.",
    asked="Stiffness at the lumped point in the vertical plane and along the axis; three "
    "frequencies of bending and the first axial one.",
    references=_second_code(),
    models=(
        Model(
            "harmonic solid, order 5, three graded layers",
            lambda: _pinion("harmonic", order=5, layers=3, edge_layers=1, ratio=0.2),
            1e-4,
            "leaves 1e-5 to 1e-4 at the port and 1e-5 in frequency; largest found 6e-5, in tilt",
            3.0,
        ),
        Model(
            "harmonic solid, order 8, four graded layers",
            lambda: _pinion("harmonic", order=8, layers=4, edge_layers=2),
            1e-5,
            "about 1e-6 from the corners that are left, and the digits of the reference",
            30.0,
        ),
        Model(
            "harmonic solid, order 2",
            lambda: _pinion("harmonic", order=2),
            _tolerance(5e-3, 2e-3),
            CORNER + ": 0.3 % in tilt",
        ),
        Model(
            "3D solid, HEX20",
            lambda: _pinion("solid", element="hex20"),
            _tolerance(5e-3, 1e-3),
            CORNER + ": 0.3 % in tilt",
            10.0,
        ),
        Model(
            "3D solid, HEX27",
            lambda: _pinion("solid", element="hex27", size=0.0225, around=8, layers=3, ratio=0.4),
            _tolerance(8e-3, 2e-3),
            CORNER + ": 0.6 % in tilt",
            10.0,
        ),
        Model(
            "3D solid, TET10",
            lambda: _pinion("solid", element="tet10", size=0.025, graded_size=0.0055),
            _tolerance(1.5e-2, 3e-3),
            CORNER + ": 1.2 % in tilt; the mesh may change with the version of gmsh",
            10.0,
        ),
        Model(
            "Timoshenko beam",
            lambda: _pinion("timoshenko"),
            1e-3,
            "model form: sections stay plane, through the shoulder and in the head; the tolerance "
            "holds the digits of the known deviation",
            known=_known(16.40, 21.25, 23.07, 2.72, 3.89, 2.71, 5.02, 0.34),
        ),
        Model(
            "Euler beam",
            lambda: _pinion("euler"),
            1e-3,
            "model form: as the Timoshenko beam, and no shear",
            known=_known(79.91, 88.96, 72.46, 2.72, 23.18, 11.69, 25.28, 0.34),
        ),
    ),
)

# --------------------------------------------------------------------------- attachments
WIDTHS = (10, 20, 40)


def _ratio_name(width: int) -> str:
    return f"rigid over averaged, seats {width} mm"


def _second_code_ratios() -> tuple[Reference, ...]:
    entries = _baselines("attachments.json", "name")
    out = []
    for width in WIDTHS:
        entry = entries[f"overhung pinion, rigid over averaged bearings, seats {width} mm"]
        value = 1 + entry["value"] / 100
        limits = "a tenth of a per cent was given"
        kind, source = entry["kind"], entry["source"]
        out.append(Reference(_ratio_name(width), value, "1", kind, source, 5e-4, limits))
    return tuple(out)


def _attachments() -> Answer:
    values, size = {}, 0
    for width in WIDTHS:
        averaged = sg.load(SCENE).with_seat_width(width / 1000)
        found = []
        for scene in (attached(averaged, "rigid"), averaged):
            body = sg.build(scene, "harmonic", **FINE)
            found.append(frequencies(sg.modes(body, scene, n=6), "bending")[0])
            size = max(size, body.size)
        values[_ratio_name(width)] = found[0] / found[1]
    return Answer(values, size)


TIES = Case(
    name="pinion_seat_ties",
    title="Overhung pinion: rigid over averaged seats",
    problem="How a bearing is tied to its seat moves first bending more than beam against solid "
    "does.",
    geometry=GEOMETRY,
    material=MATERIAL,
    supports=SUPPORTS + " Seats rigid (RBE2) or averaged (RBE3), 10, 20 and 40 mm wide; the lumped "
    "point averaged in both.",
    asked="First frequency of bending with rigid seats over that with averaged ones.",
    references=_second_code_ratios(),
    models=(
        Model(
            "harmonic solid, order 4, three graded layers",
            _attachments,
            2e-3,
            "the digits given, and 0.1 % for the discretisation of either program",
            10.0,
        ),
    ),
)

# --------------------------------------------------------------------------- beam over solid
GAPS = {"bending 1": 1.027, "1 / C_zz": 1.060, "K_zz": 1.067}


def _beam_over_solid(kappa: str) -> Answer:
    scene = sg.load(SCENE).with_attachment("section")
    found = []
    for fidelity, options in (("timoshenko", {"kappa": kappa}), ("harmonic", FINE)):
        body = sg.build(scene, fidelity, **options)
        values = measure(sg.condense(body, scene, scene.port.name), sg.modes(body, scene, n=6))
        values["1 / C_zz"] = 1 / values["C_zz"]
        found.append((values, body.size))
    (beam, _), (solid, size) = found
    return Answer({q: beam[q] / solid[q] for q in GAPS}, size)


GAP = Case(
    name="pinion_beam_over_solid",
    title="Overhung pinion: Timoshenko beam over solid, like for like",
    problem="What is left between beam and solid when both are tied by the mean motion of "
    "cross-sections: the shoulder and the shape of the head.",
    geometry=GEOMETRY,
    material=MATERIAL,
    supports=SUPPORTS + " All stations tied by the mean motion of the cross-section.",
    asked="Beam over solid: first bending, lateral stiffness alone (the inverse of the compliance) "
    "and with tilt held (the entry of the stiffness matrix).",
    references=references(
        GAPS,
        "1",
        "cross_model",
        "the same comparison made with a second program, shear coefficient of Cowper (1966), "
        "J. Appl. Mech. 33, 335",
        5e-4,
        "a tenth of a per cent was given",
    ),
    models=(
        Model(
            "Cowper's coefficient",
            lambda: _beam_over_solid("cowper"),
            1e-3,
            "the digits given, and half of a tenth of a per cent for the solid",
            2.0,
        ),
        Model(
            "Hutchinson's coefficient",
            lambda: _beam_over_solid("hutchinson"),
            1e-3,
            "Hutchinson's coefficient is 4 % larger, so the beam is stiffer: by how much is known",
            2.0,
            known={"bending 1": 0.0035, "1 / C_zz": 0.0094, "K_zz": 0.0188},
        ),
    ),
)

CASES = (PINION, TIES, GAP)
