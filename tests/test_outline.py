"""The outline of a shaft: one chain of lines and arcs, with the corners that are left between them."""

import numpy as np
import pytest
from shafts import shaft
from test_blends import everywhere, root, stepped

from solidgear.core.scene import Chamfer, Fillet
from solidgear.core.scene.closed_form import mass_properties
from solidgear.core.scene.outline import Outline


def points(scene, count=400):
    """(r, y) up the outer surface and down the bore, arcs by points on them."""
    chains = {"outer": [], "bore": []}
    for piece in scene.outline.pieces:
        ends = [(piece.r0, piece.y0), (piece.r1, piece.y1)]
        if piece.corner:
            ends = sorted(piece.corner.points(count), key=lambda p: p[1])
        chains[piece.surface] += ends
    return np.array(chains["outer"] + chains["bore"][::-1])


def test_pieces_run_on_along_either_surface_and_turn_only_through_plane_faces():
    scene = everywhere()
    for surface in ("outer", "bore"):
        chain = [p for p in scene.outline.pieces if p.surface == surface]
        assert [p.segment for p in chain] == sorted(p.segment for p in chain)
        assert chain[0].y0 == 0.0 and chain[-1].y1 == pytest.approx(scene.length)
        for one, other in zip(chain, chain[1:]):
            assert one.y1 == pytest.approx(other.y0, abs=1e-15)
            if one.r1 != pytest.approx(other.r0):  # a plane face, where segments meet
                assert one.y1 == pytest.approx(scene.segments[one.segment].y1)
    assert {p.corner.name for p in scene.outline.pieces if p.corner} == {
        str(k) for k in range(1, 11)
    }


def test_mass_and_its_centre_are_those_of_the_area_inside_the_outline():
    """By Pappus from a polygon; chords of 400 to a quarter lose 1e-6 of what an arc cuts off."""
    scene = everywhere()
    r, y = points(scene).T
    r1, y1 = np.roll(r, -1), np.roll(y, -1)
    cross = r * y1 - r1 * y
    volume = np.pi / 3 * abs(((r + r1) * cross).sum())
    # the integral of y over the solid: 2 pi int r y dA
    along = ((2 * r + r1) * y + (r + 2 * r1) * y1) * cross
    found = mass_properties(scene.outline)
    assert found.mass == pytest.approx(7850 * volume, rel=1e-7)
    assert found.centre == pytest.approx(np.pi / 12 * abs(along.sum()) / volume, rel=1e-7)


def test_a_fillet_leaves_no_corner_and_a_chamfer_two_obtuse_ones():
    def angle(*blends):
        return np.degrees(max(e.angle for e in stepped(*blends).outline.edges))

    chamfer = Chamfer(name="c", y=0.068, length=0.004, angle="30 deg")
    assert angle() == pytest.approx(270)
    assert angle(root(0.006)) == pytest.approx(180)
    assert angle(chamfer) == pytest.approx(240)
    # one at the rim leaves the root what it is
    assert angle(Fillet(name="f", y=0.068, edge="rim", radius=0.004)) == pytest.approx(270)


def test_corners_are_the_same_seen_from_the_other_end():
    parts = [(0.05, 0.02, 0.03, 0.0, 0.0), (0.04, 0.03, 0.03, 0.01, 0.02), (0.03, 0.05, 0.04)]
    turned = [(p[0], p[2], p[1], *p[:2:-1]) for p in reversed(parts)]
    one, other = (
        [(e.surface, e.angle) for e in shaft(*each).outline.edges] for each in (parts, turned)
    )
    for surface in ("outer", "bore"):
        angles, back = ([a for s, a in edges if s == surface] for edges in (one, other))
        assert angles == pytest.approx(back[::-1], abs=1e-12)


def test_a_face_is_covered_up_to_the_fillet_in_its_corner():
    scene = stepped(root(0.006))
    assert scene.outline.shared_face(1, 1) == (0.0, 0.045)
    assert scene.outline.shared_face(1, 0) == pytest.approx((0.0, 0.051))
    assert Outline(scene.segments).shared_face(1, 0) == (0.0, 0.045)


def test_a_scene_has_one_outline_and_a_changed_scene_its_own():
    scene = stepped(root(0.006))
    assert scene.outline is scene.outline
    assert scene == stepped(root(0.006))
    assert not scene.with_changes(blends=()).outline.corners
    assert scene.with_changes(title="same") != scene
