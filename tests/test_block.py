"""Free bodies without an axis, as blocks and from mesh files: frequencies against polynomials that share
no code with the solid.
"""

from itertools import product

import meshio
import numpy as np
import pytest
from numpy.polynomial import legendre
from skfem import MeshTet

import solidgear as sg
from solidgear.core.body import as_supports
from solidgear.core.judge.bounded import mode_bars
from solidgear.core.judge.settle import settle
from solidgear.core.ladder.registry import LADDER
from solidgear.core.machine.memory import NoRoom
from solidgear.core.quantity import Quantity

EDGES = (0.010, 0.009, 0.011)
E, NU, DENSITY = 207e9, 0.29, 7850.0
FILE = f"""material = {{ E = {E}, nu = {NU}, density = {DENSITY} }}
body = {{ block = {list(EDGES)} }}
"""


HEAD = FILE.splitlines()[0]


def write_tets(path, cells, edges=EDGES):
    """A block of so many cells along every edge, each of tetrahedra, in mm and away from the origin."""
    lines = [np.linspace(0, 1e3 * edge, cells + 1) for edge in edges]
    mesh = MeshTet.init_tensor(*lines)
    turned = np.linalg.det(np.diff(mesh.p[:, mesh.t], axis=1).transpose(2, 0, 1)) < 0
    mesh.t[:2, turned] = mesh.t[1::-1, turned]
    meshio.write(path, meshio.Mesh(mesh.p.T + [3.0, 5.0, -7.0], [("tetra", mesh.t.T)]))


def free(folder, *files, more=""):
    """A scene file of a body without an axis."""
    path = folder / "free.toml"
    listed = ", ".join(f'"{file}"' for file in files)
    path.write_text(f'{HEAD}\nbody = {{ mesh = [{listed}], unit = "mm", axis = "none"{more} }}\n')
    return path


@pytest.fixture(scope="module")
def meshed(tmp_path_factory):
    folder = tmp_path_factory.mktemp("meshed")
    for cells in (2, 4):
        write_tets(folder / f"{cells}.vtu", cells)
    return folder


@pytest.fixture(scope="module")
def block(tmp_path_factory):
    path = tmp_path_factory.mktemp("block") / "block.toml"
    path.write_text(FILE)
    return sg.load(path)


def by_polynomials(order):
    """Frequencies (Hz) of products of Legendre polynomials up to a degree (Visscher et al. 1991,
    J. Acoust. Soc. Am. 90, 2154): upper bounds, good to some 1e-5.
    """
    places, weights = legendre.leggauss(order + 2)
    size = np.sqrt(np.arange(order + 1) + 0.5)
    unit = np.eye(order + 1)
    value = np.array([legendre.legval(places, u) for u in unit]) * size[:, None]
    slope = np.array([legendre.legval(places, legendre.legder(u)) for u in unit]) * size[:, None]
    sides = (value, slope)
    degrees = np.array([d for d in product(range(order + 1), repeat=3) if sum(d) <= order])

    def gram(p, q):
        out = 4 / EDGES[p] / EDGES[q]
        for axis, own in enumerate(degrees.T):
            table = (sides[p == axis] * weights) @ sides[q == axis].T
            out = out * table[np.ix_(own, own)]
        return out

    lame, shear = E * NU / (1 + NU) / (1 - 2 * NU), E / 2 / (1 + NU)
    sum_of = sum(gram(p, p) for p in range(3))
    stiffness = np.block(
        [
            [lame * gram(i, j) + shear * gram(j, i) + shear * (i == j) * sum_of for j in range(3)]
            for i in range(3)
        ]
    )
    return np.sqrt(np.linalg.eigvalsh(stiffness)[6:] / DENSITY) / (2 * np.pi)


def test_a_coarse_block_vibrates_a_little_faster_than_the_exact_one(block):
    found = sg.modes(sg.build(block, "solid", refinement=0.7), block, n=6).frequency_hz[6:12]
    assert (found > by_polynomials(10)[:6]).all()
    assert found == pytest.approx(by_polynomials(10)[:6], rel=0.02)


@pytest.mark.slow
def test_modes_of_a_block_lie_above_the_exact_ones_by_no_more_than_their_bars(block):
    settled = settle(block, 5e-3, "modes")
    found = sg.modes(settled.body, block, n=10).modes
    elastic = [mode for mode in found if mode.frequency_hz > 0]
    assert [str(mode.name) for mode in elastic] == [f"mode {k}" for k in range(1, 11)]
    for mode, hertz in zip(elastic, by_polynomials(12)):
        # polynomials are upper bounds too, that fall by some 3e-5 from degree 10 to 12
        bar = settled.bars[Quantity(mode.name)]
        assert -3e-5 < mode.frequency_hz / hertz - 1 < bar < 5e-3
    assert settled.reached


def test_the_mass_of_a_block_is_its_edges_times_its_density(block):
    body = sg.build(block, "solid", refinement=0.5)
    assert body.mass_matrix()[0, 0] == pytest.approx(DENSITY * np.prod(EDGES), rel=1e-12)


@pytest.mark.parametrize(
    "model", [name for name in LADDER.bodies if not LADDER[name].for_features][:-1]
)
def test_models_of_shafts_refuse_a_block(block, model):
    with pytest.raises(sg.SolidgearError, match="a block has no axis"):
        sg.build(block, model)


def test_a_block_is_not_compared_and_without_a_point_has_no_stiffness(block):
    with pytest.raises(sg.SolidgearError, match="has no axis: run solidgear stiffness or modes"):
        sg.answer(block, ask="f1")
    with pytest.raises(sg.SolidgearError, match="one model"):
        sg.compare(block)
    with pytest.raises(sg.SolidgearError, match="no lumped point"):
        settle(block, 0.01, "stiffness")


@pytest.mark.parametrize(
    "line, field, sentence",
    [
        ("block = [0.01, 0.02]", "body.block", "three edges"),
        ('block = [0.01, 0.02, "-3 mm"]', r"body.block\[3\]", "greater than zero"),
        ('block = [0.01, 0.02, "0.3 mm"]', r"body.block\[3\]", "outside 1 mm to 20 m"),
        ('block = [0.01, 0.02, 0.03], unit = "mm"', "body.unit", "a block has none"),
        ('block = [0.01, 0.02, 0.03], step = "a.step"', "body.block", "not both"),
    ],
)
def test_a_bad_block_is_refused_in_one_sentence(tmp_path, line, field, sentence):
    path = tmp_path / "bad.toml"
    path.write_text(FILE.splitlines()[0] + f"\nbody = {{ {line} }}\n")
    with pytest.raises(sg.SceneError, match=f"{field}.*{sentence}"):
        sg.load(path)


def test_meshes_of_a_body_have_bars_of_their_own(meshed):
    scene = sg.load(free(meshed, "2.vtu", "4.vtu"))
    settled = settle(scene, 0.05, "modes")
    assert settled.options["coarser"] == 0 and len(settled.steps) == 2
    found = sg.modes(settled.body, scene, n=10).modes
    elastic = [mode for mode in found if mode.frequency_hz > 0]
    assert [str(mode.name) for mode in elastic] == [f"mode {k}" for k in range(1, 11)]
    assert {str(mode.name) for mode in found} - {str(m.name) for m in elastic} == {"rigid motion"}
    for mode, hertz in zip(elastic, by_polynomials(10)):
        bar = settled.bars[Quantity(mode.name)]
        assert -3e-5 < mode.frequency_hz / hertz - 1 < bar < 0.03
    assert settled.reached and scene.body.edges == pytest.approx(EDGES)


def test_bars_of_many_near_modes_hold_and_are_no_wider_than_those_of_few(meshed):
    """Of a spectrum as dense as this many modes lie within 5 % of the next one."""
    scene = sg.load(free(meshed, "2.vtu"))
    body, exact = sg.build(scene, "solid"), by_polynomials(12)
    bars = []
    for count in (10, 24):
        found = sg.modes(body, scene, n=count)
        bars.append(mode_bars(scene, body, as_supports(scene), found))
        elastic = [mode for mode in found.modes if mode.frequency_hz > 0]
        over_error = [bars[-1][m.name] / (1 - hz / m.frequency_hz) for m, hz in zip(elastic, exact)]
        assert min(over_error) > 1 and np.median(over_error) < 4
    few, many = bars
    assert all(many[name] < 1.5 * few[name] for name in few)


def test_a_single_mesh_of_a_body_has_bars_and_the_way_to_narrower_ones(meshed, run):
    code, out, _ = run("modes", free(meshed, "4.vtu"), "-n", 3, "--tol", "0.001")
    assert code == 3 and "mode 3" in out and "Largest error bar" in out
    assert "list a finer mesh beside those of the file" in " ".join(out.split())
    code, out, _ = run("check", meshed / "free.toml")
    assert code == 0 and "the file names no groups of surfaces" in " ".join(out.split())
    assert "there is one mesh of" in " ".join(out.split())


@pytest.mark.parametrize(
    "files, more, field, sentence",
    [
        (("4.vtu", "2.vtu"), "", r"body.mesh\[1\]", "list meshes coarse to fine"),
        (("long.vtu", "4.vtu"), "", r"body.mesh\[1\]", "another body: its size along y is .33.3 %"),
        (("none.vtu", "4.vtu"), "", r"body.mesh\[1\]", "cannot be opened"),
        (("4.vtu",), ', size_check = ["1 mm", "1 mm"]', "body.size_check", "mass_check"),
        (("4.vtu",), ', mass_check = "1 g"', "body.mass_check", "has 0.0077715 kg"),
        (("4.vtu",), ', step = "a.step"', "body.mesh", "not both"),
    ],
)
def test_a_bad_list_of_meshes_is_refused_in_one_sentence(meshed, files, more, field, sentence):
    write_tets(meshed / "long.vtu", 1, (EDGES[0], EDGES[1] * 4 / 3, EDGES[2]))
    with pytest.raises(sg.SceneError, match=f"{field}.*(?:{sentence})"):
        sg.load(free(meshed, *files, more=more))


def test_a_body_that_is_no_shaft_is_told_how_to_say_so(meshed):
    path = free(meshed, "4.vtu")
    path.write_text(path.read_text().replace(', axis = "none"', ""))
    with pytest.raises(sg.SceneError, match='write axis = "none" for a body that is none'):
        sg.load(path)


@pytest.mark.long
def test_a_thin_bar_of_a_block_is_divided_by_each_of_its_edges(tmp_path):
    """Few cells across the least edge and more along the others: cubes of it, four across, would make
    eighty times as many. 2638.8 Hz are of an independent p-FEM; the mesh leaves 1e-4.
    """
    path = tmp_path / "bar.toml"
    path.write_text(
        'material = "steel"\nbody = { block = [0.1, 0.02, 0.005] }\nask = { modes = 4 }\n'
    )
    scene = sg.load(path)
    settled = settle(scene, 0.01, "modes")
    assert settled.reached and settled.body.size < 20_000
    assert sg.modes(settled.body, scene, n=1).frequency_hz[6] == pytest.approx(2638.8, rel=2e-4)


@pytest.mark.long
def test_bars_of_a_block_hold_where_modes_change_places(tmp_path):
    """Cells are few to a wave, and modes change places from mesh to mesh."""
    path = tmp_path / "bar.toml"
    path.write_text(f"{HEAD}\nbody = {{ block = [0.1, 0.02, 0.005] }}\n")
    scene = sg.load(path)
    options = {"element": "hex27", "refinement": 0.5}
    body = sg.build(scene, "solid", **options)
    found = sg.modes(body, scene, n=10)
    bars = mode_bars(scene, body, as_supports(scene), found)
    exact = sg.modes(sg.build(scene, "solid", element="hex27"), scene, n=12)
    for mode in found.modes:
        if mode.frequency_hz > 0:
            off = mode.frequency_hz / exact.named(mode.name).frequency_hz - 1
            assert 0 < off < bars[str(mode.name)], mode.name


def test_a_block_whose_next_mesh_does_not_fit_is_told_with_the_last_one(block, monkeypatch):
    def build(scene, model, **options):
        if options["refinement"] > 0.5:
            raise NoRoom("matrices need about 9000 MB, 3000 MB are free", 9000.0, 3000.0)
        return sg.build(scene, model, **options)

    monkeypatch.setattr("solidgear.core.judge.settle.build", build)
    settled = settle(block, 1e-6, "modes")
    assert not settled.reached and settled.options["refinement"] == 0.5 and settled.bars
    assert "the next mesh could not be solved: matrices need" in settled.steps[-1].why


def test_a_setting_without_a_model_is_answered_by_one_that_holds_the_block(tmp_path, run):
    path = tmp_path / "block.toml"
    path.write_text(FILE)
    code, _, told = run("modes", path, "--set", "refinement=0.5")
    assert code == 1 and "add -f solid" in told
