# Before project(): takes the compilers from the Trilinos that -DTrilinos_ROOT=DIR (or CMAKE_PREFIX_PATH) names: a Kokkos with
# the CUDA backend has to be compiled with its own nvcc_wrapper. Compilers that the user chose (-DCMAKE_CXX_COMPILER, $CXX) stand.
# Debian's Trilinos is not visible at this point yet; it needs no certain compiler, RpcTrilinos.cmake links MPI by itself.
set(CMAKE_CXX_EXTENSIONS OFF) # KokkosConfig.cmake warns otherwise

# A function, so that none of Trilinos' variables stays: RpcTrilinos.cmake asks again, for certain components.
function(rpc_take_compiler language environment)
  set_property(GLOBAL PROPERTY TARGET_SUPPORTS_SHARED_LIBS TRUE) # else each of Trilinos' libraries warns; project() sets it anew
  find_package(Trilinos 13.2 QUIET)
  if(Trilinos_${language}_COMPILER AND NOT CMAKE_${language}_COMPILER AND NOT DEFINED ENV{${environment}})
    set(CMAKE_${language}_COMPILER ${Trilinos_${language}_COMPILER} PARENT_SCOPE)
  endif()
endfunction()
rpc_take_compiler(C CC)
rpc_take_compiler(CXX CXX)
