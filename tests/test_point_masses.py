"""Rigid masses on ports and held ends: against matrices that hold them, against constrained systems
and closed forms, on every rung and in a sweep.
"""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import scipy.linalg as sla
import scipy.sparse as sp

import solidgear as sg
from solidgear.core.body import as_supports
from solidgear.core.body.cache import Cache
from solidgear.core.reduction.effective_mass import synthesise
from solidgear.variants.sweep.bearing_task import bearing_task
from solidgear.variants.sweep.bearing_variants import bearing_variants
from solidgear.variants.sweep.file_task import run
from tests.command import table
from tests.dense import every, whole

ROOT = Path(__file__).parent.parent
DISC = ROOT / "geometry" / "rotor_disc.toml"
LIGHT = {
    "euler": {},
    "timoshenko": {},
    "harmonic": {"order": 3, "layers": 1},
    "solid": {"layers": 0, "radial_layers": 0, "edge_layers": 0, "around": 8, "relative_size": 3.0},
}
STEEL = sg.Material(E=2.07e11, nu=0.3, density=7850.0)


@pytest.fixture(scope="module")
def scene():
    return sg.load(DISC)


@pytest.fixture(scope="module")
def bodies(scene):
    return {rung: sg.build(scene, rung, **options) for rung, options in LIGHT.items()}


def rows_of(body, block, name):
    """Port rows of a block."""
    c, p = len(block.components), body.port_index(name)
    return block.ports[[c * p + k for k in range(c)]]


def with_mass_in_the_matrix(body, supports):
    """The same body with the masses added to its matrices, to be factored with them."""
    blocks = []
    for block in body.blocks:
        if block.mirror is not None:  # a disc is as round as the shaft
            blocks.append(replace(block, mass=blocks[block.mirror[0]].mass))
            continue
        c = list(block.components)
        at = [6 * i + k for i in range(len(supports.ports)) for k in c]
        rows = sp.vstack([rows_of(body, block, name) for name in supports.ports])
        added = rows.T @ sp.csr_matrix(supports.masses[np.ix_(at, at)]) @ rows
        blocks.append(replace(block, mass=(block.mass.tocsr() + added).tocsr()))
    return replace(body, blocks=tuple(blocks), cache=Cache())


@pytest.mark.parametrize(
    "rung", [pytest.param(r, marks=pytest.mark.long if r == "solid" else ()) for r in LIGHT]
)
def test_low_rank_equals_mass_in_the_matrix(bodies, scene, rung):
    supports = as_supports(scene)
    low = sg.modes(bodies[rung], supports, n=8, ovalising=False)
    full = with_mass_in_the_matrix(bodies[rung], supports)
    high = sg.modes(full, replace(supports, inertia=None), n=8, ovalising=False)
    # both solve one eigenproblem: what is left is the rounding they report themselves (1e-13 to
    # 2e-12 measured, 2e-9 for the Euler beam, whose mass matrix is nearly singular)
    left = max(1e-9, low.evidence["error"] + high.evidence["error"])
    assert np.abs(every(low)[:8] / every(high)[:8] - 1).max() < left < 1e-8
    plain = sg.modes(bodies[rung], replace(supports, inertia=None), n=8, ovalising=False)
    assert abs(plain.named("bending 1").frequency_hz / low.named("bending 1").frequency_hz) > 2


def test_nothing_is_factored_again_and_statics_do_not_change(bodies, scene, monkeypatch):
    body = bodies["harmonic"]
    bare = sg.condense(body, scene.with_changes(masses=()).bearings, "fan")
    monkeypatch.setattr("solidgear.core.solve.shifted._plan", None)  # the factors are there
    laden = sg.condense(body, scene, "fan")
    assert np.abs(laden.compliance - bare.compliance).max() <= 1e-13 * np.abs(bare.compliance).max()
    sg.modes(body, scene, n=4, ovalising=False)


def test_every_mode_is_counted_with_masses(bodies, scene):
    found = sg.modes(bodies["harmonic"], scene, n=8, count=True, ovalising=False)
    assert all(verdict["checked"] for verdict in found.evidence["count"])
    # a count blind to the masses would find some twenty modes fewer below the same frequency
    assert found.evidence["counted_below_hz"] > 1000


@pytest.mark.parametrize("rung", ["timoshenko", "harmonic"])
def test_clamped_equals_the_constrained_system(bodies, scene, rung):
    """Lagrange multipliers on the port rows, dense, nothing shared with the springs of low rank."""
    body, roller = bodies[rung], scene.bearings[1]
    got = sg.condense(body, scene, "fan").compliance
    for block in body.blocks:
        if block.mirror is not None or block.size > 2500:
            continue
        c = list(block.components)
        k = block.stiffness.toarray()
        spring = rows_of(body, block, "roller").toarray()
        k += spring.T @ roller.stiffness[np.ix_(c, c)] @ spring
        held = rows_of(body, block, "spindle").toarray()
        load = rows_of(body, block, "fan").toarray()
        size = np.abs(k).max()
        kkt = np.block([[k, size * held.T], [size * held, np.zeros((len(held),) * 2)]])
        right = np.vstack([load.T, np.zeros((len(held), len(load)))])
        wanted = load @ sla.solve(kkt, right)[: len(k)]
        scale = np.sqrt(np.outer(np.diag(wanted), np.diag(wanted)))
        # the finite spring of a clamp is worth 1e-12 here, dense rounding as much
        assert (np.abs(got[np.ix_(c, c)] - wanted) / scale).max() < 1e-11


def cantilever(length=0.5, mass=0.0, inertia=0.0, hold="clamped", rim=0.01):
    rod = sg.Segment.cylinder("rod", length=length, diameter=0.02, material=STEEL)
    return sg.Scene.from_parts(
        [rod],
        STEEL,
        [sg.Bearing(name="wall", y=0.0, seat_width=rim, face="start", hold=hold)],
        sg.Port(name="tip", y=length, lo=length - 0.01, hi=length, attachment="section"),
        masses=[
            sg.PointMass(name="tip mass", on="tip", mass=mass, inertia=[inertia, inertia, inertia])
        ]
        if mass
        else [],
    ).with_attachment("section")


def test_clamped_bar_by_closed_form():
    """A clamped bar is (1.8751 / L)^2 sqrt(E I / rho A) / 2 pi (Blevins, table 8-1)."""
    scene = cantilever()
    found = sg.modes(sg.build(scene, "euler", elements=60), scene, n=12)
    wave = math.sqrt(STEEL.E / STEEL.density) * 0.02 / 4
    exact = (1.8751040687 / 0.5) ** 2 * wave / (2 * math.pi)
    assert found.named("bending 1").frequency_hz == pytest.approx(exact, rel=1e-7)
    axial = math.sqrt(STEEL.E / STEEL.density) / (4 * 0.5)
    assert found.named("axial 1").frequency_hz == pytest.approx(axial, rel=1e-4)


@pytest.mark.parametrize("model", ["timoshenko", "harmonic", "solid"])
@pytest.mark.parametrize("tie", ["average", "rigid"])
def test_a_clamped_face_is_the_face_however_seats_are_attached(model, tie):
    """By closed form again; a clamped rim of 20 mm would be 8 % above, shear and Poisson's effect at
    the wall move it by less than 1 %.
    """
    scene = cantilever(rim=0.02).with_attachment(tie)
    exact = (1.8751040687 / 0.5) ** 2 * math.sqrt(STEEL.E / STEEL.density) * 0.005 / (2 * math.pi)
    # a solid has every attachment anyway
    for given in ({}, {"attachments": (tie,)})[: 1 if model == "solid" else 2]:
        body = sg.build(scene, model, **LIGHT[model], **given)
        found = sg.modes(body, scene, n=2).named("bending 1").frequency_hz
        assert found == pytest.approx(exact, rel=0.01)


def test_a_heavy_tip_mass_by_closed_form():
    """``sqrt(3 E I / (M + 33/140 m) L^3)``: of Rayleigh, above the truth by far less than 1e-3 for a
    tip 20 times as heavy as the bar (Blevins, table 8-8).
    """
    bar = 7850 * math.pi * 0.01**2 * 0.5
    scene = cantilever(mass=20 * bar)
    found = sg.modes(sg.build(scene, "euler", elements=40), scene, n=4)
    stiffness = 3 * STEEL.E * math.pi * 0.01**4 / 4 / 0.5**3
    exact = math.sqrt(stiffness / (20 * bar + 33 / 140 * bar)) / (2 * math.pi)
    assert found.named("bending 1").frequency_hz == pytest.approx(exact, rel=1e-5)


@pytest.mark.parametrize("length", [0.2, pytest.param(2.0, marks=pytest.mark.slow)])
@pytest.mark.filterwarnings("error::RuntimeWarning")
def test_modes_rest_where_a_shaft_is_clamped(length):
    """A seat that slips by 1e-10 of the motion counts with 1e22 N/m: residuals of 1e-3 to 1e-1, and
    frequencies off by 5e-6; one that does not move at all is no reason to divide by zero.

    What is left, 3e-6 at most, is what the eigensolver leaves of a shape and the rounding of the
    free body, which grows with the square of its highest frequency over the lowest.
    """
    heavy = cantilever(length, mass=20.0, inertia=0.1)
    for scene in (cantilever(length), heavy):
        for name in ("euler", "timoshenko", "harmonic"):
            found = sg.modes(sg.build(scene, name), scene, n=8)
            assert found.evidence["residual"] < 1e-4, name


def test_pinned_turns_and_clamped_does_not():
    pinned, clamped = cantilever(hold="pinned"), cantilever()
    body = sg.build(pinned, "timoshenko")
    assert sg.condense(body, pinned, "tip").free_names == ("thy",)
    assert sg.modes(body, pinned, n=4).names[:3] == (
        "rigid bending",
        "rigid bending",
        "rigid torsion",
    )
    assert sg.condense(body, clamped, "tip").free_names == ()


def test_an_offset_mass_couples_what_a_centred_one_does_not(bodies, scene):
    """Against a dense eigenproblem of the whole body with the mass in it: the blocks are coupled."""
    heavy = sg.PointMass(
        name="crank", on="fan", mass=5.0, inertia=[0.01] * 3, offset=[0.03, 0.01, 0.08]
    )
    firm = np.diag([1e10] * 3 + [1e7] * 3)
    bearings = tuple(b.with_changes(hold=None, matrix=firm) for b in scene.bearings)
    odd = scene.with_changes(masses=(heavy,), bearings=bearings)
    body = sg.build(odd, "timoshenko", elements=8)
    found = sg.modes(body, odd, n=8)
    supports = as_supports(odd)
    k, m, g = whole(body)
    seats = np.vstack([g[6 * body.port_index(name) :][:6] for name in supports.ports])
    k += seats.T @ supports.stiffness @ seats
    m += seats.T @ supports.masses @ seats
    exact = np.sqrt(sla.eigh(k, m, eigvals_only=True, subset_by_index=[0, 7])) / (2 * np.pi)
    assert every(found)[:8] == pytest.approx(exact, rel=1e-9)
    assert max(found.multiplicity) == 1  # no plane is like the other: nothing is a pair


@pytest.mark.long
def test_the_sweep_carries_masses(scene, tmp_path):
    out = tmp_path / "rows.csv"
    options = LIGHT["harmonic"]
    vary = ["bearing.roller.scale=log:0.1:10:3"]
    variants = bearing_variants(DISC, vary)
    run(bearing_task(variants, options=options, n=8), out)
    rows = table(out)
    body = sg.build(scene, "harmonic", **options)
    for row in rows:
        assert row["how"] == "reduced" and float(row["reduction_bound"]) < 1e-6
        scaled = scene.bearings[1].scaled(float(row["bearing.roller.scale"]))
        here = scene.with_changes(bearings=(scene.bearings[0], scaled))
        wanted = every(sg.modes(body, here, n=8, ovalising=False))[:8]
        assert [float(row[f"f{k}_hz"]) for k in range(1, 9)] == pytest.approx(wanted, rel=1e-6)


def test_a_free_disc_leaves_rigid_motions_exact(tmp_path):
    """Torsion that nothing resists, with a disc on it: zero, and the elastic one by the sweep too."""
    path = tmp_path / "loose.toml"
    text = DISC.read_text()
    start, end = text.index('name = "coupling"'), text.index("[port]")
    text = text[: text.rindex("[[mass]]", 0, start)] + text[end:]
    start = text.index('name = "spindle"')
    end = text.index("[[bearing]]", start)
    soft = 'name = "spindle"\nposition = 0.05\nseat_width = "20 mm"\n'
    soft += "stiffness = { kxx = 1e8, kyy = 1e7, kzz = 1e8 }\n"
    path.write_text(text[:start] + soft + text[end:])
    loose = sg.load(path)
    body = sg.build(loose, "timoshenko")
    found = sg.modes(body, loose, n=10)
    assert found.names[0] == "rigid torsion" and found.frequency_hz[0] == 0.0
    out = tmp_path / "rows.csv"
    variants = bearing_variants(path, ["bearing.spindle.scale=1:2:2"])
    run(bearing_task(variants, model="timoshenko", n=10), out)
    row, *_ = table(out)
    wanted = every(found)[:11][1:]
    assert [float(row[f"f{k}_hz"]) for k in range(1, 11)] == pytest.approx(wanted, rel=1e-6)


def test_lumped_models_and_systems_carry_the_masses(bodies, scene):
    body = bodies["timoshenko"]
    point, _ = synthesise(body, scene, "fan")
    assert point.total_mass == pytest.approx(body.mass_matrix()[2, 2] + 22 + 3.1)
    assert 0.99 < point.static_share <= 1 + 1e-9  # the overhung disc makes the mode a static shape
    links = sg.grounded("shaft", scene)
    assert {"shaft.fan.mass", "shaft.coupling.mass"} <= set(links)
    whole = sg.System({"shaft": sg.rubin(body, n=30)}, links)
    own = sg.modes(body, scene, n=4).frequency_hz
    assert whole.modes(4).frequency_hz[0] == pytest.approx(own[0], rel=1e-4)


def test_a_mass_as_a_slice_of_the_shaft():
    """A rigid mass in place of the last slice of a stiff shaft: the rigid-body constants are those
    of the slice, and so is what bearings feel.
    """
    rod = sg.Segment.cylinder("rod", length=0.3, diameter=0.1, material=STEEL)
    m = 7850 * math.pi * 0.05**2 * 0.1
    disc = sg.PointMass(
        name="slice",
        on="port",
        mass=m,
        inertia=[m * (3 * 0.05**2 + 0.1**2) / 12, m * 0.05**2 / 2, m * (3 * 0.05**2 + 0.1**2) / 12],
        offset=[0, 0.05, 0],
    )
    short = sg.Scene.from_parts([rod], STEEL, port=sg.Port(y=0.3, lo=0.29, hi=0.3), masses=[disc])
    body = sg.build(short, "timoshenko")
    long = sg.Scene.from_parts([sg.Segment.cylinder("rod", length=0.4, diameter=0.1)])
    wanted = sg.build(long, "timoshenko").mass_matrix()
    got = body.mass_matrix() + as_supports(short).rigid_mass(body)
    assert np.abs(got - wanted).max() < 1e-9 * np.abs(wanted).max()


BAD = {
    'on = "fan"\nmass = "22 kg"': (
        'on = "fun"\nmass = "22 kg"',
        "no lumped point, bearing or segment has",
    ),
    'mass = "22 kg"': ('mass = "0 kg"', "must be greater than zero"),
    '"0.318 kg*m^2"': ('"0.5 kg*m^2"', "larger than the sum of the other two"),
    'offset = ["0 mm", "12 mm", "0 mm"]': ('offset = ["0 mm", "12 mm"]', "three quantities"),
    'seat_width = "24 mm"': ("", "seat_width: this key is missing"),
    'position = "60 mm"': ('position = "470 mm"', "must lie inside the shaft"),
    'hold = "clamped"': ('hold = "welded"', "hold"),
    'face = "start"  ': ('face = "start"\nposition = "3 mm"  ', "not both"),
    'name = "coupling"': ('name = "roller"', "needs its own"),
    "inertia = [4.2e-3, 7.5e-3, 4.2e-3]": ('inertia = [4.2e-3, "7 kg", 4.2e-3]', "inertia"),
}


@pytest.mark.parametrize("old", BAD)
def test_a_bad_mass_or_clamp_is_one_sentence(old, refused):
    text = (ROOT / "geometry" / "rotor_disc.toml").read_text()
    new, says = BAD[old]
    refused(text, old, new, says)
