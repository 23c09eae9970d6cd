"""Statics of bodies without an axis, at named patches of their surface: blocks beside closed forms and
hexahedra of scikit-fem, an L bracket beside a mesh that is graded towards its edges.
"""

import numpy as np
import pytest
from scipy.sparse.linalg import splu
from skfem import Basis, ElementHex2, ElementVector, FacetBasis, LinearForm, MeshHex, MeshTet
from skfem.models.elasticity import lame_parameters, linear_elasticity

import solidgear as sg
from solidgear.core.judge.settle import settle
from solidgear.core.quantity import Quantity
from validation.mesh_files import write_boxes

E, NU = 207e9, 0.29
HEAD = f"material = {{ E = {E}, nu = {NU}, density = 7850 }}\n"
X, Y, Z = EDGES = 0.010, 0.030, 0.011
HELD = """
[[bearing]]
name = "wall"
patch = "foot"
attachment = "rigid"
hold = "clamped"

[[port]]
name = "tip"
patch = "eye"
"""


def scene(folder, *files, more=HELD):
    path = folder / "body.toml"
    listed = ", ".join(f'"{file}"' for file in files)
    path.write_text(f'{HEAD}body = {{ mesh = [{listed}], unit = "mm", axis = "none" }}\n{more}')
    return path


ENDS = {"foot": lambda m: m[1] < 1e-9, "eye": lambda m: m[1] > Y - 1e-9}


@pytest.fixture(scope="module")
def beam(tmp_path_factory):
    folder = tmp_path_factory.mktemp("beam")
    for cells in (2, 4):
        counts = cells, 3 * cells, cells
        lines = [np.linspace(0, e, n + 1) for e, n in zip(EDGES, counts)]
        write_boxes(folder / f"{cells}.msh", lines, ENDS)
    return folder


def by_hexahedra():
    """Compliances of the same cantilever, of the mean motion of its end, from scikit-fem alone."""
    across = np.array([0, 0.04, 0.2, 0.8, 0.96, 1])
    along = np.array([0, 0.015, 0.05, 0.15, 0.35, 0.65, 1])
    mesh = MeshHex.init_tensor(X * across, Y * along, Z * across)
    mesh = mesh.with_boundaries({"foot": lambda x: x[1] == 0, "eye": lambda x: x[1] == x[1].max()})
    element = ElementVector(ElementHex2())
    basis = Basis(mesh, element, intorder=4)
    stiffness = linear_elasticity(*lame_parameters(E, NU)).assemble(basis)
    end = FacetBasis(mesh, element, facets="eye", intorder=4)
    ways = {f"C_{n}{n}": lambda v, w, k=k: v[k] / X / Z for k, n in enumerate("xyz")}
    loads = np.array([LinearForm(way).assemble(end) for way in ways.values()]).T
    free = basis.complement_dofs(basis.get_dofs("foot"))
    moved = splu(stiffness[free][:, free].tocsc()).solve(loads[free])
    return dict(zip(ways, np.sum(moved * loads[free], axis=0)))


@pytest.mark.long
def test_bars_of_a_cantilever_on_two_meshes_hold_what_independent_hexahedra_say(beam):
    loaded = sg.load(scene(beam, "2.msh", "4.msh"))
    settled = settle(loaded, 0.2, "stiffness")
    at = sg.condense(settled.body, loaded, "tip")
    for name, exact in by_hexahedra().items():
        quantity = Quantity(name)
        off = quantity.of(at.compliance) / exact - 1
        # both are too stiff: finer hexahedra are softer by up to 2e-3
        assert -settled.bars[quantity] < off < 2e-3, name
        assert settled.bars[quantity] < 0.03
    assert settled.reached


def test_a_slender_cantilever_bends_as_a_beam(tmp_path):
    length = 0.1
    path = tmp_path / "block.toml"
    more = HELD.replace("foot", "-y").replace("eye", "+y")
    path.write_text(f"{HEAD}body = {{ block = [{X}, {length}, {Z}] }}\n{more}")
    loaded = sg.load(path)
    body = sg.build(loaded, "solid", element="hex20", size=X / 3)
    found = sg.condense(body, loaded, "tip").compliance
    shear = E / 2 / (1 + NU) * X * Z * 10 * (1 + NU) / (12 + 11 * NU)
    for k, inertia in ((0, Z * X**3 / 12), (2, X * Z**3 / 12)):
        # the wall holds the width of the section too, which stiffens some of the first width
        beam = length**3 / 3 / E / inertia + length / shear
        assert found[k, k] == pytest.approx(beam, rel=0.01)
    assert found[1, 1] == pytest.approx(length / E / X / Z, rel=0.01)
    frequency = sg.modes(body, loaded, n=1).frequency_hz[0]
    weak = E * Z * X**3 / 12 / (7850 * X * Z * length**4)
    assert frequency == pytest.approx(1.8751**2 / 2 / np.pi * weak**0.5, rel=0.015)


ARM = 0.02


def bracket(path, around, between):
    """An L of two arms, with some layers around its corner and its edges and cells between."""
    layers = 0.5 * 0.3 ** np.arange(around, 0, -1)
    one = np.unique(
        [0, *layers, *np.linspace(0.5 * 0.3, 1 - 0.5 * 0.3, between + 1), *1 - layers, 1]
    )
    if not around:
        one = np.linspace(0, 1, between + 1)
    two = np.unique([*one, *1 + one])
    patches = {
        "foot": lambda m: m[1] > 2 * ARM - 1e-9,
        "eye": lambda m: m[0] > 2 * ARM - 1e-9,
    }
    hollow = lambda m: (m[0] > ARM) & (m[1] > ARM)  # noqa: E731
    write_boxes(path, [ARM * two, ARM * two, ARM * one], patches, hollow)


@pytest.mark.parametrize(
    "attachment",
    [
        pytest.param("rigid", marks=pytest.mark.long),
        pytest.param("average", marks=pytest.mark.slow),
    ],
)
def test_bars_of_a_bracket_hold_what_a_graded_mesh_says(tmp_path, attachment):
    bracket(tmp_path / "coarse.msh", 0, 1)
    bracket(tmp_path / "fine.msh", 0, 2)
    bracket(tmp_path / "graded.msh", 2, 2)
    more = HELD.replace('patch = "eye"', f'patch = "eye"\nattachment = "{attachment}"')
    loaded = sg.load(scene(tmp_path, "coarse.msh", "fine.msh", more=more))
    settled = settle(loaded, 0.5, "all")
    at = sg.condense(settled.body, loaded, "tip").compliance
    exact = sg.load(scene(tmp_path, "graded.msh", more=more))
    body = sg.build(exact, "solid")
    there = sg.condense(body, exact, "tip").compliance
    size = np.sqrt(np.outer(np.diag(there), np.diag(there)))
    static = [bar for name, bar in settled.bars.items() if name.kind == "compliance"]
    assert (np.abs(at - there) / size).max() < max(static) < 0.5
    for k, name in enumerate(("C_xx", "C_yy", "C_zz", "C_thx", "C_thy", "C_thz")):
        off = 1 - at[k, k] / there[k, k]
        assert 0 < off < settled.bars[Quantity(name)], name
    for mode, right in zip(
        sg.modes(settled.body, loaded, n=4).modes, sg.modes(body, exact, n=4).modes
    ):
        assert 0 < mode.frequency_hz / right.frequency_hz - 1 < settled.bars[Quantity(mode.name)]


@pytest.mark.parametrize("attachment", ["average", "rigid"])
def test_a_point_beside_its_patch_moves_as_the_patch_carries_it(beam, attachment):
    away = (2e-3, 7e-3, -4e-3)
    at = [1e3 * (m + d) for m, d in zip((X / 2, Y, Z / 2), away)]
    plain = HELD + f'attachment = "{attachment}"\n'
    more = plain + "point = [{}]\n".format(", ".join(f'"{v} mm"' for v in at))
    middle, beside = (sg.load(scene(beam, "2.msh", more=m)) for m in (plain, more))
    found = [sg.condense(sg.build(s, "solid"), s, "tip").compliance for s in (middle, beside)]
    x, y, z = away
    carried = np.eye(6)
    carried[:3, 3:] = [[0, z, -y], [-z, 0, x], [y, -x, 0]]  # th x r
    assert found[1] == pytest.approx(carried @ found[0] @ carried.T, rel=1e-6, abs=1e-16)


def test_stiffness_between_two_patches_is_told_with_their_bars(beam, run):
    more = HELD.replace('hold = "clamped"', "stiffness = { kxx = 1e8, kyy = 1e8, kzz = 1e8 }")
    more += '\n[[port]]\nname = "base"\npatch = "foot"\n'
    path = scene(beam, "2.msh", "4.msh", more=more)
    code, out, _ = run("stiffness", path, "--port", "tip,base", "--tol", "0.9")
    assert "'tip' at (5.000, 30.000, 5.500) mm (average)" in " ".join(out.split()) and code == 0
    assert "between tip and base" in out
    code, out, _ = run("check", path)
    assert code == 0 and "Held at 'foot'" in out


@pytest.mark.parametrize(
    "more, field, sentence",
    [
        (HELD.replace('"eye"', '"eyes"'), r"port.*patch", 'did you mean "eye".*there are'),
        (HELD.replace('patch = "eye"', 'at = "end"'), r"port.*patch", "name the faces"),
        (HELD + 'attachment = "section"\n', r"port.*attachment", "a patch has no section"),
        (HELD + 'at = "end"\n', r"port.*\.at", "has its place and size itself"),
        (HELD + 'point = ["1 mm", "2 mm"]\n', r"port.*point", "three quantities"),
        (HELD + '[load]\nforce = ["1 N", "0 N", "0 N"]\n', "load", "no place for this"),
        (HELD + '[[mass]]\nname = "m"\nmass = "1 g"\n', r"mass\[1\].*on", "port or bearing"),
    ],
)
def test_a_bad_station_of_a_body_is_refused_in_one_sentence(beam, more, field, sentence):
    with pytest.raises(sg.SceneError, match=f"{field}.*(?:{sentence})"):
        sg.load(scene(beam, "2.msh", more=more))


#: corners of the faces S1 to S4 of a tetrahedron, as CalculiX counts them
SIDES = ((0, 1, 2), (0, 1, 3), (1, 2, 3), (0, 2, 3))


@pytest.mark.parametrize("sort", ["C3D4", "C3D8"])
def test_surfaces_of_a_deck_are_patches(tmp_path, sort):
    lines = [1e3 * np.linspace(0, e, n + 1) for e, n in zip(EDGES, (1, 2, 1))]
    if sort == "C3D4":
        mesh, sides = MeshTet.init_tensor(*lines), SIDES
        turned = np.linalg.det(np.diff(mesh.p[:, mesh.t], axis=1).transpose(2, 0, 1)) < 0
        mesh.t[:2, turned] = mesh.t[1::-1, turned]
        cells = mesh.t
    else:
        mesh = MeshHex.init_tensor(*lines)
        at = mesh.p[:, mesh.t] - mesh.p[:, mesh.t].mean(axis=1, keepdims=True)
        corner = (at > 0).transpose(2, 1, 0)
        around = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
        wanted = np.array([*around, *((a, b, 1) for a, b, _ in around)], bool)
        order = [[int((c == w).all(axis=1).argmax()) for w in wanted] for c in corner]
        cells = np.take_along_axis(mesh.t, np.array(order).T, axis=0)
        # bottom, top, and the sides from the first corner on
        sides = ((0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 4, 5), (1, 2, 5, 6), (2, 3, 6, 7), (0, 3, 4, 7))
    text = ["*NODE", *(f"{k}, {x}, {y}, {z}" for k, (x, y, z) in enumerate(mesh.p.T, 1))]
    text += [f"*ELEMENT, TYPE={sort}"]
    text += [", ".join(map(str, [k, *(1 + c)])) for k, c in enumerate(cells.T, 1)]
    text += ["*ELSET, ELSET=all", ", ".join(str(k + 1) for k in range(cells.shape[1]))]
    text += ["*SURFACE, NAME=foot, TYPE=ELEMENT"]
    for k, own in enumerate(cells.T):
        y = mesh.p[1, own]
        text += [f"{k + 1}, S{s}" for s, c in enumerate(sides, 1) if np.all(y[list(c)] == 0)]
    # inside of the part there is no surface
    text += ["*SURFACE, NAME=whole, TYPE=ELEMENT", *(f"all, S{s + 1}" for s in range(len(sides)))]
    (tmp_path / "beam.inp").write_text("\n".join(text) + "\n")
    foot, whole = sg.load(scene(tmp_path, "beam.inp", more="")).body.patches
    assert (foot.name, whole.name) == ("foot", "whole")
    assert foot.point == pytest.approx((X / 2, 0, Z / 2), abs=1e-12)
    assert foot.extent == pytest.approx(np.hypot(X, Z))
    assert whole.point == pytest.approx((X / 2, Y / 2, Z / 2))


def test_patches_are_not_of_a_shaft(tmp_path):
    path = tmp_path / "shaft.toml"
    path.write_text(
        f'{HEAD}segment = [{{ kind = "cylinder", name = "s", length = 0.1, diameter = 0.02 }}]\n'
        'port = { patch = "eye" }\n'
    )
    with pytest.raises(sg.SceneError, match="port.patch.*a body without an axis"):
        sg.load(path)
