# SPDX-License-Identifier: BSD-3-Clause
"""rpc for Spack: spack repo add cmake/spack && spack install rpc-contact (doc/portability.md says what was checked).

The name rpc is taken: in Spack it is a virtual package, that of remote procedure calls.
"""

from spack.package import *


class RpcContact(CMakePackage, CudaPackage):
    """Contact of an elastic body with a rigid-plastic foundation, by finite elements on Trilinos."""

    homepage = "https://example.org/rpc"
    # From a checkout: spack install rpc-contact@main with  spack develop --path=CHECKOUT rpc-contact@main

    license("BSD-3-Clause")

    version("main")

    generator("ninja")

    variant("openmp", default=False, description="Kokkos' threads instead of its serial backend")
    variant("gmsh", default=True, description="meshes from gmsh's geometry files")
    variant("mumps", default=True, description="sparse factors for thin and nearly incompressible bodies")

    conflicts("+openmp", when="+cuda", msg="Kokkos runs on the GPU or on threads")

    depends_on("cxx", type="build")
    depends_on("c", type="build")
    depends_on("cmake@3.23:", type="build")
    depends_on("pkgconfig", type="build")
    depends_on("mpi")
    depends_on("lapack")
    # What was compiled and run: doc/trilinos_versions.md.
    depends_on(
        "trilinos@13.2:16.1 +mpi +amesos2 +belos +ifpack2 +muelu +nox +tpetra +zoltan +zoltan2"
        " +explicit_template_instantiation gotype=long_long cxxstd=17"
    )
    depends_on("trilinos +openmp", when="+openmp")
    for arch in CudaPackage.cuda_arch_values:
        depends_on("trilinos +cuda +uvm +wrapper cuda_arch={0}".format(arch), when="+cuda cuda_arch={0}".format(arch))
    depends_on("muparser")
    depends_on("metis")
    depends_on("mumps +mpi +metis", when="+mumps")
    depends_on("gmsh", when="+gmsh")
    depends_on("seacas~applications~legacy")
    depends_on("netcdf-c")  # which seacas writes by
    depends_on("nlohmann-json")

    def cmake_args(self):
        return [
            self.define("RPC_BUILD_TESTS", False),
            self.define_from_variant("RPC_USE_GMSH", "gmsh"),
            self.define_from_variant("RPC_USE_MUMPS", "mumps"),
            self.define("Trilinos_ROOT", self.spec["trilinos"].prefix),
        ]
