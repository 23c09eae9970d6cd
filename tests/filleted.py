"""A shaft with one filleted shoulder, for tests of its stress."""

from solidgear.core.scene import Bearing, Fillet, Material, Port, Scene, Segment, Strength

STRONG = Strength(yield_point=700e6, ultimate=1000e6)


def shoulder(ratio=1.5, radius=0.1, *, d=0.05, bore=0.0, turned=False, strength=None):
    """D/d and r/d; small end first unless turned. Both sides four D long, bearings at the ends and a
    gear on the large side.
    """
    large = ratio * d
    length = 4 * large
    steel = Material(E=2.07e11, nu=0.3, density=7850.0, strength=strength)
    diameters = (large, d) if turned else (d, large)
    parts = [
        Segment.cylinder(
            f"s{k}", y0=k * length, length=length, diameter=one, bore=bore, material=steel
        )
        for k, one in enumerate(diameters)
    ]
    gear = (0.5 if turned else 1.5) * length
    seat = 0.1 * length
    port = Port(name="gear", y=gear, lo=gear - seat / 2, hi=gear + seat / 2)
    bearings = [
        Bearing(name=name, y=y, seat_width=seat, stiffness={"kxx": 1e8, "kzz": 1e8, "kyy": 1e8})
        for name, y in (("A", seat), ("B", 2 * length - seat))
    ]
    fillet = Fillet(name="fillet", y=length, radius=radius * d)
    return Scene.from_parts(parts, steel, bearings, port, blends=[fillet])
