# Installation: library, headers, apps, and how others find them. Components: runtime (the shared
# library), development, tools.
include(CMakePackageConfigHelpers)
set(package_directory ${CMAKE_INSTALL_LIBDIR}/cmake/pcl_surflet)

install(TARGETS pcl_surflet EXPORT pcl_surflet-targets
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT runtime
  NAMELINK_COMPONENT development
  INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/ ${PROJECT_BINARY_DIR}/include/
  DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development)

# find_package(pcl_surflet)
install(EXPORT pcl_surflet-targets NAMESPACE pcl_surflet:: DESTINATION ${package_directory}
  COMPONENT development)
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/pcl_surflet-config.cmake.in
  ${PROJECT_BINARY_DIR}/pcl_surflet-config.cmake INSTALL_DESTINATION ${package_directory})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/pcl_surflet-config-version.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/pcl_surflet-config.cmake
  ${PROJECT_BINARY_DIR}/pcl_surflet-config-version.cmake
  DESTINATION ${package_directory} COMPONENT development)

# pkg-config
file(RELATIVE_PATH prefix_from_pc /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
string(REGEX REPLACE "/$" "" prefix_from_pc ${prefix_from_pc})
math(EXPR next_minor "${PCL_VERSION_MINOR} + 1")
set(pcl_requirements "pcl_common >= ${PCL_VERSION_MAJOR}.${PCL_VERSION_MINOR}, \
pcl_common < ${PCL_VERSION_MAJOR}.${next_minor}")
foreach(component IN LISTS pcl_surflet_public_components)
  if(NOT component STREQUAL common)
    string(APPEND pcl_requirements ", pcl_${component}")
  endif()
endforeach()
list(TRANSFORM pcl_surflet_eigen_definitions PREPEND -D OUTPUT_VARIABLE eigen_flags)
list(JOIN eigen_flags " " eigen_flags)
configure_file(${PROJECT_SOURCE_DIR}/cmake/pcl_surflet.pc.in ${PROJECT_BINARY_DIR}/pcl_surflet.pc
  @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/pcl_surflet.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig
  COMPONENT development)

install(FILES ${PROJECT_SOURCE_DIR}/README.md ${PROJECT_SOURCE_DIR}/CHANGES.md
  ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT documentation)

if(PCL_SURFLET_BUILD_APPS)
  install(TARGETS ${pcl_surflet_apps} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT tools)
  file(GLOB man_pages CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/doc/man/*.1)
  if(man_pages)
    set(manual ${PROJECT_BINARY_DIR}/man) # compressed, as Debian wants it
    file(MAKE_DIRECTORY ${manual})
    foreach(page IN LISTS man_pages)
      configure_file(${page} ${manual} COPYONLY)
    endforeach()
    list(TRANSFORM man_pages REPLACE ".*/" "${manual}/")
    execute_process(COMMAND gzip -9nf ${man_pages} COMMAND_ERROR_IS_FATAL ANY)
    list(TRANSFORM man_pages APPEND .gz)
    install(FILES ${man_pages} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT tools)
  endif()
  # One completion for all apps; bash looks it up by the name of the command.
  set(completions ${CMAKE_INSTALL_DATAROOTDIR}/bash-completion/completions)
  if(EXISTS ${PROJECT_SOURCE_DIR}/completions/pcl_surflet)
    install(FILES ${PROJECT_SOURCE_DIR}/completions/pcl_surflet DESTINATION ${completions}
      COMPONENT tools)
    file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/completions)
    foreach(app IN LISTS pcl_surflet_apps)
      file(CREATE_LINK pcl_surflet ${PROJECT_BINARY_DIR}/completions/${app} SYMBOLIC)
      install(FILES ${PROJECT_BINARY_DIR}/completions/${app} DESTINATION ${completions}
        COMPONENT tools)
    endforeach()
  endif()
endif()
