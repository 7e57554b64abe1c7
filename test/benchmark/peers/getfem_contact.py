"""The beam on a rigid foundation (xi = inf) in GetFEM: python3 getfem_contact.py N

Its integral contact brick: the augmented Lagrangian of Alart and Curnier with a multiplier on the contact side, r = E; MUMPS.
"""
import sys

import getfem
import numpy as np

from report import Clock, report

BOTTOM, TOP, HELD = 1, 2, 3


def main(n):
    clock = Clock()
    getfem.util_trace_level(0)
    n = int(n)
    mesh = getfem.Mesh("cartesian", np.linspace(0, 5, 5 * n + 1), np.linspace(0, 1, n + 1))
    mesh.set_region(BOTTOM, mesh.outer_faces_with_direction([0, -1], 0.01))
    mesh.set_region(TOP, mesh.outer_faces_with_direction([0, 1], 0.01))
    mesh.set_region(HELD, np.hstack([mesh.outer_faces_with_direction([side, 0], 0.01) for side in (-1, 1)]))
    displacement, scalar = getfem.MeshFem(mesh, 2), getfem.MeshFem(mesh, 1)
    for field in (displacement, scalar):
        field.set_classical_fem(1)
    inside = getfem.MeshIm(mesh, getfem.Integ("IM_GAUSS_PARALLELEPIPED(2, 3)"))
    model = getfem.Model("real")
    model.add_fem_variable("u", displacement)
    model.add_initialized_data("lambda", 2000 * 0.3 / (1.3 * 0.4))
    model.add_initialized_data("mu", 2000 / 2.6)
    model.add_isotropic_linearized_elasticity_brick(inside, "u", "lambda", "mu")
    model.add_source_term_brick(inside, "u", "[0, -20*sin(pi*X(1)/5)]", TOP)
    model.add_Dirichlet_condition_with_simplification("u", HELD)
    model.add_filtered_fem_variable("p", scalar, BOTTOM)
    model.add_initialized_data("r", 2000)
    model.add_initialized_fem_data("distance", scalar, scalar.basic_dof_nodes()[1])
    model.add_integral_contact_with_rigid_obstacle_brick(inside, "u", "p", "distance", "r", BOTTOM)
    clock.phase("model")
    newton, _ = model.solve("max_res", 1e-9, "max_iter", 100, "lsolver", "mumps")
    # In equilibrium with a gap of 0: J = -a(u, u) / 2.
    energy = -getfem.asm("generic", inside, 0, "0.5*lambda*sqr(Div_u) + mu*sqr(Norm(Sym(Grad_u)))", -1, model)
    report(clock, energy, displacement.nbdof(), [newton])


if __name__ == "__main__":
    main(*sys.argv[1:])
