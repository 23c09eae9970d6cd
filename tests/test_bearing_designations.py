"""Designations as drawings and shops have them: kind, sizes, suffixes of makers."""

import math

import numpy as np
import pytest
from published_sizes import PUBLISHED

from solidgear.bearings.catalogue import Catalogue
from solidgear.bearings.catalogued import catalogued, state
from solidgear.bearings.clearance import clearance_range
from solidgear.bearings.designation import boundary, families, usual_angle
from solidgear.bearings.suffixes import read_suffixes
from solidgear.core import SceneError

#: designation as on a drawing: kind, sizes in mm, class of clearance, and suffixes that are put by
DRAWN = (
    ("608-2Z", "deep_groove", (8, 22, 7), None, "2Z"),
    ("6001-2RSH", "deep_groove", (12, 28, 8), None, "2RSH"),
    ("6003-2Z-C3-GJN", "deep_groove", (17, 35, 10), "C3", "2Z GJN"),
    ("6202ZZCM", "deep_groove", (15, 35, 11), "CM", "ZZ"),
    ("6204LLUC3/5K", "deep_groove", (20, 47, 14), "C3", "LLU 5K"),
    ("62052RS", "deep_groove", (25, 52, 15), None, "2RS"),
    ("6205-2RSR-C3", "deep_groove", (25, 52, 15), "C3", "2RSR"),
    ("6206-2Z/C3", "deep_groove", (30, 62, 16), "C3", "2Z"),
    ("6208 VV C4", "deep_groove", (40, 80, 18), "C4", "VV"),
    ("6210 NR", "deep_groove", (50, 90, 20), None, "NR"),
    ("6305DDUC3", "deep_groove", (25, 62, 17), "C3", "DDU"),
    ("6319M/C4VL0241", "deep_groove", (95, 200, 45), "C4", "M VL0241"),
    ("6204 P63", "deep_groove", (20, 47, 14), "C3", "P6"),
    ("61808-2RZ", "deep_groove", (40, 52, 7), None, "2RZ"),
    ("6902 2RS", "deep_groove", (15, 28, 7), None, "2RS"),
    ("16008", "deep_groove", (40, 68, 9), None, ""),
    ("62205-2RS1", "deep_groove", (25, 52, 18), None, "2RS1"),
    ("4206 ATN9", "deep_groove", (30, 62, 20), None, "A TN9"),
    ("7208 BECBP", "angular_contact", (40, 80, 18), None, "CB P"),
    ("7306-B-XL-TVP", "angular_contact", (30, 72, 19), None, "XL TVP"),
    ("7205BEAT85", "angular_contact", (25, 52, 15), None, "T85"),
    ("7014 CD/P4A", "angular_contact", (70, 110, 20), None, "P4A"),
    ("B71910-E-T-P4S-UL", "angular_contact", (50, 72, 12), None, "T P4S UL"),
    ("3206 A-2RS1TN9/MT33", "double_row_angular", (30, 62, 23.8), None, "A 2RS1 TN9 MT33"),
    ("QJ 208 MA", "four_point", (40, 80, 18), None, "MA"),
    ("1208 ETN9", "self_aligning", (40, 80, 18), None, "E TN9"),
    ("NU 208 ECP", "cylindrical", (40, 80, 18), None, "ECP"),
    ("NU2205ET2XC3", "cylindrical", (25, 52, 18), "C3", "ET2X"),
    ("NU 312 ECJ/C3", "cylindrical", (60, 130, 31), "C3", "ECJ"),
    ("NU315-E-M1A-C3", "cylindrical", (75, 160, 37), "C3", "E M1A"),
    ("NJ 2206-E-XL-TVP2", "cylindrical", (30, 62, 20), None, "E XL TVP2"),
    ("NUP 308 ECML", "cylindrical", (40, 90, 23), None, "ECML"),
    ("NCF 2208 V", "cylindrical", (40, 80, 23), None, "V"),
    ("SL182208-A", "cylindrical", (40, 80, 23), None, "A"),
    ("NA 4905", "needle", (25, 42, 17), None, ""),
    ("RNA 6906", "needle", (35, 47, 30), None, ""),
    ("NKI 20/16", "needle", (20, 32, 16), None, ""),
    ("HK 2016", "needle", (20, 26, 16), None, ""),
    ("30206 J2/Q", "tapered", (30, 62, 17.25), None, "J2 Q"),
    ("32008 XQ", "tapered", (40, 68, 19), None, "X Q"),
    ("4T-32206", "tapered", (30, 62, 21.25), None, ""),
    ("HR32207J", "tapered", (35, 72, 24.25), None, "J"),
    ("31310 J2/QDF", "tapered", (50, 110, 29.25), None, "J2"),
    ("33208/Q", "tapered", (40, 80, 32), None, "Q"),
    ("22210 E/C3", "spherical", (50, 90, 23), "C3", "E"),
    ("22320-E1-XL-T41A", "spherical", (100, 215, 73), None, "E1 XL T41A"),
    ("51108", "thrust_ball", (40, 60, 13), None, ""),
)


@pytest.mark.parametrize("written, kind, sizes, clearance, ignored", DRAWN)
def test_forty_seven_designations_of_drawings(written, kind, sizes, clearance, ignored):
    assert len(DRAWN) == 47
    result = boundary(written)
    assert (result.kind, result.clearance, result.ignored) == (kind, clearance, ignored)
    assert _sizes(result) == pytest.approx(sizes)
    # the same in small letters, and with other separators
    assert boundary(written.lower()) == result
    if "/" not in written and " " in written:
        assert boundary(written.replace(" ", "-")) == result


def _sizes(result):
    return [1e3 * size for size in (result.bore, result.outer_diameter, result.width)]


@pytest.mark.parametrize("kind", PUBLISHED)
def test_sizes_are_those_of_printed_lists(kind):
    for entry in PUBLISHED[kind].split():
        name, sizes = entry.split(":")
        result = boundary(name.replace("_", " "))
        assert result.kind == kind, name
        assert _sizes(result) == pytest.approx([float(s) for s in sizes.split("x")]), name


def test_the_plan_grows_with_the_bore_and_with_the_series():
    # a slip of a row by one place breaks the order
    for family in families():
        for series, sizes in family.series.items():
            ordered = [sizes[bore] for bore in sorted(sizes)]
            outer = [size.outer for size in ordered]
            assert all(np.diff(outer) > 0), series
            assert all(size.outer > bore for bore, size in sizes.items()), series
    light, medium, heavy = (_family("deep_groove").series[name] for name in ("60", "62", "63"))
    for bore in medium.keys() & heavy.keys() & light.keys():
        assert light[bore].outer < medium[bore].outer < heavy[bore].outer


@pytest.mark.parametrize(
    "written, degrees",
    [
        ("7208 A", 30),
        ("7208 AC", 25),
        ("7208 BEP", 40),
        ("7208 C", 15),
        ("7012UCG/GNP42", 15),
        ("B7014-E-T-P4S-UL", 25),
        ("3208-B-TVH", 25),
        ("32206 BJ2/Q", 20.1),
        ("HR30306DJ", 28.8),
        ("T5FD 050", 20.1),
    ],
)
def test_letters_that_are_a_contact_angle(written, degrees):
    assert math.degrees(boundary(written).contact_angle) == pytest.approx(degrees)


def test_names_of_iso_355_are_the_older_ones():
    # Timken, Metric tapered roller bearings, bearings of 55 mm; NACHI, of 30 mm
    for name, older in (
        ("T2FB 055", "30311"),
        ("T7FB 055", "31311"),
        ("T2FD 055", "32311"),
        ("T3DB 055", "30211"),
        ("T3DC 055", "32211"),
        ("T3DE 055", "33211"),
        ("T4CC 030", "32006"),
    ):
        assert _sizes(boundary(name)) == _sizes(boundary(older))


def test_rows_pairs_rings_and_ribs_that_a_designation_says():
    assert boundary("4206 ATN9").arrangement == "double_row"
    assert boundary("NN 3010 KTN/SP").arrangement == "double_row"
    assert boundary("31310 J2/QDF").arrangement == "face_to_face"
    assert boundary("7208 BDB").arrangement == "back_to_back"
    assert boundary("NA 4905").raceway == boundary("RNA 4905").bore == 0.03
    ribs = {name: boundary(f"{name} 208").ribs for name in ("N", "NU", "NJ", "NF", "NUP")}
    assert ribs == {
        "N": "none", "NU": "none", "NJ": "one way", "NF": "one way", "NUP": "both ways"
    }  # fmt: skip
    assert boundary("NJ 210 ECP + HJ 210 EC").ribs == "both ways"
    assert boundary("NU 210+HJ 210").ribs == "one way"
    assert boundary("NCF 2208 V").cage is False


WRONG = (
    ("6208-XYZ", '"XYZ" is no suffix that is known'),
    ("6008 C6", '"C6" is no suffix'),
    ("81107", "is a cylindrical roller thrust bearing of which there is no model"),
    ("29412 E", "is a spherical roller thrust bearing"),
    ("HC6205", "ceramic balls"),
    ("6205/HC5C3", "HC5 has ceramic elements"),
    ("LM11949/10", "is an inch tapered roller bearing"),
    ("UC206", "is an insert bearing"),
    ("6280", 'did you mean "6208"'),
    ("6208 C3 C4", "two classes of clearance, C3 and C4"),
)


@pytest.mark.parametrize("written, sentence", WRONG)
def test_what_is_not_known_is_named(written, sentence):
    with pytest.raises(SceneError, match=sentence):
        boundary(written)


def test_a_tapered_bore_asks_for_the_clearance_that_is_left():
    with pytest.raises(SceneError, match="tapered bore, K"):
        Catalogue(designation="22210 EK/C3")
    assert Catalogue(designation="22210 EK", clearance="20 um").clearance == 20e-6
    assert boundary("2210 E-2RS1KTN9/C3").ignored == "E 2RS1 TN9"


def test_single_letters_do_not_read_every_word():
    for word in ("BOX", "XYZ", "QED", "HURZ"):
        assert read_suffixes(word, "deep_groove").unread, word


@pytest.mark.parametrize(
    "written, low, high",
    [
        # SKF, Rolling bearings, radial internal clearance; CM: Mitsubishi's list for its motors
        ("6000/C3", 8, 23),
        ("6202ZZCM", 4, 11),
        ("6210/C5", 45, 73),
        ("6230 C3", 46, 91),
        ("NU 2226 C4", 145, 190),
        ("NU 210 C5", 95, 125),
        ("22232 C3", 170, 220),
        ("1208 C3", 23, 40),
    ],
)
def test_classes_of_clearance(written, low, high):
    assert clearance_range(Catalogue(designation=written)) == pytest.approx((low / 1e6, high / 1e6))


def test_a_class_that_has_no_table_is_refused():
    with pytest.raises(
        SceneError, match="CM of deep groove bearings is not known here at a bore of"
    ):
        clearance_range(Catalogue(designation="6320 CM"))
    with pytest.raises(SceneError, match="C5 of double row angular bearings is not known here"):
        clearance_range(Catalogue(designation="3206 A/C5"))


@pytest.mark.parametrize(
    "written, low, high",
    [("3206 A/C3", 18, 37), ("3212-B-TVH", 13, 36), ("QJ 208 MA/C3", 100, 150)],
)
def test_classes_along_the_shaft(written, low, high):
    """DAS Lager's catalogue: axial clearance of series 32 and 33 and of QJ."""
    data = Catalogue(designation=written, load={"y": "0.01 N"})
    data = data.with_changes(clearance="CN") if written.startswith("3212") else data
    assert clearance_range(data) == pytest.approx((low / 1e6, high / 1e6))
    # the shaft moves that far along its axis before a row carries, half of it each way
    moved = state(data, catalogued(data))[1]
    assert 2e6 * moved == pytest.approx((low + high) / 2, rel=1e-3)


def test_usual_angles_of_series():
    # SKF: e 0.83 of 313, 0.4 of 331, T7FC 0.88; of self-aligning balls e 0.22 of a 1208
    for name, kind, e in (("31310", "tapered", 0.83), ("33110", "tapered", 0.4),
                          ("T7FC 050", "tapered", 0.88), ("1208", "self_aligning", 0.22)):  # fmt: skip
        assert 1.5 * math.tan(usual_angle(name, kind)) == pytest.approx(e, abs=0.03)


def _family(kind):
    return next(family for family in families() if family.kind == kind)
