# SPDX-License-Identifier: BSD-3-Clause
"""Far displacements of the half planes and the half space of problems_tools.py, and the decks that have them.

A pressure moves what is far as forces at the places of Gauss' rule for it do, which have its first moments: Flamant's in the plane, Boussinesq's in space.
    python3 far_fields.py    writes wedge.yaml, rounded_punch.yaml and hertz_ellipsoid.yaml
"""
import math
import os

import numpy as np

E, NU = 2000.0, 0.3  # [Pa], [-]
E_STAR, SHEAR = E / (1 - NU**2), E / (2 + 2 * NU)
DEPTH = 0.02  # [m] of the ellipsoid
SEMI_AXES = (1.0, 0.6)  # [m] of the contact with it
HEIGHT = 30.0  # [m] of the ellipsoid: half of it, across the contact
SLOPE = 0.02  # of the wedge's sides
FLAT, EDGE = 0.6, 10.0  # [m] of the punch: half the flat width, radius of the edges
PLACES = 4  # of the rule in the plane
RINGS, SPOKES = 2, 8  # of the rule in space


def gauss_rule(places, weights, size):
    """Places and weights of Gauss' rule for a sum, by the recurrence of its orthogonal polynomials."""
    diagonal, ratios, last, this, norm = [], [weights.sum()], np.zeros_like(places), np.ones_like(places), weights.sum()
    for k in range(size):
        diagonal.append((weights * places * this**2).sum() / norm)
        last, this = this, (places - diagonal[k]) * this - (ratios[k] if k else 0) * last
        ratios.append((weights * this**2).sum() / norm)
        norm = (weights * this**2).sum()
    beside = np.sqrt(ratios[1:size])
    values, vectors = np.linalg.eigh(np.diag(diagonal) + np.diag(beside, 1) + np.diag(beside, -1))
    return values, ratios[0] * vectors[0] ** 2


class Profile:
    """A tool in the plane, alike on both sides, that touches from -1 to 1: its pressure is that of flat punches of half widths from `start` to 1.

    slope  of x > 0: how fast its surface falls    start  half width of its flat part
    """

    def __init__(self, slope, start=0.0):
        self.start = start
        self.angles, self.angle_weights = np.polynomial.legendre.leggauss(60)
        self.slope = slope

    def load(self, half_width=1.0):
        """[N/m] for a contact from -half_width to half_width: E* times the integral of x f'(x)/(half_width^2 - x^2)^(1/2)."""
        if half_width <= self.start:
            return 0.0
        low = math.asin(self.start / half_width)
        t = (low + math.pi / 2) / 2 + (math.pi / 2 - low) / 2 * self.angles
        x = half_width * np.sin(t)
        return E_STAR * (math.pi / 2 - low) / 2 * float((self.angle_weights * x * self.slope(x)).sum())

    def growth(self, half_width):
        """dload/dhalf_width."""
        step = min(1e-4 * half_width, (half_width - self.start) / 3)
        return (self.load(half_width + step) - self.load(half_width - step)) / (2 * step)

    def half_widths(self, above):
        """Places and weights of a rule from `above` to 1, graded to its lower end."""
        ends = np.concatenate([[above], above + (1 - above) * 0.5 ** np.arange(30, -1, -1)])
        places, weights = np.polynomial.legendre.leggauss(12)
        for low, high in zip(ends[:-1], ends[1:]):
            yield from zip((low + high) / 2 + (high - low) / 2 * places, (high - low) / 2 * weights)

    def pressure(self, x):
        """[Pa]"""
        above = max(abs(x), self.start)
        return sum(w * self.growth(c) / math.sqrt(c * c - x * x) for c, w in self.half_widths(above)) / math.pi

    def rule(self):
        """Places, forces [N/m], and the mean of ln|x| under the pressure."""
        chebyshev = np.cos((np.arange(40) + 0.5) * math.pi / 40)  # a flat punch presses alike at these
        places, weights, logarithm = [], [], 0.0
        for c, w in self.half_widths(self.start):
            share = w * self.growth(c)
            places.append(c * chebyshev)
            weights.append(np.full(40, share / 40))
            logarithm += share * math.log(c / 2)
        return (*gauss_rule(np.concatenate(places), np.concatenate(weights), PLACES), logarithm)

    def far(self):
        """Expressions of the displacement, 0 at the middle of the contact."""
        across, along = [], []
        places, forces, logarithm = self.rule()
        for place, force in zip(places, forces):
            s = offset("x", place)
            square, factor = "(%s^2 + y^2)" % s, force / (2 * math.pi * SHEAR)
            across.append("%.10g*(%.10g*asin(%s/sqrt%s) - %s*y/%s)" % (factor, 1 - 2 * NU, s, square, s, square))
            along.append("%.10g*(%.10g*ln%s - y^2/%s)" % (factor, 1 - NU, square, square))
        return ["-(%s)" % " + ".join(across), "%.10g - %s" % ((1 - NU) * logarithm / (math.pi * SHEAR), " - ".join(along))]


def offset(name, place):
    """x - place, as an expression."""
    return "(%s %s %.8f)" % (name, "-" if place > 0 else "+", abs(place))


WEDGE = Profile(lambda x: SLOPE + 0 * x)
ROUNDED_PUNCH = Profile(lambda x: (x - FLAT) / np.sqrt(EDGE**2 - (x - FLAT) ** 2), FLAT)


def elliptic_integrals(modulus):
    """Complete ones, K and E, by the arithmetic-geometric mean."""
    a, b, c, power, total = 1.0, math.sqrt(1 - modulus**2), modulus, 0.5, modulus**2 / 2
    while abs(c) > 1e-15:
        a, b, c, power = (a + b) / 2, math.sqrt(a * b), (a - b) / 2, 2 * power
        total += power * c * c
    return math.pi / (2 * a), math.pi / (2 * a) * (1 - total)


class Elliptical:
    """Hertz' contact over an ellipse: K. L. Johnson (1985), (4.26)."""

    def __init__(self):
        a, b = SEMI_AXES
        modulus = math.sqrt(1 - (b / a) ** 2)
        first, second = elliptic_integrals(modulus)
        self.pressure = DEPTH * E_STAR / (b * first)  # [Pa], the largest
        self.force = 2 / 3 * self.pressure * math.pi * a * b
        scale = self.pressure / E_STAR * b / (modulus * a) ** 2
        bends = scale * (first - second), scale * ((a / b) ** 2 * second - first)  # the gap is bends[0] x^2 + bends[1] y^2
        self.semi_axes = [math.sqrt(HEIGHT / (2 * bend)) for bend in bends] + [HEIGHT]

    def far(self):
        """Expressions of the displacement."""
        places, weights = np.polynomial.legendre.leggauss(200)
        near_edge = (1 - places) / 2
        shares = weights * near_edge**2  # of the pressure by r^2 = 1 - near_edge^2
        squares, shares = gauss_rule(1 - near_edge**2, shares / shares.sum(), RINGS)
        parts = ([], [], [])
        for radius, share in zip(np.sqrt(squares), shares):
            for k in range(SPOKES):
                turn, factor = 2 * math.pi * (k + 0.5) / SPOKES, self.force * share / SPOKES / (4 * math.pi * SHEAR)
                x, y = offset("x", SEMI_AXES[0] * radius * math.cos(turn)), offset("y", SEMI_AXES[1] * radius * math.sin(turn))
                r = "sqrt(%s^2 + %s^2 + z^2)" % (x, y)
                for part, s in zip(parts, (x, y)):
                    part.append("%.10g*%s/%s*(z/%s^2 - %.10g/(%s + z))" % (factor, s, r, r, 1 - 2 * NU, r))
                parts[2].append("%.10g*(z^2/%s^3 + %.10g/%s)" % (factor, r, 2 - 2 * NU, r))
        return [" + ".join(part) for part in parts[:2]] + ["%s - %.10g" % (" + ".join(parts[2]), DEPTH)]


def deck(words, name, mesh, target, held, far, obstacle):
    """A deck's text."""
    lines = ["# " + line for line in words] + [name + ":", "  Mesh: {Type: gmsh, File: %s}" % mesh, "  Adapt: {Target Relative Error: %g}" % target,
             "  Material: {Young's Modulus: %.1f, Poisson's Ratio: %g}" % (E, NU), "  Dirichlet:"]
    lines += ["    %s: {%s: 0.0}" % side for side in held] + ["    far:"] + ['      %s: "%s"' % each for each in zip("XYZ", far)]
    return "\n".join(lines + ["  Contact:", "    Side: surface", "    Normal: surface", "    Obstacle: {%s}" % obstacle, ""])


def decks():
    """Texts by file name."""
    forces = "like forces that have the first moments of the pressure (far_fields.py). Units: m, N, Pa."
    half = 'Half of it, right of the plane of symmetry; it is moved on "far"'
    a, b, c = Elliptical().semi_axes
    return {
        "wedge.yaml": deck(["An elastic half plane is pressed on a rigid wedge whose sides fall by %g m per m, over a width of 2." % SLOPE, half, forces],
                           "wedge", "half_space.geo", 0.003, [("axis", "X")], WEDGE.far(),
                           "Type: wedge, Point: [0.0, 0.0], Normal: [0.0, 1.0], Slope: %g" % SLOPE),
        "rounded_punch.yaml": deck(["Ciavarella, Hills, Monno (1998): an elastic half plane is pressed on a rigid, flat punch with rounded edges, over a width of 2, of",
                                    "which %g are flat. %s" % (2 * FLAT, half), forces],
                                   "rounded_punch", "half_space.geo", 0.003, [("axis", "X")], ROUNDED_PUNCH.far(),
                                   "Type: flat punch, Point: [0.0, 0.0], Normal: [0.0, 1.0], Radius: %.1f, Edge Radius: %.1f" % (FLAT + EDGE, EDGE)),
        "hertz_ellipsoid.yaml": deck(["Hertz (1882): an elastic half space is pressed by %g on a rigid ellipsoid, over an ellipse with the semi-axes %g and %g. A quarter of it," % (DEPTH, *SEMI_AXES),
                                      'between planes of symmetry, whose forces and areas are those of the quarter; it is moved on "far"', forces],
                                     "hertz_ellipsoid", "half_space_3d.geo", 0.03, [("symmetry_x", "X"), ("symmetry_y", "Y")], Elliptical().far(),
                                     "Type: ellipsoid, Centre: [0.0, 0.0, %.1f], Semi-Axes: [%.8f, %.8f, %.1f]" % (-HEIGHT, a, b, c)),
    }


if __name__ == "__main__":
    for file_name, text in decks().items():
        with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), file_name), "w") as file:
            file.write(text)
