# SPDX-License-Identifier: BSD-3-Clause
"""Internal forces, energies and loads of a displacement: isotropic small strains on the cells of the file, by the oracle's own integration.

The laws are doc/theory.md's: (2.4), (2.4a) of revolution, (2.6) the projected dilatation of nearly incompressible blocks, (2.5) loads.
"""
import numpy as np

from elements import gauss, triangle

PROJECTED_FROM = {("QUAD4",): 0.4, ("HEX8",): 0.4, ("QUAD9",): 0.4, ("HEX27",): 0.4, ("TRI6",): 0.48, ("TETRA10",): 0.48}


def lame(E, nu):
    return E * nu / ((1 + nu) * (1 - 2 * nu)), E / (2 * (1 + nu))


class Cells:
    """Geometry of a block's cells at the points of a rule."""

    def __init__(self, mesh, block, axisymmetric, rule=None):
        points, weights = rule or block.element.rule(axisymmetric)
        values, slopes = block.element.shapes(points)
        X = mesh.coords[block.cells]  # (c, n, d)
        jacobian = np.einsum("cnd,qne->cqde", X, slopes)
        self.values = values
        self.place = np.einsum("qn,cnd->cqd", values, X)
        self.gradients = np.einsum("qne,cqed->cqnd", slopes, np.linalg.inv(jacobian))
        self.weights = np.abs(np.linalg.det(jacobian)) * weights
        if axisymmetric:
            self.weights = self.weights * 2 * np.pi * self.place[:, :, 0]

    def dilatation(self, axisymmetric):
        """D(ai) at each point: sum D u is div u. (c, q, n, d)"""
        D = self.gradients.copy()
        if axisymmetric:
            D[..., 0] += self.values[None] / self.place[:, :, :1]
        return D

    def projected(self, D, element):
        """D of the L2 projection of div u on constants, of Q2 on linear functions, in each cell."""
        basis = np.ones((*self.weights.shape, 1))
        if element.order == 2 and not element.simplex:
            middle = self.place.mean(axis=1, keepdims=True)
            size = np.abs(self.place - middle).max(axis=(1, 2), keepdims=True)
            basis = np.concatenate([basis, (self.place - middle) / size], axis=2)
        products = np.einsum("cq,cqk,cql->ckl", self.weights, basis, basis)
        moments = np.einsum("cq,cqk,cqnd->cknd", self.weights, basis, D)
        factors = np.linalg.solve(products, moments.reshape(*moments.shape[:2], -1)).reshape(moments.shape)
        return np.einsum("cqk,cknd->cqnd", basis, factors)


def internal(mesh, u, material, axisymmetric=False):
    """(forces (nodes, dim), strain energy)
    @param material {"E", "nu", "blocks": {name: (E, nu)}}"""
    forces, energy = np.zeros_like(mesh.coords), 0.0
    for block in mesh.blocks:
        E, nu = material["blocks"].get(block.name, (material["E"], material["nu"]))
        lam, mu = lame(E, nu)
        cells = Cells(mesh, block, axisymmetric)
        D = cells.dilatation(axisymmetric)
        if nu > PROJECTED_FROM.get((block.element.name,), 1.0):
            D = cells.projected(D, block.element)
        v = u[block.cells]
        gradient = np.einsum("cqnd,cne->cqed", cells.gradients, v)
        strain = (gradient + np.swapaxes(gradient, 2, 3)) / 2
        divergence = np.einsum("cqnd,cnd->cq", D, v)
        f = lam * np.einsum("cq,cq,cqnd->cnd", cells.weights, divergence, D)
        f += 2 * mu * np.einsum("cq,cqed,cqnd->cne", cells.weights, strain, cells.gradients)
        if axisymmetric:
            hoop = np.einsum("qn,cn->cq", cells.values, v[..., 0]) / cells.place[:, :, 0]
            f[..., 0] += 2 * mu * np.einsum("cq,cq,qn->cn", cells.weights, hoop / cells.place[:, :, 0], cells.values)
        np.add.at(forces, block.cells, f)
        energy += np.sum(f * v) / 2
    return forces, energy


def largest_product(mesh, u, material, axisymmetric=False):
    """The largest sum at a node of |K||u|, of which forces have so many digits less as they are smaller."""
    sums = np.zeros(len(mesh.coords))
    for block in mesh.blocks:
        lam, mu = lame(*material["blocks"].get(block.name, (material["E"], material["nu"])))
        cells = Cells(mesh, block, axisymmetric)
        slopes = np.linalg.norm(cells.gradients, axis=3)
        moved = np.einsum("cqn,cn->cq", slopes, np.linalg.norm(u[block.cells], axis=2))
        np.add.at(sums, block.cells, (lam + 2 * mu) * np.einsum("cq,cqn,cq->cn", cells.weights, slopes, moved))
    return float(np.max(sums))


def facet_geometry(mesh, element, cells, facet, at):
    """(values (points, nodes), place (facets, points, dim), outward normal with the size of the facet's scale (facets, points, dim))"""
    places, tangents = element.facet_map(facet, at)
    values, slopes = element.shapes(places)
    X = mesh.coords[cells]
    along = np.einsum("qne,qek,fnd->fqdk", slopes, tangents, X)
    if mesh.dim == 2:
        normal = np.stack([along[..., 1, 0], -along[..., 0, 0]], axis=-1)
    else:
        normal = np.cross(along[..., 0], along[..., 1])
    place = np.einsum("qn,fnd->fqd", values, X)
    inside = X[:, :element.corners].mean(axis=1)
    sign = np.sign(np.einsum("fqd,fqd->fq", normal, place - inside[:, None]))
    return values, place, normal * sign[..., None]


def around(place, axisymmetric):
    return 2 * np.pi * place[..., 0] if axisymmetric else np.ones(place.shape[:-1])


def loads(mesh, traction, body_force, axisymmetric=False):
    """Nodal forces. @param traction {side: vector}, body_force: vector or None, both constant"""
    forces = np.zeros_like(mesh.coords)
    for side, vector in traction.items():
        for element, cells, facet in mesh.facets(side):
            corners = len(element.facets[facet])
            points, weights = triangle(6) if corners == 3 else gauss(4, mesh.dim - 1)
            values, place, normal = facet_geometry(mesh, element, cells, facet, points)
            w = np.linalg.norm(normal, axis=2) * weights * around(place, axisymmetric)
            np.add.at(forces, cells, np.einsum("fq,qn,d->fnd", w, values, np.asarray(vector)))
    for block in mesh.blocks if body_force is not None else []:
        element = block.element
        rule = gauss(3, mesh.dim) if not element.simplex else triangle(6) if mesh.dim == 2 else element.rule()
        cells = Cells(mesh, block, axisymmetric, rule)
        np.add.at(forces, block.cells, np.einsum("cq,qn,d->cnd", cells.weights, cells.values, np.asarray(body_force)))
    return forces
