#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Contact of two elastic bodies whose interface gives way at a pressure xi: the study of README.md, in the plane.

    python3 two_bodies.py            prints the table of README.md
    python3 two_bodies.py --check    exits with 1 where a statement of README.md does not hold

Body 1 lies above y = 0, body 2 below; nu = (0, -1) is the outer normal of body 1. Lengths in m, stresses in Pa, forces in N/m.
v = u1.nu - u2.nu - g is the penetration [m], p >= 0 the pressure that it costs [Pa]; numbers in brackets are equations of README.md."""

import sys

try:
    import numpy as np
except ModuleNotFoundError:
    print("this study needs numpy: apt-get install python3-numpy", file=sys.stderr)
    sys.exit(77)


class Body:
    """A rectangle of Q1 cells in plane strain; displacements are numbered 2 node + direction, nodes x first."""

    def __init__(self, x, y, young, poisson):
        self.x, self.y = np.asarray(x), np.asarray(y)
        lame = young * poisson / ((1 + poisson) * (1 - 2 * poisson))
        shear = young / (2 * (1 + poisson))
        law = np.array([[lame + 2 * shear, lame, 0], [lame, lame + 2 * shear, 0], [0, 0, shear]])
        self.stiffness = np.zeros((2 * self.num_nodes(),) * 2)
        for j in range(len(self.y) - 1):
            for i in range(len(self.x) - 1):
                nodes = [self.node(i, j), self.node(i + 1, j), self.node(i + 1, j + 1), self.node(i, j + 1)]
                dofs = np.array([2 * node + c for node in nodes for c in range(2)])
                self.stiffness[np.ix_(dofs, dofs)] += cell_stiffness(self.x[i + 1] - self.x[i], self.y[j + 1] - self.y[j], law)

    def num_nodes(self):
        return len(self.x) * len(self.y)

    def node(self, i, j):
        return j % len(self.y) * len(self.x) + i

    def row(self, j, direction):
        """Displacements of a row of nodes."""
        return np.array([2 * self.node(i, j) + direction for i in range(len(self.x))])

    def column(self, i, direction):
        return np.array([2 * self.node(i % len(self.x), j) + direction for j in range(len(self.y))])


def cell_stiffness(a, b, law):
    """Of a Q1 cell with sides a and b [m], by 2 x 2 Gauss points; (8, 8)."""
    points = np.array([-1, 1]) / np.sqrt(3)
    corners = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
    matrix = np.zeros((8, 8))
    for s in points:
        for t in points:
            by_x = corners[:, 0] * (1 + corners[:, 1] * t) / 4 * 2 / a
            by_y = corners[:, 1] * (1 + corners[:, 0] * s) / 4 * 2 / b
            strain = np.zeros((3, 8))
            strain[0, 0::2], strain[1, 1::2] = by_x, by_y
            strain[2, 0::2], strain[2, 1::2] = by_y, by_x
            matrix += strain.T @ law @ strain * a * b / 4
    return matrix


def hats(knots, x):
    """Values of the piecewise linear functions of the knots at the points x; (points, knots)."""
    return np.array([np.interp(x, knots, unit) for unit in np.eye(len(knots))]).T


def weights(x):
    """w_a, the integral of the function of node a [m]."""
    h = np.diff(x)
    return np.concatenate([[h[0]], h[:-1] + h[1:], [h[-1]]]) / 2


def mortar(x1, x2):
    """Pi, (3): (nodes of body 1, nodes of body 2). Exact, for the pieces between all knots are integrated one by one."""
    pi = np.zeros((len(x1), len(x2)))
    knots = np.unique(np.concatenate([x1, x2]))
    for left, right in zip(knots[:-1], knots[1:]):
        for s in np.array([-1, 1]) / np.sqrt(3):
            x = np.array([(left + right) / 2 + s * (right - left) / 2])
            phi1, phi2 = hats(x1, x)[0], hats(x2, x)[0]
            edge = np.flatnonzero(phi1)
            dual = np.zeros(len(x1))
            dual[edge] = 2 * phi1[edge] - phi1[edge[::-1]]  # of the edge's two nodes
            pi += (right - left) / 2 * np.outer(dual, phi2)
    return pi / weights(x1)[:, None]


def collocation(x1, x2):
    """The pairing that fails: u2 at the nodes of body 1."""
    return hats(x2, np.asarray(x1))


class Contact:
    """Two bodies, or one on a rigid foundation where lower is None; prescribed displacements are told in `fix`."""

    def __init__(self, upper, lower, gap, limit, pairing=mortar):
        self.upper, self.lower, self.limit = upper, lower, limit
        n1, n2 = 2 * upper.num_nodes(), 0 if lower is None else 2 * lower.num_nodes()
        self.stiffness = np.zeros((n1 + n2, n1 + n2))
        self.stiffness[:n1, :n1] = upper.stiffness
        self.jump = np.zeros((len(upper.x), n1 + n2))  # B of (4)
        self.jump[:, upper.row(0, 1)] = -np.eye(len(upper.x))
        if lower is not None:
            self.stiffness[n1:, n1:] = lower.stiffness
            self.jump[:, n1 + lower.row(-1, 1)] = pairing(upper.x, lower.x)
        self.offset, self.gap, self.weights = n1, gap(upper.x), weights(upper.x)
        self.load = np.zeros(n1 + n2)
        self.prescribed = {}

    def fix(self, body, dofs, value):
        offset = 0 if body is self.upper else self.offset
        self.prescribed.update({offset + dof: value for dof in dofs})

    def reduced(self):
        """K, b, B and g of the free displacements, and the energy of the prescribed ones [J/m]."""
        held = np.array(sorted(self.prescribed), dtype=int)
        self.free = np.setdiff1d(np.arange(len(self.load)), held)
        u_d = np.zeros(len(self.load))
        u_d[held] = [self.prescribed[dof] for dof in held]
        self.u_d = u_d
        K = self.stiffness[np.ix_(self.free, self.free)]
        b = (self.load - self.stiffness @ u_d)[self.free]
        return K, b, self.jump[:, self.free], self.gap - self.jump @ u_d, u_d @ self.stiffness @ u_d / 2 - self.load @ u_d

    def solve(self, tolerance=1e-11):
        """Generalized Newton's method on the smoothed functional inside, Uzawa's method outside, as rpc does on one body."""
        K, b, B, g, rest = self.reduced()
        w, u = self.weights, np.zeros(len(b))
        X, start = np.linalg.solve(K, B.T), np.linalg.solve(K, b)
        r = 10 * self.upper.stiffness.diagonal().max() / w.min()  # [Pa/m], the penalty of (5)
        pressure = np.zeros(len(w))
        self.newton_steps = 0
        for uzawa in range(100):
            multiplier = pressure
            for newton in range(100):
                trial = multiplier + r * (B @ u - g)
                p = np.clip(trial, 0, self.limit)
                residual = K @ u - b + B.T @ (w * p)
                if newton and np.abs(residual).max() < tolerance * np.abs(B.T @ (w * p)).max() + 1e-14:
                    break
                active = (trial > 0) & (trial < self.limit)
                step = start - u - X @ (w * p)  # -K^-1 residual, and then -H^-1 residual by Woodbury's formula
                inner = np.diag(1 / (r * w[active])) + B[active] @ X[:, active]
                step -= X[:, active] @ np.linalg.solve(inner, B[active] @ step)
                u = u + length(K, B, b, w, g, r, multiplier, self.limit, u, step) * step
                self.newton_steps += 1
            pressure = p
            if np.abs(pressure - multiplier).max() <= 1e-10 * np.abs(pressure).max():
                break
        self.pressure, self.penetration = pressure, B @ u - g
        yielding = np.where(self.penetration > 0, self.penetration, 0)
        plastic = 0 if np.isinf(self.limit) else self.limit * (w @ yielding)
        self.energy = u @ K @ u / 2 - b @ u + plastic + rest
        self.u = self.u_d.copy()
        self.u[self.free] += u
        return self

    def oracle(self, sweeps=200000, tolerance=1e-13):
        """The pressure by another algorithm: the dual problem (6) by coordinate descent, with the dense compliance B K^-1 B'."""
        K, b, B, g, _ = self.reduced()
        w = self.weights
        compliance = B @ np.linalg.solve(K, B.T) * w  # of forces w p
        opening = B @ np.linalg.solve(K, b) - g
        p = np.zeros(len(w))
        for _ in range(sweeps):
            largest = 0
            for a in range(len(w)):
                new = min(max(p[a] + (opening[a] - compliance[a] @ p) / compliance[a, a], 0), self.limit)
                largest, p[a] = max(largest, abs(new - p[a])), new
            if largest <= tolerance * np.abs(p).max():
                break
        return p

    def force(self):
        return self.weights @ self.pressure


def length(K, B, b, w, g, r, multiplier, limit, u, step):
    """The exact minimum along a step: the functional's derivative is piecewise linear and increases."""
    def slope(t):
        p = np.clip(multiplier + r * (B @ (u + t * step) - g), 0, limit)
        return step @ (K @ (u + t * step) - b) + (B @ step) @ (w * p)
    if slope(1) <= 0:
        return 1.0
    low, high = 0.0, 1.0
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if slope(middle) < 0 else (low, middle)
    return high


def patch(pairing):
    """Largest error of the pressure and of the reaction below, where both are 1 Pa everywhere: cells of 1/7 and 1/10 m on each other."""
    upper = Body(np.linspace(0, 1, 8), np.linspace(0, 0.5, 4), 200.0, 0.3)
    lower = Body(np.linspace(0, 1, 11), np.linspace(-0.5, 0, 6), 70.0, 0.2)
    scene = Contact(upper, lower, lambda x: 0 * x, np.inf, pairing)
    for body in (upper, lower):
        scene.fix(body, body.column(0, 0), 0.0)
    scene.fix(lower, lower.row(0, 1), 0.0)
    scene.fix(upper, upper.row(-1, 1), -0.5 * ((1 - 0.3**2) / 200 + (1 - 0.2**2) / 70))  # of a pressure of 1 Pa
    scene.solve()
    reactions = (scene.stiffness @ scene.u)[scene.offset:][lower.row(0, 1)] / weights(lower.x)
    return max(np.abs(scene.pressure - 1).max(), np.abs(reactions - 1).max())


def wave(n1, n2, limit=np.inf, young=(1.0, 3.0), pairing=mortar, depth=0.5):
    """Half a period of a wave pressed by 0.02 m: n1 cells along body 1, n2 along body 2, sides mirrored."""
    upper = Body(np.linspace(0, 1, n1 + 1), np.linspace(0, depth, max(n1 // 2, 1) + 1), young[0], 0.3)
    lower = None if n2 is None else Body(np.linspace(0, 1, n2 + 1), np.linspace(-depth, 0, max(n2 // 2, 1) + 1), young[1], 0.3)
    scene = Contact(upper, lower, lambda x: 0.01 * (1 - np.cos(np.pi * x)), limit, pairing)
    for body in (upper, lower):
        if body is not None:
            scene.fix(body, body.column(0, 0), 0.0)
            scene.fix(body, body.column(-1, 0), 0.0)
    scene.fix(upper, upper.row(-1, 1), -0.01)
    if lower is not None:
        scene.fix(lower, lower.row(0, 1), 0.0)
    return scene


def mirrored(limit):
    """Two equal bodies that are each other's image, and one of them on a rigid foundation: largest difference of pressures over
    their largest, and of energies over theirs (twice that of the one body)."""
    one = wave(12, None, limit).solve()
    two = wave(12, 12, limit, (1.0, 1.0))
    two.gap = 2 * two.gap
    two.fix(two.lower, two.lower.row(0, 1), 0.01)
    two.solve()
    return (np.abs(two.pressure - one.pressure).max() / one.pressure.max(), abs(two.energy / (2 * one.energy) - 1))


def hertz():
    """Two cylinders, E = 1 and 3 Pa, nu = 0.3, by a force: largest pressure over Hertz' one."""
    grade = np.concatenate([np.linspace(0, 0.06, 25), 0.06 + 0.94 * np.linspace(0, 1, 13)[1:] ** 2])
    coarser = np.concatenate([np.linspace(0, 0.06, 18), 0.06 + 0.94 * np.linspace(0, 1, 11)[1:] ** 2])
    upper, lower = Body(grade, grade, 1.0, 0.3), Body(coarser, -coarser[::-1], 3.0, 0.3)
    scene = Contact(upper, lower, lambda x: x**2 / 2, np.inf)  # R = 1 m
    for body in (upper, lower):
        scene.fix(body, body.column(0, 0), 0.0)
    scene.fix(lower, lower.row(0, 1), 0.0)
    scene.fix(upper, upper.row(-1, 1), -0.002)
    scene.solve()
    modulus = 1 / sum((1 - 0.3**2) / young for young in (1.0, 3.0))
    return scene.pressure.max() / np.sqrt(2 * scene.force() * modulus / np.pi)


def orders(limit):
    """Energies on meshes of 8 and 12, 16 and 24, 32 and 48 cells, and their observed order."""
    energies = [wave(2 * n, 3 * n, limit).solve().energy for n in (4, 8, 16)]
    return energies, np.log2((energies[0] - energies[1]) / (energies[1] - energies[2]))


def differences(limit):
    """Of pressures from those of the oracle, over their largest, and Newton steps."""
    scene = wave(14, 9, limit).solve()
    exact = scene.oracle()
    return np.abs(scene.pressure - exact).max() / exact.max(), scene.newton_steps


def results():
    """Each line of the table: what, value, whether the statement of README.md holds."""
    good, bad = patch(mortar), patch(collocation)
    yield "patch test, mortar", f"{good:.1e}", good < 1e-10
    yield "patch test, nodes of body 1 on facets of body 2", f"{bad:.1e}", bad > 1e-2
    for limit in (np.inf, 0.01):
        name = "xi = inf" if np.isinf(limit) else f"xi = {limit} Pa"
        pressure, energy = mirrored(limit)
        yield f"mirrored bodies, {name}: pressure, energy", f"{pressure:.1e}, {energy:.1e}", pressure < 1e-8 and energy < 1e-10
        difference, steps = differences(limit)
        yield f"oracle, {name}: pressure, Newton steps", f"{difference:.1e}, {steps}", difference < 1e-7
        energies, order = orders(limit)
        yield f"order of the energy, {name}", f"{order:.2f} ({', '.join(f'{energy:.8e}' for energy in energies)} J/m)", order > 1.5
    ratio = hertz()
    yield "largest pressure over Hertz' one", f"{ratio:.4f}", abs(ratio - 1) < 0.02


def main():
    failed = False
    for name, value, holds in results():
        print(f"| {name} | {value} |" + ("" if holds else "  DOES NOT HOLD"))
        failed = failed or not holds
    if failed and "--check" in sys.argv[1:]:
        sys.exit(1)


if __name__ == "__main__":
    main()
