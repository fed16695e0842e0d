# Flags that every target of squall is compiled with; never handed on to its users.
add_library(squall_options INTERFACE)
target_compile_options(squall_options INTERFACE
  -Wall -Wextra -Wpedantic -Wconversion
  # Results must not depend on what the compiler contracts: fused multiply-adds are written as fma().
  -ffp-contract=off -fno-math-errno -fno-trapping-math)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  target_compile_options(squall_options INTERFACE -Wno-restrict)  # false alarms on std::string (GCC bug 105651)
endif()
if(SQUALL_WARNINGS_AS_ERRORS)
  target_compile_options(squall_options INTERFACE -Werror)
endif()
if(SQUALL_SANITIZE)
  target_compile_options(squall_options INTERFACE -fsanitize=${SQUALL_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  # An index past the size, but within the capacity, is heap that may be read: the library looks itself.
  target_compile_definitions(squall_options INTERFACE _GLIBCXX_ASSERTIONS)
  target_link_options(squall_options INTERFACE -fsanitize=${SQUALL_SANITIZE})
endif()
