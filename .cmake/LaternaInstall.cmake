include(CMakePackageConfigHelpers)
set(config_dir ${CMAKE_INSTALL_LIBDIR}/cmake/laterna)
install(EXPORT laterna NAMESPACE laterna:: FILE laternaTargets.cmake DESTINATION ${config_dir})
file(WRITE ${PROJECT_BINARY_DIR}/laternaConfig.cmake "include(\"\${CMAKE_CURRENT_LIST_DIR}/LaternaDependencies.cmake\")\ninclude(\"\${CMAKE_CURRENT_LIST_DIR}/laternaTargets.cmake\")\n")
write_basic_package_version_file(${PROJECT_BINARY_DIR}/laternaConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/laternaConfig.cmake ${PROJECT_BINARY_DIR}/laternaConfigVersion.cmake
        .cmake/Findmrcal.cmake .cmake/LaternaDependencies.cmake DESTINATION ${config_dir})
