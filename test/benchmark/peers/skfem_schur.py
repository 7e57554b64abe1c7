# SPDX-License-Identifier: BSD-3-Clause
"""A scene with scikit-fem, condensed to its contact unknowns by MUMPS: python3 skfem_schur.py SCENE N XI

One factorization gives the Schur complement; Newton works on that dense matrix. petsc4py does not wrap PETSc's functions for it,
hence ctypes.
"""
import copy
import ctypes
import sys

import numpy as np

from petsc4py import PETSc
from report import Clock, report
from scene import SCENES, energy, newton


def library():
    """PETSc's, as this process has loaded it."""
    with open("/proc/self/maps") as maps:
        return ctypes.CDLL(next(line.split()[-1] for line in maps if "/libpetsc" in line))


class Condensed:
    """K^-1 and the Schur complement of the contact unknowns, from one factorization."""

    def __init__(self, scene):
        K, size = scene.K, len(scene.contact)
        matrix = PETSc.Mat().createAIJ(K.shape, csr=(K.indptr, K.indices, K.data))
        matrix.setOption(PETSc.Mat.Option.SPD, True)
        self.pc = PETSc.PC().create()
        self.pc.setOperators(matrix)
        self.pc.setType("cholesky")
        self.pc.setFactorSolverType("mumps")
        self.pc.setFactorSetUpSolverType()
        petsc, pointer = library(), ctypes.c_void_p
        factor = pointer(self.pc.getFactorMatrix().handle)
        contact = PETSc.IS().createGeneral(scene.contact.astype(PETSc.IntType))
        schur, status, entries = pointer(), ctypes.c_int(), pointer()
        failed = petsc.MatFactorSetSchurIS(factor, pointer(contact.handle))
        self.pc.setUp()
        failed = failed or petsc.MatFactorGetSchurComplement(factor, ctypes.byref(schur), ctypes.byref(status))
        failed = failed or petsc.MatDenseGetArray(schur, ctypes.byref(entries))
        if failed:
            sys.exit("PETSc error %d" % failed)
        half = np.ctypeslib.as_array(ctypes.cast(entries, ctypes.POINTER(ctypes.c_double)), (size, size))
        half = np.triu(half)  # by columns, the lower triangle
        self.schur = half + np.triu(half, 1).T
        petsc.MatDenseRestoreArray(schur, ctypes.byref(entries))
        petsc.MatFactorRestoreSchurComplement(factor, ctypes.byref(schur), status)

    def solve(self, rhs):
        b = PETSc.Vec().createWithArray(rhs)
        x = b.duplicate()
        self.pc.apply(b, x)
        return x.getArray().copy()


def main(scene, n, xi):
    clock = Clock()
    scene = SCENES[scene](int(n), float(xi))
    clock.phase("assembly")
    condensed = Condensed(scene)
    S, contact = condensed.schur, scene.contact
    start = condensed.solve(scene.f)
    clock.phase("factorization")
    reduced = copy.copy(scene)
    reduced.K, reduced.f, reduced.contact = S, S @ start[contact], np.arange(len(contact))
    y, _, counts = newton(reduced, lambda diagonal, rhs, _: np.linalg.solve(S + np.diag(diagonal), rhs))
    forces = scene.f.copy()
    forces[contact] += S @ y - reduced.f
    x = condensed.solve(forces)
    report(clock, energy(scene, x, scene.K @ x), scene.dofs, **counts)


if __name__ == "__main__":
    main(*sys.argv[1:])
