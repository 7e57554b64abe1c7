# SPDX-License-Identifier: BSD-3-Clause
"""A slender block on much friction, in the plane: it is pressed, sheared to and fro, and lifted."""

SHEARED = """sheared:
  Mesh: {Lower: [0.0, 0.0], Upper: [0.7686, 1.0], Cells: [3, 20], Element: P2}
  Material: {Young's Modulus: 246.85, Poisson's Ratio: -0.09383}
  Dirichlet:
    top:
      Y: "-0.0012661434690363976*(max(0, 1 - abs(t - 1)) + max(0, 1 - abs(t - 2)) + 0.99457*max(0, 1 - abs(t - 3)) + 0.47807*max(0, 1 - abs(t - 4)))"
      X: "0.0011054498333261914*(0.5*max(0, 1 - abs(t - 1)) + max(0, 1 - abs(t - 2)) - 0.5*max(0, 1 - abs(t - 3)) - max(0, 1 - abs(t - 4)))"
  Contact:
    Side: bottom
    Yield Stress: 0.16762
    Friction Coefficient: 1.75
    Gap: "0.0001435 + 0.001005*(x - 0.27)^2"
  Steps: {From: 0.25, To: 4.0, Step: 0.25}
  Output: {Exodus: false}
"""
