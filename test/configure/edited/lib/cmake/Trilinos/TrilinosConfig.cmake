# SPDX-License-Identifier: BSD-3-Clause
# The Trilinos of the build with what the file ${edit} changes.
include(${trilinos}/TrilinosConfig.cmake)

# edit_header(<header> <regular expression> <replacement>): a copy of one of Trilinos' headers is found before it
function(edit_header header old new)
  foreach(dir IN LISTS Trilinos_INCLUDE_DIRS)
    if(EXISTS ${dir}/${header})
      file(READ ${dir}/${header} text)
      string(REGEX REPLACE "${old}" "${new}" changed "${text}")
      if(changed STREQUAL text)
        message(FATAL_ERROR "${dir}/${header} has no \"${old}\"")
      endif()
      file(WRITE ${CMAKE_BINARY_DIR}/edited/${header} "${changed}")
      break()
    endif()
  endforeach()
endfunction()

# The header that tells Tpetra's default node, in which Trilinos 14 and later have put what older ones have under the shorter name.
set(default_node_header KokkosClassic_DefaultNode_config.h)
foreach(dir IN LISTS Trilinos_INCLUDE_DIRS)
  if(EXISTS ${dir}/Tpetra_${default_node_header})
    set(default_node_header Tpetra_${default_node_header})
    break()
  endif()
endforeach()

file(REMOVE_RECURSE ${CMAKE_BINARY_DIR}/edited)
include(${edit})
list(PREPEND Trilinos_INCLUDE_DIRS ${CMAKE_BINARY_DIR}/edited)
