"""Every number that decides how wide an error bar of a solid is, or whether there is one.

What is derived stands with its reason, what is measured with its date and the bodies.  The safety of
local problems is judged by ``python -m validation.campaign answers``, the rest by ``solids``.  Numbers
that tell rounding from values, or points from each other, stand where they are used, and so do those
that decide which mesh is tried next.
"""

from __future__ import annotations

from collections.abc import Mapping
from math import pi
from types import MappingProxyType
from typing import Final

# ------------------------------------------------------------------------------------------------
# - where stress is singular
#: exponent of displacement where only a load jumps, on a smooth surface: rotations go with the
#: logarithm of the distance; what is larger is as smooth
LOAD_EDGE: Final = 1.0
#: the same of a body without any edge or load at which stress is singular or jumps. 2026-11-29: 90 modes
#: of free blocks on 15 meshes, bars without any safety 1.09 to 5 of the error
CONVEX: Final = 1.5
#: rad, to which flat sides of cells stand for a surface, and by how many of these it turns where there
#: is an edge: ten sides of a bore are round (36 degrees each), a chamfer of 45 degrees has edges
ROUGH: Final = pi / 12
TURNED: Final = 3
#: least side of a cell, in distances within which two points are one (1e-9 of the shaft): what is
#: nearer to a corner no mesh sees
RESOLVED: Final = 4.0
#: share of the cost of a corner within that side beyond which there is no error bar: the rest would be
#: most of it
UNRESOLVED: Final = 1 / 2

# ------------------------------------------------------------------------------------------------
# - local problems of the harmonic solid
#: on bounds, for errors that the richer space does not see. 2026-11-23: 37 bodies; judged on 43 drawn
#: ones and seeds 98001 to 98060
LOCAL: Final = 1.25
#: orders of the richer space above that of the mesh: of one alone 0.78 of the error was seen, of two
#: 0.98, and their difference gives the tail
EXTRA: Final = 2
#: cuts towards singular corners (one where only a load jumps): two leave 0.15^(4 a) of the cost of a
#: corner, 1.6 % at a shoulder, which is added
LAYERS: Final = 2
#: a side shorter than this share of another one of its cell joins the hats at its ends: a hat that falls
#: across a slender cell made bounds 5 to 130 times too wide
SHORT: Final = 0.1
#: an order leaves at most this share of the remaining error, else the tail of all orders has no end
SLOWEST: Final = 0.8

# ------------------------------------------------------------------------------------------------
# - one order more of the 3D solid
#: energies of errors over what one order more tells of them, by elements where this is not one.
#: 2026-11-26: 7 drawn bodies, seeds 99101 to 99107 on 45 meshes: of hex27 85 of 88 before; judged on
#: 2026-11-27 on 25 shafts, 12 drawn bodies and 44 other parts of seeds 99201 to 99232: 8622 of 8631
SLOWER: Final[Mapping[str, float]] = MappingProxyType({"hex27": 1.25})
#: share of an energy that may be missing where conjugate gradients end, which is added, and steps after
#: which they have failed: slender cells, or a volume that hardly changes
MISSING: Final = 0.04
MOST_STEPS: Final = 200
#: of the lower side: volume and seats of a mesh are not quite those of the body, 1.015 of the error at
#: most on 72 numbers; 2091 of 2091 lower sides of the bodies above
LEAST: Final = 0.97

# ------------------------------------------------------------------------------------------------
# - layers that are held on both sides
#: Poisson's ratio from which on a layer locks that is one cell thick; one that is so in places locks by
#: their share times its bulk over its shear modulus. 2026-11-28: 6 mm of rubber of 0.49 to 0.4999 between
#: steel bars of 40 mm, hex20 and tet10: with one cell across 0.02 to 0.87 of the error, with cells of half
#: its length 1.04 and more. 2026-11-29: bushes with 6 % of such cells 1.6 and more at 0.49, 0.6 at 0.4999
LOCKING: Final = 0.45
#: what cells as wide as a layer is thick add at its rim to the energy of an error over that in one order
#: more, at a Poisson's ratio of 1/2. 2026-11-28: pads of 100 x 5 x 100 mm between rigid plates, nu 0.3 to
#: 0.4999, 9 meshes of hexahedra and 7 of tetrahedra of each: 0.13 of the error without, 1.02 with it.
#: 2026-11-29: bushes 5 to 20 times as long as thick, 57 of 57 bars held, least 1.23
RIM: Final = 1.5
#: cosine of the angle between faces that count as one, or as opposite: within 60 degrees
ALONG: Final = 0.5

# ------------------------------------------------------------------------------------------------
# - narrow seats. 2026-11-26: bars of 40 mm, tetrahedra 8 to 20 mm deep under seats of 1 to 16 mm; gaps of
# 0.04 to 4 mm between rigid seats on tetrahedra and hexahedra
#: distance from a narrow seat that cells of first order see, over their depth
REACH: Final = 3.77
#: factor by which cells of first order are too stiff in a gap between rigid seats as wide as they are
#: deep, less one
GAP: Final = 0.5

# ------------------------------------------------------------------------------------------------
# - near modes
#: gap between eigenvalues, relative to the upper one, below which modes may turn into one another
BESIDE: Final = 0.05
#: relative difference of frequencies below which shapes of a plain part may turn into one another by a
#: cut, and square of the cosine above which two shapes are one mode: each part has half of it at least
TURNING: Final = 0.05
ALIKE: Final = 0.5
#: gap that is solved on for: a bar is no wider than three times what the energy says
ROOM: Final = 1 / 3
