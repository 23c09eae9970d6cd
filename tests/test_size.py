"""Unknowns and memory told before anything is meshed."""

import builtins
import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import solidgear as sg
from solidgear.ladder import remedies as ways
from solidgear.ladder.size import estimated_size, estimated_unknowns
from solidgear.meshing.element_size import estimated_counts

GEOMETRY = Path(__file__).parents[1] / "geometry"
SCENES = {
    name: sg.load(GEOMETRY / f"{name}.toml")
    for name in ("pinion_overhung", "shaft_hollow", "shaft_stepped", "gear_shaft", "cylinder_free")
}
LIGHT = (
    ("euler", {}),
    ("euler", {"elements": 77}),
    ("timoshenko", {}),
    ("timoshenko", {"mass": "lumped", "rotary_inertia": False}),
    ("harmonic", {"order": 1, "layers": 2}),
    ("harmonic", {"order": 2, "ovalising": (2, 3)}),
    ("harmonic", {"order": 4, "edge_layers": 2, "refinement": 0.6}),
    ("solid", {"element": "hex8", "refinement": 0.7}),
    ("solid", {"element": "hex20", "refinement": 0.4}),
    ("solid", {"element": "hex27", "refinement": 0.3, "around": 16}),
)


@pytest.mark.parametrize("scene", ["pinion_overhung", "shaft_hollow", "cylinder_free"])
@pytest.mark.parametrize("model, options", LIGHT)
def test_unknowns_are_counted_exactly(scene, model, options):
    body = sg.build(SCENES[scene], model, **options)
    size = estimated_size(SCENES[scene], model, options)
    assert size.unknowns == estimated_unknowns(SCENES[scene], model, options) == body.size
    entries = sum(block.stiffness.nnz for block in body.blocks if block.mirror is None)
    # rows that conditions on the axis or numbers that happen to be zero take out, at most half of
    # the smallest meshes' entries
    assert (
        entries <= size.entries + 36
        and size.entries < (1.01 if model == "solid" else 1.6) * entries
    )


def test_entries_of_hexahedra_are_exact_but_for_the_genus():
    # 18 entries are what a body without a hole has more than Euler's formula for one with a hole: 9
    # for each of two vertices
    for name, more in (("pinion_overhung", 18), ("shaft_hollow", 0)):
        body = sg.build(SCENES[name], "solid", element="hex20", refinement=0.4)
        assert (
            body.blocks[0].stiffness.nnz
            - estimated_size(SCENES[name], "solid", {"refinement": 0.4}).entries
            == more
        )


@pytest.mark.parametrize(
    "scene, options",
    [
        ("shaft_stepped", {"refinement": 0.5}),
        ("shaft_hollow", {"refinement": 0.5}),
        ("cylinder_free", {"refinement": 0.6}),
    ],
)
def test_tetrahedra_are_estimated(scene, options):
    options = {"element": "tet10", **options}
    body = sg.build(SCENES[scene], "solid", **options)
    # the constants were fitted to 21 meshes within 17 %
    assert estimated_unknowns(SCENES[scene], "solid", options) == pytest.approx(body.size, rel=0.2)


def test_counts_of_tetrahedra_hang_together():
    rod = SCENES["cylinder_free"].segments
    counts = {h: np.array(estimated_counts(rod, size=h)) for h in (0.01, 0.001)}
    vertices, edges, faces, cells = counts[0.001]
    # Euler's formula, which the fitted constants keep to their three digits
    assert abs(vertices - edges + faces - cells) < 2e-3 * vertices
    # a thousandfold, but for the surface, where the coarser mesh is held to 16 cells around besides
    assert np.all(counts[0.001] < 1000 * counts[0.01]) and np.all(
        counts[0.001] > 300 * counts[0.01]
    )


def test_twins_share_their_memory():
    one, two = (
        estimated_size(SCENES["pinion_overhung"], "harmonic", {"ovalising": waves})
        for waves in ((), (2,))
    )
    assert two.unknowns > one.unknowns and two.peak_mb > 1.2 * one.peak_mb


# ------------------------------------------------------------------------------------------------- refusals
BIG = (
    (
        "harmonic",
        {"order": 8, "layers": 4, "edge_layers": 2, "ovalising": (2, 3)},
        "fewer ovalising harmonics",
    ),
    ("harmonic", {"order": 1, "refinement": 20}, "lower order, refinement or layers"),
    (
        "solid",
        {},
        "lower refinement, around or the layers, or raise size, or use the harmonic model",
    ),
    ("solid", {"element": "tet10", "refinement": 1.5}, "raise size and graded_size"),
)


@pytest.mark.parametrize("model, options, lower", BIG)
def test_refused_before_meshing(monkeypatch, model, options, lower):
    def meshed(*_, **__):
        pytest.fail("meshed before the estimate")

    monkeypatch.setenv("SOLIDGEAR_MEMORY_MB", "250")
    monkeypatch.setattr("solidgear.models.harmonic.body.meridian", meshed)
    monkeypatch.setattr("solidgear.meshing.hexahedra.hexahedra", meshed)
    monkeypatch.setattr("solidgear.meshing.tetrahedra.tetrahedra", meshed)
    size = estimated_size(SCENES["pinion_overhung"], model, options)
    with pytest.raises(sg.SolidgearError) as caught:
        sg.build(SCENES["pinion_overhung"], model, **options)
    message = str(caught.value)
    assert f"{model}: about {size.unknowns} unknowns need about {size.peak_mb:.0f} MB" in message
    assert "250 MB are free" in message and lower in message


def test_more_entries_than_can_be_numbered(monkeypatch):
    monkeypatch.setattr(ways, "available_mb", lambda: 1e9)
    for model, options in (
        ("solid", {"refinement": 20}),
        ("harmonic", {"order": 12, "refinement": 20}),
        ("solid", {"element": "tet10", "graded_size": 1e-9}),
    ):
        with pytest.raises(
            sg.SolidgearError,
            match=r"matrix entries, more than the 2e\+09 that can be numbered; lower",
        ):
            sg.build(SCENES["pinion_overhung"], model, **options)


def test_beams_are_never_refused_for_want_of_memory(monkeypatch):
    monkeypatch.setenv("SOLIDGEAR_MEMORY_MB", "1")
    assert sg.build(SCENES["pinion_overhung"], "timoshenko").size == 446


def test_what_fits_is_built(monkeypatch):
    need = estimated_size(SCENES["pinion_overhung"], "harmonic").peak_mb
    for share, fits in ((1.01, True), (0.99, False)):
        monkeypatch.setattr(ways, "available_mb", lambda share=share: share * need)
        if fits:
            assert ways.refuse_too_large(SCENES["pinion_overhung"], "harmonic").peak_mb == need
        else:
            with pytest.raises(sg.SolidgearError, match="MB are free"):
                ways.refuse_too_large(SCENES["pinion_overhung"], "harmonic")


def test_a_refusal_needs_no_module_that_is_not_there_yet(monkeypatch):
    """Where memory has run out nothing can be imported; the sentence comes all the same."""

    def used_up():
        def without_memory(*_, **__):
            raise MemoryError

        monkeypatch.setattr(builtins, "__import__", without_memory)
        return 100.0

    monkeypatch.setattr("solidgear.machine.memory.available_mb", used_up)
    monkeypatch.setattr("solidgear.ladder.remedies.available_mb", used_up)
    with pytest.raises(sg.SolidgearError) as refusal:
        try:
            sg.build(SCENES["pinion_overhung"], "solid", refinement=3.0)
        finally:
            monkeypatch.undo()
    assert "100 MB are free; lower refinement" in str(refusal.value)


def test_a_builder_that_runs_out_of_memory_says_what_to_lower(monkeypatch):
    def broken(*_, **__):
        raise MemoryError

    monkeypatch.setattr("solidgear.models.solid.body._hexes", broken)
    with pytest.raises(sg.SolidgearError, match=r"unknowns did not fit into memory; lower refine"):
        sg.build(SCENES["pinion_overhung"], "solid", refinement=0.3)


# ------------------------------------------------------------------------------------------------- peaks
PEAK = """
import json, resource, sys
from solidgear.machine.threads import pin
pin()
import solidgear as sg
from solidgear.ladder.size import estimated_size
from solidgear.solve.factor import pardiso_missing
path, model, options = sys.argv[1], sys.argv[2], json.loads(sys.argv[3])
scene = sg.load(path)
pardiso_missing()
sg.condense(sg.build(scene, "timoshenko"), scene, scene.port.name)
import solidgear.models.harmonic.body, solidgear.models.solid.body
held = int(open("/proc/self/statm").read().split()[1]) * resource.getpagesize() / 2**20
body = sg.build(scene, model, **options)
sg.condense(body, scene, scene.port.name)
sg.modes(body, scene, n=10)
# of this program alone: ru_maxrss is inherited from the process that started it
status = open("/proc/self/status").read()
peak = int(status.split("VmHWM:")[1].split()[0]) / 1024 - held
print(json.dumps([estimated_size(scene, model, options).peak_mb, peak]))
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
def test_estimated_peak_within_a_third(name, model, options):
    arguments = [
        sys.executable,
        "-c",
        PEAK,
        str(GEOMETRY / f"{name}.toml"),
        model,
        json.dumps(options),
    ]
    estimate, peak = json.loads(
        subprocess.run(arguments, capture_output=True, text=True, check=True).stdout
    )
    # fitted within 1.2 on one machine; allocators and back ends of others differ
    assert peak > 180 and 1 / 1.3 < estimate / peak < 1.3


WHOLE = """
import json, sys
from solidgear.machine.threads import pin
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
    estimate, peak = json.loads(told)
    assert 1 / 1.3 < estimate / peak < 1.3
    # 1500 MB on two of them; the rotor needs a third mesh of 71,000 unknowns in 3D for its 3 %
    assert peak < (1900 if name == "motor_rotor" else 1500)


@pytest.mark.long
def test_a_comparison_stays_below_the_limit(monkeypatch):
    """A finer mesh that would not fit is refused with its number, and what was solved before is
    kept.
    """
    import solidgear as sg

    monkeypatch.setenv("SOLIDGEAR_MEMORY_MB", "150")
    scene = sg.load(GEOMETRY / "pinion_overhung.toml")
    results = sg.compare(
        scene.with_changes(ask=scene.ask.with_changes(tolerance=0.002)), ("timoshenko", "solid")
    ).results
    assert any("finer mesh" in w and "MB are free" in w for w in results["warnings"])
    assert results["models"]["solid"]["compliance"]
