# SPDX-License-Identifier: BSD-3-Clause
"""Problems of the gallery on foundations that give way, and published ones with friction."""
import math

from problems import NO_BAR_OF, Problem, Quantity, Run, result, vertical

STIFFNESS = 2000 / 3  # [N m] EI of the beams, with k = 4 EI so that lengths are in units of 1/beta
FORCE = 50  # [N/m] on the whole beam


def weitsman():
    k = 4 * STIFFNESS
    return Problem(
        "Weitsman: a beam that lifts off",
        "A long, weightless beam lies on springs that do not pull (k w, w the settlement) and bears one force P = 50 N/m. It touches them over a length that does not depend on P, and lifts off "
        "beyond. The mesh is the right half, 0.02 m thick with EI = 2000/3 and k = 4EI, so that β = (k/4EI)^¼ = 1/m; shear, which the formula leaves out, adds 10⁻⁴.",
        "Y. Weitsman (1970), On foundations that react in compression only, J. Appl. Mech. 37, 1019–1030",
        "length in contact π/(2β) on each side, w(0) = Pβ/(2k) coth(π/2)",
        [Run("weitsman.yaml", coarse=0.01)],
        [Quantity("length in contact, of the half", "m", math.pi / 2, result("contact_length"), (0, "contact_length")),
         Quantity("settlement below the force", "m", FORCE / (2 * k) / math.tanh(math.pi / 2), result("max_penetration"), (0, "max_penetration"))],
        ["--scale=20"])


def raft_at(ahead, limit):
    """A beam whose soil has yielded up to x = c and holds it beyond, over the length `ahead`, until it lifts off. Lengths in 1/beta.

    Beyond c, from the point of lift-off back, the deflection without moment and shear there is a multiple of phi = (cos s sinh s + sin s cosh s)/2.
    @return slope at x = 0, which is to be 0, c, and the deflection at 0
    """
    s, k = ahead, 4 * STIFFNESS
    factor = limit / k / ((math.cos(s) * math.sinh(s) + math.sin(s) * math.cosh(s)) / 2)
    first = -factor * math.cos(s) * math.cosh(s)  # derivatives at c by x
    second = factor * (math.cos(s) * math.sinh(s) - math.sin(s) * math.cosh(s))
    third = factor * 2 * math.sin(s) * math.sinh(s)
    fourth = -limit / STIFFNESS
    c = (FORCE / 2 - STIFFNESS * third) / limit  # the shear force at 0 is half of the load
    slope = first - second * c + third * c**2 / 2 - fourth * c**3 / 6
    return slope, c, limit / k - first * c + second * c**2 / 2 - third * c**3 / 6 + fourth * c**4 / 24


def solved_raft(limit):
    """Length in contact, length that yields, both of the half, and settlement: by bisection."""
    low, high = 0.2, math.pi / 2
    for _ in range(60):
        middle = (low + high) / 2
        if raft_at(low, limit)[0] * raft_at(middle, limit)[0] <= 0:
            high = middle
        else:
            low = middle
    _, c, settlement = raft_at(low, limit)
    return c + low, c, settlement


def raft():
    contact, yields, settlement = solved_raft(20)
    return Problem(
        "A raft on soil that yields",
        "The beam of the last problem as a raft on soil: springs that do not pull and that yield at ξ = 20 kPa. Below the column (P = 50 kN/m) the soil yields, next to that it is elastic, "
        "and farther out the raft lifts off. The right value joins the closed solutions of the three parts, by bisection for the length of the elastic one.",
        "M. Hetényi (1946), Beams on Elastic Foundation, University of Michigan Press, for the parts; Y. Weitsman (1970) for the lift-off",
        "EI w'''' = −p, p = min(k w, ξ) where w > 0, w'(0) = 0, EI w'''(0) = P/2, no moment nor shear at the lift-off",
        [Run("raft.yaml", coarse=0.01)],
        [Quantity("length in contact, of the half", "m", contact, result("contact_length"), (0, "contact_length")),
         Quantity("settlement below the column", "m", settlement, result("max_penetration"), (0, "max_penetration")),
         Quantity("length that yields, of the half", "m", yields, result("yielded_length"), NO_BAR_OF, 3)],
        ["--scale=20"])


def footing():
    load, lever, k, limit = 90, 0.5, 1e4, 100  # [kN/m], [m] from the load to the right edge, [kPa/m], [kPa]
    contact = 3 * lever
    largest = 2 * load / contact
    # With a yield limit: load = limit (c + y)/2, load lever = limit (c² + c y + y²)/6 of c in contact and y that yields.
    total, difference = 2 * load / limit, math.sqrt(12 * load / limit * (1 - load / limit))
    c, y = (total + difference) / 2, (total - difference) / 2
    changes = {"Contact->Yield Stress": "100"}
    return Problem(
        "A footing that rocks",
        "A stiff footing, 2 m wide, bears N = 90 kN/m at e = 0.5 m from its middle, outside of the middle third: on springs that do not pull (k = 10⁴ kPa/m) its left side lifts off. "
        "On elastic soil it touches over 3 (B/2 − e). On soil that yields at ξ = 100 kPa the pressures are a triangle and a rectangle that balance N and its moment.",
        "N. Allotey and M. H. El Naggar (2003), Analytical moment-rotation curves for rigid foundations based on a Winkler model, Soil Dyn. Earthq. Eng. 23, 367–381",
        "elastic: c = 3 (B/2 − e), kw = 2N/c at the edge; yielding: N = ξ (c + y)/2, N (B/2 − e) = ξ (c² + cy + y²)/6, w = ξ/k · c/(c − y)",
        [Run("footing.yaml", coarse=0.02), Run("footing.yaml", changes, coarse=0.02)],
        [Quantity("elastic: width in contact c", "m", contact, result("contact_length"), (0, "contact_length")),
         Quantity("elastic: settlement of the edge", "m", largest / k, result("max_penetration"), (0, "max_penetration")),
         Quantity("yielding: width in contact c", "m", c, result("contact_length", 1), (1, "contact_length")),
         Quantity("yielding: settlement of the edge", "m", limit / k * c / (c - y), result("max_penetration", 1), (1, "max_penetration")),
         Quantity("yielding: width that yields y", "m", y, result("yielded_length", 1), NO_BAR_OF, 2)],
        ["--scale=20"], pictured=1)


def limit_load():
    limit, width, eccentricity, step = 100, 2, 0.5, 0.01
    right = limit * (width - 2 * eccentricity)

    def loaded(load):
        return {"Traction->top->Y": "-%g*3/8*(1 + x)^2" % load}

    return Problem(
        "A footing at its limit load",
        "The footing of the last problem on the foundation of Namm & Tsoy, rigid up to its yield stress ξ = 100 kPa: no springs, so that all that holds it against tipping is what the foundation bears. "
        "At the limit load the foundation yields over the part of the width that has the load in its middle, and the rest has lifted off. The program solves a load just below the limit and refuses one just above (exit code 5).",
        "G. G. Meyerhof (1953), The bearing capacity of foundations under eccentric and inclined loads, Proc. 3rd Int. Conf. Soil Mech. Found. Eng. 1, 440–445: effective width B − 2e",
        "F = ξ (B − 2e)",
        [Run("limit_load.yaml", loaded(right - step)), Run("limit_load.yaml", loaded(right + step), refused="carries at most")],
        [Quantity("limit load", "kN/m", right, lambda runs: (runs[0]["contact_force"][-1] + right + step) / 2, step),
         Quantity("width in contact, just below", "m", width - 2 * eccentricity, result("contact_length"), NO_BAR_OF, 2)],
        ["--scale=100"],
        remark="The bar of the limit load is half the distance of the two loads. The width in contact reaches its limit like the root of the load that is left.")


def greco():
    published = ((0, 28.6), (0.00125, 27.2), (0.005, 22.8), (0.0075, 19.8), (0.01125, 15.0))
    why = "the program prints none for displacements of points"
    probes = [Quantity("u at x = %g mm" % (1000 * x), "µm", value, lambda runs, x=x: 1e6 * runs[0]["probe"](x), why, 2)
              for x, value in published]
    return Problem(
        "GRECO's plate: SSNV128 of Code_Aster",
        "Half of a square plate (E = 130 GPa, ν = 0.2, plane strain, 40 mm) is pressed on a rigid, rough plane (μ = 1) by 50 MPa and along it by 150 MPa. "
        "It opens at its left end, slips in the middle and sticks at the right. Compared are the published displacements of five points of the contact side.",
        "Code_Aster, V6.04.128, SSNV128: Plaque avec contact et frottement sur un plan rigide, after the French group GRECO",
        "published values of an analysis with finite deformations",
        [Run("greco.yaml", coarse=0.02)], probes, [],
        remark="Published values have three digits and come from other meshes. An independent code has 28.59, 27.22, 22.85, 19.80 and 15.41 µm on 32 × 32 cells: the fifth published value is off by 2.7 %.")


def namm_tsoy():
    return Problem(
        "Namm and Tsoy: the paper's beam",
        "A beam, 5 m × 1 m (E = 2000 Pa, ν = 0.3), clamped at its ends and loaded by 20 sin(πx/5) Pa, is pressed into a foundation that yields at ξ = 2 Pa: all of it gives way. "
        "The right values are those of an independent code with hp elements; the paper's energy on its finest mesh, 2.6 million unknowns, is −3.976381 J/m. "
        "At ξ = 16 Pa a third of the foundation stays rigid.",
        "R. V. Namm and G. I. Tsoy (2025), see [doc/paper](../paper/README.md), Example 1, Table 1",
        "J to 2·10⁻⁷; the force is 5ξ at ξ = 2",
        [Run("namm_tsoy.yaml", coarse=0.01), Run("namm_tsoy.yaml", {"Contact->Yield Stress": "16"}, coarse=0.01)],
        [Quantity("ξ = 2: energy J", "J/m", -3.9764833, result("energy_J"), (0, "energy_J")),
         Quantity("ξ = 2: largest penetration", "m", 0.19068271, result("max_penetration"), (0, "max_penetration")),
         Quantity("ξ = 2: force", "N/m", 10, vertical(), (0, "contact_force")),
         Quantity("ξ = 16: energy J", "J/m", -0.21344083, result("energy_J", 1), (1, "energy_J")),
         Quantity("ξ = 16: largest penetration", "m", 0.0117280, result("max_penetration", 1), (1, "max_penetration")),
         Quantity("ξ = 16: force", "N/m", 64.9414, vertical(1), (1, "contact_force"))],
        ["--scale=1"], pictured=1)


def cap(radius):
    """Area of a ball's surface, of radius 1, within this radius of the axis."""
    return 2 * math.pi * (1 - math.sqrt(1 - radius**2))


def ball_dent():
    deck, finer = "../../input/ball_axisymmetric_adaptive.xml", {"Adapt->Target Relative Error": "0.002"}
    return Problem(
        "A ball that dents its foundation",
        "The lower half of a ball (R = 1 m, E = 2000 Pa, ν = 0.3), its flat top moved down by 0.02 m, is pressed on a foundation: a rigid one, and one that is rigid up to its yield stress, ξ = 100 Pa, half of the "
        "pressure on the rigid one. Then a disc of the foundation yields, and a ring around it stays rigid. The half ball is no half space: Hertz's formula between force and approach is off by 11 %, and the right "
        "values are those of an independent code, on axisymmetric quadratic triangles graded to the edge of the contact.",
        "R. V. Namm and G. I. Tsoy (2025) for the law of the foundation, H. Hertz (1882) for the ball",
        "the digits of the independent code that six meshes agree on",
        [Run(deck, {"Contact->Yield Stress": "100", **finer}, coarse=0.01), Run(deck, finer, coarse=0.01)],
        [Quantity("ξ = 100: force", "N", 7.65925, vertical(), (0, "contact_force")),
         Quantity("ξ = 100: energy J", "J", 0.0650233, result("energy_J"), (0, "energy_J")),
         Quantity("ξ = 100: area of the cap in contact", "m^2", cap(0.157166), result("contact_area"), (0, "contact_area")),
         Quantity("rigid: force", "N", 9.22776, vertical(1), (1, "contact_force")),
         Quantity("rigid: largest pressure", "Pa", 204.741, result("max_pressure", 1), (1, "max_pressure")),
         Quantity("rigid: area of the cap in contact", "m^2", cap(0.146347), result("contact_area", 1), (1, "contact_area"))],
        ["--window=0,-0.1,0.4,0.25"])
