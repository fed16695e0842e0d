# `find_package(squall)` gives squall::core, squall::backends and the backends that were built.
include(CMakePackageConfigHelpers)

set(squall_libraries squall_core squall_backends)
set(squall_has_openmp OFF)
set(squall_has_opencl OFF)
foreach(backend openmp opencl)
  if(TARGET squall_${backend})
    list(APPEND squall_libraries squall_${backend})
    set(squall_has_${backend} ON)
  endif()
endforeach()
install(TARGETS ${squall_libraries} EXPORT squallTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(EXPORT squallTargets NAMESPACE squall:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/squall)
install(FILES src/backends.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/squall)
install(DIRECTORY src/core DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/squall FILES_MATCHING PATTERN "*.h")
install(DIRECTORY kernels DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/squall FILES_MATCHING PATTERN "*.h")
install(DIRECTORY scenes DESTINATION ${CMAKE_INSTALL_DATADIR}/squall)

configure_package_config_file(cmake/squallConfig.cmake.in "${PROJECT_BINARY_DIR}/squallConfig.cmake"
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/squall)
write_basic_package_version_file("${PROJECT_BINARY_DIR}/squallConfigVersion.cmake" COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/squallConfig.cmake" "${PROJECT_BINARY_DIR}/squallConfigVersion.cmake"
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/squall)
