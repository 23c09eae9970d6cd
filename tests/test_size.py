"""Sizes are counted on the mesh, and what does not fit is refused before its numbers are computed."""

import builtins
import json
import subprocess
import sys
from pathlib import Path

import pytest

import solidgear as sg
from solidgear.core.kernel import room
from solidgear.core.ladder.registry import LADDER
from solidgear.core.machine import memory
from solidgear.core.machine.memory import NoRoom
from solidgear.core.meshing.element_size import rough_cells
from solidgear.core.models.size import size_of_body
from solidgear.core.solve.backends import missing
from solidgear.core.solve.shifted import factors, needed_mb

GEOMETRY = Path(__file__).parents[1] / "geometry"
SCENES = {
    name: sg.load(GEOMETRY / f"{name}.toml")
    for name in (
        "pinion_overhung",
        "pinion_keyed",
        "pinion_toothed",
        "pinion_spiral",
        "shaft_hollow",
        "cylinder_free",
    )
}
COUNTED = (
    ("pinion_overhung", "timoshenko", {}),
    ("pinion_overhung", "euler", {"elements": 77}),
    ("shaft_hollow", "harmonic", {"order": 2, "ovalising": (2, 3)}),
    ("pinion_overhung", "solid", {"element": "hex8", "refinement": 0.7}),
    ("shaft_hollow", "solid", {"element": "hex20", "refinement": 0.4}),
    ("cylinder_free", "solid", {"element": "hex27", "refinement": 0.3, "around": 16}),
    ("shaft_hollow", "solid", {"element": "tet10", "refinement": 0.5}),
    ("cylinder_free", "solid", {"element": "tet4", "refinement": 0.6}),
    ("pinion_keyed", "solid", {"refinement": 0.3}),
    ("pinion_toothed", "sector", {"refinement": 0.5}),
    *(
        pytest.param(*case, marks=pytest.mark.long)
        for case in (
            ("pinion_keyed", "solid", {"refinement": 0.3, "half": False}),
            ("pinion_toothed", "solid", {"refinement": 0.3}),
            ("pinion_toothed", "sector", {"refinement": 0.5, "half": False}),
            ("pinion_spiral", "sector", {"refinement": 0.5}),
        )
    ),
)


@pytest.mark.parametrize("scene, model, options", COUNTED)
def test_unknowns_are_those_of_the_body(scene, model, options):
    body = sg.build(SCENES[scene], model, **options)
    size = LADDER[model].size(SCENES[scene], options)
    assert size.unknowns == body.size
    # entries of nodes on mirror planes and cut faces, where they are eliminated: up to a third of
    # those of coarse meshes
    held = size_of_body(body).entries
    assert held <= size.entries < 1.6 * held
    whole = model == "solid" and len(body.blocks) == 1
    assert not whole or size.entries == held


@pytest.mark.parametrize("name", ["pinion_overhung", "cylinder_free"])
def test_rough_numbers_are_good_to_a_factor_of_three(name):
    given = {"element": "tet10", "refinement": 0.6}
    solid = LADDER["solid"]
    rough = solid.rough_unknowns(SCENES[name], given)
    assert 1 / 3 < rough / solid.size(SCENES[name], given).unknowns < 3


def test_small_elements_at_edges_make_many():
    rod = SCENES["cylinder_free"].outline
    plain, graded = (rough_cells(rod, size=0.01, graded_size=h) for h in (None, 1e-6))
    assert graded > 1000 * plain


@pytest.mark.skipif(bool(missing("pardiso")), reason="what the analysis of PARDISO says is held")
@pytest.mark.parametrize(
    "scene, options",
    [
        ("pinion_overhung", {"refinement": 0.7}),  # blocks of more unknowns than SuperLU takes
        pytest.param(
            "shaft_hollow", {"element": "tet10", "refinement": 0.7}, marks=pytest.mark.long
        ),
    ],
)
def test_the_law_is_near_the_analysis(scene, options):
    """0.75 to 1.2 of it on ten bodies of 15,000 to 146,000 unknowns."""
    body = sg.build(SCENES[scene], "solid", **options)
    told = size_of_body(body).factors_mb
    assert 0.65 < told / needed_mb(body, body.factoring) < 1.4


# ------------------------------------------------------------------------------------------------- refusals
@pytest.mark.parametrize(
    "model, options",
    [("harmonic", {}), pytest.param("solid", {"refinement": 0.5}, marks=pytest.mark.long)],
)
def test_factors_are_refused_before_a_number_is_computed(monkeypatch, model, options):
    scene = SCENES["pinion_overhung"]
    body = sg.build(scene, model, **options)
    need = needed_mb(body, body.factoring)
    for share, fits in ((0.98, False), (1.02, True)):
        monkeypatch.setenv("SOLIDGEAR_MEMORY_MB", str(share * need))
        if fits:
            factors(body)
            continue
        for backend in ("Pardiso", "SuperLU"):
            monkeypatch.setattr(
                f"solidgear.core.solve.backends.{backend}.factor",
                lambda self: pytest.fail("the numbers were begun"),
            )
        with pytest.raises(NoRoom) as caught:
            factors(body)
        monkeypatch.undo()
        message = str(caught.value)
        total = sum({id(b.stiffness): b.size for b in body.blocks}.values())
        assert message.startswith(
            f"{model}: {total} unknowns need about {need:.0f} MB to factor by"
        )
        assert "MB are free; lower " in message and "\n" not in message


@pytest.mark.long
def test_all_factors_of_a_body_are_refused_together(monkeypatch):
    """Each half of a keyed part would fit by itself."""
    body = sg.build(SCENES["pinion_keyed"], "solid", refinement=0.35)
    need = needed_mb(body, body.factoring)
    monkeypatch.setenv("SOLIDGEAR_MEMORY_MB", str(0.8 * need))
    with pytest.raises(NoRoom):
        factors(body)


ABSURD = (
    ("solid", {"refinement": 20}),
    ("harmonic", {"order": 12, "refinement": 20}),
    ("solid", {"element": "tet10", "graded_size": 1e-9}),
    ("solid", {"element": "tet10", "refinement": 20}),
)


@pytest.fixture
def no_mesh(monkeypatch):
    def meshed(*_, **__):
        pytest.fail("meshed")

    monkeypatch.setattr("solidgear.core.models.harmonic.body.meridian", meshed)
    monkeypatch.setattr("solidgear.core.models.solid.body.hexahedra", meshed)
    monkeypatch.setattr("solidgear.core.models.solid.body.tetrahedra", meshed)


@pytest.mark.parametrize("model, options", ABSURD)
def test_what_cannot_be_numbered_is_refused_before_meshing(no_mesh, monkeypatch, model, options):
    monkeypatch.setattr(memory, "available_mb", lambda: 1e9)
    monkeypatch.setattr("solidgear.core.ladder.remedies.LARGE", ())
    with pytest.raises(NoRoom, match=r"more than the 2e\+09 that can be numbered; lower"):
        sg.build(SCENES["pinion_overhung"], model, **options)


@pytest.mark.parametrize(
    "model, options",
    [("solid", {"refinement": 2}), ("solid", {"element": "tet10", "refinement": 3})],
)
def test_a_mesh_that_would_not_fit_is_refused_before_it_is_made(
    no_mesh, monkeypatch, model, options
):
    monkeypatch.setattr("solidgear.core.ladder.remedies.LARGE", ())
    monkeypatch.setenv("SOLIDGEAR_MEMORY_MB", "100")
    with pytest.raises(NoRoom, match="elements need about [0-9]* MB, 100 MB are free; lower"):
        sg.build(SCENES["pinion_overhung"], model, **options)


def test_a_refusal_needs_no_module_that_is_not_there_yet(monkeypatch):
    """Where memory has run out nothing can be imported; the sentence comes all the same."""

    def used_up():
        def without_memory(*_, **__):
            raise MemoryError

        monkeypatch.setattr(builtins, "__import__", without_memory)
        return 100.0

    monkeypatch.setattr(memory, "available_mb", used_up)
    with pytest.raises(NoRoom) as refusal:
        try:
            sg.build(SCENES["pinion_overhung"], "solid", refinement=3.0)
        finally:
            monkeypatch.undo()
    assert "100 MB are free; lower refinement" in str(refusal.value)


def test_a_builder_that_runs_out_of_memory_says_what_to_lower(monkeypatch):
    def broken(*_, **__):
        raise MemoryError

    monkeypatch.setattr("solidgear.core.models.solid.body._hexes", broken)
    with pytest.raises(sg.SolidgearError, match=r"matrices did not fit into memory; lower refine"):
        sg.build(SCENES["pinion_overhung"], "solid", refinement=0.3)


def test_matrices_that_would_not_fit_are_refused_before_they_are_made(monkeypatch):
    monkeypatch.setattr("solidgear.core.ladder.remedies.LARGE", ())
    scene, options = SCENES["pinion_overhung"], {"refinement": 0.7}
    size = LADDER["solid"].size(scene, options)
    monkeypatch.setenv("SOLIDGEAR_MEMORY_MB", str(0.95 * size.matrices_mb))
    with pytest.raises(NoRoom, match=f"solid: matrices of {size.unknowns} unknowns need about"):
        sg.build(scene, "solid", **options)


def test_beams_are_never_refused_for_want_of_memory(monkeypatch):
    monkeypatch.setenv("SOLIDGEAR_MEMORY_MB", "1")
    body = sg.build(SCENES["pinion_overhung"], "timoshenko")
    assert body.size == 446 and factors(body)


def test_what_is_small_is_assembled_whatever_there_is(monkeypatch):
    monkeypatch.setenv("SOLIDGEAR_MEMORY_MB", "1")
    room.assemblable(1000, 20)
    with pytest.raises(NoRoom):
        room.assemblable(100_000, 20)


def test_whoever_listens_is_told_before_factors_are_made():
    body = sg.build(SCENES["pinion_overhung"], "solid", refinement=0.3)
    said = []
    with memory.listening(lambda *one: said.append(one)):
        factors(body)
    unknowns = sum({id(b.stiffness): b.size for b in body.blocks}.values())
    assert said == [(unknowns, pytest.approx(needed_mb(body, body.factoring)))]


# ------------------------------------------------------------------------------------------------- peaks
PEAK = """
import json, resource, sys
from solidgear.core.machine.threads import pin
pin()
import solidgear as sg
from solidgear.core.machine.memory import one_run
from solidgear.core.solve.backends import missing
path, model, options = sys.argv[1], sys.argv[2], json.loads(sys.argv[3])
scene = sg.load(path)
missing("pardiso")
sg.condense(sg.build(scene, "timoshenko"), scene, scene.port.name)
import solidgear.core.models.harmonic.body, solidgear.core.models.solid.body
with one_run(watched=True) as run:
    body = sg.build(scene, model, **options)
    sg.condense(body, scene, scene.port.name)
    sg.modes(body, scene, n=10)
# of this program alone: ru_maxrss is inherited from the process that started it
status = open("/proc/self/status").read()
peak = int(status.split("VmHWM:")[1].split()[0]) / 1024
print(json.dumps([run.expected_mb - run.base_mb, peak - run.base_mb]))
"""


@pytest.mark.slow
@pytest.mark.skipif(
    not Path("/proc/self/statm").exists(), reason="resident memory is read from /proc"
)
@pytest.mark.parametrize(
    "name, model, options",
    [
        ("pinion_overhung", "solid", {}),
        ("shaft_hollow", "solid", {}),
        ("gear_shaft", "solid", {"element": "hex27", "refinement": 0.8}),
        ("shaft_stepped", "solid", {"element": "hex8", "refinement": 1.4}),
        ("pinion_overhung", "solid", {"element": "tet10"}),
        ("shaft_hollow", "solid", {"element": "tet4", "refinement": 2}),
        ("shaft_stepped", "harmonic", {"refinement": 1.5}),
        ("pinion_overhung", "harmonic", {"order": 8, "layers": 4, "edge_layers": 2}),
        ("pinion_overhung", "harmonic", {"order": 2, "refinement": 6}),
    ],
)
def test_the_expected_peak_is_within_a_third(name, model, options):
    arguments = [
        sys.executable,
        "-c",
        PEAK,
        str(GEOMETRY / f"{name}.toml"),
        model,
        json.dumps(options),
    ]
    expected, peak = json.loads(
        subprocess.run(arguments, capture_output=True, text=True, check=True).stdout
    )
    # allocators and back ends differ from machine to machine
    assert peak > 180 and 1 / 1.35 < expected / peak < 1.35


WHOLE = """
import json, sys
from solidgear.core.machine.threads import pin
pin()
import solidgear as sg
results = sg.compare(sg.load(sys.argv[1])).results
print(json.dumps([results["expected_peak_mb"], results["peak_mb"]]))
"""


@pytest.mark.slow
@pytest.mark.skipif(
    not Path("/proc/self/statm").exists(), reason="resident memory is read from /proc"
)
@pytest.mark.parametrize("name", ["motor_rotor", "input_shaft", "hypoid_pinion"])
def test_peak_of_a_whole_comparison_within_a_third(name):
    scene = Path(__file__).parent / "scenes" / f"{name}.toml"
    told = subprocess.run(
        [sys.executable, "-c", WHOLE, str(scene)], capture_output=True, text=True, check=True
    ).stdout
    expected, peak = json.loads(told)
    assert 1 / 1.3 < expected / peak < 1.3
    # 1500 MB on two of them; the rotor needs a third mesh of 71,000 unknowns in 3D for its 3 %
    assert peak < (1900 if name == "motor_rotor" else 1500)


@pytest.mark.slow
def test_a_comparison_stays_below_the_limit(monkeypatch):
    """A finer mesh that would not fit is refused with its number, and what was solved before is
    kept.
    """
    monkeypatch.setenv("SOLIDGEAR_MEMORY_MB", "150")
    scene = sg.load(GEOMETRY / "pinion_overhung.toml")
    results = sg.compare(
        scene.with_changes(ask=scene.ask.with_changes(tolerance=0.002)), ("timoshenko", "solid")
    ).results
    assert any("finer mesh" in w and "MB are free" in w for w in results["cautions"])
    assert results["models"]["solid"]["compliance"]
