# SPDX-License-Identifier: BSD-3-Clause
# RPC_USE_GMSH=OFF leaves gmsh out: no rpc_gmsh is built or installed, and rpc looks for none.
cmake_minimum_required(VERSION 3.23)
set(without ${work_dir}/without_gmsh)
file(REMOVE_RECURSE ${without})
execute_process(COMMAND ${CMAKE_COMMAND} -S ${source_dir} -B ${without} -G ${generator} -D RPC_USE_GMSH=OFF -D RPC_BUILD_TESTS=OFF
                        -D CMAKE_CXX_COMPILER=${compiler} -D Trilinos_DIR=${trilinos}
                RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
if(NOT result EQUAL 0)
  message(FATAL_ERROR "Not configured with RPC_USE_GMSH=OFF:\n${output}")
endif()
foreach(file IN ITEMS packages/mesh/cmake_install.cmake compile_commands.json)
  file(READ ${without}/${file} text)
  if(text MATCHES "rpc_gmsh|gmsh_program\\.cpp|RPC_GMSH_PROGRAM")
    message(FATAL_ERROR "${file} of a build with RPC_USE_GMSH=OFF has \"${CMAKE_MATCH_0}\"")
  endif()
  if(has_gmsh) # the same words are what a build with gmsh has
    file(READ ${build_dir}/${file} text)
    if(NOT text MATCHES "rpc_gmsh|gmsh_program\\.cpp|RPC_GMSH_PROGRAM")
      message(FATAL_ERROR "${file} of a build with gmsh has nothing of it: this test looks for the wrong words")
    endif()
  endif()
endforeach()
