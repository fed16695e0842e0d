# squall_add_tests(<folder> [BACKENDS <name>...] LABELS <label>...)
#
# Builds tests/<folder>/**/*_test.cpp into <folder>_tests and adds it to ctest: as one entry, or as one entry per backend
# named, which runs the tests with /<name> in their parameter's name, and one for the tests without a backend.
function(squall_add_tests folder)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "BACKENDS;LABELS")
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/${folder}/*_test.cpp")
  if(NOT sources)
    return()
  endif()
  set(program ${folder}_tests)
  add_executable(${program} ${sources})
  target_include_directories(${program} PRIVATE "${CMAKE_CURRENT_SOURCE_DIR}")
  target_link_libraries(${program} PRIVATE squall_backends GTest::gtest_main GTest::gmock squall_options)
  foreach(library squall_openmp squall_opencl squall_harness squall_bench_support)
    if(TARGET ${library})
      target_link_libraries(${program} PRIVATE ${library})
    endif()
  endforeach()
  if(OpenMP_CXX_FOUND)
    target_link_libraries(${program} PRIVATE OpenMP::OpenMP_CXX)
  endif()
  target_compile_definitions(${program} PRIVATE
    SQUALL_SCENES_DIR="${PROJECT_SOURCE_DIR}/scenes" SQUALL_TEST_SCENES_DIR="${PROJECT_SOURCE_DIR}/tests/scenes"
    SQUALL_GOLDEN_HASHES="${PROJECT_SOURCE_DIR}/tests/golden/hashes.txt")
  target_precompile_headers(${program} PRIVATE <gtest/gtest.h> <Eigen/Core>)

  if(NOT arg_BACKENDS)
    squall_add_test_entry(${folder} ${program} "*" "${arg_LABELS}")
    return()
  endif()
  foreach(backend ${arg_BACKENDS})
    squall_add_test_entry(${folder}.${backend} ${program} "*/${backend}*" "${arg_LABELS};${backend}")
    list(APPEND others "*/${backend}*")
  endforeach()
  list(JOIN others ":" others)
  squall_add_test_entry(${folder}.between_backends ${program} "-${others}" "${arg_LABELS}")
endfunction()

# Sanitizers take minutes for a million particles, which go the way of a thousand, and for full size windows far into their
# scenes, which are tried at smaller sizes, too. There these are left out (scripts/check.sh says so), but for one test.
set(squall_left_out "*_1048577:*/1048577_on_1:*/1048577_on_2:*/1048577_on_3:SortOfMany.*:Large.*"
                    "*OnAnyNumberOfThreadsAndOnOpenCl/*_front_meets_wall_*:*OnAnyNumberOfThreadsAndOnOpenCl/*_impact_*")
list(JOIN squall_left_out ":" squall_left_out)

# A filter that matches nothing would pass: GoogleTest's line about it makes the entry fail.
function(squall_add_test_entry name program filter labels)
  if(SQUALL_SANITIZE AND filter MATCHES "-")
    string(APPEND filter ":${squall_left_out}")
  elseif(SQUALL_SANITIZE)
    string(APPEND filter "-${squall_left_out}")
  endif()
  add_test(NAME ${name} COMMAND ${program} "--gtest_filter=${filter}" --gtest_brief=1)
  set(timeout 600)
  if(SQUALL_SANITIZE)
    set(timeout 2400)  # they slow everything down, by up to ten times
  endif()
  set_tests_properties(${name} PROPERTIES LABELS "${labels}" TIMEOUT ${timeout}
                       FAIL_REGULAR_EXPRESSION "0 tests from 0 test suites ran|SKIPPED")
endfunction()
