# SPDX-License-Identifier: BSD-3-Clause
# rpc_add_test(<package> <name> [LABEL unit] [NP 1 2 3] [LIBRARIES libs] [TIMEOUT seconds] [ALONE])
# The GoogleTests of <name>_test.cpp, linked to rpc::<package> where there is such a target; one CTest entry
# <package>.<name>.np<k> per number of ranks. Unit tests on several ranks are one entry for each package, <package>.np<k>: to start ranks takes longer
# than most of them. ALONE: but for those that change their process for good. LABEL is unit, verification, regression or performance. What the sources of all tests of
# a package are compiled with belongs to the target <package>_tests.
find_package(GTest QUIET)
rpc_require("GoogleTest" libgtest-dev GTest_FOUND)

set(RPC_TEST_THREADS 1 CACHE STRING "OpenMP threads per rank in tests")
set(RPC_TEST_TIMEOUT_FACTOR 1 CACHE STRING "Factor on the tests' time limits, an integer")
set(RPC_TEST_PACKAGES "" CACHE STRING "Packages and folders of test/ whose tests are wanted; empty: all")

# rpc_add_tests_of(<package or folder of test/> <folder>)
function(rpc_add_tests_of name folder)
  if(NOT RPC_TEST_PACKAGES OR name IN_LIST RPC_TEST_PACKAGES)
    add_subdirectory(${folder})
    get_property(numbers GLOBAL PROPERTY rpc_unit_tests_of_${name})
    list(REMOVE_DUPLICATES numbers)
    foreach(np IN LISTS numbers)
      get_property(sources GLOBAL PROPERTY rpc_unit_tests_of_${name}_np${np})
      list(TRANSFORM sources PREPEND --source=)
      rpc_add_run_test(${name} ${np} LABEL unit TIMEOUT 1800 COMMAND rpc_tests ${sources})
    endforeach()
  endif()
endfunction()

# One program has all GoogleTests, and runs those of one file at a time: of static libraries with GPU code, each of sixty
# programs would hold a copy of 100 MB. rpc_test_main is what the tests themselves need.
add_library(rpc_test_main INTERFACE)
target_include_directories(rpc_test_main INTERFACE ${PROJECT_SOURCE_DIR}/test/support)
target_compile_features(rpc_test_main INTERFACE cxx_std_17)
target_link_libraries(rpc_test_main INTERFACE rpc::trilinos GTest::gtest)
add_executable(rpc_tests ${PROJECT_SOURCE_DIR}/test/support/gtest_main.cpp)
target_compile_options(rpc_tests PRIVATE -Wall -Wextra)
target_link_libraries(rpc_tests PRIVATE rpc_test_main rpc::device_pool)

# More ranks than cores, and root in a container: Open MPI refuses both unless told.
set(rpc_test_environment
    OMP_NUM_THREADS=${RPC_TEST_THREADS}
    OMP_PROC_BIND=false
    OMP_WAIT_POLICY=passive # threads that spin while they wait take the cores from those that they wait for
    OMPI_ALLOW_RUN_AS_ROOT=1
    OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
    OMPI_MCA_rmaps_base_oversubscribe=1
    OMPI_MCA_btl_vader_single_copy_mechanism=none) # containers forbid it, with an error message per message sent
set(rpc_mpiexec_flags)
if(RPC_TRILINOS_HAS_MPI)
  execute_process(COMMAND ${MPIEXEC_EXECUTABLE} --version OUTPUT_VARIABLE version ERROR_QUIET)
  if(version MATCHES "Open ?MPI|OpenRTE")
    set(rpc_mpiexec_flags --oversubscribe --bind-to none) # bound ranks of tests that run side by side share one core
  endif()
endif()

# What each test on several ranks loads, see yield.c. One rank waits for nobody, but MUMPS asks for messages: if it yielded whenever there are none, it
# would get next to nothing of a busy core.
add_library(rpc_yield MODULE ${PROJECT_SOURCE_DIR}/test/support/yield.c)
set_target_properties(rpc_yield PROPERTIES LIBRARY_OUTPUT_DIRECTORY $<1:${PROJECT_BINARY_DIR}>)
add_dependencies(rpc_tests rpc_yield)
set(rpc_ranks_environment
    LD_PRELOAD=$<TARGET_FILE:rpc_yield>
    OMPI_MCA_mpi_yield_when_idle=1
    OMPI_MCA_btl=^ofi) # no network cards: tests run on one host, and Open MPI 6 sleeps for a second while it looks for cards

# What shows that all ranks make the same collective calls, see collectives.c.
if(RPC_TRILINOS_HAS_MPI)
  find_package(MPI QUIET COMPONENTS C)
endif()
if(RPC_TRILINOS_HAS_MPI AND MPI_C_FOUND)
  find_package(Threads REQUIRED)
  add_library(rpc_collectives MODULE ${PROJECT_SOURCE_DIR}/test/support/collectives.c)
  add_executable(rpc_different_calls ${PROJECT_SOURCE_DIR}/test/support/different_calls.cpp)
  target_compile_options(rpc_collectives PRIVATE -Wall -Wextra)
  target_link_libraries(rpc_collectives PRIVATE MPI::MPI_C Threads::Threads ${CMAKE_DL_LIBS})
  target_link_libraries(rpc_different_calls PRIVATE MPI::MPI_C)
  target_compile_definitions(rpc_different_calls PRIVATE OMPI_SKIP_MPICXX MPICH_SKIP_MPICXX) # C's functions only
  set_target_properties(rpc_collectives PROPERTIES LIBRARY_OUTPUT_DIRECTORY $<1:${PROJECT_BINARY_DIR}>)
  add_dependencies(rpc_tests rpc_collectives rpc_different_calls)
endif()

# rpc_append_session_folder(<list> <test>): appends to a list of environment variables a folder of Open MPI's for one test. Its own in /tmp
# is the same for all runs on a host, and of two that start or end at once one may fail.
macro(rpc_append_session_folder list test)
  foreach(name IN ITEMS OMPI_MCA_orte PRTE_MCA_prte) # Open MPI 4, later ones
    list(APPEND ${list} ${name}_tmpdir_base=${PROJECT_BINARY_DIR}/sessions/${test})
  endforeach()
endmacro()

# rpc_add_run_test(<name> <np> LABEL label TIMEOUT seconds COMMAND target args...): the CTest entry <name>.np<np> that runs an
# executable target, through mpiexec for np > 1; none then where Trilinos has no MPI.
function(rpc_add_run_test name np)
  cmake_parse_arguments(PARSE_ARGV 2 arg "" "LABEL;TIMEOUT" "COMMAND")
  if(np GREATER 1 AND NOT RPC_TRILINOS_HAS_MPI)
    return()
  endif()
  if(NOT arg_LABEL MATCHES "^(unit|verification|regression|performance|stress)$")
    message(FATAL_ERROR "test ${name}: LABEL must be one of unit, verification, regression, performance, stress, got ${arg_LABEL}")
  endif()
  set(launch)
  set(environment ${rpc_test_environment})
  if(np EQUAL 1)
    list(APPEND environment OMPI_MCA_ess_singleton_isolated=1 OMPI_MCA_orte_create_session_dirs=0 OMPI_MCA_btl=self) # as src/main.cpp does
  else()
    set(launch ${MPIEXEC_EXECUTABLE} ${MPIEXEC_NUMPROC_FLAG} ${np} ${rpc_mpiexec_flags})
    list(APPEND environment ${rpc_ranks_environment})
    rpc_append_session_folder(environment ${name}.np${np})
  endif()
  list(POP_FRONT arg_COMMAND target)
  add_test(NAME ${name}.np${np} COMMAND ${launch} $<TARGET_FILE:${target}> ${arg_COMMAND})
  math(EXPR processors "${np} * ${RPC_TEST_THREADS}")
  math(EXPR timeout "${arg_TIMEOUT} * ${RPC_TEST_TIMEOUT_FACTOR}")
  set_tests_properties(${name}.np${np} PROPERTIES LABELS ${arg_LABEL} PROCESSORS ${processors} TIMEOUT ${timeout}
                       COST ${np} ENVIRONMENT "${environment}")
endfunction()

function(rpc_add_test package name)
  cmake_parse_arguments(PARSE_ARGV 2 arg "ALONE" "LABEL;TIMEOUT" "NP;LIBRARIES")
  if(arg_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "rpc_add_test(${package} ${name}): unknown argument ${arg_UNPARSED_ARGUMENTS}")
  endif()
  foreach(default IN ITEMS LABEL=unit TIMEOUT=600 NP=1)
    string(REGEX MATCH "^(.*)=(.*)$" default ${default})
    if(NOT arg_${CMAKE_MATCH_1})
      set(arg_${CMAKE_MATCH_1} ${CMAKE_MATCH_2})
    endif()
  endforeach()
  if(TARGET rpc::${package})
    list(PREPEND arg_LIBRARIES rpc::${package})
  endif()
  set(target ${package}_tests)
  if(NOT TARGET ${target})
    # -O1: tests spend their time in the libraries. To optimize their own code further takes the compiler longer and gains nothing.
    add_library(${target} OBJECT)
    target_compile_options(${target} PRIVATE -Wall -Wextra $<$<CONFIG:Release>:-O1>)
    target_link_libraries(${target} PUBLIC rpc_test_main)
    target_link_libraries(rpc_tests PRIVATE ${target})
  endif()
  target_sources(${target} PRIVATE ${name}_test.cpp)
  target_link_libraries(${target} PUBLIC ${arg_LIBRARIES})
  file(RELATIVE_PATH source ${PROJECT_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR}/${name}_test.cpp)
  foreach(np IN LISTS arg_NP)
    if(np GREATER 1 AND arg_LABEL STREQUAL "unit" AND NOT arg_ALONE)
      set_property(GLOBAL APPEND PROPERTY rpc_unit_tests_of_${package} ${np})
      set_property(GLOBAL APPEND PROPERTY rpc_unit_tests_of_${package}_np${np} ${source})
      continue()
    endif()
    rpc_add_run_test(${package}.${name} ${np} LABEL ${arg_LABEL} TIMEOUT ${arg_TIMEOUT} COMMAND rpc_tests --source=${source})
  endforeach()
endfunction()
