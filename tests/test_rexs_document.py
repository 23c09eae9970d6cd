"""REXS as a format: XML, JSON and zips read as one document, and hostile files refused."""

import base64
import io
import json
import zipfile

import numpy as np
import pytest
from rexs_gearboxes import helical

from solidgear.exchange.rexs import reading
from solidgear.exchange.rexs.document import RexsError
from solidgear.exchange.rexs.reading import document_of
from solidgear.exchange.rexs.writing import xml_of


def xml(components, relations="", version="1.4"):
    return (
        f'<model version="{version}"><relations>{relations}</relations>'
        f"<components>{components}</components></model>"
    ).encode()


SHAFT = '<component id="1" type="shaft"><attribute id="rotational_speed" unit="1 / min">30</attribute></component>'


def as_json(document):
    """Return a document in JSON, numbers as numbers, by the schema of the format."""

    def attribute(entry):
        value = entry.value
        if isinstance(value, tuple):
            return {
                "id": entry.name,
                "unit": entry.unit,
                "floating_point_array": [*map(float, value)],
            }
        try:
            return {"id": entry.name, "unit": entry.unit, "floating_point": json.loads(value)}
        except ValueError:
            return {"id": entry.name, "unit": entry.unit, "string": value}

    def component(entry):
        attributes = [attribute(a) for a in entry.attributes.values()]
        return {"id": entry.id, "type": entry.type, "name": entry.name, "attributes": attributes}

    relations = [
        {"id": r.id, "type": r.type, "refs": [{"id": ref.id, "role": ref.role} for ref in r.refs]}
        for r in document.relations
    ]
    components = [component(c) for c in document.components.values()]
    model = {**document.header, "relations": relations, "components": components}
    return json.dumps({"model": model}).encode()


def test_xml_json_and_a_zip_are_one_document():
    plain = document_of(helical().xml().encode())
    again = document_of(as_json(plain))
    assert again.relations == plain.relations
    for number, component in plain.components.items():
        other = again.components[number]
        assert (other.type, other.name) == (component.type, component.name)
        assert [other.number(k) for k in component.attributes if k.endswith("diameter_begin")] == [
            component.number(k) for k in component.attributes if k.endswith("diameter_begin")
        ]
        assert other.numbers("support_vector") == component.numbers("support_vector")
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("__MACOSX/._model.rexs", "no model")
        archive.writestr("data.gde", "teeth")
        archive.writestr("model.rexs", helical().xml())
    assert document_of(packed.getvalue()) == plain
    assert document_of(xml_of(plain).encode()) == plain


def test_numbers_come_in_si_by_the_unit_of_the_file_or_of_rexs():
    rows = (
        ("length", "mm", "80", 0.08),
        ("length", "", "80", 0.08),
        ("elastic_modulus", "N / mm^2", "210000", 2.1e11),
        ("rotational_speed", "1 / min", "30", np.pi),
        ("helix_angle_reference_diameter", "°", "180", np.pi),
        ("bending_stiffness", "N mm / rad", "5e6", 5e3),
        ("static_capacity", "kN", "7.5", 7500.0),
        ("load_duration_fraction", "%", "25", 0.25),
    )
    for name, unit, text, number in rows:
        part = f'<component id="1" type="x"><attribute id="{name}" unit="{unit}">{text}</attribute></component>'
        newest = {"static_capacity": "radial_static_load_rating"}.get(name, name)
        newest = newest.replace("load_duration", "operating_time")
        assert document_of(xml(part)).components[1].number(newest) == pytest.approx(
            number, rel=1e-12
        )


def test_arrays_and_matrices_plain_and_coded_are_one():
    numbers = np.array([1.5, -2.0, 3.25])
    coded = base64.b64encode(numbers.astype("<f8").tobytes()).decode()
    single = base64.b64encode(numbers.astype("<f4").tobytes()).decode()
    cells = "".join(f"<c>{n}</c>" for n in numbers)
    for inside in (
        f"<array>{cells}</array>",
        f'<array code="float64">{coded}</array>',
        f'<array code="float32">{single}</array>',
    ):
        part = f'<component id="1" type="x"><attribute id="support_vector" unit="mm">{inside}</attribute></component>'
        assert document_of(xml(part)).components[1].numbers("support_vector") == (
            0.0015,
            -0.002,
            0.00325,
        )
    matrix = f'<matrix code="float64" rows="3" columns="1">{coded}</matrix>'
    part = f'<component id="1" type="x"><attribute id="m">{matrix}</attribute></component>'
    assert document_of(xml(part)).components[1].attributes["m"].value == (
        ("1.5",),
        ("-2.0",),
        ("3.25",),
    )


REF = '<relation id="1" type="{kind}"><ref id="{a}" role="assembly"/><ref id="{b}" role="part"/></relation>'
TWO = SHAFT + '<component id="2" type="shaft"/>'
HOSTILE = {
    "entities": (
        b'<!DOCTYPE m [<!ENTITY a "aaaa"><!ENTITY b "&a;&a;">]><model version="1.4">&b;</model>',
        "document type",
    ),
    "a file from outside": (
        b'<!DOCTYPE m [<!ENTITY x SYSTEM "file:///etc/passwd">]><model>&x;</model>',
        "document type",
    ),
    "deep XML": (b"<model>" + b"<a>" * 5000, "deeper than"),
    "deep JSON": (b'{"model":' + b"[" * 200000, "nested too deeply"),
    "cut off": (helical().xml().encode()[:4000], "no whole XML"),
    "JSON cut off": (b'{"model": {"version": "1.4", "components": [', "no whole JSON"),
    "no model": (b"<html/>", "begins with <html>"),
    "nothing": (b"", "is no REXS file"),
    "text": (b"shaft 1", "is no REXS file"),
    "no version": (xml(SHAFT, version=""), "has no version"),
    "a later version": (xml(SHAFT, version="3.0"), 'of version "3.0"'),
    "no components": (xml(""), "holds no components"),
    "a reference to nothing": (xml(SHAFT, REF.format(kind="assembly", a=1, b=7)), "component 7"),
    "a part of itself": (xml(SHAFT, REF.format(kind="assembly", a=1, b=1)), "part of itself"),
    "a circle": (
        xml(TWO, REF.format(kind="assembly", a=1, b=2)
            + REF.format(kind="ordered_assembly", a=2, b=1).replace('id="1" type', 'id="2" type')),
        "part of itself",
    ),
    "a component twice": (xml(SHAFT + SHAFT), "component 1 is there twice"),
    "an attribute twice": (
        xml('<component id="1" type="x"><attribute id="a">1</attribute><attribute id="a">2</attribute></component>'),
        "attribute a is there twice",
    ),
    "a number that is none": (xml('<component id="one" type="x"/>'), "id of a component"),
    "broken base64": (
        xml('<component id="1" type="x"><attribute id="a"><array code="float64">AAA</array></attribute></component>'),
        "base64",
    ),
    "no zip": (b"PK\x03\x04" + b"x" * 50, "broken or locked zip"),
}  # fmt: skip


@pytest.mark.parametrize("case", HOSTILE)
def test_a_hostile_or_broken_file_ends_in_a_sentence(case):
    data, words = HOSTILE[case]
    with pytest.raises(RexsError, match=words) as refusal:
        document_of(data)
    assert "\n" not in str(refusal.value) and len(str(refusal.value)) < 400


def test_gigabytes_in_a_zip_stop_at_the_limit(monkeypatch):
    monkeypatch.setattr(reading, "LARGEST", 100_000)
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("model.rexs", b" " * 50_000_000)
    assert len(packed.getvalue()) < 100_000
    with pytest.raises(RexsError, match="unpacks to more than"):
        document_of(packed.getvalue())
    two = io.BytesIO()
    with zipfile.ZipFile(two, "w") as archive:
        archive.writestr("a.rexs", "<model/>")
        archive.writestr("b.rexs", "<model/>")
    with pytest.raises(RexsError, match="2 models"):
        document_of(two.getvalue())


@pytest.mark.parametrize(
    ("unit", "words"), [("kg", "'kg' is not its unit"), ("inch", "REXS has mm")]
)
def test_a_wrong_unit_is_named(unit, words):
    part = f'<component id="5" type="shaft_section" name="neck"><attribute id="length" unit="{unit}">8</attribute></component>'
    with pytest.raises(RexsError, match=words) as refusal:
        document_of(xml(part)).components[5].number("length")
    assert 'shaft_section 5 "neck": length = 8' in str(refusal.value)
