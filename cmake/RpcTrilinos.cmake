# SPDX-License-Identifier: BSD-3-Clause
# The target rpc::trilinos: all that this project uses of Trilinos. Trilinos 13.2 exports variables, later versions export targets
# with all that belongs to them, and nothing outside this file needs to know. Also installed, for rpcConfig.cmake.
# Sets RPC_TRILINOS_HAS_MPI, and FindMPI's MPIEXEC_EXECUTABLE where there is MPI.
include_guard()

set(CMAKE_CXX_EXTENSIONS OFF) # KokkosConfig.cmake warns otherwise
# Only the packages in use and what they pull in: a full Trilinos costs link time, and Debian may have but a part installed.
set(rpc_packages Teuchos Kokkos KokkosKernels Tpetra Xpetra Belos Amesos2 Ifpack2 MueLu NOX)
set(Kokkos_FIND_QUIETLY ON) # RpcTrilinosCheck.cmake says more
# Zoltan2 repartitions MueLu's coarse levels; Intrepid2 gives tests their reference values.
# No version is named here: Trilinos' own version file takes none but that of the same major number. RpcTrilinosCheck.cmake looks at it.
find_package(Trilinos QUIET COMPONENTS ${rpc_packages} OPTIONAL_COMPONENTS Zoltan2 Intrepid2)
include(${CMAKE_CURRENT_LIST_DIR}/RpcTrilinosCheck.cmake) # sets RPC_TRILINOS_HAS_MPI

if(RPC_TRILINOS_HAS_MPI)
  find_package(MPI QUIET COMPONENTS CXX) # adds nothing when the compiler is the MPI wrapper
  if(NOT MPI_CXX_FOUND)
    message(FATAL_ERROR "Trilinos was built with MPI, which was not found. On Debian: apt-get install libopenmpi-dev openmpi-bin.")
  endif()
endif()

# Debian's Trilinos names folders and libraries of -dev packages that it does not depend on (scotch); a shared library needs none.
# Drops from a list the files and the targets of files that do not exist.
function(rpc_drop_missing_files list)
  set(kept)
  foreach(item IN LISTS ${list})
    set(file ${item})
    if(TARGET "${item}")
      get_target_property(location ${item} IMPORTED_LOCATION)
      if(location)
        set(file ${location})
      endif()
    endif()
    if(NOT IS_ABSOLUTE "${file}" OR EXISTS "${file}")
      list(APPEND kept ${item})
    endif()
  endforeach()
  set(${list} ${kept} PARENT_SCOPE)
endfunction()

# The same for what a target of Trilinos brings to those that link it, and for the targets that it links.
function(rpc_drop_missing_files_of target)
  get_target_property(aliased ${target} ALIASED_TARGET)
  if(aliased)
    set(target ${aliased})
  endif()
  get_target_property(seen ${target} RPC_MISSING_FILES_DROPPED)
  if(seen)
    return()
  endif()
  set_target_properties(${target} PROPERTIES RPC_MISSING_FILES_DROPPED TRUE)
  foreach(property IN ITEMS INTERFACE_LINK_LIBRARIES INTERFACE_INCLUDE_DIRECTORIES INTERFACE_SYSTEM_INCLUDE_DIRECTORIES)
    get_target_property(items ${target} ${property})
    if(items)
      set(all ${items})
      rpc_drop_missing_files(items)
      if(NOT "${items}" STREQUAL "${all}")
        set_target_properties(${target} PROPERTIES ${property} "${items}")
      endif()
      foreach(item IN LISTS items)
        if(TARGET "${item}")
          rpc_drop_missing_files_of(${item})
        endif()
      endforeach()
    endif()
  endforeach()
endfunction()

# Headers of others do not warn. A folder that the compiler searches anyway must not become -isystem: it would come before
# libstdc++, whose #include_next <stdlib.h> then finds nothing.
function(rpc_system_include target)
  list(TRANSFORM ARGN REPLACE "/+$" "" OUTPUT_VARIABLE dirs)
  list(REMOVE_DUPLICATES dirs)
  list(REMOVE_ITEM dirs /usr/include /usr/local/include ${CMAKE_CXX_IMPLICIT_INCLUDE_DIRECTORIES})
  rpc_drop_missing_files(dirs)
  target_include_directories(${target} SYSTEM INTERFACE ${dirs})
endfunction()

if(NOT TARGET rpc_trilinos)
  add_library(rpc_trilinos INTERFACE IMPORTED GLOBAL)
  add_library(rpc::trilinos ALIAS rpc_trilinos)
  rpc_system_include(rpc_trilinos ${Trilinos_INCLUDE_DIRS} ${Trilinos_TPL_INCLUDE_DIRS})
  # Not Trilinos::all_selected_libs, which later versions have too: it holds what RpcTrilinosCompiler.cmake has asked for.
  set(links ${Trilinos_LIBRARIES} ${Trilinos_TPL_LIBRARIES} ${Trilinos_EXTRA_LD_FLAGS})
  rpc_drop_missing_files(links)
  foreach(library IN LISTS links)
    if(TARGET "${library}")
      rpc_drop_missing_files_of(${library})
    endif()
  endforeach()
  target_link_libraries(rpc_trilinos INTERFACE ${links})
  if(RPC_TRILINOS_HAS_MPI)
    target_link_libraries(rpc_trilinos INTERFACE MPI::MPI_CXX)
  endif()
  # Of Trilinos' compiler flags only those that its headers depend on: Debian's hardening, -w and -O3 stay out. The linker needs
  # them too: -fopenmp brings libgomp.
  separate_arguments(rpc_flags UNIX_COMMAND "${Trilinos_CXX_COMPILER_FLAGS}")
  list(FILTER rpc_flags INCLUDE REGEX "^(-fopenmp|-?-(expt-)?extended-lambda|-arch=.*|-march=.*)$")
  target_compile_options(rpc_trilinos INTERFACE ${rpc_flags})
  target_link_options(rpc_trilinos INTERFACE ${rpc_flags})
endif()
