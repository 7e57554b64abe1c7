# SPDX-License-Identifier: BSD-3-Clause
"""A scene in base units, its deck in scaled ones, and whether it has a solution: known from the data alone, without rpc."""
import dataclasses
import math
from xml.sax.saxutils import quoteattr

from fields import INFINITE, Constant, InTime, factor_at, ramp

COMPONENTS = "XYZ"
AXISYMMETRIC = "axisymmetric"
# What a refusal's message must say, one of the alternatives.
REASONS = {
    "limit": [["at most"]],
    "mode": [["rotation"], ["translation"]],
    "tilted": [["at most"], ["turns"], ["pulls"]],
    "lifted": [["at most"], ["turns"], ["pulls"], ["rotation"], ["translation"]],
    "part": [["part"]],
    "pressed": [["presses"], ["yield stress"]],
}
MARGIN = 0.03  # of the limit load, on both sides: no scene comes closer
MOST_MODES = 3  # free rigid motions of a part that `verdict` can judge


def dot(a, b):
    return sum(u * v for u, v in zip(a, b))


def difference(a, b):
    return tuple(u - v for u, v in zip(a, b))


def unit(a):
    size = math.hypot(*a)
    return tuple(v / size for v in a)


def seen(field, time):
    return field.at(time) if isinstance(field, InTime) else field


@dataclasses.dataclass
class Friction:
    """A point sticks up to the traction min(bound + coefficient p, limit) along its side, and slips at it."""

    coefficient: object = Constant(0.0)  # Field [1]
    bound: object = Constant(0.0)  # Field [stress]
    limit: object = INFINITE  # Field [stress]

    def seen_at(self, time):
        return Friction(*(seen(field, time) for field in (self.coefficient, self.bound, self.limit)))

    def bears(self, pressure, *point):
        """The traction along the side that a point bears."""
        return min(self.bound(*point) + self.coefficient(*point) * pressure, self.limit(*point))

    def deck(self, length, stress):
        given = {"Friction Coefficient": (self.coefficient, 1.0), "Friction Bound": (self.bound, stress), "Friction Limit": (self.limit, stress)}
        left_out = (0.0, math.inf)
        return {name: _field(field, length, unit) for name, (field, unit) in given.items()
                if not (isinstance(field, Constant) and field.value in left_out)}


@dataclasses.dataclass
class ContactSide:
    side: str
    xi: object  # Field [stress]
    gap: object = Constant(0.0)  # Field [length], without an obstacle
    normal: object = None  # None: rpc's default; "surface", "foundation", or a vector
    hardening: float = 0.0  # [stress/length]
    stiffness: float = math.inf  # [stress/length]
    remembers: bool = True
    obstacle: dict = None  # Type, and Point, Normal or Centre, Radius, Encloses Body or Point, Axis, Radius, Encloses Body
    motion: tuple = None  # (direction, factors of time) in which its point or centre moves [length]
    friction: object = None  # Friction

    def at(self, point, outward):
        """Normal and gap of a node; None if the normal misses the obstacle."""
        if not self.obstacle:
            return (self.normal if isinstance(self.normal, tuple) else outward), self.gap(*point)
        given = self.obstacle
        if given["Type"] == "plane":
            n = unit(given["Normal"])
            nu = self._direction(outward, tuple(-v for v in n))
            descent, height = -dot(nu, n), dot(difference(point, given["Point"]), n)
            return (nu, height / descent) if descent > 1e-9 else None
        sign = 1 if given.get("Encloses Body") else -1
        axis = unit(given["Axis"]) if given["Type"] == "cylinder" else None
        across = lambda v: difference(v, [dot(v, axis) * a for a in axis]) if axis else v
        m = across(difference(point, given["Centre"] if "Centre" in given else given["Point"]))
        nu = self._direction(outward, tuple(sign * v for v in unit(m)))
        way = across(nu)
        square, along, rest = dot(way, way), dot(m, way), dot(m, m) - given["Radius"] ** 2
        within = along * along - square * rest
        if square < 1e-18 or within < 0 or (sign < 0 < along and rest > 0):
            return None
        return nu, (sign * math.sqrt(within) - along) / square

    def seen_at(self, time):
        if self.friction:
            return dataclasses.replace(self, friction=self.friction.seen_at(time)).moved_to(time)
        return self.moved_to(time)

    def moved_to(self, time):
        if not self.motion:
            return self
        name = "Centre" if "Centre" in self.obstacle else "Point"
        place = tuple(a + d * factor_at(self.motion[1], time) for a, d in zip(self.obstacle[name], self.motion[0]))
        return dataclasses.replace(self, obstacle={**self.obstacle, name: place}, motion=None)

    def _direction(self, outward, foundation):
        if self.normal == "surface":
            return outward
        return self.normal if isinstance(self.normal, tuple) else foundation


@dataclasses.dataclass
class Scene:
    mesh: dict  # of the deck, without lengths: see `lengths`
    contact: list
    material: dict = dataclasses.field(default_factory=lambda: {"E": 1000.0, "nu": 0.3, "blocks": {}})
    dirichlet: dict = dataclasses.field(default_factory=dict)  # {side: {component: Field}}
    traction: dict = dataclasses.field(default_factory=dict)  # {side: [Field per component]}
    body_force: list = None  # numbers
    body: object = None  # Body; None where the suite does not know the mesh
    lengths: dict = dataclasses.field(default_factory=dict)  # mesh parameters that are lengths
    file: object = None  # f(length) -> text of Mesh->File
    dim: int = 2
    kinematics: str = None  # of a plane mesh; None: rpc's default
    cell: float = 0.1  # size of the smallest cell, where there is no body
    expect: str = None  # "solution" or a key of REASONS where `body` is None
    applied: list = None  # resultant of the load, where known
    units: tuple = (1.0, 1.0)  # of length and stress
    exodus: bool = False
    times: list = None  # of load steps; fields are InTime then
    more: dict = dataclasses.field(default_factory=dict)  # further parameters of the deck by their list, in the deck's units

    def at(self, time):
        """The scene as it is at one time."""
        return dataclasses.replace(
            self, times=None, contact=[contact.seen_at(time) for contact in self.contact],
            dirichlet={side: {c: seen(f, time) for c, f in fields.items()} for side, fields in self.dirichlet.items()},
            traction={side: [seen(f, time) for f in fields] for side, fields in self.traction.items()})

    def load_power(self):
        """Forces are stresses times this power of the length."""
        return 2 if self.kinematics == AXISYMMETRIC else self.dim - 1

    def stiffest(self):
        return max([self.material["E"]] + [e for e, _ in self.material["blocks"].values()])

    def softening(self):
        """1/(1 - 2 nu): how much stiffer the body is in volume than in shape."""
        return max(1 / (1 - 2 * nu) for nu in [self.material["nu"]] + [v for _, v in self.material["blocks"].values()])


def _parameter(name, kind, value):
    return f"<Parameter name={quoteattr(name)} type={quoteattr(kind)} value={quoteattr(value)}/>"


def _list(name, entries):
    lines = [f"<ParameterList name={quoteattr(name)}>"]
    for key, value in entries.items():
        lines.append(_list(key, value) if isinstance(value, dict) else _entry(key, value))
    return "\n".join(lines + ["</ParameterList>"])


def _entry(name, value):
    if isinstance(value, bool):
        return _parameter(name, "bool", str(value).lower())
    if isinstance(value, (tuple, list)):
        if all(isinstance(v, str) for v in value):
            return _parameter(name, "Array(string)", "{" + ", ".join(value) + "}")
        kind = "int" if all(isinstance(v, int) for v in value) else "double"
        return _parameter(name, f"Array({kind})", "{" + ", ".join(repr(v) for v in value) + "}")
    kind = {float: "double", int: "int", str: "string"}[type(value)]
    return _parameter(name, kind, value if kind == "string" else repr(value))


def _field(field, length, unit):
    if isinstance(field, Constant) and not math.isinf(field.value):
        return field.value * unit
    return field.deck(length, unit)


def _contact(side, length, stress):
    entries = {"Side": side.side, "Yield Stress": "inf" if side.xi(0) == math.inf else _field(side.xi, length, stress)}
    if side.hardening:
        entries["Hardening"] = side.hardening * stress / length
    if not math.isinf(side.stiffness):
        entries["Stiffness"] = side.stiffness * stress / length
    if not side.remembers:
        entries["Remembers"] = "false"
    if side.friction:
        entries.update(side.friction.deck(length, stress))
    if isinstance(side.normal, str):
        entries["Normal"] = side.normal
    elif side.normal:
        entries["Normal"] = ", ".join(repr(v) for v in side.normal)
    if not side.obstacle:
        return {**entries, "Gap": _field(side.gap, length, length)}
    scaled = {"Point": length, "Centre": length, "Radius": length}
    times = lambda v, f: [float(x) * f for x in v] if isinstance(v, (list, tuple)) else float(v) * f
    obstacle = {k: times(v, scaled[k]) if k in scaled else v for k, v in side.obstacle.items()}
    if side.motion:
        name = "Centre" if "Centre" in obstacle else "Point"
        obstacle[name] = [f"{x!r} + ({d * length!r})*({ramp(side.motion[1])})" for x, d in zip(obstacle[name], side.motion[0])]
    return {**entries, "Obstacle": obstacle}


def deck(scene, mesh_file=None):
    """The deck's XML."""
    length, stress = scene.units
    mesh = {**scene.mesh, **{k: [float(x) * length for x in v] for k, v in scene.lengths.items()}}
    if mesh_file:
        mesh["File"] = mesh_file
    material = {"Young's Modulus": scene.material["E"] * stress, "Poisson's Ratio": scene.material["nu"]}
    if scene.material["blocks"]:
        material["Blocks"] = {name: {"Young's Modulus": e * stress, "Poisson's Ratio": nu}
                              for name, (e, nu) in scene.material["blocks"].items()}
    lists = {"Mesh": mesh, "Material": material}
    if scene.kinematics:
        lists["Kinematics"] = scene.kinematics
    lists["Dirichlet"] = {side: {c: _field(f, length, length) for c, f in components.items()}
                          for side, components in scene.dirichlet.items()}
    lists["Traction"] = {side: {c: _field(f, length, stress) for c, f in zip(COMPONENTS, fields)}
                         for side, fields in scene.traction.items()}
    if scene.body_force:
        lists["Body Force"] = {c: f * stress / length for c, f in zip(COMPONENTS, scene.body_force)}
    contact = _contact(scene.contact[0], length, stress)
    for number, side in enumerate(scene.contact[1:]):
        contact.setdefault("Sides", {})[f"further {number}"] = _contact(side, length, stress)
    lists["Contact"] = contact
    if scene.times:
        lists["Steps"] = {"Times": [float(t) for t in scene.times]}
    lists["Output"] = {"Exodus": scene.exodus}
    for name, entries in scene.more.items():
        lists[name] = {**lists.get(name, {}), **entries}
    return _list("scene", lists) + "\n"


# --- whether there is a solution -------------------------------------------------------------------------------------------


def _null_space(rows, size):
    """Basis of the vectors that all rows, of size about 1, annihilate; by elimination with full pivoting."""
    rows, done = [list(row) for row in rows], []
    pivots = lambda: [c for c, _ in done]
    while len(done) < size:
        best = max(((abs(row[c]), k, c) for k, row in enumerate(rows) for c in range(size) if c not in pivots()), default=(0, 0, 0))
        if best[0] < 1e-9:
            break
        _, k, c = best
        pivot = [v / rows[k][c] for v in rows[k]]
        rows = [[a - row[c] * b for a, b in zip(row, pivot)] for n, row in enumerate(rows) if n != k]
        done.append((c, pivot))
    basis = []
    for free in (c for c in range(size) if c not in pivots()):
        x = [1.0 if c == free else 0.0 for c in range(size)]
        for c, pivot in reversed(done):
            x[c] = -sum(pivot[d] * x[d] for d in range(size) if d != c)
        scale = math.sqrt(sum(v * v for v in x))
        basis.append([v / scale for v in x])
    return basis


def _extreme_rays(points, dim):
    """Directions in which the cones of {d: a.d >= 0 or <= 0 for each a} end; the points span all of the space."""
    if dim == 1:
        return [[1.0], [-1.0]]
    planes = []
    for a in points:
        size = math.sqrt(sum(v * v for v in a))
        if size > 1e-12:
            planes.append([v / size for v in a])
    if dim == 2:
        rays = [[-b, a] for a, b in planes]
    else:
        rays = []
        for k, (a, b, c) in enumerate(planes):
            for d, e, f in planes[:k]:
                ray = [b * f - c * e, c * d - a * f, a * e - b * d]
                size = math.sqrt(sum(v * v for v in ray))
                if size > 1e-9:
                    rays.append([v / size for v in ray])
    return rays + [[-v for v in ray] for ray in rays]


class _Part:
    """A connected part of a body: its free rigid motions, in coordinates scaled by its size: (u, v, w) -> (u - w y, v + w x) in the plane;
    in space (t, r) -> t + r x (x, y, z)."""

    def __init__(self, scene, grid):
        self.scene, self.grid = scene, grid
        places = [grid.nodes[k] for k in grid.used_nodes()]
        lows, highs = [min(c) for c in zip(*places)], [max(c) for c in zip(*places)]
        self.centre, self.size = [(a + b) / 2 for a, b in zip(lows, highs)], math.dist(lows, highs) / 2
        rows, self.prescribed = [], {}
        for side, components in scene.dirichlet.items():
            for k in grid.side_nodes(side):
                motion = self.motion(grid.nodes[k])
                for component, field in components.items():
                    rows.append(motion[COMPONENTS.index(component)])
                    self.prescribed.setdefault(k, {})[component] = field(*grid.nodes[k])
        if scene.kinematics == AXISYMMETRIC:  # a body of revolution moves along its axis only
            rows += [[1, 0, 0], [0, 0, 1]]
            for k, place in enumerate(grid.nodes):
                if place[0] == 0:
                    self.prescribed.setdefault(k, {})["X"] = 0.0
        self.modes = _null_space(rows, 3 if scene.dim == 2 else 6)

    def motion(self, point):
        """Displacement at a point: for each component its factors of the motion's numbers."""
        x = [v / self.size for v in difference(point, self.centre)]
        if len(x) == 2:
            return [[1, 0, -x[1]], [0, 1, x[0]]]
        return [[1, 0, 0, 0, x[2], -x[1]], [0, 1, 0, -x[2], 0, x[0]], [0, 0, 1, x[1], -x[0], 0]]

    def work(self, force, point):
        """Of a force at a point on each free motion."""
        motion = self.motion(point)
        return [sum(f * dot(row, mode) for f, row in zip(force, motion)) for mode in self.modes]

    def contact(self):
        """([work of the normal on each motion], force that the foundation can bear) of nodes that can move along the normal;
        with what is wrong about the others: None, "pressed" or "close"; or "missed" if no node of a side faces its obstacle."""
        points, trouble = [], None
        for contact in self.scene.contact:
            nodes = self.grid.contact_nodes(contact.side)
            facing = {k: contact.at(self.grid.nodes[k], outward) for k, (_, outward) in nodes.items()}
            if nodes and not any(facing.values()):
                return [], "missed"
            largest = max((abs(gap) for _, gap in filter(None, facing.values())), default=0)
            for k, (w, _) in nodes.items():
                if not facing[k]:
                    continue
                place = self.grid.nodes[k]
                nu, gap = facing[k]
                fixed = self.prescribed.get(k, {})
                if math.hypot(*(0 if c in fixed else v for c, v in zip(COMPONENTS, nu))) > 1e-9:
                    points.append((self.work(nu, place), w * contact.xi(*place)))
                    continue
                v = sum(fixed.get(c, 0) * n for c, n in zip(COMPONENTS, nu)) - gap
                scale = max([abs(gap)] + [abs(u) for u in fixed.values()])
                if v > 1e-13 * scale and math.isinf(contact.xi(*place)):  # far out on a bump the gap may be 1e-88: too close to call
                    trouble = "pressed" if v > 1e-6 * max(scale, largest) or trouble == "pressed" else "close"
        return points, trouble

    def load(self):
        """Work of the load on each motion, and the sum of its forces' sizes."""
        forces = _applied_forces(self.scene, self.grid)
        works = [self.work(*force) for force in forces]
        return [sum(w[m] for w in works) for m in range(len(self.modes))], sum(math.hypot(*f) for f, _ in forces)

    def verdict(self):
        """J is bounded below and grows in all directions if and only if for each free motion d
        load.d < sum_i w_i xi_i (nu_i.d)+. Both sides are linear on cones, so that the rays where these end are enough."""
        points, trouble = self.contact()
        if trouble:
            return "pressed" if trouble == "pressed" else None
        if not self.modes:
            return "solution"
        if len(self.modes) > MOST_MODES:
            return None
        if _null_space([a for a, _ in points], len(self.modes)):
            return "mode"
        load, total = self.load()
        verdicts = {self._verdict_of_ray(d, points, load, total) for d in _extreme_rays([a for a, _ in points], len(self.modes))}
        return next((v for v in (None, "lifted", "mode", "limit", "tilted") if v in verdicts), "solution")

    def _verdict_of_ray(self, d, points, load, total):
        held = sum(c * dot(a, d) for a, c in points if dot(a, d) > 1e-9)
        pull = dot(load, d)
        if held == 0:
            if abs(pull) <= 1e-9 * total:
                return "mode"
            return "lifted" if pull > 0.02 * total else "solution" if pull < -0.02 * total else None
        if math.isinf(held) or pull <= held * (1 - MARGIN):
            return "solution"
        if pull < held * (1 + MARGIN):
            return None
        return "limit" if len(self.modes) == 1 else "tilted"


def verdict(scene):
    """"solution", a key of REASONS, or None: too close to call."""
    if scene.body is None:
        return scene.expect
    verdicts = [_Part(scene, grid).verdict() for grid in scene.body.parts]
    if None in verdicts:
        return None
    bad = [v for v in verdicts if v != "solution"]
    if not bad:
        return "solution"
    return "part" if len(verdicts) > 1 and bad[0] in ("mode", "lifted", "tilted") and len(bad) < len(verdicts) else bad[0]


def _applied_forces(scene, grid):
    """[force, point] of all quadrature points."""
    forces = [([w * f(*point) for f in fields], point) for side, fields in scene.traction.items() for point, w in grid.side_points(side)]
    return forces + [([w * f for f in scene.body_force], point) for point, w in (grid.body_points() if scene.body_force else [])]


def applied_resultant(scene):
    """Of tractions and body forces, in base units, along the axis only of an axisymmetric body; None where it is not known."""
    if scene.body is None:
        return scene.applied
    forces = [force for grid in scene.body.parts for force, _ in _applied_forces(scene, grid)]
    total = [sum(force[c] for force in forces) for c in range(scene.dim)]
    return [0.0, total[1]] if scene.kinematics == AXISYMMETRIC else total


def radial_size(scene):
    """Sum of the sizes of the radial loads of an axisymmetric body, which its resultant does not show, in base units; else 0."""
    if scene.body is None or scene.kinematics != AXISYMMETRIC:
        return 0.0
    return sum(abs(force[0]) for grid in scene.body.parts for force, _ in _applied_forces(scene, grid))
