# SPDX-License-Identifier: BSD-3-Clause
"""The problems of the gallery: what is asked, and what is right by formulas that have nothing to do with the program."""
import dataclasses
import math
import typing


class Run(typing.NamedTuple):
    """One run of the program: a deck with changes to it. `coarse` is the target for the error in everyday tests."""

    deck: str
    changes: dict = {}
    coarse: typing.Optional[float] = None
    refused: str = ""  # what the message says where no solution exists

    @property
    def name(self):
        return self.deck.rsplit("/", 1)[-1].rsplit(".", 1)[0]


class Quantity(typing.NamedTuple):
    """A number to compare.

    right   the right value
    value   of a function of the runs' results, each with the keys of its JSON file and "probe"
    bar     (run, key of adaptation->errors), a number where the runs themselves bracket the value, or why there is none
    digits  behind the point where there is no bar
    """

    name: str
    unit: str
    right: float
    value: typing.Callable
    bar: typing.Union[tuple, float, str]
    digits: int = 4
    source: str = ""  # of the right value where it differs from the problem's


@dataclasses.dataclass
class Problem:
    title: str
    statement: str
    source: str
    equation: str
    runs: list
    quantities: list
    picture: list  # options of doc/picture.sh for the run `pictured`
    pictured: int = 0
    remark: str = ""

    @property
    def name(self):
        return self.runs[0].name


NO_BAR_OF = "the program prints none for it"
E_STAR = 2000 / (1 - 0.3**2)  # [Pa] of the half spaces
AREA = "contact_area"


def result(key, run=0, component=None):
    """A function that takes a key of a run's JSON file."""
    return lambda runs: runs[run][key] if component is None else runs[run][key][component]


def vertical(run=0):
    """The vertical contact force."""
    return lambda runs: runs[run]["contact_force"][-1]


HERTZ = "H. Hertz (1882), Über die Berührung fester elastischer Körper, J. reine angew. Math. 92, 156–171"
JOHNSON = "K. L. Johnson (1985), Contact Mechanics, Cambridge University Press"


def hertz_line():
    a, R = 1, 50
    return Problem(
        "Hertz: a half plane on a cylinder",
        "An elastic half plane (E = 2000 Pa, ν = 0.3) is pressed on a rigid cylinder of radius R = 50 m until they touch over a width of 2a = 2 m. "
        "The gap is Hertz's parabola, x²/2R. The mesh is the right half of what an ellipse cuts off; on the ellipse the body is given the exact displacement "
        "of the half plane, so that the formulas hold for the finite body too.",
        f"{HERTZ}; {JOHNSON}, (4.43) to (4.45)",
        "F = π E* a²/(4R), p₀ = E* a/(2R), E* = E/(1 − ν²)",
        [Run("hertz_line.yaml", coarse=0.02)],
        [Quantity("force on the half", "N/m", math.pi * E_STAR * a**2 / (4 * R) / 2, vertical(), (0, "contact_force")),
         Quantity("largest pressure", "Pa", E_STAR * a / (2 * R), result("max_pressure"), (0, "max_pressure")),
         Quantity("half width a", "m", a, result("contact_length"), (0, "contact_length"))],
        ["--window=0,-0.4,2,1.2"])


def hertz_force(a, R):
    return 4 / 3 * E_STAR * a**3 / R


def hertz_pressure(a, R):
    return 2 * E_STAR * a / (math.pi * R)


def hertz_ball():
    a, R = 1, 50
    return Problem(
        "Hertz: a half space on a ball",
        "An elastic half space (E = 2000 Pa, ν = 0.3) is pressed by d = a²/R = 0.02 m on a rigid ball of radius R = 50 m. "
        "The body is one of revolution, of which the mesh is the section. It ends at a spheroid, where it is given the exact displacement of the half space.",
        f"{HERTZ}; {JOHNSON}, (4.22) to (4.24)",
        "F = 4/3 E* R^½ d^(3/2), p₀ = 2 E* a/(πR), a² = R d",
        [Run("hertz_ball.yaml", coarse=0.004)],
        [Quantity("force", "N", hertz_force(a, R), vertical(), (0, "contact_force")),
         Quantity("largest pressure", "Pa", hertz_pressure(a, R), result("max_pressure"), (0, "max_pressure")),
         Quantity("area in contact, πa²", "m^2", math.pi * a**2, result(AREA), (0, AREA))],
        ["--window=0,-0.4,2,1.2"])


def hertz_space():
    a, R = 1, 50
    return Problem(
        "Hertz: the same in space",
        "The half space on a ball of the last problem once more, in space: a quarter of it between two planes of symmetry, of tetrahedra. "
        "Force and area are those of the quarter. The spheroid at which the mesh ends lies nearer here, which makes no difference to what is right.",
        f"{HERTZ}; {JOHNSON}, (4.22) to (4.24)",
        "F = E* a³/(3R) for the quarter, p₀ = 2 E* a/(πR)",
        [Run("hertz_space.yaml", coarse=0.06)],
        [Quantity("force on the quarter", "N", hertz_force(a, R) / 4, vertical(), (0, "contact_force")),
         Quantity("largest pressure", "Pa", hertz_pressure(a, R), result("max_pressure"), (0, "max_pressure")),
         Quantity("area in contact, πa²/4", "m^2", math.pi * a**2 / 4, result(AREA), (0, AREA))],
        [])


def sneddon_cone():
    slope, a = 0.02, 1
    return Problem(
        "Sneddon: a half space on a cone",
        "An elastic half space (E = 2000 Pa, ν = 0.3) is pressed on a rigid cone that rises by s = 0.02 m per m, until the contact has the radius a = 1 m. "
        "At the tip the pressure is infinite, like a logarithm. On the spheroid at which the mesh ends the body is given the exact displacement.",
        "I. N. Sneddon (1948), Boussinesq's problem for a rigid cone, Proc. Camb. Phil. Soc. 44, 492–507; A. E. H. Love (1939), Quart. J. Math. 10, 161–175",
        "F = π E* a² s/2, d = π a s/2",
        [Run("sneddon_cone.yaml", coarse=0.02)],
        [Quantity("force", "N", math.pi * E_STAR * a**2 * slope / 2, vertical(), (0, "contact_force")),
         Quantity("area in contact, πa²", "m^2", math.pi * a**2, result(AREA), (0, AREA)),
         Quantity("largest pressure", "Pa", math.inf, result("max_pressure"), (0, "max_pressure"))],
        ["--window=0,-0.4,2,1.2"])


def flat_punch():
    d, a = 0.02, 1
    return Problem(
        "Boussinesq: a half space on a flat punch",
        "An elastic half space (E = 2000 Pa, ν = 0.3) is pressed by d = 0.02 m on a rigid, flat, round punch of radius a = 1 m. "
        "At its edge the pressure is infinite, like r^(−1/2). On the spheroid at which the mesh ends the body is given the exact displacement.",
        "J. Boussinesq (1885), Application des potentiels à l'étude de l'équilibre et du mouvement des solides élastiques, Gauthier-Villars; "
        "I. N. Sneddon (1965), Int. J. Eng. Sci. 3, 47–57",
        "F = 2 E* a d",
        [Run("flat_punch.yaml", coarse=0.02)],
        [Quantity("force", "N", 2 * E_STAR * a * d, vertical(), (0, "contact_force")),
         Quantity("largest pressure", "Pa", math.inf, result("max_pressure"), (0, "max_pressure"))],
        ["--window=0,-0.4,2,1.2", "--field=disp_y"])


def westergaard():
    length, amplitude, mean = 1, 0.005, 10
    full = math.pi * E_STAR * amplitude / length  # mean pressure that closes the gap
    sine = math.sqrt(mean / full)
    return Problem(
        "Westergaard: a half plane on a wave",
        "An elastic half plane (E = 2000 Pa, ν = 0.3) is pressed by p̄ = 10 Pa on a rigid wave, Δ (1 − cos(2πx/λ)) below it, λ = 1 m, Δ = 0.005 m. "
        "It touches each crest over a width of 2a. The mesh is half a wave between planes of symmetry, 2λ deep, where the wave's stresses have died away (e^(−8π)).",
        f"H. M. Westergaard (1939), Bearing pressures and cracks, J. Appl. Mech. 6, A49–A53; {JOHNSON}, section 13.2",
        "p̄ = p* sin²(πa/λ), p(0) = 2 (p̄ p*)^½, p* = π E* Δ/λ",
        [Run("westergaard.yaml", coarse=0.02)],
        [Quantity("half width a", "m", length / math.pi * math.asin(sine), result("contact_length"), (0, "contact_length")),
         Quantity("largest pressure", "Pa", 2 * math.sqrt(mean * full), result("max_pressure"), (0, "max_pressure"))],
        ["--window=0,-0.2,0.5,0.6"])


def mindlin():
    nu, a, c, R, mu = 0.4999, 1, 0.6, 50, 0.5
    normal = math.pi * 2000 / (1 - nu**2) * a**2 / (4 * R)
    return Problem(
        "Cattaneo and Mindlin: partial slip",
        "An elastic half plane (E = 2000 Pa) is pressed on a rigid, rough cylinder (R = 50 m, μ = 0.5) over a width of 2a = 2 m and pushed along it, until points stick "
        "in the middle 2c = 1.2 m only. Pressures do not move points along a rigid surface if ν = 1/2; the deck has ν = 0.4999. On the ellipse at which the mesh ends "
        "the body is given the exact displacement.",
        "C. Cattaneo (1938), Sul contatto di due corpi elastici, Rend. Accad. Naz. Lincei 27; R. D. Mindlin (1949), Compliance of elastic bodies in contact, "
        f"J. Appl. Mech. 16, 259–268; {JOHNSON}, section 7.2",
        "Q = μP (1 − c²/a²), P = π E* a²/(4R)",
        [Run("mindlin.yaml", coarse=0.05)],
        [Quantity("force Q along the cylinder", "N/m", -mu * normal * (1 - (c / a) ** 2), result("contact_force", 0, 0), (0, "contact_force")),
         Quantity("normal force P", "N/m", normal, vertical(), (0, "contact_force")),
         Quantity("width in contact, 2a", "m", 2 * a, result("contact_length"), (0, "contact_length")),
         Quantity("width that sticks, 2c", "m", 2 * c, result("stick_length"), NO_BAR_OF, 3),
         Quantity("largest pressure", "Pa", 2000 / (1 - nu**2) * a / (2 * R), result("max_pressure"), (0, "max_pressure"), 2)],
        ["--window=-1.6,-0.6,1.6,1"],
        remark="The bar of the force is that of the vector, and counts for both components.")
