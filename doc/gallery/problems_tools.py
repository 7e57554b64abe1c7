# SPDX-License-Identifier: BSD-3-Clause
"""Problems of the gallery with tools of closed shapes as obstacles."""
import math

import far_fields
from problems import AREA, E_STAR, HERTZ, JOHNSON, Problem, Quantity, Run, result, vertical


def wedge():
    slope, a = far_fields.SLOPE, 1
    return Problem(
        "A half plane on a wedge",
        "An elastic half plane (E = 2000 Pa, ν = 0.3) is pressed on a rigid wedge, an obstacle whose sides fall by s = 0.02 m per m, until they touch over a width of "
        "2a = 2 m. At the edge the pressure is infinite, like a logarithm. On the ellipse at which the mesh ends the body moves as under four forces with the moments of the pressure.",
        f"{JOHNSON}, section 5.2",
        "P = E* a s",
        [Run("wedge.yaml", coarse=0.02)],
        [Quantity("force on the half", "N/m", E_STAR * a * slope / 2, vertical(), (0, "contact_force")),
         Quantity("half width a", "m", a, result("contact_length"), (0, "contact_length")),
         Quantity("largest pressure", "Pa", math.inf, result("max_pressure"), (0, "max_pressure"))],
        ["--window=0,-0.4,2,1.2"])


def rounded_punch():
    punch = far_fields.ROUNDED_PUNCH
    low, high = far_fields.FLAT, 1.0  # the pressure is largest beyond the flat part
    for _ in range(25):
        thirds = low + (high - low) / 3, high - (high - low) / 3
        low, high = (thirds[0], high) if punch.pressure(thirds[0]) < punch.pressure(thirds[1]) else (low, thirds[1])
    return Problem(
        "A half plane on a flat punch with rounded edges",
        "An elastic half plane (E = 2000 Pa, ν = 0.3) is pressed on a rigid, flat punch, an obstacle of 2b = 1.2 m with edges of the radius R = 10 m, until they touch over "
        "a width of 2a = 2 m. On the ellipse at which the mesh ends the body moves as under four forces with the moments of the pressure.",
        "M. Ciavarella, D. A. Hills, G. Monno (1998), The influence of rounded edges on indentation by a flat punch, Proc. Inst. Mech. Eng. C 212, 319–328, with arcs of circles for parabolas",
        "P = E* ∫ x f′(x)/(a² − x²)^½ dx from b to a, f′ = (x − b)/(R² − (x − b)²)^½, and p from the flat punches whose sum it is",
        [Run("rounded_punch.yaml", coarse=0.02)],
        [Quantity("force on the half", "N/m", punch.load() / 2, vertical(), (0, "contact_force")),
         Quantity("largest pressure", "Pa", punch.pressure((low + high) / 2), result("max_pressure"), (0, "max_pressure")),
         Quantity("half width a", "m", 1, result("contact_length"), (0, "contact_length"))],
        ["--window=0,-0.4,2,1.2"])


def hertz_ellipsoid():
    contact = far_fields.Elliptical()
    a, b = far_fields.SEMI_AXES
    return Problem(
        "Hertz: a half space on an ellipsoid",
        "An elastic half space (E = 2000 Pa, ν = 0.3) is pressed by d = 0.02 m on a rigid ellipsoid, until it touches an ellipse with the semi-axes a = 1 m and b = 0.6 m. "
        "A quarter of it between two planes of symmetry, of tetrahedra; force and area are those of the quarter. On the spheroid at which the mesh ends the body moves "
        "as under sixteen forces with the moments of the pressure.",
        f"{HERTZ}; {JOHNSON}, (4.24) to (4.26)",
        "p₀ = E* d/(b K(e)), F = 2πab p₀/3, e² = 1 − b²/a²",
        [Run("hertz_ellipsoid.yaml", coarse=0.1)],
        [Quantity("force on the quarter", "N", contact.force / 4, vertical(), (0, "contact_force")),
         Quantity("largest pressure", "Pa", contact.pressure, result("max_pressure"), (0, "max_pressure")),
         Quantity("area in contact, πab/4", "m^2", math.pi * a * b / 4, result(AREA), (0, AREA))],
        [])
