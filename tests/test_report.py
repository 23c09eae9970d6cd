"""The report says everything the run found, escapes what it was given, and survives a run that
broke off.
"""

from __future__ import annotations

import copy
import io
import math
import re
from pathlib import Path

import numpy as np
import pytest
from rich.console import Console

import solidgear as sg
from solidgear.errors import SolidgearError
from solidgear.evidence.record import SCHEMA, Record
from solidgear.evidence.recording import recorded
from solidgear.report import charts
from solidgear.report.html import render_page, write_report
from solidgear.report.terminal import (
    final_table,
    matrix_table,
    modes_table,
    verdict_text,
)
from solidgear.report.words import engineering, hertz, percent

ROOT = Path(__file__).parent.parent
LOOKS = {
    "euler": ("Euler beam", "Euler", "beam", "#c98a00", "v"),
    "timoshenko": ("Timoshenko beam", "Timoshenko", "beam", "#0072b2", "s"),
    "harmonic": ("harmonic solid", "harmonic", "solid", "#00805e", "o"),
    "solid": ("3D solid", "", "solid", "#5a3e8c", "D"),
}
LOOKS = {
    key: dict(zip(("title", "short", "family", "colour", "marker"), look))
    for key, look in LOOKS.items()
}
#: quantities of causes and attachments
SHOWN = ("C_zz", "K_zz", "bending 1")
ORDER = ["x", "y", "z", "thx", "thy", "thz"]
#: K_zz, K_yy, K_z,thx, K_thx
STIFFNESS = {
    "euler": (7.32787443e9, 1.15632925e9, 3.78053273e8, 2.74390076e7),
    "timoshenko": (4.16590093e9, 1.15632925e9, 2.14322871e8, 1.84884606e7),
    "harmonic": (4.71078133e9, 1.13637271e9, 2.40131356e8, 1.90104307e7),
    "solid": (4.71542048e9, 1.13654552e9, 2.40524864e8, 1.90501559e7),
}
FREQUENCY = {
    "euler": {
        "rigid torsion": 0.0,
        "axial 1": 1388.0674,
        "bending 1": 3343.8930,
        "bending 2": 4482.2185,
        "torsion 1": 4956.7916,
        "axial 2": 8790.0971,
    },
    "timoshenko": {
        "rigid torsion": 0.0,
        "axial 1": 1388.0674,
        "bending 1": 2782.7973,
        "bending 2": 4010.6014,
        "torsion 1": 4956.7916,
        "bending 3": 8369.6690,
        "axial 2": 8790.0971,
    },
    "harmonic": {
        "rigid torsion": 0.0,
        "axial 1": 1385.6329,
        "bending 1": 2758.0902,
        "bending 2": 4038.3145,
        "torsion 1": 4843.6107,
        "bending 3": 8148.8623,
        "axial 2": 8554.7405,
    },
    "solid": {
        "rigid torsion": 0.0,
        "axial 1": 1385.6497,
        "bending 1": 2759.0611,
        "bending 2": 4038.8256,
        "torsion 1": 4843.8043,
        "bending 3": 8152.6586,
        "axial 2": 8556.2716,
    },
}
TIES = {  # C_zz, K_zz, first bending
    "harmonic": {
        "average": (5.96108061e-10, 4.71078133e9, 2758.0902),
        "rigid": (4.75605924e-10, 5.41550793e9, 3083.5360),
        "section": (6.36272457e-10, 3.83362651e9, 2700.0471),
    },
    "solid": {
        "average": (5.9574025e-10, 4.71542048e9, 2759.0611),
        "rigid": (4.73333976e-10, 5.4323382e9, 3091.2683),
        "section": (6.35902625e-10, 3.83989742e9, 2700.8633),
    },
}


def _six(zz, yy, coupling, turn):
    k = np.diag([zz, yy, zz, turn, 0.0, turn])
    k[2, 3] = k[3, 2] = coupling
    k[0, 5] = k[5, 0] = -coupling
    k[0, 1] = k[1, 0] = 53.93  # a weak coupling of the bearing data
    keep = [0, 1, 2, 3, 5]
    c = np.full((6, 6), np.nan)
    c[np.ix_(keep, keep)] = np.linalg.inv(k[np.ix_(keep, keep)])
    return k.tolist(), [[None if math.isnan(v) else v for v in row] for row in c.tolist()]


def _scene():
    steel = {"E": 2.07e11, "nu": 0.3, "density": 7850.0}
    head, back, end = 0.05824528977, 0.06824528977, 0.27624528977

    def segment(name, part, y0, y1, outer0, outer1):
        return {
            "name": name,
            "part": part,
            "y0": y0,
            "y1": y1,
            "length": y1 - y0,
            "outer0": outer0,
            "outer1": outer1,
            "inner0": 0.0,
            "inner1": 0.0,
            "material": steel,
        }

    def bearing(name, y, status, *k):
        return {
            "name": name,
            "y": y,
            "lo": y - 0.02,
            "hi": y + 0.02,
            "seat_width": 0.04,
            "attachment": "average",
            "status": status,
            "note": "Seat width assumed.",
            "stiffness": _six(*k)[0],
        }

    return {
        "name": "pinion_overhung",
        "title": "Overhung pinion on two bearings",
        "source": "Hua (2010), Table 1",
        "length": end,
        "steps": [back],
        "material": steel,
        "housing_axial": None,
        "segments": [
            segment("head", "frustum", 0.0, head, 0.04298987256, 0.067),
            segment("head.backcone", "backcone", head, back, 0.067, 0.067),
            segment("shaft", "shaft", back, end, 0.045, 0.045),
        ],
        "bearings": [
            bearing("1", back + 0.028, "published", 8.823e9, 8.887e8, -1.452e8, 3.856e6),
            bearing("2", back + 0.178, "identified", 8.599e9, 3.311e8, 1.521e8, 3.6e6),
        ],
        "port": {"name": "pinion", "y": head / 2, "lo": 0.0, "hi": head, "attachment": "average"},
        "ask": {"modes": 10, "max_frequency": 1e4, "tolerance": 0.05},
    }


def _estimate(limit, gci, observed):
    return {
        "observed_order": observed,
        "expected_order": 1.09,
        "ratio": [1.41, 1.40],
        "extrapolated": limit,
        "gci": gci,
        "factor": 1.25,
        "asymptotic": True,
    }


def fixture_results():
    """A made-up run: the size of its figures is right, but no test may take a figure from here for
    a result.
    """
    models = {}
    facts = {
        "euler": (270, 0.31, 290.0),
        "timoshenko": (270, 0.26, 292.0),
        "harmonic": (21846, 4.1, 410.0),
        "solid": (138210, 35.3, 2610.0),
    }
    for key, k in STIFFNESS.items():
        stiffness, compliance = _six(*k)
        beam = key in ("euler", "timoshenko")
        c = compliance[2][2]
        levels = (
            []
            if beam
            else [
                {
                    "dofs": int(facts[key][0] / r**2),
                    "h": 0.004 * r,
                    "quantities": {
                        "C_zz": c * (1 + s * 4e-4 * r**1.9),
                        "bending 1": FREQUENCY[key]["bending 1"] * (1 + 2e-4 * r**1.9),
                    },
                }
                for r, s in ((1.97, -1), (1.4, -1), (1.0, -1))
            ]
        )
        dofs, total, peak = facts[key]
        models[key] = {
            **LOOKS[key],
            "valid": key != "euler",
            "why_not": "shear: the shaft is stubby (overhang over diameter 1.1), and Euler leaves shear out"
            if key == "euler"
            else None,
            "stiffness": stiffness,
            "compliance": compliance,
            "modes": [
                {
                    "name": n,
                    "family": n.replace("rigid ", "").split()[0],
                    "frequency_hz": f,
                    "multiplicity": 2 if "bending" in n else 1,
                }
                for n, f in FREQUENCY[key].items()
            ],
            "band": None
            if beam
            else {
                "compliance": 0.0012 if key == "solid" else 0.0007,
                "method": "GCI on three meshes",
                "each": {"bending 1": 0.0005},
            },
            "convergence": None
            if beam
            else {
                "levels": levels,
                "quantities": {
                    "C_zz": _estimate(c * (1 + 1e-4), 0.0012, 1.92),
                    "bending 1": _estimate(FREQUENCY[key]["bending 1"] * 0.9999, 0.0005, 1.87),
                },
            },
            "dofs": dofs,
            "seconds": {
                "build": 0.3 * total,
                "statics": 0.2 * total,
                "modes": 0.2 * total,
                "band": 0.3 * total,
                "total": total,
            },
            "peak_mb": peak,
            "backend": "superlu",
            "mesh": {
                "elements": dofs // 6,
                "element": "beam" if beam else "HEX27",
                "min_detj_ratio": 0.31,
            },
            "evidence": {
                "asymmetry": 3.1e-14,
                "rigid_residual": 2.2e-12,
                "modal_residual": 4.4e-11,
                "orthogonality": 8.5e-13,
                "rigid_modes": 1,
            },
        }
    deviations = []

    def deviate(model, attachment, band, mine, theirs):
        for quantity, unit, n in (("bending 1", "Hz", 2), ("C_zz", "m/N", 0), ("K_zz", "N/m", 1)):
            value, ref = mine[n], theirs[n]
            relative = value / ref - 1
            deviations.append(
                {
                    "model": model,
                    "reference": "harmonic",
                    "attachment": attachment,
                    "quantity": quantity,
                    "unit": unit,
                    "value": value,
                    "reference_value": ref,
                    "relative": relative,
                    "band": band,
                    "verdict": "resolved" if abs(relative) > band else "not resolved",
                }
            )

    average, section = TIES["harmonic"]["average"], TIES["harmonic"]["section"]
    for beam, c in (("euler", 4.71903934e-10), ("timoshenko", 5.94736655e-10)):
        mine = (c, STIFFNESS[beam][0], FREQUENCY[beam]["bending 1"])
        deviate(beam, "as scene", 0.0007, mine, average)
        deviate(beam, "section", 0.0007, mine, section)
    deviate("solid", "as scene", 0.0012, TIES["solid"]["average"], average)
    names = [n for n in FREQUENCY["harmonic"] if "rigid" not in n]
    square = [
        [0.9993 if i == j else 0.002 + 0.03 * ((i * j) % 5) for j in range(len(names))]
        for i in range(len(names))
    ]

    def pairs(key):
        both = [
            (n, FREQUENCY[key][n], FREQUENCY["harmonic"][n]) for n in names if n in FREQUENCY[key]
        ]
        return [
            {
                "mode": n,
                "partner": n,
                "mac": 0.9993,
                "frequency_hz": f,
                "reference_hz": ref,
                "relative": f / ref - 1,
            }
            for n, f, ref in both
        ]

    return {
        "schema": SCHEMA,
        "complete": True,
        "scene": _scene(),
        "models": models,
        "deviations": deviations,
        "port": {
            "name": "pinion",
            "y": 0.0291226,
            "attachment": "average",
            "order": ORDER,
            "free": ["thy"],
        },
        "attachments": {
            k: {t: {"quantities": dict(zip(SHOWN, v))} for t, v in ties.items()}
            for k, ties in TIES.items()
        },
        "mac": {
            "reference": "harmonic",
            "stations": [0.0, 0.1, 0.2],
            "models": {
                k: {"rows": names, "columns": names, "values": square, "pairs": pairs(k)}
                for k in ("euler", "timoshenko", "solid")
            },
        },
        "causes": [
            {
                "cause": "shear",
                "change": "Euler -> Timoshenko",
                "model": "beam",
                "quantities": {"C_zz": 0.2603, "K_zz": -0.4315, "bending 1": -0.1678},
            },
            {
                "cause": "rotary inertia",
                "change": "off -> on",
                "model": "beam",
                "quantities": {"C_zz": 0.0, "K_zz": 0.0, "bending 1": -0.0312},
            },
            {
                "cause": "attachment",
                "change": "average -> section",
                "model": "harmonic",
                "quantities": {"C_zz": 0.0674, "K_zz": -0.1862, "bending 1": -0.0210},
            },
            {
                "cause": "shoulder flexibility",
                "change": "beam -> solid, section ties",
                "model": "harmonic",
                "quantities": {"C_zz": 0.0698, "K_zz": -0.0798, "bending 1": -0.0297},
            },
        ],
        "verdict": {
            "trust": "harmonic",
            "reference": "harmonic",
            "cheapest": None,
            "tolerance": 0.05,
            "sentences": [
                "The shaft is a body of revolution, so the harmonic solid solves the same elasticity as the 3D solid, at a tenth of the time.",
                "The Timoshenko beam is 6.5 % too stiff in C_zz like for like: outside the 5 % asked for.",
            ],
        },
        "environment": {
            "solidgear": "0.1.0",
            "python": "3.11.2",
            "numpy": "2.4.0",
            "scipy": "1.17.0",
            "platform": "Linux x86_64",
            "cpu": "test fixture",
            "cores": 2,
            "date": "2026-01-05",
        },
        "where": {
            "model": "harmonic",
            "quantity": "C_zz",
            "order": 3,
            "total": 4e-4,
            "sentence": "97 % of what is left in C_zz sits at the shoulder at y = 186 mm",
            "rows": [
                {"what": "shoulder", "y": 0.186, "r": 0.03, "share": 0.97},
                {"what": "elsewhere", "y": 0.05, "r": 0.02, "share": 0.03},
            ],
            "points": [[0.0, 0.03, 0.03, 0.0], [0.0, 0.0, 0.2, 0.2]],
            "cells": [[0], [1], [2], [3]],
            "shares": [1.0],
        },
        "images": {},
        "warnings": ["made-up figures: a test fixture, not a run"],
        "seconds_total": 41.2,
    }


@pytest.fixture(scope="module")
def page():
    return render_page(fixture_results())


@pytest.fixture
def no_charts(monkeypatch):
    """Drawing is what takes the time, and most tests do not look at it."""
    monkeypatch.setattr(charts, "CHARTS", dict.fromkeys(charts.CHARTS, lambda results: None))


def text_of(page):
    return re.sub(r"\s+", " ", re.sub(r"<[^>]+>", " ", page))


def shown(renderable, width=80):
    console = Console(width=width, file=io.StringIO(), color_system=None)
    console.print(renderable)
    return console.file.getvalue()


# ------------------------------------------------------------------------------------------------- the page
def test_page_needs_no_other_file_and_no_network(page):
    assert not re.search(r"""(src|href)\s*=\s*["'](?!data:|#)""", page)
    assert "<script" not in page and "@import" not in page and "<link" not in page
    assert not re.search(r"url\((?!#)", page)
    assert page.count("<svg") == 8, "one for each chart"


def test_identifiers_of_the_charts_do_not_collide(page):
    ids = re.findall(r'\sid="([^"]+)"', page)
    assert len(ids) == len(set(ids))
    assert set(re.findall(r'(?:url\(|href=")#([^")]+)', page)) <= set(ids)


@pytest.mark.parametrize(
    "figure",
    [
        "4.7108e9",
        "7.3279e9",
        "1.1364e9",
        "240.13e6",
        "19.010e6",
        "2758.1",
        "3343.9",
        "1385.6",
        "138 210",
        "0.12 %",
        "35.3",
        "2610",
        "+26.0 %",
        "-43.1 %",
        "0.9993",
        "1.92",
        "1.09",
        "3.1e-14",
        "29.1226",
        "58.2453",
        "5.4155e9",
        "published",
        "identified",
        "Seat width assumed.",
        "41.2",
        "2.4.0",
    ],
)
def test_figures_of_the_run_are_on_the_page(page, figure):
    assert figure in text_of(page)


def test_page_says_where_the_error_sits(page):
    assert "97 % of what is left in C_zz sits at the shoulder at y = 186 mm" in page
    assert "1: shoulder, y = 186 mm, 97 %" in page  # beside the picture


def test_every_matrix_names_its_units(page):
    text = text_of(page)
    assert text.count("N m/rad") >= 4 and text.count("rad/(N m)") >= 4
    for model in STIFFNESS:
        assert engineering(STIFFNESS[model][3]) in text


def test_free_motion_is_a_dash_in_both_matrices(page):
    table = page[page.index("Harmonic solid: stiffness") :]
    row = re.search(r'<th scope="row">thy</th>(.*?)</tr>', table).group(1)
    assert re.findall(r">([^<]+)</td>", row) == ["–"] * 6


def test_small_difference_is_called_not_resolved(page):
    assert 'unresolved">not resolved</td>' in page
    assert "validated against experiment" in page and "Code verification" in page


def test_compliance_comes_first_among_differences(page):
    part = page[page.index('id="deviations"') : page.index('id="causes"')]
    first = re.findall(r'<tbody>\s*<tr><th scope="row">(\S+?)</th>', part)
    assert len(first) == 5 and set(first) == {"C_zz"}


def test_same_results_same_page_from_numpy_or_plain(page):
    results = fixture_results()
    for model in results["models"].values():
        model["compliance"] = np.array(
            [[np.nan if v is None else v for v in row] for row in model["compliance"]]
        )
        model["dofs"] = np.int64(model["dofs"])
    assert render_page(results) == page


def test_names_from_a_scene_are_escaped():
    results = fixture_results()
    evil = '<script>alert("x")</script>$\\frac{'
    for part in (
        results["scene"],
        results["scene"]["bearings"][0],
        results["scene"]["segments"][0],
        results["scene"]["port"],
    ):
        part["name"] = evil
    results["scene"] |= {"title": evil, "source": evil}
    results["scene"]["bearings"][1]["note"] = "<img src=http://x/>"
    results["models"]["harmonic"]["modes"][1]["name"] = evil
    results["warnings"], results["verdict"]["sentences"] = [evil], [evil]
    page = render_page(results)
    assert "<script" not in page and "<img" not in page and "&lt;script&gt;" in page
    assert page.count("<svg") == 8


# ------------------------------------------------------------------------------------------------- missing parts
def test_interrupted_run_has_a_banner(page, no_charts):
    assert "Interrupted run" not in page
    results = fixture_results() | {"complete": False, "missing": ["3D solid"]}
    del results["models"]["solid"], results["verdict"]
    page = render_page(results)
    assert (
        "Interrupted run" in page
        and "models without results: 3D solid" in page
        and "No verdict" in page
    )


PARTS = [(key,) for key in fixture_results()] + [tuple(fixture_results())]


@pytest.mark.parametrize("gone", PARTS, ids=lambda gone: "everything" if len(gone) > 1 else gone[0])
def test_any_part_may_be_missing(no_charts, gone):
    for results in (
        fixture_results() | dict.fromkeys(gone),
        {k: v for k, v in fixture_results().items() if k not in gone},
    ):
        assert "</html>" in render_page(results)
        shown(final_table(results))
        verdict_text(results)


@pytest.mark.parametrize("gone", list(fixture_results()["models"]["harmonic"]))
def test_any_part_of_a_model_may_be_missing(no_charts, gone):
    results = fixture_results()
    for model in results["models"].values():
        model[gone] = None
    assert "</html>" in render_page(results)
    assert "harmonic" in shown(final_table(results))
    del results["models"]["solid"][gone]
    assert "</html>" in render_page(results)


@pytest.mark.parametrize(
    "name, needs",
    [
        ("sketch", "scene"),
        ("modes", "models"),
        ("mac", "mac"),
        ("convergence", "models"),
        ("where", "where"),
        ("causes", "causes"),
        ("cost", "models"),
        ("attachments", "attachments"),
    ],
)
def test_chart_without_its_data_is_none(name, needs):
    assert charts.CHARTS[name](fixture_results() | {needs: None}) is None
    assert charts.CHARTS[name]({}) is None


def test_charts_draw_what_is_left_of_a_broken_off_run():
    results = fixture_results() | {"verdict": None, "port": None}
    del (
        results["models"]["solid"],
        results["models"]["harmonic"]["band"],
        results["models"]["harmonic"]["convergence"]["quantities"]["bending 1"],
    )
    results["models"]["harmonic"]["convergence"]["levels"][0]["h"] = None
    results["scene"]["port"], results["scene"]["bearings"] = None, []
    results["causes"][0]["quantities"]["C_zz"] = None
    for chart in charts.CHARTS.values():
        chart(results)


def test_chart_that_fails_costs_only_itself(monkeypatch):
    def broken(results):
        raise ValueError("no pen")

    monkeypatch.setattr(
        charts, "CHARTS", dict.fromkeys(charts.CHARTS, broken) | {"causes": charts.cause_chart}
    )
    page = render_page(fixture_results())
    assert "no pen" in page and page.count("<svg") == 1 and "</html>" in page


def test_models_without_a_record_are_named_by_the_ladder():
    scene = sg.load(ROOT / "geometry" / "shaft_stepped.toml")
    record = recorded(scene, {}, {"euler": "no memory"}, [], {}, [], complete=False)
    assert record.missing == ["Timoshenko beam", "harmonic solid", "3D solid"]
    assert record.models["euler"].title == "Euler beam"


def test_model_without_a_title_is_called_by_its_key(no_charts):
    results = fixture_results()
    for model in results["models"].values():
        del model["title"], model["short"]
    assert "harmonic: stiffness" in render_page(results).lower()
    assert "Trust: harmonic\n" in verdict_text(results)
    assert "timoshenko" in shown(final_table(results))


# ------------------------------------------------------------------------------------------------- the border
@pytest.mark.parametrize("version", [1, 2, SCHEMA + 1, "x"])
def test_results_of_another_version_are_refused_in_a_sentence(tmp_path, version):
    results = fixture_results() | {"schema": version}
    which = "an older" if version in (1, 2) else "another"
    for take in (final_table, verdict_text, render_page, lambda r: write_report(r, tmp_path)):
        with pytest.raises(SolidgearError, match=f"written by {which} version") as refused:
            take(results)
        assert "run solidgear compare again" in str(refused.value)
        assert "\n" not in str(refused.value)
    assert not list(tmp_path.iterdir())


def test_what_is_no_record_is_refused_with_the_place_of_the_fault():
    results = fixture_results()
    results["models"]["solid"]["dofs"] = "many"
    with pytest.raises(SolidgearError, match=r"models\.solid\.dofs") as refused:
        render_page(results)
    assert "\n" not in str(refused.value)


def test_a_record_is_taken_as_it_is(no_charts):
    record = Record.model_validate(fixture_results())
    assert render_page(record) == render_page(fixture_results())
    assert Record.model_validate(record.as_dict()) == record


# ------------------------------------------------------------------------------------------------- the file
PNG = b"\x89PNG\r\n\x1a\n" + b"0" * 20


def test_file_is_written_whole_with_its_pictures(tmp_path, no_charts):
    (tmp_path / "mode_solid.png").write_bytes(PNG)
    path = write_report(
        fixture_results(),
        tmp_path / "out",
        {"harmonic": PNG, "solid": tmp_path / "mode_solid.png", "euler": tmp_path / "absent.png"},
    )
    page = path.read_text(encoding="utf-8")
    assert path == tmp_path / "out" / "report.html"
    assert (
        page.count('src="data:image/png;base64,') == 2
        and page.count("could not be made or read") == 1
    )
    assert [p.name for p in path.parent.iterdir()] == ["report.html"]


def test_pictures_named_by_the_results_come_from_the_folder_only(tmp_path, no_charts):
    (tmp_path / "secret.png").write_bytes(PNG)
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "mode_solid.png").write_bytes(PNG)
    page = write_report(
        fixture_results() | {"images": {"solid": "mode_solid.png", "euler": "../secret.png"}},
        tmp_path / "out",
    ).read_text(encoding="utf-8")
    assert page.count('src="data:image/png;base64,') == 1


def test_failed_report_leaves_the_old_one(tmp_path, monkeypatch, no_charts):
    path = write_report(fixture_results(), tmp_path)
    before = path.read_bytes()
    monkeypatch.setattr("solidgear.report.html.render_page", lambda *a: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        write_report(fixture_results(), tmp_path)
    assert path.read_bytes() == before and len(list(tmp_path.iterdir())) == 1


# ------------------------------------------------------------------------------------------------- the terminal
def test_final_table_fits_eighty_columns():
    text = shown(final_table(fixture_results()), width=200)
    assert max(len(line.rstrip()) for line in text.splitlines()[:8]) <= 80
    text = shown(final_table(fixture_results()), width=80)
    assert "…" not in text and "\x1b" not in text
    for word in (
        "4.711e9",
        "596.1e-12",
        "2758.1",
        "138k",
        "0.12 %",
        "24.7",
        "n.r.",
        "not resolved",
        "ref.",
        "shear: the shaft is stubby",
    ):
        assert word in text


def test_final_table_survives_names_with_brackets():
    results = fixture_results()
    odd = copy.deepcopy(results["models"]["solid"])
    del odd["title"], odd["short"]
    results["models"]["[red]x[/nonsense]"] = odd
    assert "[red]x" in shown(final_table(results))


def test_verdict_names_model_and_tolerance():
    text = verdict_text(fixture_results())
    assert "harmonic solid" in text and "5 %" in text and "- The Timoshenko beam" in text


@pytest.mark.parametrize("kind, unit", [("stiffness", "N m/rad"), ("compliance", "rad/(N m)")])
def test_matrix_table_has_units_and_fits(kind, unit):
    text = shown(matrix_table(fixture_results()["models"]["harmonic"][kind], kind))
    assert unit in text and "…" not in text and max(map(len, text.splitlines())) <= 80


def test_modes_table_lists_pairs():
    text = shown(modes_table(fixture_results()["models"]["harmonic"]["modes"]))
    assert "rigid torsion" in text and "2758.1" in text


@pytest.mark.parametrize(
    "value, text",
    [
        (4.71078133e9, "4.7108e9"),
        (-2.40131e8, "-240.13e6"),
        (9.999999e5, "1.0000e6"),
        (0.0, "0"),
        (None, "-"),
        (float("nan"), "-"),
        (53.93, "53.930"),
        (5.96e-10, "596.00e-12"),
    ],
)
def test_engineering(value, text):
    assert engineering(value) == text


@pytest.mark.parametrize(
    "value, text",
    [
        (0.2603, "+26.0 %"),
        (-0.0654, "-6.54 %"),
        (0.0012, "+0.12 %"),
        (3.2e-5, "+0.0032 %"),
        (0.0, "0 %"),
        (-4.7e-15, "<1e-6 %"),
        (None, "-"),
    ],
)
def test_percent(value, text):
    assert percent(value) == text
    assert hertz(2758.09) == "2758.1"
