"""The beam with scikit-fem and SciPy's SuperLU: python3 skfem_superlu.py N XI"""
import sys

import scipy.sparse as sparse
from scipy.sparse.linalg import splu

from beam import R, Beam, newton
from report import Clock, report


def main(n, xi):
    clock = Clock()
    beam = Beam(int(n))
    clock.phase("assembly")
    stiffness = beam.K.tocsc()

    def solve(diagonal, rhs, _):
        factor = splu(stiffness + sparse.diags(diagonal, format="csc"), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0,
                      options={"SymmetricMode": True})
        return factor.solve(rhs)

    _, energy, counts = newton(beam, float(xi), R, solve)
    report(clock, energy, beam.dofs, **counts)


if __name__ == "__main__":
    main(*sys.argv[1:])
