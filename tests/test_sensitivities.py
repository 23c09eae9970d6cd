"""Derivatives of numbers by entries of a scene file, against shafts built and solved anew."""

import json
import weakref

import numpy as np
import pytest

import solidgear as sg
from solidgear.core.scene.file import scene_of
from solidgear.core.scene.paths import entry, keys_of, with_entry
from solidgear.core.scene.toml_file import parse
from solidgear.variants.sensitivity import run
from tests.command import command

#: of the strongest elasticity: central differences of fine meshes that are made anew repeat to 3e-6
AGREES = 1e-5

# a step, a cone, equal bores side by side, springs in series, a housing, a mass
SHAFT = """
material = { E = "207 GPa", nu = 0.3, density = "7850 kg/m^3" }
segment = [
    { kind = "cylinder", name = "seat", length = "60 mm", diameter = "50 mm", bore = "12 mm" },
    { kind = "cone", name = "taper", length = "50 mm", start_diameter = "50 mm", end_diameter = "44 mm", bore = "12 mm" },
    { kind = "cylinder", name = "rod", length = "80 mm", diameter = "36 mm", bore = "12 mm" },
]
bearing = [
    { name = "A", position = "22 mm", seat_width = "16 mm", stiffness = { kxx = "6e8 N/m", kyy = "2e8 N/m", kzz = "6e8 N/m" }, attachment = "TIE" },
    { name = "B", position = "150 mm", seat_width = "14 mm", stiffness = { kxx = "4e8 N/m", kyy = "1e8 N/m", kzz = "4e8 N/m", kthx = "2e5 N*m/rad", kthz = "2e5 N*m/rad" }, axial_series = ["3e8 N/m"] },
]
mass = [{ name = "disc", position = "178 mm", seat_width = "10 mm", mass = "2 kg" }]
housing = { axial = "5e8 N/m" }
port = { name = "gear", at = "taper.middle", span = ["70 mm", "100 mm"] }
"""

# few cells, so that a mesh as fine as differences need is cheap
STUB = """
material = { E = "207 GPa", nu = 0.3, density = "7850 kg/m^3" }
segment = [
    { kind = "cylinder", name = "seat", length = "40 mm", diameter = "40 mm" },
    { kind = "cone", name = "rod", length = "40 mm", start_diameter = "30 mm", end_diameter = "28 mm" },
]
bearing = [{ name = "A", position = "20 mm", seat_width = "16 mm", stiffness = { kxx = "6e8 N/m", kyy = "2e8 N/m", kzz = "6e8 N/m", kthx = "2e5 N*m/rad", kthz = "2e5 N*m/rad" } }]
port = { name = "gear", at = "rod.middle", span = ["50 mm", "70 mm"] }
"""
CONE = 'kind = "cone", name = "rod", length = "40 mm", start_diameter = "30 mm", end_diameter = "28 mm"'
PLAIN = 'kind = "cylinder", name = "rod", length = "40 mm", diameter = "30 mm"'
FILLET = """
feature = [{ kind = "fillet", name = "root", at = "seat.end", radius = "2 mm" }]
"""


def shaft(folder, tie="average"):
    file = folder / "shaft.toml"
    file.write_text(SHAFT.replace("TIE", tie))
    return file


def by_differences(file, direction, model, of, step, **options):
    """Elasticities along a direction of relative changes of entries, from two shafts read from
    changed tables, built and solved anew.
    """
    tables = parse(str(file))

    def values(share):
        other = tables
        for path, weight in direction.items():
            keys = keys_of(path, tables)
            number, _, unit = str(entry(keys, tables)).partition(" ")
            value = float(number) * (1 + share * weight)
            other = with_entry(other, keys, f"{value!r} {unit}" if unit else value)
        scene = scene_of(other, str(file))
        body = sg.build(scene, model, **options)
        static = sg.condense(body, scene, port="gear").compliance
        modes = sg.modes(body, scene, n=8) if any(" " in name for name in of) else None
        known = {"C_zz": static[2, 2], "C_thx": static[3, 3], "C_yy": static[1, 1]}
        return np.array([known.get(n) or _mean(modes, n) for n in of])

    return (np.log(values(step)) - np.log(values(-step))) / (2 * step)


def _mean(modes, name):
    """A frequency; of a pair, which a spring of one plane splits, the mean."""
    family = [m for m in modes.solved if m.name.startswith(name.split()[0])]
    alike = [m.frequency_hz for m in family for _ in range(m.multiplicity)]
    if name.startswith("bending"):
        return np.sqrt(np.mean(np.square(sorted(alike)[:2])))
    return min(alike)


def held_against(found, file, direction, model, step=3e-4, **options):
    of = [one.name for one in found.of]
    differences = by_differences(file, direction, model, of, step, **options)
    for one, there in zip(found.of, differences):
        here = sum(weight * one[path].elasticity for path, weight in direction.items())
        top = max(abs(d.elasticity) for d in one.derivatives)
        assert abs(here - there) < AGREES * top, (one.name, direction)


@pytest.mark.parametrize(
    ("model", "text", "mesh", "count"),
    [
        ("timoshenko", SHAFT, {"elements": 300}, 32),
        ("harmonic", STUB, {"order": 4, "layers": 2, "edge_layers": 1}, 17),
    ],
)
def test_derivatives_are_those_of_shafts_built_anew(tmp_path, model, text, mesh, count):
    file = tmp_path / "shaft.toml"
    file.write_text(text.replace("TIE", "average"))
    found = sg.sensitivities(file, model, of=["bending 1", "C_zz"], coarser=False, **mesh)
    assert not found.without
    # all numbers at once, none like another
    paths = sorted(d.path for d in found.of[0].derivatives)
    assert len(paths) == count
    direction = {path: float(np.cos(2.0 + k)) for k, path in enumerate(paths)}
    held_against(found, file, direction, model, **mesh)


@pytest.mark.slow
@pytest.mark.parametrize("tie", ["average", "rigid", "section"])
def test_every_number_moves_a_harmonic_solid_as_solids_meshed_anew_say(tmp_path, tie):
    file = shaft(tmp_path, tie)
    mesh = {"order": 7, "layers": 3, "edge_layers": 2}
    of = ["bending 1", "axial 1", "C_zz", "C_thx", "C_yy"]
    found = sg.sensitivities(file, of=of, coarser=False, **mesh)
    for one in found.of[0].derivatives:
        held_against(found, file, {one.path: 1.0}, "harmonic", **mesh)


@pytest.mark.slow
def test_a_step_that_opens_where_two_surfaces_meet_is_felt_as_a_step(tmp_path):
    file = tmp_path / "shaft.toml"
    file.write_text(STUB.replace(CONE, PLAIN.replace("30 mm", "40 mm")))
    mesh = {"order": 6, "layers": 2, "edge_layers": 2}
    found = sg.sensitivities(file, of=["bending 1", "C_zz"], coarser=False, **mesh)
    # a small step has corners of its own: what differs falls with it
    there = by_differences(
        file, {"segment.rod.diameter": 1.0}, "harmonic", ["bending 1"], 3e-3, **mesh
    )
    here = found["bending 1"]["segment.rod.diameter"].elasticity
    assert here == pytest.approx(there[0], rel=3e-5)


def test_a_shaft_and_all_of_it_twice_as_large_is_half_as_fast(tmp_path):
    # lengths scale a frequency by -1 where springs, by length, and no mass stand against it
    file = shaft(tmp_path)
    bending = sg.sensitivities(file, of=["bending 1"], coarser=False, order=3, layers=1)[
        "bending 1"
    ]

    def share(*ends):
        return sum(d.elasticity for d in bending.derivatives if d.path.endswith(ends))

    lengths = share("length", "diameter", "bore", "position", "seat_width", ".span.1", ".span.2")
    # k ~ E L, k_th ~ E L^3, m ~ rho L^3: with all of them scaled what is left is sqrt(E / rho) / L
    springs = share("kxx", "kyy", "kzz", "axial", "series.1")
    tilts, heavy = share("kthx", "kthz"), share("disc.mass")
    assert lengths + springs + 3 * tilts + 3 * heavy == pytest.approx(-1, abs=1e-7)
    assert share("material.E") + springs + tilts == pytest.approx(0.5, abs=1e-7)
    assert share("material.density") + heavy == pytest.approx(-0.5, abs=1e-7)


def test_the_radius_of_a_fillet_and_the_shaft_beside_it_move_a_number_as_shafts_meshed_anew(
    tmp_path,
):
    file = tmp_path / "shaft.toml"
    file.write_text(STUB.replace(CONE, PLAIN) + FILLET)
    mesh = {"order": 3, "layers": 1, "edge_layers": 0}
    direction = {"feature.root.radius": 1.0, "segment.seat.length": -0.1}
    found = sg.sensitivities(file, of=["C_zz"], by=[*direction], coarser=False, **mesh)
    assert not found.without and found["C_zz"]["feature.root.radius"].elasticity < -1e-3
    held_against(found, file, direction, "harmonic", **mesh)


def test_a_seat_flush_with_a_shoulder_has_a_derivative_away_from_it(tmp_path):
    file = tmp_path / "shaft.toml"
    file.write_text(STUB.replace('position = "20 mm", seat', 'position = "32 mm", seat'))
    path, mesh = "bearing.A.position", {"elements": 200}
    found = sg.sensitivities(file, "timoshenko", of=["C_zz"], by=[path], coarser=False, **mesh)
    assert found["C_zz"][path].side == "smaller"
    assert any("for smaller entries" in note for note in found.notes)
    # differences of shafts meshed anew, about seats at a distance, carried on to the flush one
    near, far = (
        by_differences(_beside(file, share), {path: 1.0}, "timoshenko", ["C_zz"], 2e-3, **mesh)[0]
        for share in (1e-2, 2e-2)
    )
    away = (1 - 1e-2, 1 - 2e-2)  # an elasticity is by a share of where the bearing is
    assert found["C_zz"][path].elasticity == pytest.approx(
        2 * near / away[0] - far / away[1], rel=1e-3
    )


def _beside(file, share):
    """The file with its bearing by a share of its position further from the shoulder."""
    other = file.with_name(f"beside_{share}.toml")
    other.write_text(file.read_text().replace('"32 mm", seat', f'"{32 * (1 - share)} mm", seat'))
    return other


def test_a_solid_is_stiffer_as_its_springs_and_its_modulus_are(tmp_path):
    file = tmp_path / "shaft.toml"
    file.write_text(STUB)
    by = ["material", "bearing.A.stiffness", "segment.rod.length"]
    found = sg.sensitivities(file, "solid", by=by, refinement=0.4)
    bending = found["bending 1"]
    stiff = [d.elasticity for d in bending.derivatives if d.path.endswith(("E", "kxx", "kzz"))]
    tilts = [d.elasticity for d in bending.derivatives if d.path.endswith(("kthx", "kthz"))]
    # twice as stiff is twice the square of a frequency; what moves the mesh is refused
    assert sum(stiff) + sum(tilts) == pytest.approx(0.5, abs=1e-6)
    assert bending["material.density"].elasticity == pytest.approx(-0.5, abs=1e-6)
    assert "makes a new mesh for every shape" in found.without["segment.rod.length"]


def test_what_a_motion_does_not_feel_is_exactly_nothing(tmp_path):
    found = sg.sensitivities(shaft(tmp_path), "euler", of=["C_zz"], coarser=False)
    for path in ("material.density", "bearing.A.stiffness.kxx", "mass.disc.mass"):
        assert found["C_zz"][path].by == 0.0


@pytest.mark.parametrize(
    ("model", "more", "told"),
    [
        ("sector", {}, "the sector model has no derivatives"),
        ("timoshenko", {"by": ["bearing.C"]}, "`by` bearing.C: the file has no such number"),
        ("timoshenko", {"of": ["bending 90"]}, "bending 90: no such mode was found"),
        ("solid", {"of": ["C_zz"]}, "derivatives of C_zz are for bodies of revolution"),
        ("timoshenko", {"of": ["C_thy"]}, "C_thy: gear moves freely there"),
    ],
)
def test_what_has_no_derivative_is_refused_in_a_sentence(tmp_path, model, more, told):
    with pytest.raises(sg.SolidgearError, match=told):
        sg.sensitivities(shaft(tmp_path), model, **more)


def test_the_command_writes_what_it_tells(tmp_path):
    out = tmp_path / "out"
    words = ["sensitivities", shaft(tmp_path), "-f", "euler", "--of", "C_zz", "--out", out]
    done = command(*words)
    assert done.exit_code == 0, done.output
    assert "What would move C_zz" in done.output
    data = json.loads((out / "sensitivities.json").read_text())
    rows = (out / "sensitivities.csv").read_text().splitlines()
    assert len(rows) == 1 + len(data["numbers"][0]["derivatives"])
    assert (out / "sensitivities_1.svg").exists()


def test_a_table_fits_a_page_and_shows_no_bar_of_a_mesh_that_is_next_to_none():
    told = command("sensitivities", "geometry/shaft_stepped.toml", "-f", "timoshenko")
    assert max(map(len, told.stdout.splitlines())) <= 80
    assert "Mesh: below 0.010 % everywhere." in told.stdout and "0.00000" not in told.stdout


def test_numbers_of_a_material_by_name_have_derivatives(tmp_path):
    """The same shaft with its material by name and by its numbers."""
    named, told = tmp_path / "named.toml", tmp_path / "told.toml"
    text = shaft(tmp_path).read_text()
    constants = next(line for line in text.splitlines() if line.startswith("material = "))
    named.write_text(text.replace(constants, 'material = "42CrMo4"'))
    own = 'material = { E = "210 GPa", nu = 0.3, density = "7850 kg/m^3" }'
    told.write_text(text.replace(constants, own))
    of = {"model": "euler", "of": ["bending 1"], "by": ["material"], "coarser": False}
    by_name, by_numbers = (sg.sensitivities(path, **of)["bending 1"] for path in (named, told))
    for path in ("material.E", "material.density"):
        assert by_name[path].by == pytest.approx(by_numbers[path].by, rel=1e-9)


def test_one_mesh_is_there_at_a_time(tmp_path, monkeypatch):
    """The coarser mesh that judges is solved once the fine one is gone: they do not add up."""
    alive = weakref.WeakSet()

    class Counted(run.SolvedMesh):
        def __init__(self, *words):
            assert not alive
            super().__init__(*words)
            alive.add(self)

    monkeypatch.setattr(run, "SolvedMesh", Counted)
    found = sg.sensitivities("geometry/shaft_stepped.toml", "timoshenko", of=["bending 1"])
    (nu,) = [d for d in found["bending 1"].derivatives if d.path == "material.nu"]
    assert nu.apart is not None and not nu.unit
