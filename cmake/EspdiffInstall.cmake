# EspdiffInstall.cmake: the library for other programs: archives, headers, and what find_package(espdiff) reads. Component
# `development`; scripts/test-install builds a program against it.
include(CMakePackageConfigHelpers)
include(GNUInstallDirs)

set(library espdiff_system espdiff_base espdiff_io espdiff_align espdiff_engine_cpu espdiff_engine espdiff_causes espdiff_prepare
  espdiff_field espdiff_options espdiff_motions espdiff_mapping espdiff_certificate espdiff_input_checks espdiff_compare espdiff_potential espdiff_report espdiff_plot espdiff_scene espdiff_page espdiff_export)
if(ESPDIFF_CUDA_ENABLED)
  list(APPEND library espdiff_engine_cuda espdiff_cuda_thrust)
endif()
# What a program links: espdiff::espdiff.
add_library(espdiff_library INTERFACE)
target_link_libraries(espdiff_library INTERFACE espdiff_export espdiff_page)
set_target_properties(espdiff_library PROPERTIES EXPORT_NAME espdiff)

install(TARGETS espdiff_library espdiff_flags espdiff_cpu_thrust ${library} EXPORT espdiff
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development)
install(EXPORT espdiff NAMESPACE espdiff:: FILE espdiffTargets.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/espdiff COMPONENT development)
foreach(room system base io align engine causes prepare field options motions mapping certificate input_checks compare potential report plot page export)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/src/${room} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/espdiff COMPONENT development
    FILES_MATCHING PATTERN "*.h")
endforeach()
install(FILES ${PROJECT_BINARY_DIR}/generated/base/version.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/espdiff/base
  COMPONENT development)

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/espdiffConfig.cmake.in ${PROJECT_BINARY_DIR}/generated/espdiffConfig.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/espdiff)
# Before 1.0.0 a minor version may change what a program calls.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/generated/espdiffConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/generated/espdiffConfig.cmake ${PROJECT_BINARY_DIR}/generated/espdiffConfigVersion.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/espdiff COMPONENT development)
