"""Real flanks of a bevel pair: envelopes by the derivatives of a family of cones, and real rotations.

Of the package this takes the cutters' data alone.
"""

import numpy as np

#: of derivatives by a complex step
TINY = 1e-30


def turned(axis, angle, vector):
    """A vector turned about an axis (Rodrigues)."""
    c, s = np.cos(angle), np.sin(angle)
    return vector * c + np.cross(axis, vector) * s + axis * (axis @ vector) * (1 - c)


class RealFlank:
    """Flank that a cone envelops while crown and member roll on each other at constant ratio."""

    def __init__(self, flanks, member):
        angles = flanks.blank.pitch_angles
        cutter = (flanks.pinion_cutter, flanks.gear_cutter)[member]
        sense = (1, -1)[member]
        self.cutter = cutter
        self.axis = np.array([np.cos(angles[member]), 0.0, sense * np.sin(angles[member])])
        self.rate = sense / np.sin(angles[member])

    def cone(self, theta, z):
        cutter = self.cutter
        rho = cutter.radius + cutter.slope * z + cutter.curvature * z * z / 2
        x, y = cutter.centre
        return np.array([x + rho * np.cos(theta), y + rho * np.sin(theta), z])

    def carried(self, theta, z, phi):
        """A point of the cone on the member, which is turned back to its position 0."""
        crown = np.array([0.0, 0.0, 1.0])
        return turned(self.axis, -phi * self.rate, turned(crown, phi, self.cone(theta, z)))

    def derivatives(self, theta, z, phi):
        steps = TINY * 1j * np.eye(3)
        return [self.carried(theta + a, z + b, phi + c).imag / TINY for a, b, c in steps]

    def touching(self, theta, z, near):
        """Turn of the crown at which a point of the cone touches: the family has no volume there."""

        def volume(phi):
            by_theta, by_z, by_phi = self.derivatives(theta, z, phi)
            across = np.cross(by_theta, by_z)
            return across @ by_phi / np.linalg.norm(across)

        first, second = near, near + 1e-4
        values = volume(first), volume(second)
        for _ in range(40):
            if values[1] == values[0] or abs(second - first) < 1e-15:
                break
            step = values[1] * (second - first) / (values[1] - values[0])
            first, second = second, second - step
            values = values[1], volume(second)
        return second

    def at(self, theta, z, position, near):
        """Point and normal of the flank in a position of the crown."""
        phi = self.touching(theta, z, near)
        by_theta, by_z, _ = self.derivatives(theta, z, phi)
        across = np.cross(by_theta, by_z)
        back = position * self.rate
        point = turned(self.axis, back, self.carried(theta, z, phi))
        return point, turned(self.axis, back, across / np.linalg.norm(across))


def cone_angle(cutter, point, roll):
    """Angle about the cutter's axis of a point in the position `roll`."""
    x, y, _ = turned(np.array([0.0, 0.0, 1.0]), -roll, point)
    return np.arctan2(y - cutter.centre[1], x - cutter.centre[0])


def distance(flanks, theta, z, position, towards):
    """Distance from the gear's flank to the pinion's along the gear's normal, positive towards a
    direction, and the gear's point.
    """
    gear, pinion = RealFlank(flanks, 1), RealFlank(flanks, 0)
    point, normal = gear.at(theta, z, position, position)
    normal = normal * np.sign(normal @ towards)
    unknown = np.array([cone_angle(pinion.cutter, point, position), point[2], 0.0])

    def miss(values):
        place, _ = pinion.at(values[0], values[1], position, position)
        return place - point - values[2] * normal

    for _ in range(20):
        wrong = miss(unknown)
        steps = 1e-7 * np.eye(3)
        slopes = np.stack([(miss(unknown + s) - miss(unknown - s)) / 2e-7 for s in steps], 1)
        change = np.linalg.solve(slopes, -wrong)
        unknown = unknown + change
        if np.abs(change).max() < 1e-14:
            break
    return unknown[2], point
