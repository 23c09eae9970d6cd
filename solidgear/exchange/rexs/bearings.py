"""Bearings of a REXS document: by stiffness, by their inside, by designation, or rigid."""

from __future__ import annotations

import re
from typing import Any

import numpy as np

from solidgear.bearings.catalogue import CLASSES
from solidgear.bearings.designation import Boundary, boundary
from solidgear.bearings.kinds import SHARES
from solidgear.core import SceneError
from solidgear.core.scene.bearing_stiffness import stiffness_entries
from solidgear.core.scene.support import RIGID
from solidgear.exchange.rexs.commented import Sourced, deg, mm, said
from solidgear.exchange.rexs.document import Component, Document
from solidgear.exchange.rexs.notes import Notes
from solidgear.exchange.rexs.shafts import Shaft
from solidgear.exchange.rexs.units import MOTIONS

#: N m/rad from there on stands for rigid: E d^3 of a steel shaft of 0.1 m is 2e8 N m/rad
RIGID_TURN = 1e13
ROLLING = ("rolling_bearing_with_catalog_geometry", "rolling_bearing_with_detailed_geometry")
KINDS = {
    "radial_grooved_ball_bearing": "deep_groove",
    "angular_contact_ball_bearing": "angular_contact",
    "radial_roller_bearing": "cylindrical",
    "radial_tapered_roller_bearing": "tapered",
    "radial_needle_roller_bearing": "needle",
    "radial_self_aligning_roller_bearing": "spherical",
    "axial_grooved_ball_bearing": "thrust_ball",
}
#: kinds that hold the shaft one way, and those that carry nothing along it
ONE_WAY, FLOATING = ("angular_contact", "tapered", "thrust_ball"), ("cylindrical", "needle")
BALLS = tuple(kind for kind, shares in SHARES.items() if shares.elements == "balls")
BOTH_WAYS = "held both ways along the shaft, where the file says one way"
#: relative difference of sizes that are the same
SAME = 1e-3
#: width over bore of a bearing whose width nothing says: of ISO 15, series 02, 0.6 at 25 mm and 0.34
#: at 100 mm
USUAL_WIDTH = 0.4
#: places of u, v, w and their turns among x, y, z
_ENTRY_WORDS = {motion: k for k, motion in enumerate(("u", "v", "w", "u_rot", "v_rot", "w_rot"))}


#: words of axial_force_absorption
ABSORBS = ("both_directions", "no_direction", "positive", "negative")


def absorbed(bearing: Component, notes: Notes) -> str:
    """Return the direction along the shaft in which a bearing takes force; empty where none is said."""
    word = bearing.text("axial_force_absorption").lower()
    if word in ("true", "false"):
        # some writers of 1.4 put false at every bearing, and shafts would be free along their axes
        notes.doubt(bearing, f"axial_force_absorption {word} is no word of REXS: both directions")
        return ABSORBS[0]
    if word and word not in ABSORBS:
        raise bearing.wrong("axial_force_absorption", f"REXS has {', '.join(ABSORBS)}")
    return word


def bearing_table(
    document: Document, bearing: Component, shaft: Shaft, y: float, notes: Notes
) -> dict[str, Any]:
    """Return the table of a bearing at a place y (m) of a shaft, without its name and its place."""
    label = bearing.label
    if (entries := _operating_stiffness(bearing, shaft)) is not None:
        values = {k: said(v, _unit(k)) for k, v in entries.items()}
        source = f"{label}: stiffness at its operating point"
        return {"stiffness": Sourced(values, source), "status": "calculated"}
    radial = bearing.number("radial_stiffness")
    is_rolling = bearing.kind in ROLLING
    if radial is not None and 0 < radial < RIGID or not is_rolling:
        return _given(bearing, radial, notes)
    catalogue = _catalogue(document, bearing, shaft, y, notes)
    if catalogue is None:
        notes.ask(
            f"sizes and inside of {bearing.title}, whose designation is not known here: until then it "
            "is rigid"
        )
        return _given(bearing, radial, notes)
    if radial is not None and radial >= RIGID:
        notes.doubt(
            bearing,
            f"radial_stiffness {radial:.3g} N/m, which stands for rigid, beside catalogue data: these "
            "give the stiffness",
        )
    table: dict[str, Any] = {}
    if absorbed(bearing, notes) == "no_direction" and kind_of(bearing) not in FLOATING + ONE_WAY:
        table["support"] = Sourced("floating", "axial_force_absorption: no_direction")
    return {**table, "catalogue": catalogue}


def width_of(bearing: Component, shaft: Shaft, y: float, notes: Notes) -> tuple[float, str]:
    """Return the width of a bearing, m, and where it came from."""
    width = bearing.number("width")
    if width:
        return width, f"{bearing.label}: width"
    standard, designation = standard_of(bearing)
    if standard is not None:
        return standard.width, f"width of {designation}"
    seat = shaft.seat(y, shaft.length / 1000)
    width = USUAL_WIDTH * shaft.mean_outer(*(seat or (0.0, shaft.length)))
    notes.assume(bearing, f"as wide as {USUAL_WIDTH:g} of the shaft's diameter")
    return width, f"assumed: {USUAL_WIDTH:g} of the diameter"


def standard_of(bearing: Component) -> tuple[Boundary | None, str]:
    """Return the standard sizes of a designation, and the part of it that is known; None for one that
    is not known here.
    """
    text = bearing.text("catalogue_designation") if bearing.kind in ROLLING else ""
    basic = re.match(r"\s*([A-Za-z]*)[\s-]*(\d{2,6})", text)
    for designation in (text, f"{basic[1]} {basic[2]}".strip() if basic else ""):
        if not designation:
            continue
        try:
            standard = boundary(designation)
        except SceneError:
            continue
        # of a tapered bore no file says what clearance is left
        if not standard.tapered_bore:
            return standard, designation
    return None, text


def kind_of(bearing: Component) -> str:
    """Return the kind of a rolling bearing by its type, or its designation; empty where unknown."""
    standard, _ = standard_of(bearing)
    kind = KINDS.get(bearing.text("bearing_type"), "")
    return kind or (standard.kind if standard is not None else "")


def _unit(entry: str) -> str:
    if "_" in entry:
        return "N/rad" if not entry.startswith("kth") else "N*m/rad"
    return "N*m/rad" if entry.startswith("kth") else "N/m"


def _given(bearing: Component, radial: float | None, notes: Notes) -> dict[str, Any]:
    """Return the table of a bearing by stiffness; where a direction is absorbed and none is given, it
    is rigid.
    """
    entries: dict[str, str] = {}
    absorbs = absorbed(bearing, notes) or "both_directions"
    rigid = []
    if bearing.flag("radial_force_absorption") is not False:
        stiffness = RIGID if radial is None else min(radial, RIGID)
        rigid += ["across"] * (stiffness >= RIGID)
        if stiffness:
            entries["kxx"] = entries["kzz"] = said(stiffness, "N/m")
    axial = bearing.number("axial_stiffness")
    if absorbs != "no_direction":
        # 0 beside an absorbed direction is no spring, and a rigid bearing elsewhere in such files
        stiffness = min(axial, RIGID) if axial else RIGID
        rigid += ["along"] * (stiffness >= RIGID)
        entries["kyy"] = said(stiffness, "N/m")
        if absorbs in ("positive", "negative"):
            notes.assume(bearing, BOTH_WAYS)
    bending = bearing.number("bending_stiffness")
    if bending is None and bearing.kind not in ROLLING:
        notes.assume(bearing, "no bending_stiffness is given: it does not hold the shaft in tilt")
    tilting = min(bending or 0.0, RIGID_TURN)
    if tilting:
        entries["kthx"] = entries["kthz"] = said(tilting, "N*m/rad")
    if rigid:
        notes.assume(bearing, f"rigid {' and '.join(rigid)} the shaft: {RIGID:g} N/m")
    if not entries:
        notes.doubt(bearing, "absorbs nothing; it is kept as a station without stiffness")
    source = f"{bearing.label}: radial_stiffness, axial_stiffness, bending_stiffness"
    return {"stiffness": Sourced(entries, source)}


def _operating_stiffness(bearing: Component, shaft: Shaft) -> dict[str, float] | None:
    """Return the stiffness at an operating point by entries of a file; None where the file has none."""
    K = np.zeros((6, 6))
    for load in MOTIONS:
        for motion in MOTIONS:
            kind = f"m_{load[0]}" if load.endswith("rot") else f"f_{load}"
            turn = f"rot_{motion[0]}" if motion.endswith("rot") else f"d_{motion}"
            number = bearing.number(f"operating_point_stiffness_{kind}_{turn}")
            K[_ENTRY_WORDS[load], _ENTRY_WORDS[motion]] = number or 0.0
    diagonal = np.abs(np.diag(K))
    if not 0 < max(diagonal[1:3]) < RIGID:
        return None
    # programs give it with the sign of the bearing's force, or of the force on it
    if K[1, 1] + K[2, 2] < 0:
        K = -K
    turned = np.kron(np.eye(2), shaft.turn)
    K = turned @ ((K + K.T) / 2) @ turned.T
    return stiffness_entries(K)


def _catalogue(
    document: Document, bearing: Component, shaft: Shaft, y: float, notes: Notes
) -> dict[str, Any] | None:
    """Return the catalogue data of a rolling bearing; None where its kind or sizes are not known."""
    standard, designation = standard_of(bearing)
    kind = kind_of(bearing)
    file_sizes = [bearing.number(k) for k in ("inner_diameter", "outer_diameter", "width")]
    label, table = bearing.label, {}
    if standard is not None and kind == standard.kind and _fits(standard, file_sizes):
        text = bearing.text("catalogue_designation")
        source = f"{label}: catalogue_designation"
        source += f" {text}" if designation != text else ""
        table["designation"] = Sourced(designation, source)
    elif kind and all(file_sizes):
        if standard is not None:
            notes.doubt(
                bearing, f"is no {designation} by its type or sizes; those of the file hold"
            )
        table["kind"] = Sourced(kind, f"{label}: bearing_type")
        for key, size in zip(("bore", "outer_diameter", "width"), file_sizes):
            table[key] = Sourced(mm(size or 0.0), label)
    else:
        return None
    ratings = (
        ("load_rating", "radial_dynamic_load_rating"),
        ("static_rating", "radial_static_load_rating"),
        ("fatigue_limit", "fatigue_limit_load"),
    )
    for key, name in ratings:
        if kind == "thrust_ball":
            name = name.replace("radial", "axial")
        if value := bearing.number(name):
            table[key] = Sourced(said(value, "kN", 1e3), f"{label}: {name}")
    table |= _clearance(bearing, kind, notes, is_ours=document.is_ours)
    table |= _inside(document, bearing, kind, notes)
    if kind in ONE_WAY:
        table |= _one_way(bearing, shaft, y, notes)
    elif kind == "cylindrical":
        table |= _ribs(bearing, shaft, y, notes)
    elif kind in FLOATING and absorbed(bearing, notes) not in ("", "no_direction"):
        notes.assume(bearing, "carries nothing along the shaft, where the file says it does")
    elif absorbed(bearing, notes) in ("positive", "negative"):
        notes.assume(bearing, BOTH_WAYS)
    return table


def _ribs(bearing: Component, shaft: Shaft, y: float, notes: Notes) -> dict[str, Any]:
    """Return how ribs of cylindrical rollers hold the shaft, where the file says so."""
    word = absorbed(bearing, notes)
    ways = {"positive": "one way", "negative": "one way", "both_directions": "both ways"}
    if not word:
        return {}
    ribs = Sourced(ways.get(word, "none"), f"{bearing.label}: axial_force_absorption")
    holds = _one_way(bearing, shaft, y, notes) if word in ("positive", "negative") else {}
    return {"ribs": ribs, **holds}


def _fits(standard: Boundary, sizes: list[float | None]) -> bool:
    pairs = zip(sizes, (standard.bore, standard.outer_diameter, standard.width))
    return all(size is None or abs(size - due) <= SAME * due for size, due in pairs)


def _clearance(bearing: Component, kind: str, notes: Notes, is_ours: bool) -> dict[str, Any]:
    """Return the clearance of a bearing; none written by another program says nothing."""
    if kind == "thrust_ball":
        return {}
    for name in ("mounted_radial_bearing_clearance", "radial_bearing_clearance"):
        clearance = bearing.number(name)
        if clearance or (is_ours and clearance is not None):
            return {"clearance": Sourced(said(clearance, "um", 1e-6), f"{bearing.label}: {name}")}
    word = bearing.text("radial_clearance_class").replace("C0", "CN")
    if word in CLASSES:
        return {"clearance": Sourced(word, f"{bearing.label}: radial_clearance_class")}
    if word:
        notes.drop(bearing, f"clearance class {word}, which has no table here: no clearance")
    return {}


def _inside(document: Document, bearing: Component, kind: str, notes: Notes) -> dict[str, Any]:
    """Return the inner dimensions that rows and rolling elements give."""
    rows = document.parts_of(bearing, "rolling_bearing_row")
    if not rows:
        return {}
    row, out = rows[0], {}
    elements = document.parts_of(row, "rolling_element")
    count = row.whole("number_of_rolling_elements") or len(elements)
    diameter = elements[0].number("diameter_of_rolling_element") if elements else None
    pitch = row.number("reference_diameter_rolling_bearing")
    if count:
        out["elements"] = Sourced(count, f"{row.label}: number_of_rolling_elements")
    if diameter:
        source = f"{elements[0].label}: diameter_of_rolling_element"
        out["element_diameter"] = Sourced(mm(diameter), source)
    if pitch:
        out["pitch_diameter"] = Sourced(mm(pitch), f"{row.label}: reference diameter")
    if (
        kind not in BALLS
        and elements
        and (length := elements[0].number("length_of_rolling_element"))
    ):
        out["element_length"] = Sourced(
            mm(length), f"{elements[0].label}: length_of_rolling_element"
        )
    angle = row.number("pressure_angle")
    if angle and SHARES[kind].angled:
        out["contact_angle"] = Sourced(deg(abs(angle)), f"{row.label}: pressure_angle")
    grooves = [row.number(f"raceway_radius_of_{ring}_ring") for ring in ("inner", "outer")]
    if kind in BALLS and diameter and all(grooves):
        ratios = [round((groove or 0.0) / diameter, 6) for groove in grooves]
        if all(0.5 < ratio <= 0.6 for ratio in ratios):
            out["conformity"] = Sourced(ratios, f"{row.label}: raceway radii over the diameter")
        else:
            notes.doubt(row, f"raceway radii of {ratios} ball diameters; the usual ones are taken")
    return out


def _one_way(bearing: Component, shaft: Shaft, y: float, notes: Notes) -> dict[str, Any]:
    """Return which way a bearing with a contact angle holds the shaft, and its preload."""
    word = absorbed(bearing, notes)
    out: dict[str, Any] = {}
    kind = bearing.text("bearing_type")
    if (bearing.whole("number_of_bearing_rows") or 1) > 1 and "axial" not in kind:
        out["arrangement"] = Sourced("back_to_back", f"{bearing.label}: two rows")
        if distance := bearing.number("distance_between_bearing_rows"):
            out["row_distance"] = Sourced(mm(distance), f"{bearing.label}: distance of rows")
        notes.assume(bearing, "two rows, back to back")
    elif word in ("positive", "negative"):
        towards = "+y" if (word == "positive") == (shaft.sign > 0) else "-y"
        out["holds"] = Sourced(towards, f"{bearing.label}: axial_force_absorption {word}")
    else:
        towards = "+y" if y > shaft.length / 2 else "-y"
        out["holds"] = Sourced(towards, "assumed: towards the nearer end of the shaft")
        notes.doubt(
            bearing,
            f"one row of this kind holds the shaft one way, and axial_force_absorption is "
            f"{word or 'missing'}: it holds towards the nearer end",
        )
    force, distance = bearing.number("preload_force"), bearing.number("preload_distance")
    if force:
        out["preload"] = Sourced(said(abs(force), "N"), f"{bearing.label}: preload_force")
    elif distance:
        out["preload"] = Sourced(
            said(abs(distance), "um", 1e-6), f"{bearing.label}: preload_distance"
        )
    return out
