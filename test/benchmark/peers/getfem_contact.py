# SPDX-License-Identifier: BSD-3-Clause
"""A scene on a rigid foundation (xi = inf) in GetFEM: python3 getfem_contact.py SCENE N

Its contact brick: the augmented Lagrangian of Alart and Curnier, with a force as multiplier at each node of the contact side, r = E h;
MUMPS.
"""
import sys

import getfem
import numpy as np

from report import Clock, report

LOADED, HELD = 1, 2
# Lower and upper corner, Young's modulus, directions of the normals of held sides, load along the last axis, gap
SCENES = {"beam": ((0, 0), (5, 1), 2000.0, ([-1, 0], [1, 0]), "-20*sin(pi*X(1)/5)", lambda x: 0 * x[0]),
          "block": ((-1, -1, 0), (1, 1, 1), 1000.0, ([-1, 0, 0],), "-20", lambda x: 0.01 * (x[0] ** 2 + x[1] ** 2))}


def main(scene, n):
    clock = Clock()
    getfem.util_trace_level(0)
    n = int(n)
    lower, upper, young, held, load, gap = SCENES[scene]
    dim = len(lower)
    mesh = getfem.Mesh("cartesian", *[np.linspace(a, b, (b - a) * n + 1) for a, b in zip(lower, upper)])
    mesh.set_region(LOADED, mesh.outer_faces_with_direction([0] * (dim - 1) + [1], 0.01))
    mesh.set_region(HELD, np.hstack([mesh.outer_faces_with_direction(normal, 0.01) for normal in held]))
    displacement = getfem.MeshFem(mesh, dim)
    displacement.set_classical_fem(1)
    inside = getfem.MeshIm(mesh, getfem.Integ("IM_GAUSS_PARALLELEPIPED(%d, 3)" % dim))
    model = getfem.Model("real")
    model.add_fem_variable("u", displacement)
    model.add_initialized_data("lambda", young * 0.3 / (1.3 * 0.4))
    model.add_initialized_data("mu", young / 2.6)
    model.add_isotropic_linearized_elasticity_brick(inside, "u", "lambda", "mu")
    model.add_source_term_brick(inside, "u", "[%s%s]" % ("0, " * (dim - 1), load), LOADED)
    model.add_Dirichlet_condition_with_simplification("u", HELD)
    x = displacement.basic_dof_nodes()
    fixed = np.isin(np.arange(displacement.nbdof()), displacement.basic_dof_on_region(HELD))
    normal = np.arange(displacement.nbdof()) % dim == dim - 1
    contact = np.flatnonzero((np.abs(x[-1] - lower[-1]) < 1e-9) & normal & ~fixed)
    towards = getfem.Spmat("empty", len(contact), displacement.nbdof())
    towards.add(range(len(contact)), contact, getfem.Spmat("identity", len(contact)) * -1.0)
    model.add_variable("p", len(contact))
    model.add_initialized_data("r", young / n)
    model.add_initialized_data("gap", gap(x[:, contact]))
    model.add_basic_contact_brick("u", "p", "r", towards, "gap")
    clock.phase("model")
    newton, _ = model.solve("max_res", 1e-9, "max_iter", 100, "lsolver", "mumps")
    energy = getfem.asm("generic", inside, 0, "0.5*lambda*sqr(Div_u) + mu*sqr(Norm(Sym(Grad_u)))", -1, model)
    energy -= getfem.asm("generic", inside, 0, "%s*u(%d)" % (load, dim), LOADED, model)
    report(clock, energy, displacement.nbdof(), [newton])


if __name__ == "__main__":
    main(*sys.argv[1:])
