"""The paper's beam in scikit-fem, and the semismooth Newton method that its peers share.

Q1 on a uniform mesh with 1/h = N, nodal quadrature of the contact term, exact line search:

    minimize u.K u / 2 - f.u + sum_i w_i max over 0 <= p <= xi of (p v_i - (p - o_i)^2 / (2 r)),    v_i = u_nu at node i

followed by o (origin) <- p until the contact law holds to 1e-8.
"""
import numpy as np
import skfem
from skfem.models.elasticity import lame_parameters, linear_elasticity

TOLERANCE = 1e-8  # of the contact law, over the largest pressure; rpc's
MOST_STEPS = 200
R = 1e10  # [Pa/m] of all tried the best: 12 steps at 1/h = 64, xi = 16; 13, 14, 17, 35 with 1e8, 1e7, 1e6, 1e5


class Beam:
    """Stiffness and load of the free unknowns, two to a node; contact unknowns (normal displacement = -x[contact])."""

    def __init__(self, n):
        mesh = skfem.MeshQuad.init_tensor(np.linspace(0, 5, 5 * n + 1), np.linspace(0, 1, n + 1))
        element = skfem.ElementVector(skfem.ElementQuad1())
        basis = skfem.Basis(mesh, element, intorder=3)
        stiffness = linear_elasticity(*lame_parameters(2000.0, 0.3)).assemble(basis)
        top = skfem.FacetBasis(mesh, element, facets=mesh.facets_satisfying(lambda x: x[1] == 1), intorder=5)
        load = skfem.LinearForm(lambda v, w: -20 * np.sin(np.pi * w.x[0] / 5) * v[1]).assemble(top)
        held = (mesh.p[0] == 0) | (mesh.p[0] == 5)
        free = basis.nodal_dofs[:, ~held].ravel("F")
        number = np.full(basis.N, -1)
        number[free] = np.arange(len(free))
        touching = np.flatnonzero((mesh.p[1] == 0) & ~held)
        self.dofs = basis.N
        self.K = stiffness[free][:, free].tocsr()
        self.f = load[free]
        self.points = mesh.p[:, ~held].T
        self.contact = number[basis.nodal_dofs[1, touching]]
        self.weight = np.full(len(touching), 1 / n)


def pressure(origin, r, v, xi):
    return np.clip(origin + r * v, 0, xi)


def step_length(slope0, curvature, dv, origin, r, v, weight, xi):
    """The root t of the increasing, piecewise linear slope0 + curvature t + sum w p(v + t dv) dv."""
    def slope(t):
        return slope0 + curvature * t + np.dot(weight * dv, pressure(origin, r, v + t * dv, xi))

    moving = dv != 0
    bounds = np.array([0.0, xi]) if np.isfinite(xi) else np.array([0.0])
    kinks = ((bounds[:, None] - origin[moving]) / r - v[moving]) / dv[moving]
    kinks = np.concatenate([[0.0], np.sort(kinks[kinks > 0])])
    low, high = 0, len(kinks)
    while high - low > 1:  # slope(kinks[low]) <= 0 < slope(kinks[high])
        middle = (low + high) // 2
        low, high = (middle, high) if slope(kinks[middle]) <= 0 else (low, middle)
    a = kinks[low]
    b = kinks[high] if high < len(kinks) else a + 1.0
    slope_a, slope_b = slope(a), slope(b)
    return a - slope_a * (b - a) / (slope_b - slope_a)


def newton(beam, xi, r, solve, forcing=0.0):
    """Returns u, J and the counts. solve(diagonal, rhs, tolerance) -> (K + diag(diagonal))^-1 rhs."""
    K, f, contact, weight = beam.K, beam.f, beam.contact, beam.weight
    x, origin = np.zeros(len(f)), np.zeros(len(contact))
    Kx = np.zeros(len(f))
    norm_f = np.linalg.norm(f)
    steps = []
    while sum(steps) < MOST_STEPS:
        steps.append(0)
        while sum(steps) < MOST_STEPS:
            v = -x[contact]
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
        p = pressure(origin, r, -x[contact], xi)
        law = np.max(np.abs(p - pressure(p, 2000.0 / weight, -x[contact], xi))) / np.max(p)
        if law < TOLERANCE:
            break
        origin = p
    energy = 0.5 * np.dot(x, Kx) - np.dot(f, x)
    if np.isfinite(xi):
        energy += xi * np.dot(weight, np.maximum(-x[contact], 0))
    return x, energy, {"newton": steps, "contact_law": law}
