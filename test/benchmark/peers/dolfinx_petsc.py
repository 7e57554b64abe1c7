# SPDX-License-Identifier: BSD-3-Clause
"""The block of input/block.xml on a .msh, order 1, with DOLFINx and PETSc: python3 dolfinx_petsc.py FILE XI hypre|gamg

The mesh is one of suite/own_meshes.py. The active-set iteration that a user of DOLFINx would write; CG with
algebraic multigrid that knows the rigid body modes.
"""
import sys

import numpy as np
import scipy.sparse
import ufl
from dolfinx import fem, mesh
from dolfinx.fem import petsc
from mpi4py import MPI
from petsc4py import PETSc
from report import Clock, report
from scene import MOST_STEPS, energy
from skfem_petsc import SETTINGS

CELLS = {4: ("tetrahedron", [0, 1, 2, 3]), 5: ("hexahedron", [0, 1, 3, 2, 4, 5, 7, 6])}  # by gmsh's type: DOLFINx' order of nodes


def read_msh(path):
    """Of format 2.2, cells of the body last: coordinates, cells and their kind."""
    with open(path) as file:
        text = file.read()

    def lines_of(section):
        return text.split("$%s\n" % section)[1].split("$End%s" % section)[0].splitlines()[1:]

    elements = lines_of("Elements")
    gmsh_type = elements[-1].split()[1]
    kind, order = CELLS[int(gmsh_type)]
    of_kind = [line for line in elements if line.split(None, 2)[1] == gmsh_type]
    points = np.fromstring(" ".join(lines_of("Nodes")), sep=" ").reshape(-1, 4)[:, 1:]
    cells = np.fromstring(" ".join(of_kind), sep=" ", dtype=np.int64).reshape(len(of_kind), -1)[:, 5:]
    return np.ascontiguousarray(points), cells[:, order] - 1, kind


class Scene:
    """As scene.Scene, with the unknowns of the clamped side as rows of the identity."""

    def __init__(self, path, xi):
        points, cells, kind = read_msh(path)
        domain = mesh.create_mesh(MPI.COMM_SELF, cells, points,
                                  ufl.Mesh(ufl.VectorElement("Lagrange", ufl.Cell(kind, geometric_dimension=3), 1)))
        space = fem.VectorFunctionSpace(domain, ("Lagrange", 1))
        E, nu = 1000.0, 0.3
        lam, mu = E * nu / ((1 + nu) * (1 - 2 * nu)), E / (2 * (1 + nu))
        u, v = ufl.TrialFunction(space), ufl.TestFunction(space)

        def strain(w):
            return ufl.sym(ufl.grad(w))

        def facets_at(axis, at):
            return mesh.locate_entities_boundary(domain, 2, lambda x: np.isclose(x[axis], at))

        top, below = facets_at(2, 1), facets_at(2, 0)
        tags = np.repeat([1, 2], [len(top), len(below)])
        order = np.argsort(np.concatenate([top, below]))
        of_facets = mesh.meshtags(domain, 2, np.concatenate([top, below])[order].astype(np.int32), tags[order].astype(np.int32))
        ds = ufl.Measure("ds", domain=domain, subdomain_data=of_facets)
        clamped = fem.dirichletbc(np.zeros(3), fem.locate_dofs_topological(space, 2, facets_at(0, -1)), space)
        inner = lam * ufl.div(u) * ufl.div(v) + 2 * mu * ufl.inner(strain(u), strain(v))
        gauss = ufl.dx(metadata={"quadrature_degree": 3 if kind == "hexahedron" else 1})  # rpc's points
        self.matrix = petsc.assemble_matrix(fem.form(inner * gauss), bcs=[clamped])
        self.matrix.assemble()
        force = petsc.assemble_vector(fem.form(-20.0 * v[2] * ds(1)))
        fem.set_bc(force, [clamped])
        weight = petsc.assemble_vector(fem.form(v[2] * ds(2))).array
        offsets, columns, values = self.matrix.getValuesCSR()
        self.K = scipy.sparse.csr_matrix((values, columns, offsets), self.matrix.getSize())
        self.f = force.array.copy()
        self.points = space.tabulate_dof_coordinates()
        self.dofs = len(self.f)
        held = self.points[:, 0] < -1 + 1e-12
        touching = np.flatnonzero((weight[2::3] > 0) & ~held)
        x = self.points[touching].T
        self.contact = 3 * touching + 2
        self.weight = weight[self.contact]
        self.gap, self.xi = 0.01 * (x[0] ** 2 + x[1] ** 2), xi * (1 + x[0] / 2)
        self.stiffness_of_cells = E / np.sqrt(np.median(self.weight))
        self.largest = self.K.diagonal().max()


class Solver:
    """Of K x = rhs with some unknowns given, by CG and algebraic multigrid that is set up anew where other unknowns are given."""

    def __init__(self, scene, name):
        self.scene, self.given, self.iterations, self.held = scene, None, [], None
        for key, value in SETTINGS[3][name].items():
            PETSc.Options()[key] = value
        scene.matrix.setOption(PETSc.Mat.Option.SPD, True)
        self.rigid = PETSc.NullSpace().createRigidBody(PETSc.Vec().createWithArray(scene.points.ravel(), bsize=3))
        self.ksp = PETSc.KSP().create()
        self.ksp.setType("cg")
        self.ksp.setNormType(PETSc.KSP.NormType.UNPRECONDITIONED)
        self.ksp.getPC().setType(name)
        self.ksp.setInitialGuessNonzero(True)
        self.ksp.setFromOptions()

    def __call__(self, given, value, rhs, start, tolerance):
        """tolerance: of the residual, absolute."""
        x = start.copy()
        x[given] = value
        b = rhs - self.scene.K[:, given] @ value
        b[given] = value
        if self.given is None or not np.array_equal(given, self.given):
            matrix = self.scene.matrix.copy()
            matrix.setNearNullSpace(self.rigid)
            matrix.zeroRowsColumns(given.astype(np.int32), diag=self.scene.largest)
            self.given = given
            self.ksp.setOperators(matrix)
        b[given] *= self.scene.largest
        solution = PETSc.Vec().createWithArray(x)
        self.ksp.setTolerances(rtol=0, atol=tolerance)
        self.ksp.solve(PETSc.Vec().createWithArray(b), solution)
        self.iterations.append(self.ksp.getIterationNumber())
        return solution.getArray().copy()


def active_set(scene, solve):
    """Open, closed or yielding by p + c v, c = E / h; closed points have v = 0, yielding ones p = xi. All points are closed
    at first, and none goes from open to yielding at once: from all points open this does not end. Solves are exact to 1e-3 of the load
    until no state changes, then to 1e-9."""
    x, p = np.zeros(scene.dofs), np.zeros(len(scene.contact))
    size, tolerance = np.linalg.norm(scene.f), 1e-3
    last, steps = None, 0
    while steps < MOST_STEPS:
        trial = p - scene.stiffness_of_cells * (x[scene.contact] + scene.gap)
        states = np.where(trial <= 0, 0, np.where(trial < scene.xi, 1, 2))
        states = np.ones_like(states) if last is None else np.clip(states, last - 1, last + 1)
        if last is not None and np.array_equal(states, last):
            if tolerance < 1e-8:
                break
            tolerance = 1e-9
        last, closed = states, states == 1
        rhs = scene.f.copy()
        rhs[scene.contact] += scene.weight * scene.xi * (states == 2)
        x = solve(scene.contact[closed], -scene.gap[closed], rhs, x, tolerance * size)
        p = np.where(closed, (scene.K @ x - scene.f)[scene.contact] / scene.weight, scene.xi * (states == 2))
        steps += 1
    return x, steps


def main(path, xi, name):
    clock = Clock()
    scene = Scene(path, float(xi))
    clock.phase("assembly")
    solver = Solver(scene, name)
    x, steps = active_set(scene, solver)
    report(clock, energy(scene, x, scene.K @ x), scene.dofs, [steps], linear_iterations=solver.iterations)


if __name__ == "__main__":
    main(*sys.argv[1:])
