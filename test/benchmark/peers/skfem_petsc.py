# SPDX-License-Identifier: BSD-3-Clause
"""A scene with scikit-fem and PETSc: python3 skfem_petsc.py SCENE N XI mumps|hypre|gamg

mumps: Cholesky factorization in every Newton step. hypre, gamg: CG with algebraic multigrid that knows the rigid body modes, with
inexact early steps (relative residual 1e-2).
"""
import sys

from petsc4py import PETSc
from report import Clock, report
from scene import SCENES, newton

FORCING = {"mumps": 0.0, "hypre": 1e-2, "gamg": 1e-2}
# Measured: hypre's solves in space, 1/h = 12, in 5.1 s instead of 12.3; reused interpolation costs GAMG twice the time in the plane
PLANE = {"mumps": {}, "hypre": {"pc_hypre_boomeramg_strong_threshold": 0.5}, "gamg": {"pc_gamg_reuse_interpolation": False}}
SPACE = {"mumps": {}, "gamg": {"pc_gamg_reuse_interpolation": True}, "hypre": {**PLANE["hypre"], **{
    "pc_hypre_boomeramg_" + key: value
    for key, value in (("coarsen_type", "HMIS"), ("interp_type", "ext+i"), ("P_max", 4), ("agg_nl", 1))}}}
SETTINGS = {2: PLANE, 3: SPACE}


class Solver:
    """(K + diagonal)^-1, set up anew where the diagonal has changed."""

    def __init__(self, scene, name):
        K, dim = scene.K, scene.points.shape[1]
        self.matrix = PETSc.Mat().createAIJ(K.shape, csr=(K.indptr, K.indices, K.data))
        self.matrix.setBlockSize(dim)
        self.matrix.setOption(PETSc.Mat.Option.SPD, True)
        self.matrix.setNearNullSpace(PETSc.NullSpace().createRigidBody(
            PETSc.Vec().createWithArray(scene.points.ravel(), bsize=dim)))
        self.diagonal, self.added, self.iterations = self.matrix.getDiagonal(), None, []
        options = PETSc.Options()
        for key, value in SETTINGS[dim][name].items():
            options[key] = value
        self.ksp = PETSc.KSP().create()
        self.ksp.setOperators(self.matrix)
        if name == "mumps":
            self.ksp.setType("preonly")
            self.ksp.getPC().setType("cholesky")
            self.ksp.getPC().setFactorSolverType("mumps")
        else:
            self.ksp.setType("cg")
            self.ksp.setNormType(PETSc.KSP.NormType.UNPRECONDITIONED)
            self.ksp.getPC().setType(name)
        self.ksp.setFromOptions()

    def __call__(self, added, rhs, tolerance):
        if self.added is None or (added != self.added).any():
            diagonal = self.diagonal.copy()
            diagonal.setArray(self.diagonal.getArray() + added)
            self.matrix.setDiagonal(diagonal)
            self.matrix.assemble()
            self.added = added
        b = PETSc.Vec().createWithArray(rhs)
        x = b.duplicate()
        self.ksp.setTolerances(rtol=tolerance)
        self.ksp.solve(b, x)
        self.iterations.append(self.ksp.getIterationNumber())
        return x.getArray()


def main(scene, n, xi, name):
    clock = Clock()
    scene = SCENES[scene](int(n), float(xi))
    clock.phase("assembly")
    solver = Solver(scene, name)
    _, energy, counts = newton(scene, solver, FORCING[name])
    report(clock, energy, scene.dofs, **counts, linear_iterations=solver.iterations)


if __name__ == "__main__":
    main(*sys.argv[1:])
