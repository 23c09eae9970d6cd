"""Shafts that more than one test file meshes."""

#: (length, outer at both ends, inner at both ends): steps up and down outside and in the bore,
#: cones next to steps, a blind bore, a conical bore
NASTY = (
    (0.04, 0.030, 0.030, 0.010, 0.010),
    (0.03, 0.030, 0.050, 0.010, 0.010),
    (0.02, 0.080, 0.080, 0.020, 0.020),
    (0.03, 0.060, 0.025, 0.020, 0.008),
    (0.03, 0.025, 0.025, 0.008, 0.008),
    (0.02, 0.040, 0.040, 0.0, 0.0),
    (0.05, 0.020, 0.035, 0.0, 0.0),
)
