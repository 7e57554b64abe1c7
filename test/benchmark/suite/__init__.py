# SPDX-License-Identifier: BSD-3-Clause
"""Tables of doc/benchmarks.md: a module for each kind."""
