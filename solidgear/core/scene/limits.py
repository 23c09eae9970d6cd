"""Limits of shafts and of things on them: sizes in m, counts and shares."""

#: m; two edges nearer than this are one edge
TOUCH = 1e-9

#: least diameter and least length of a part over the length of the shaft, least wall over the
#: radius; thinner ones would need endless meshes or drown in rounding, and come from wrong units
SLIMMEST, SHORTEST, THINNEST = 1e-3, 1e-6, 1e-4

#: moduli, densities or their quotients of two materials of one shaft; beyond, the residuals of
#: frequencies rise above 1e-4 and searches do not end
MOST_UNLIKE = 1e5

#: elastic modes of one question; no mesh here has a digit of the last of them
MOST_MODES = 500

#: every segment takes at least a line of cells, and every bearing six ports
MOST_SEGMENTS, MOST_BEARINGS, MOST_SPRINGS, MOST_MASSES = 100, 50, 20, 50
#: loads of a shaft
MOST_LOADS = 50
#: lumped points; each is condensed to and judged
MOST_PORTS = 12

#: fillets and chamfers of one shaft
MOST_BLENDS = 40
#: least size over the radius of the edge; smaller ones would need endless meshes
SMALLEST_BLEND = 2e-3
#: share of a plane face, and of the cylinder between two edges, that fillets and chamfers may take
MOST_OF_FACE, MOST_OF_LENGTH = 0.95, 0.95
