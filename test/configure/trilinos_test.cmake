# SPDX-License-Identifier: BSD-3-Clause
# The configuration step takes the Trilinos of the build, and refuses it with the right message once something is missing of it.
cmake_minimum_required(VERSION 3.23)
file(REMOVE_RECURSE ${work_dir})
file(WRITE ${work_dir}/cuda/bin/nvcc "")
file(CHMOD ${work_dir}/cuda/bin/nvcc PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE)
set(edited ${CMAKE_CURRENT_LIST_DIR}/edited)

# configure(<result> [EDIT code] [OPTIONS ...]): runs CMake with an edited Trilinos; the same build folder each time, which saves the
# search for compilers. Sets result and output.
function(configure)
  cmake_parse_arguments(PARSE_ARGV 0 arg "" "EDIT" "OPTIONS")
  file(WRITE ${work_dir}/edit.cmake "${arg_EDIT}")
  execute_process(COMMAND ${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR}/project -B ${work_dir}/build -G ${generator} -U Trilinos_DIR
                          -D modules=${modules} -D trilinos=${trilinos} -D Trilinos_ROOT=${edited}
                          -D edit=${work_dir}/edit.cmake -D CMAKE_CXX_COMPILER=${compiler} ${arg_OPTIONS}
                  RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  string(REGEX REPLACE "[ \n]+" " " output "${output}") # CMake breaks lines
  set(result ${result} PARENT_SCOPE)
  set(output "${output}" PARENT_SCOPE)
endfunction()

# accepts(<text in the output> ...), refuses(<text in the message> ...): the rest goes to configure()
function(accepts text)
  configure(${ARGN})
  string(FIND "${output}" "${text}" position)
  if(NOT result EQUAL 0 OR position EQUAL -1)
    message(SEND_ERROR "Not accepted with \"${text}\": ${ARGN}\n${output}")
  endif()
endfunction()
function(refuses text)
  configure(${ARGN})
  string(FIND "${output}" "${text}" position)
  string(REGEX MATCHALL "CMake Error" errors "${output}")
  list(LENGTH errors number)
  if(result EQUAL 0 OR position EQUAL -1 OR NOT number EQUAL 1)
    message(SEND_ERROR "Not refused with one message \"${text}\": ${ARGN}\n${output}")
  endif()
endfunction()

accepts("kernels on Kokkos")
accepts("rpc was tried with Trilinos 13.2" EDIT "set(Trilinos_VERSION 15.1.0)")
configure(EDIT "set(Trilinos_VERSION 13.2.0)")
if(output MATCHES "was tried with")
  message(SEND_ERROR "Warns of a version that was tried:\n${output}")
endif()
configure(OPTIONS -D rpc_FIND_QUIETLY=ON)
if(NOT result EQUAL 0 OR output MATCHES "Kokkos")
  message(SEND_ERROR "Not quiet:\n${output}")
endif()

set(here_only -D CMAKE_FIND_USE_CMAKE_SYSTEM_PATH=OFF -D CMAKE_FIND_USE_SYSTEM_ENVIRONMENT_PATH=OFF) # Debian's Trilinos stays out of sight
refuses("Trilinos was not found" OPTIONS -D Trilinos_ROOT=${work_dir}/nowhere ${here_only})
refuses("Trilinos 12.18 in ${edited}/lib/cmake/Trilinos does not suit" EDIT "set(Trilinos_VERSION 12.18)" OPTIONS ${here_only})
refuses("Trilinos_ROOT=${work_dir}/nowhere, but" OPTIONS -D Trilinos_ROOT=${work_dir}/nowhere -D CMAKE_PREFIX_PATH=${edited})
refuses("lacks packages that rpc needs: Ifpack2, NOX."
        EDIT "set(Trilinos_NOX_FOUND FALSE)\nset(Trilinos_Ifpack2_FOUND FALSE)\nset(Trilinos_FOUND FALSE)")

function(refuses_without header macro text)
  refuses("${text}" EDIT "edit_header(${header} \"#define (${macro})\n\" \"/* #undef \\\\1 */\n\")")
endfunction()
refuses_without(Belos_config.h HAVE_BELOS_TPETRA "Belos was built without Tpetra")
refuses_without(Xpetra_config.hpp HAVE_XPETRA_TPETRA "Xpetra was built without Tpetra")
refuses_without(MueLu_config.hpp HAVE_MUELU_TPETRA "MueLu was built without Tpetra")
refuses_without(MueLu_config.hpp HAVE_MUELU_IFPACK2 "MueLu was built without Ifpack2")
refuses_without(MueLu_config.hpp HAVE_MUELU_AMESOS2 "MueLu was built without Amesos2")
refuses_without(Amesos2_config.h HAVE_AMESOS2_KLU2 "Amesos2 was built without KLU2")
refuses_without(TpetraCore_config.h HAVE_TPETRA_INST_DOUBLE "Tpetra was built without double")
refuses_without(TpetraCore_config.h HAVE_TPETRA_INST_INT_LONG_LONG "Tpetra was built without the ordinals int")
refuses_without(TpetraCore_config.h "HAVE_TPETRA_INST_(SERIAL|OPENMP|CUDA)" "Tpetra was not instantiated for its default node")
refuses("runs by default on none of Kokkos Serial, OpenMP and Cuda"
        EDIT "edit_header(\${default_node_header} HAVE_TPETRA_DEFAULTNODE_ HAVE_TPETRA_DEFAULTNODE_NO_)")

set(cuda "set(Kokkos_DEVICES CUDA SERIAL)")
unset(ENV{CUDA_ROOT})
refuses("nvcc is not there" EDIT "${cuda}" OPTIONS ${here_only})
set(ENV{CUDA_ROOT} ${work_dir}/cuda)
refuses("was built without CUDA_LAMBDA" EDIT "${cuda}\nset(Kokkos_OPTIONS CUDA_UVM)")
refuses("was built without CUDA_UVM" EDIT "${cuda}\nset(Trilinos_VERSION 13.2)\nset(Kokkos_OPTIONS CUDA_LAMBDA)")
if(NOT compiler MATCHES "nvcc_wrapper")
  refuses("which its nvcc_wrapper compiles and ${compiler} does not" EDIT "${cuda}\nset(Kokkos_OPTIONS CUDA_LAMBDA CUDA_UVM)")
endif()
