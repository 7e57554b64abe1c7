# SPDX-License-Identifier: BSD-3-Clause
# Installs the build tree to a scratch prefix, builds the consumer against it and runs both the consumer and the program.
cmake_minimum_required(VERSION 3.23)
file(REMOVE_RECURSE ${work_dir})
set(prefix ${work_dir}/prefix)
set(consumer ${work_dir}/consumer)

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "${command}\nended with ${result}:\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

run(${CMAKE_COMMAND} --install ${build_dir} --prefix ${prefix} --config ${config})

# The install tree has to stand without the source and build trees.
file(GLOB_RECURSE installed ${prefix}/*.cmake)
foreach(file IN LISTS installed)
  file(READ ${file} text)
  foreach(dir IN ITEMS ${source_dir}/packages ${source_dir}/cmake ${build_dir}/)
    string(FIND "${text}" "${dir}" position)
    if(NOT position EQUAL -1)
      message(FATAL_ERROR "${file} refers to ${dir}")
    endif()
  endforeach()
endforeach()

run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR}/consumer -B ${consumer} -G ${generator} -D CMAKE_PREFIX_PATH=${prefix}
    -D CMAKE_CXX_COMPILER=${compiler} -D CMAKE_CXX_COMPILER_LAUNCHER=${launcher} -D CMAKE_BUILD_TYPE=${config}
    "-D CMAKE_CXX_FLAGS=${flags}")
run(${CMAKE_COMMAND} --build ${consumer} --config ${config})
run(${consumer}/consumer)
# The foundation carries the load, 5 t (2 + 2) N/m, at both times.
foreach(line IN ITEMS "t = 0.5: contact force 10 N/m" "t = 1: contact force 20 N/m, largest pressure 14 Pa"
        "on a ridge: contact force 20 N/m")
  if(NOT output MATCHES "${line}")
    message(FATAL_ERROR "The consumer had to print \"${line}\", but printed:\n${output}")
  endif()
endforeach()

foreach(file IN ITEMS LICENSE NOTICE CITATION.cff licences.md)
  if(NOT EXISTS ${prefix}/share/doc/rpc/${file})
    message(FATAL_ERROR "No ${file} in ${prefix}/share/doc/rpc")
  endif()
endforeach()
file(GLOB decks ${prefix}/share/rpc/input/*.xml)
if(NOT decks)
  message(FATAL_ERROR "No deck in ${prefix}/share/rpc/input")
endif()
file(GLOB templates ${prefix}/share/rpc/input/templates/*.xml)
if(NOT templates)
  message(FATAL_ERROR "No deck to start from in ${prefix}/share/rpc/input/templates")
endif()
run(${prefix}/bin/rpc --version)
