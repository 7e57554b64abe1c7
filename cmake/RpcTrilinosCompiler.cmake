# SPDX-License-Identifier: BSD-3-Clause
# Before project(): takes the compilers from the Trilinos that -DTrilinos_ROOT=DIR (or CMAKE_PREFIX_PATH) names: a Kokkos with
# the CUDA backend has to be compiled with its own nvcc_wrapper. Compilers that the user chose (-DCMAKE_CXX_COMPILER, $CXX) stand.
# Debian's Trilinos is not visible at this point yet; it needs no certain compiler, RpcTrilinos.cmake links MPI by itself.
set(CMAKE_CXX_EXTENSIONS OFF) # KokkosConfig.cmake warns otherwise

# A function, so that none of Trilinos' variables stays: RpcTrilinos.cmake asks again, for all its components.
function(rpc_take_compilers)
  set_property(GLOBAL PROPERTY TARGET_SUPPORTS_SHARED_LIBS TRUE) # else each of Trilinos' libraries warns; project() sets it anew
  set(Kokkos_FIND_QUIETLY ON)
  find_package(Trilinos QUIET COMPONENTS Kokkos)
  if(CUDA IN_LIST Kokkos_DEVICES)
    find_program(nvcc nvcc HINTS $ENV{CUDA_ROOT}/bin NO_CACHE) # where nvcc_wrapper looks
    if(NOT nvcc)
      message(FATAL_ERROR "Kokkos in ${Trilinos_DIR} has CUDA, and nvcc is not there to compile for it. Where it is installed: "
                          "export CUDA_ROOT=/usr/local/cuda PATH=/usr/local/cuda/bin:$PATH, as cmake --preset cuda does.")
    endif()
  endif()
  if(Trilinos_C_COMPILER AND NOT CMAKE_C_COMPILER AND NOT DEFINED ENV{CC})
    set(CMAKE_C_COMPILER ${Trilinos_C_COMPILER} PARENT_SCOPE)
  endif()
  if(Trilinos_CXX_COMPILER AND NOT CMAKE_CXX_COMPILER AND NOT DEFINED ENV{CXX})
    set(CMAKE_CXX_COMPILER ${Trilinos_CXX_COMPILER} PARENT_SCOPE)
  endif()
endfunction()
rpc_take_compilers()
