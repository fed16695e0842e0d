# What a result says about the build it came from. The build needs no git: without it the revision is "unknown".
set(SQUALL_GIT_REVISION "unknown")
find_package(Git QUIET)
if(Git_FOUND AND EXISTS "${PROJECT_SOURCE_DIR}/.git")
  execute_process(COMMAND "${GIT_EXECUTABLE}" -C "${PROJECT_SOURCE_DIR}" describe --always --dirty --abbrev=12
                  OUTPUT_VARIABLE SQUALL_GIT_REVISION OUTPUT_STRIP_TRAILING_WHITESPACE
                  RESULT_VARIABLE squall_git_result ERROR_QUIET)
  if(NOT squall_git_result EQUAL 0)
    set(SQUALL_GIT_REVISION "unknown")
  endif()
  if(EXISTS "${PROJECT_SOURCE_DIR}/.git/HEAD")
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/.git/HEAD")
  endif()
endif()
string(TOUPPER "${CMAKE_BUILD_TYPE}" squall_build_type)
set(SQUALL_COMPILER "${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}")
string(STRIP "${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${squall_build_type}} -ffp-contract=off" SQUALL_FLAGS)
configure_file("${CMAKE_CURRENT_LIST_DIR}/build_info.h.in" "${PROJECT_BINARY_DIR}/generated/build_info.h" @ONLY)
