# SPDX-License-Identifier: BSD-3-Clause
"""A scene with scikit-fem and SciPy's SuperLU: python3 skfem_superlu.py SCENE N XI"""
import sys

import scipy.sparse as sparse
from scipy.sparse.linalg import splu

from report import Clock, report
from scene import SCENES, newton


def main(scene, n, xi):
    clock = Clock()
    scene = SCENES[scene](int(n), float(xi))
    clock.phase("assembly")
    stiffness = scene.K.tocsc()

    def solve(diagonal, rhs, _):
        factor = splu(stiffness + sparse.diags(diagonal, format="csc"), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0,
                      options={"SymmetricMode": True})
        return factor.solve(rhs)

    _, energy, counts = newton(scene, solve)
    report(clock, energy, scene.dofs, **counts)


if __name__ == "__main__":
    main(*sys.argv[1:])
