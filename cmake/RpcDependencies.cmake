# SPDX-License-Identifier: BSD-3-Clause
# Everything outside this project, and what to do when it is missing. Also installed, for rpcConfig.cmake.
include_guard()
include(${CMAKE_CURRENT_LIST_DIR}/RpcTrilinos.cmake)

# rpc_require(<what> <Debian package> <variable> ...): stops unless all the variables hold a true value
function(rpc_require what package)
  foreach(variable IN LISTS ARGN)
    if(NOT ${variable})
      message(FATAL_ERROR "${what} was not found. On Debian: bash cmake/install_packages.sh (or apt-get install ${package}).")
    endif()
  endforeach()
endfunction()

find_package(nlohmann_json 3.9 QUIET)
rpc_require("nlohmann_json 3.9 or newer" nlohmann-json3-dev nlohmann_json_FOUND)

find_package(PkgConfig QUIET)
rpc_require("pkg-config" pkgconf PKG_CONFIG_FOUND)
pkg_check_modules(muparser QUIET IMPORTED_TARGET GLOBAL muparser)
rpc_require("muParser" libmuparser-dev muparser_FOUND)

# rpc_find_library(<name> <what> <Debian package> <header> <library name> ...): the target rpc::<name> for a library that comes
# without a CMake package
function(rpc_find_library name what package header)
  string(TOUPPER ${name} prefix)
  find_path(${prefix}_INCLUDE_DIR ${header})
  find_library(${prefix}_LIBRARY NAMES ${ARGN})
  rpc_require("${what}" ${package} ${prefix}_INCLUDE_DIR ${prefix}_LIBRARY)
  mark_as_advanced(${prefix}_INCLUDE_DIR ${prefix}_LIBRARY)
  if(NOT TARGET rpc_${name})
    add_library(rpc_${name} INTERFACE IMPORTED GLOBAL)
    add_library(rpc::${name} ALIAS rpc_${name})
    rpc_system_include(rpc_${name} ${${prefix}_INCLUDE_DIR})
    target_link_libraries(rpc_${name} INTERFACE ${${prefix}_LIBRARY})
  endif()
endfunction()
rpc_find_library(metis "METIS" libmetis-dev metis.h metis)
rpc_find_library(exodus "The Exodus library" libexodusii-dev exodusII.h exoIIv2c exodus)
# Exodus writes its files by NetCDF, of which Debian has two libraries, with MPI and without. rpc calls the one that Exodus was linked to: a
# file that one of them has opened is unknown to the other.
execute_process(COMMAND ${CMAKE_READELF} -d ${EXODUS_LIBRARY} OUTPUT_VARIABLE exodus_needs ERROR_QUIET)
string(REGEX MATCH "libnetcdf[a-z_]*\\.so[.0-9]*" netcdf_file "${exodus_needs}")
rpc_find_library(netcdf "The NetCDF library" libnetcdf-dev netcdf.h ${netcdf_file} netcdf)

# MUMPS makes sparse factors. Without it there are banded ones only. It is looked for where Trilinos has MPI, which Debian's library takes.
option(RPC_USE_MUMPS "Sparse factors by MUMPS, where it is found" ON)
find_path(MUMPS_INCLUDE_DIR dmumps_c.h)
find_library(MUMPS_LIBRARY dmumps)
mark_as_advanced(MUMPS_INCLUDE_DIR MUMPS_LIBRARY)
set(RPC_HAS_MUMPS OFF)
if(RPC_USE_MUMPS AND RPC_TRILINOS_HAS_MPI AND MUMPS_INCLUDE_DIR AND MUMPS_LIBRARY)
  set(RPC_HAS_MUMPS ON)
  rpc_find_library(mumps "MUMPS" libmumps-dev dmumps_c.h dmumps)
endif()
