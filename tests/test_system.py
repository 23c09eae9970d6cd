"""Systems of parts and links against answers by hand, and against matrices that share no code with them."""

import re

import numpy as np
import pytest
import scipy.linalg as sla
import scipy.sparse as sp
import scipy.sparse.linalg as spla

import solidgear as sg
from solidgear.core.frames import rotation, shift
from solidgear.core.reduction.superelement import PortMotion
from solidgear.core.system.gear_mesh import line_of_action, mesh_point, to_gear_frame

PINION, GEAR = sg.load("geometry/pinion_overhung.toml"), sg.load("geometry/gear_shaft.toml")
RATIO = 45 / 14
MESH = 8.6e8
NORMAL = line_of_action(0.391, 0.478, np.radians(25), "left", "concave")
ON_PINION = sg.MeshVector(NORMAL, mesh_point(0.055, 0.004))
ON_GEAR = sg.MeshVector(to_gear_frame(NORMAL), mesh_point(0.055 * RATIO, -0.003, member="gear"))
#: eigenvalues of full matrices are rounded by some 1e-16 of the highest, (1 MHz)^2 beside (700 Hz)^2
LAPACK = 1e-9
#: the frame of the gear in that of the pinion: axes cross at a right angle
ACROSS = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])


def drive(pinion, gear, reduction=sg.rubin, **options):
    """Two shafts on their bearings, axes at a right angle, coupled by the mesh spring."""
    parts = {
        "pinion": reduction(pinion, **options),
        "gear": sg.Placed(reduction(gear, **options), ACROSS, (0.0, 0.0, 0.0)),
    }
    mesh = sg.mesh_spring("pinion.pinion", ON_PINION, "gear.gear", ON_GEAR, MESH)
    links = (
        sg.grounded("pinion", PINION.bearings) | sg.grounded("gear", GEAR.bearings) | {"mesh": mesh}
    )
    return sg.System(parts, links)


class Assembled:
    """K, M and port rows of free bodies side by side, bearings and mesh added to K: nothing of the package but the blocks."""

    def __init__(self, *shafts):
        blocks = [(body, b) for body, _ in shafts for b in body.blocks if b.components]
        self.elastic = sp.block_diag([b.stiffness for _, b in blocks]).tocsr()
        self.mass = sp.block_diag([b.mass for _, b in blocks]).tocsr()
        self.stiffness = self.elastic.copy()
        self.rows, start = [], 0
        for body, scene in shafts:
            ports = {p.name: np.zeros((6, self.mass.shape[0])) for p in body.ports}
            for block in body.blocks:
                if not block.components:
                    continue
                own, c = block.ports.toarray(), len(block.components)
                for k, name in enumerate(ports):
                    ports[name][list(block.components), start : start + block.size] = own[
                        c * k : c * k + c
                    ]
                start += block.size
            for bearing in scene.bearings:
                g = sp.csr_matrix(ports[bearing.name])
                self.stiffness = self.stiffness + g.T @ sp.csr_matrix(bearing.stiffness) @ g
            self.rows.append(ports)
        row = ON_PINION.vector @ self.rows[0]["pinion"] - ON_GEAR.vector @ self.rows[1]["gear"]
        self.mesh = sp.csr_matrix(row[None])
        self.stiffness = self.stiffness + MESH * self.mesh.T @ self.mesh


@pytest.fixture(scope="module")
def beams():
    return sg.build(PINION, "timoshenko", elements=12), sg.build(GEAR, "timoshenko", elements=12)


@pytest.fixture(scope="module")
def whole(beams):
    """The coarse pair in full, and its modes by LAPACK."""
    full = Assembled((beams[0], PINION), (beams[1], GEAR))
    value, shapes = sla.eigh(full.stiffness.toarray(), full.mass.toarray())
    return full, np.sqrt(np.abs(value)) / (2 * np.pi), shapes


# -- two shafts and a mesh ---------------------------------------------------------------------------------------------------
@pytest.mark.parametrize(
    "reduction, options",
    [
        (sg.rubin, {"n": 6, "steps": 0}),
        (sg.rubin, {"n": 12, "steps": 0}),
        (sg.rubin, {"n": 24, "steps": 1}),
        (sg.craig_bampton, {"n": 6}),
        (sg.craig_bampton, {"n": 24}),
    ],
)
def test_coupled_beams_against_the_full_matrices(beams, whole, reduction, options):
    found = drive(*beams, reduction, **options).modes(12)
    assert found.rigid == 1 and found.frequency_hz[0] == 0.0
    error, bound = found.frequency_hz[1:] / whole[1][1:13] - 1, found.error_bound[1:]
    assert error.min() > -LAPACK and np.all(error <= bound + LAPACK)
    # proven, and not far above
    clear = error > 1e-7
    assert np.all(bound[clear] < 2 * error[clear])
    # poor bases are seen to be poor, so that there is something to bound
    assert clear.any() == (options.get("steps") != 1)


def test_a_bound_falls_with_the_basis(beams):
    few, more = (drive(*beams, n=n, steps=s).modes(8).error_bound for n, s in ((6, 0), (20, 0)))
    assert np.all(more[1:] < few[1:]) and np.isfinite(few).all()


def test_coupled_harmonic_shafts_against_the_full_matrices():
    light = {"order": 2, "layers": 1}
    bodies = [sg.build(s, "harmonic", **light) for s in (PINION, GEAR)]
    found = drive(*bodies, n=16).modes(8)
    full = Assembled((bodies[0], PINION), (bodies[1], GEAR))
    shift_ = (2 * np.pi * 100) ** 2
    value = spla.eigsh(full.stiffness, 9, full.mass, sigma=-shift_, return_eigenvectors=False)
    exact = np.sqrt(np.sort(value)[1:]) / (2 * np.pi)
    assert found.rigid == 1
    np.testing.assert_allclose(found.frequency_hz[1:], exact, rtol=LAPACK)
    assert found.error_bound.max() < LAPACK


def test_shares_of_energy_are_those_of_the_full_matrices(beams, whole):
    full, hertz, shapes = whole
    found = drive(*beams, n=24).modes(6)
    for k in (1, 2, 5):
        mesh = MESH * (full.mesh @ shapes[:, k])[0] ** 2 / (2 * np.pi * hertz[k]) ** 2
        assert found.energy["mesh"][k] == pytest.approx(mesh, abs=1e-6)
        bearing = full.rows[0]["2"] @ shapes[:, k]
        held = bearing @ PINION.bearings[1].stiffness @ bearing / (2 * np.pi * hertz[k]) ** 2
        assert found.energy["pinion.2"][k] == pytest.approx(held, abs=1e-6)
    np.testing.assert_allclose(sum(found.energy.values())[1:], 1.0, rtol=1e-9)
    assert not any(share[0] for share in found.energy.values())
    assert found.dominant()[0] == "rigid"


def test_response_on_four_thousand_frequencies(beams, whole):
    full, hertz, _ = whole
    system = drive(*beams, n=24)
    frequency = np.linspace(1.0, 0.8 * hertz[8], 4000)
    # both sides of the mesh are pushed apart: transmission error of a micrometre
    push = (
        1e-6
        * MESH
        * (
            system.motion("pinion.pinion").T @ ON_PINION.vector
            - system.motion("gear.gear").T @ ON_GEAR.vector
        )
    )
    loss = {"pinion": 0.002, "gear": 0.002, "mesh": 0.02, "pinion.1": 0.01}
    moved = system.response(frequency, push, loss=loss) @ system.motion("gear.4").T
    k = full.elastic * (1 + 0.002j) + (1 + 0.02j) * MESH * full.mesh.T @ full.mesh
    for ports, scene in zip(full.rows, (PINION, GEAR)):
        for bearing in scene.bearings:
            eta = 0.01j if bearing.name == "1" else 0.0
            g = sp.csr_matrix(ports[bearing.name])
            k = k + g.T @ sp.csr_matrix(bearing.stiffness * (1 + eta)) @ g
    load = 1e-6 * MESH * full.mesh.toarray()[0]
    sharp = int(np.argmax(np.abs(moved[:, 2])))
    for i in (0, 700, 1999, sharp, 3999):
        w2 = (2 * np.pi * frequency[i]) ** 2
        exact = full.rows[1]["4"] @ spla.spsolve((k - w2 * full.mass).tocsc(), load)
        assert np.abs(moved[i] - exact).max() < 1e-6 * np.abs(exact).max()
    assert moved.shape == (4000, 6)


def eliminated(system, hertz, load, loss):
    """Each frequency by itself, in the coordinates of the system, equations of one size."""
    rows, where = system.strains
    factor = np.ones(len(rows), complex)
    for name, eta in loss.items():
        factor[where[name]] += 1j * eta
    elastic = rows.T @ (factor[:, None] * rows)
    for f in hertz:
        inertia = (2 * np.pi * f) ** 2 * system.mass
        size = np.sqrt(np.diag(elastic).real + np.diag(inertia))
        dynamic = (elastic - inertia) / np.outer(size, size)
        yield np.linalg.solve(dynamic, load / size) / size


@pytest.mark.parametrize("mixed", [False, True], ids=["one loss but few", "many losses"])
def test_a_response_to_a_transmission_error_has_eight_digits(beams, mixed):
    """The mesh drives its stiff spring, and what the shafts do is a difference of large terms.

    A sum over modes whose rounding is that of the highest keeps seven digits here, one whose
    rounding is that of the lowest nine.
    """
    system = drive(*beams, n=16)
    names = [*system.strains[1]]
    loss = {n: 0.01 * (1 + k % 3 * mixed) for k, n in enumerate(names)} | {"mesh": 0.12}
    pinion, gear = (system.motion(end) for end in ("pinion.pinion", "gear.gear"))
    push = pinion.T @ ON_PINION.vector - gear.T @ ON_GEAR.vector
    seen = np.vstack([pinion[:3], gear[:3]])
    hertz = [10.0, 60.0, 580.0, 1500.0, 3000.0]
    exact = np.array([seen @ q for q in eliminated(system, hertz, push, loss)])
    found = system.response(hertz, push, loss=loss) @ seen.T
    np.testing.assert_allclose(found, exact, rtol=5e-9)


def test_twins_that_lose_at_one_bearing_answer_as_they_do_in_full():
    """Bending in two planes at one frequency: any two shapes of that plane may be its modes."""
    scene = sg.load("geometry/shaft_stepped.toml")
    shaft = sg.rubin(sg.build(scene, "timoshenko"), n=8)
    system = sg.System({"shaft": shaft}, sg.grounded("shaft", scene))
    loss = {"shaft": 0.004, "shaft.A": 0.05, "shaft.B": 0.02}
    push = system.load({"shaft.port": [1.0, 0.3, 0.5, 0.01, 0.0, 0.02]})
    hertz = [10.0, 580.0, 1500.0]
    exact = np.array([*eliminated(system, hertz, push, loss)])
    seen = system.motion("shaft.port")[[0, 1, 2, 3, 5]]
    found = system.response(hertz, push, loss=loss)
    np.testing.assert_allclose(found @ seen.T, exact @ seen.T, rtol=1e-9)


# -- parts and links by hand -------------------------------------------------------------------------------------------------
def test_structural_damping_of_one_mass():
    system = sg.System(
        {"mass": sg.Inertia(2.0, "z")}, {"spring": sg.torsion_spring("mass", 800.0, dof="z")}
    )
    push = system.load({"mass": np.eye(6)[2]})
    own = 20.0 / (2 * np.pi)
    assert system.modes().frequency_hz == pytest.approx([own], rel=1e-14)
    for given in ({"damping": 0.01}, {"loss": {"spring": 0.02}}):
        found = system.response([0.0, own, 2 * own], push, **given)[:, 0]
        z = system.motion("mass")[2, 0] * found
        want = 1 / (800 * (1 + 0.02j) - 2 * np.array([0.0, 20.0, 40.0]) ** 2)
        np.testing.assert_allclose(z, want, rtol=1e-10)
    with pytest.raises(sg.SolidgearError, match="undamped mode"):
        system.response([own], push)


def test_free_masses_answer_with_their_inertia():
    train = sg.System(
        {"motor": sg.Inertia(2.0), "fan": sg.Inertia(3.0)},
        {"shaft": sg.torsion_spring("motor", 400.0, "fan")},
    )
    push = train.load({"motor": np.eye(6)[4]})
    w = 2 * np.pi * 0.7
    dynamic = np.array([[400 - 2 * w**2, -400], [-400, 400 - 3 * w**2]])
    found = train.response([0.7], push)[0]
    np.testing.assert_allclose(found, np.linalg.solve(dynamic, [1.0, 0.0]), rtol=1e-12)
    with pytest.raises(sg.SolidgearError, match="at 0 Hz"):
        train.response([0.0], push)
    with pytest.raises(sg.SolidgearError, match="nothing resists"):
        train.static(push)
    # balanced, they twist the shaft by 1 / 400
    twist = train.static(train.load({"motor": np.eye(6)[4], "fan": -np.eye(6)[4]}))
    assert twist[0] - twist[1] == pytest.approx(1 / 400, rel=1e-12)


def bodies_joined(turn=None, origin=(0.0, 0.0, 0.0)):
    """Two free rigid bodies joined by a bearing between ports that do not coincide, placed anywhere."""
    mass = np.diag([3.0, 3, 3, 0.02, 0.03, 0.04])
    spring = shift((0, -0.1, 0)).T @ np.diag([1e6, 2e6, 3e6, 1e3, 2e3, 3e3]) @ shift((0, -0.1, 0))
    away = np.array([0.0, 0.4, 0.1])
    lean = rotation(0, 0.3)[:3, :3]
    turn, origin = np.eye(3) if turn is None else turn, np.asarray(origin)
    parts = {
        "first": sg.Placed(sg.RigidBody(mass, {"seat": (0, 0.2, 0)}), turn, origin),
        "second": sg.Placed(
            sg.RigidBody(2 * mass, {"seat": (0.05, 0, 0)}), turn @ lean, origin + turn @ away
        ),
    }
    return sg.System(parts, {"bearing": sg.BearingSpring("first.seat", spring, "second.seat")})


def test_a_bearing_between_two_parts_lets_them_move_together():
    turned = rotation(2, 1.1)[:3, :3] @ rotation(1, -0.4)[:3, :3]
    system, other = bodies_joined(), bodies_joined(turned, (1.0, -2.0, 3.0))
    for pair in (system, other):
        # one rigid motion of both, told at the origin and in the axes of each
        both = [
            np.kron(np.eye(2), part.rotation.T) @ shift(part.origin) for part in pair.parts.values()
        ]
        strain = pair.strains[0]
        assert np.abs(strain @ np.vstack(both)).max() < 1e-12 * np.abs(strain).max()
    found, elsewhere = system.modes(), other.modes()
    assert found.rigid == 6 and found.frequency_hz[6] > 1
    np.testing.assert_allclose(elsewhere.frequency_hz[6:], found.frequency_hz[6:], rtol=1e-9)


def test_a_rod_between_two_ports_of_one_shaft_holds_nothing(beams):
    part = sg.rubin(beams[0], n=12)
    rod = sg.BearingSpring("shaft.1", np.diag([0, 1e9, 1e9, 1e5, 1e5, 0]), "shaft.2")
    free, tied = sg.System({"shaft": part}), sg.System({"shaft": part}, {"rod": rod})
    assert free.modes(3).rigid == tied.modes(3).rigid == 6
    # it stiffens one of the two bending planes
    assert tied.modes(3).frequency_hz[7] > 1.001 * free.modes(3).frequency_hz[7]


@pytest.mark.parametrize("stiff", [1e-22, 1e-3, 1e8, 1e20])
def test_zero_frequencies_do_not_depend_on_how_stiff_springs_are(stiff):
    parts = {name: sg.Inertia(j) for name, j in zip("abcd", (1.0, 1e-4, 1e3, 2.0))}
    links = {
        "soft": sg.torsion_spring("a", 1.0, "b"),
        "any": sg.torsion_spring("c", stiff, "d"),
        "twice": sg.torsion_spring("c", 1e7, "b"),
    }
    found = sg.System(parts, links).modes()
    assert found.rigid == 1 and found.residual < 1e-12


def test_a_redundant_spring_takes_no_second_motion_away():
    links = {str(k): sg.torsion_spring("body", 10.0**k, dof="x") for k in range(3)}
    assert sg.System({"body": sg.RigidBody(np.eye(6))}, links).modes().rigid == 5


def test_an_inertia_at_a_port_is_mass_of_the_part(beams, whole):
    extra = np.diag([5.0, 5, 5, 0.05, 0.08, 0.05])
    system = drive(*beams, n=24)
    loaded = sg.System(
        system.parts, {**system.links, "disc": sg.PortInertia("pinion.pinion", extra)}
    )
    full = whole[0]
    g = sp.csr_matrix(full.rows[0]["pinion"])
    mass = (full.mass + g.T @ sp.csr_matrix(extra) @ g).toarray()
    exact = np.sqrt(sla.eigh(full.stiffness.toarray(), mass, eigvals_only=True)[1:9]) / (2 * np.pi)
    found = loaded.modes(8)
    error = found.frequency_hz[1:] / exact - 1
    assert np.all((error > -LAPACK) & (error <= found.error_bound[1:] + LAPACK))
    assert found.error_bound.max() < 1e-4
    assert np.all(exact < whole[1][1:9] * (1 + 1e-8)) and exact[0] < 0.9 * whole[1][1]


# -- a part kind and a link kind of one's own --------------------------------------------------------------------------------
class Rod:
    """A bar of n equal masses and springs along y, with a port at each end."""

    def __init__(self, n, mass, stiffness):
        self.mass = mass * np.eye(n)
        self.strain = np.sqrt(stiffness) * np.diff(np.eye(n), axis=0)
        self.ports = {}
        for name, at in (("left", 0), ("right", n - 1)):
            rows = np.zeros((6, n))
            rows[1, at] = 1.0
            self.ports[name] = PortMotion(rows, np.array([0.0, at, 0.0]), np.eye(3))


class Middle:
    """A spring that holds one port half-way between two others."""

    def __init__(self, stiffness, *ends):
        self.ends, self.root = ends, np.sqrt(stiffness)

    def strain(self, a, b, c):
        return self.root * (b.rows[[1]] - (a.rows[[1]] + c.rows[[1]]) / 2)


def test_a_part_and_a_link_of_ones_own_are_one_class_each():
    system = sg.System(
        {"rod": Rod(5, 2.0, 3e4), "ball": sg.RigidBody(np.eye(6)), "other": Rod(2, 1.0, 1e4)},
        {
            "between": Middle(5e3, "rod.left", "ball", "other.right"),
            "wall": sg.torsion_spring("rod.right", 1e4, dof="y"),
        },
    )
    k = np.zeros((13, 13))
    for start, n, c in ((0, 5, 3e4), (11, 2, 1e4)):
        for i in range(start, start + n - 1):
            k[i : i + 2, i : i + 2] += c * np.array([[1.0, -1.0], [-1.0, 1.0]])
    row = np.zeros(13)
    row[[0, 6, 12]] = -0.5, 1.0, -0.5
    k += 5e3 * np.outer(row, row)
    k[4, 4] += 1e4
    mass = np.r_[[2.0] * 5, [1.0] * 8]
    value = np.linalg.eigvalsh(k / np.sqrt(np.outer(mass, mass)))
    found = system.modes()
    # the ball in five directions, and ball with the other rod along y
    assert found.rigid == 6 and np.abs(value[:6]).max() < 1e-9 * value[-1]
    np.testing.assert_allclose((2 * np.pi * found.frequency_hz[6:]) ** 2, value[6:], rtol=1e-10)
    assert set(found.energy) == {"rod", "other", "between", "wall"}
    assert not found.error_bound.any()  # nothing is left out of them


# -- bad input ---------------------------------------------------------------------------------------------------------------
ONE = {"a": sg.Inertia(1.0)}
BALL = {"ball": sg.RigidBody(np.eye(6), {"p": (0, 0, 0), "q": (1, 0, 0)})}


@pytest.mark.parametrize(
    "make, words",
    [
        (lambda: sg.System({}), "at least one part"),
        (lambda: sg.System({"a.b": sg.Inertia(1.0)}), "without a dot"),
        (lambda: sg.System(ONE, {"a": sg.torsion_spring("a", 1.0)}), "each needs its own"),
        (lambda: sg.System(ONE, {"s": sg.torsion_spring("b", 1.0)}), "no part 'b'"),
        (lambda: sg.System(BALL, {"s": sg.torsion_spring("ball.r", 1.0)}), "it has|ball.p, ball.q"),
        (lambda: sg.System(BALL, {"s": sg.torsion_spring("ball", 1.0)}), "is no port"),
        (lambda: sg.System(ONE).modes(0), "not a number of modes"),
        (lambda: sg.System(ONE).expand("a", np.zeros(1)), "nothing to expand"),
        (lambda: sg.System(ONE).response([1.0], [1.0], damping=-0.1), "damping is -0.1"),
        (lambda: sg.System(ONE).response([1.0], [1.0], loss={"b": 0.1}), "no part and no link"),
        (lambda: sg.Inertia(0.0), "finite and positive"),
        (lambda: sg.Inertia(1.0, "w"), "one of x y z"),
        (lambda: sg.RigidBody(np.diag([1, 1, 1, 0, 1, 1])), "must be positive"),
        (lambda: sg.RigidBody(np.eye(6), {"p": (1, 2)}).ports, "shape (2,)"),
        (lambda: sg.Placed(sg.Inertia(1.0), 2 * np.eye(3)), "orthogonal"),
        (lambda: sg.Placed(sg.Inertia(1.0), np.diag([1, 1, -1])), "right-handed"),
        (lambda: sg.BearingSpring("a", np.diag([-1, 0, 0, 0, 0, 0])), "not negative"),
        (lambda: sg.BearingSpring("a", np.triu(np.ones((6, 6)))), "not symmetric"),
        (lambda: sg.BearingSpring("a", np.eye(3)), "shape (3, 3)"),
        (lambda: sg.BearingSpring("a", 2 * np.ones((6, 6)) - np.eye(6)), "semidefinite"),
        (lambda: sg.torsion_spring("a", -1.0), "not negative"),
        (lambda: sg.torsion_spring("a", 1.0, dof="w"), "one of x y z"),
        (lambda: sg.RowSpring("a", [1.0, 2.0]), "shape (1, 2)"),
        (lambda: sg.PortInertia("a", np.full((6, 6), np.nan)), "NaN"),
    ],
)
def test_bad_systems_are_one_sentence(make, words):
    with pytest.raises(sg.SolidgearError) as caught:
        make()
    said = str(caught.value)
    assert any(word in said for word in words.split("|")), said
    assert "\n" not in said and len(re.findall(r"\.\s", said)) == 0
