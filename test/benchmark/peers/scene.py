# SPDX-License-Identifier: BSD-3-Clause
"""Scenes in scikit-fem, and the semismooth Newton method that their peers share.

Q1 on a uniform mesh with 1/h = N: `beam`, the paper's, in the plane; `block`, that of input/block.xml, in space. Nodal quadrature of
the contact term, exact line search:

    minimize u.K u / 2 - f.u + sum_i w_i max over 0 <= p <= xi_i of (p v_i - (p - o_i)^2 / (2 r)),    v_i = u_nu - g at node i

followed by o (origin) <- p until the contact law holds to 1e-8.
"""
import numpy as np
import skfem
from skfem.models.elasticity import lame_parameters, linear_elasticity

TOLERANCE = 1e-8  # of the contact law, over the largest pressure; rpc's
MOST_STEPS = 200
MESHES = {2: (skfem.MeshQuad, skfem.ElementQuad1), 3: (skfem.MeshHex, skfem.ElementHex1)}


class Scene:
    """Stiffness and load of the free unknowns, those of a node together; of the contact points the unknowns (normal
    displacement = -x[contact]), gaps, weights and yield stresses."""

    def __init__(self, lines, material, load, fixed, gap, xi, r):
        """lines: nodes along each axis, the last one from the foundation to the load. Functions of points: load along the last
        axis, fixed, gap, xi. r [Pa/m]: of the regularized contact term."""
        kind, element = MESHES[len(lines)]
        mesh, element = kind.init_tensor(*lines), skfem.ElementVector(element())
        basis = skfem.Basis(mesh, element, intorder=3)
        stiffness = linear_elasticity(*lame_parameters(*material)).assemble(basis)
        top = skfem.FacetBasis(mesh, element, facets=mesh.facets_satisfying(lambda x: x[-1] == lines[-1][-1]), intorder=5)
        force = skfem.LinearForm(lambda v, w: load(w.x) * v[-1]).assemble(top)
        held = fixed(mesh.p)
        free = basis.nodal_dofs[:, ~held].ravel("F")
        number = np.full(basis.N, -1)
        number[free] = np.arange(len(free))
        touching = np.flatnonzero((mesh.p[-1] == lines[-1][0]) & ~held)
        x = mesh.p[:, touching]
        self.dofs = basis.N
        self.K = stiffness[free][:, free].tocsr()
        self.f = force[free]
        self.points = mesh.p[:, ~held].T
        self.contact = number[basis.nodal_dofs[-1, touching]]
        self.gap, self.xi, self.r = gap(x), xi(x), r
        self.weight = np.prod([trapezoid(line)[np.searchsorted(line, along)] for line, along in zip(lines[:-1], x)], axis=0)
        self.stiffness_of_cells = material[0] / (lines[-1][1] - lines[-1][0])  # [Pa/m]


def trapezoid(line):
    """Weights of the nodes."""
    return np.convolve(np.diff(line), (0.5, 0.5))


def beam(n, xi):
    # r: of all tried the best: 12 steps at 1/h = 64, xi = 16; 13, 14, 17, 35 with 1e8, 1e7, 1e6, 1e5
    return Scene((np.linspace(0, 5, 5 * n + 1), np.linspace(0, 1, n + 1)), (2000.0, 0.3), lambda x: -20 * np.sin(np.pi * x[0] / 5),
                 lambda x: (x[0] == 0) | (x[0] == 5), lambda x: np.zeros(x.shape[1]), lambda x: np.full(x.shape[1], xi), 1e10)


def block(n, xi):
    """xi [Pa]: in the middle; the deck's is 18."""
    across, along = np.linspace(-1, 1, 2 * n + 1), np.linspace(0, 1, n + 1)
    # r = 3 E/h: fewest steps; the plane's 1e10 takes 100 at 1/h = 8 and more on finer meshes, for the line search ends at the next
    # kink. GAMG fails with 8 E/h at 1/h = 12.
    return Scene((across, across, along), (1000.0, 0.3), lambda x: -20 + 0 * x[0], lambda x: x[0] == -1,
                 lambda x: 0.01 * (x[0] ** 2 + x[1] ** 2), lambda x: xi * (1 + x[0] / 2), 3000.0 * n)


SCENES = {"beam": beam, "block": block}


def pressure(origin, r, v, xi):
    return np.clip(origin + r * v, 0, xi)


def step_length(slope0, curvature, dv, origin, r, v, weight, xi):
    """The root t of the increasing, piecewise linear slope0 + curvature t + sum w p(v + t dv) dv."""
    def slope(t):
        return slope0 + curvature * t + np.dot(weight * dv, pressure(origin, r, v + t * dv, xi))

    moving = dv != 0
    bounds = np.array([np.zeros(len(xi)), xi])[:, moving]
    kinks = ((bounds - origin[moving]) / r - v[moving]) / dv[moving]
    kinks = np.concatenate([[0.0], np.sort(kinks[(kinks > 0) & np.isfinite(kinks)])])
    low, high = 0, len(kinks)
    while high - low > 1:  # slope(kinks[low]) <= 0 < slope(kinks[high])
        middle = (low + high) // 2
        low, high = (middle, high) if slope(kinks[middle]) <= 0 else (low, middle)
    a = kinks[low]
    b = kinks[high] if high < len(kinks) else a + 1.0
    slope_a, slope_b = slope(a), slope(b)
    return a - slope_a * (b - a) / (slope_b - slope_a)


def newton(scene, solve, forcing=0.0):
    """Returns x, J and the counts. solve(diagonal, rhs, tolerance) -> (K + diag(diagonal))^-1 rhs."""
    K, f, contact, weight, xi, r = scene.K, scene.f, scene.contact, scene.weight, scene.xi, scene.r
    x, origin = np.zeros(len(f)), np.zeros(len(contact))
    Kx = np.zeros(len(f))
    norm_f = np.linalg.norm(f)
    steps = []
    while sum(steps) < MOST_STEPS:
        steps.append(0)
        while sum(steps) < MOST_STEPS:
            v = -x[contact] - scene.gap
            p = pressure(origin, r, v, xi)
            residual = f - Kx
            residual[contact] += weight * p
            size = np.linalg.norm(residual) / norm_f
            if size < TOLERANCE / 100:
                break
            free = origin + r * v
            diagonal = np.zeros(len(f))
            diagonal[contact] = r * weight * ((free >= 0) & (free < xi))
            d = solve(diagonal, residual, max(min(forcing, size), 1e-8))
            Kd = K @ d
            t = step_length(np.dot(Kx - f, d), np.dot(d, Kd), -d[contact], origin, r, v, weight, xi)
            x += t * d
            Kx += t * Kd
            steps[-1] += 1
            if t * np.linalg.norm(d) < 1e-11 * np.linalg.norm(x):
                break
        v = -x[contact] - scene.gap
        p = pressure(origin, r, v, xi)
        law = np.max(np.abs(p - pressure(p, scene.stiffness_of_cells, v, xi))) / np.max(p)
        if law < TOLERANCE:
            break
        origin = p
    return x, energy(scene, x, Kx), {"newton": steps, "contact_law": law}


def energy(scene, x, Kx):
    """J [J, in the plane J/m]."""
    yielding = np.isfinite(scene.xi)
    depth = np.maximum(-x[scene.contact] - scene.gap, 0)
    return 0.5 * np.dot(x, Kx) - np.dot(scene.f, x) + np.dot((scene.weight * scene.xi)[yielding], depth[yielding])
