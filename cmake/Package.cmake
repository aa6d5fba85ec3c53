# Debian packages through CPack, see scripts/package.sh: the shared library, what programs are
# compiled with, and the apps.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME pcl-surflet)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
# Who packs, by Debian's own variables.
if(DEFINED ENV{DEBEMAIL})
  set(maintainer "$ENV{DEBFULLNAME} <$ENV{DEBEMAIL}>")
else()
  set(maintainer "pcl_surflet authors <pcl-surflet@example.org>")
endif()
set(CPACK_PACKAGE_CONTACT ${maintainer})
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY ${PROJECT_DESCRIPTION})
set(CPACK_OUTPUT_FILE_PREFIX packages)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ
  GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_COMPONENTS_ALL runtime development tools)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(version ${CPACK_PACKAGE_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE})
set(library_package libpcl-surflet${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
string(CONCAT method "Surflet-pair histograms count the relations between pairs of oriented\n"
  "points (Wahl, 2007); they are the ancestor of PCL's PFH, FPFH and VFH.\n"
  "One small histogram per object, trained from a mesh or a scan, finds\n"
  "and names that object in a 3D point cloud.\n\n")

set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME ${library_package})
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_CONTROL_EXTRA ${PROJECT_SOURCE_DIR}/cmake/debian/triggers)
set(CPACK_DEBIAN_RUNTIME_DESCRIPTION "${method}This package holds the shared library.")

# Our classes derive from PCL's, which change between minor versions.
math(EXPR next_minor "${PCL_VERSION_MINOR} + 1")
string(CONCAT CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "${library_package} (= ${version}), "
  "libpcl-dev (>= ${PCL_VERSION_MAJOR}.${PCL_VERSION_MINOR}), "
  "libpcl-dev (<< ${PCL_VERSION_MAJOR}.${next_minor}~)")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libpcl-surflet-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_DESCRIPTION
  "${method}This package holds the headers, and what CMake and pkg-config find\nthem by.")

set(CPACK_DEBIAN_TOOLS_PACKAGE_NAME pcl-surflet-tools)
set(CPACK_DEBIAN_TOOLS_PACKAGE_SECTION science)
set(CPACK_DEBIAN_TOOLS_PACKAGE_DEPENDS "${library_package} (= ${version})")
set(CPACK_DEBIAN_TOOLS_PACKAGE_SUGGESTS xvfb)
set(CPACK_DEBIAN_TOOLS_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${CMAKE_LIBRARY_OUTPUT_DIRECTORY})
string(CONCAT CPACK_DEBIAN_TOOLS_DESCRIPTION "${method}"
  "This package holds the programs: training, classification and search\n"
  "of single objects, interpretation and generation of scenes, viewing.")

# What Debian wants beside every package; a plain installation goes without.
set(debian ${PROJECT_BINARY_DIR}/debian)
configure_file(${PROJECT_SOURCE_DIR}/cmake/debian/changelog.in ${debian}/changelog.Debian @ONLY)
execute_process(COMMAND gzip -9nf ${debian}/changelog.Debian COMMAND_ERROR_IS_FATAL ANY)
foreach(component IN LISTS CPACK_COMPONENTS_ALL)
  string(TOUPPER ${component} upper)
  install(FILES ${PROJECT_SOURCE_DIR}/cmake/debian/copyright ${debian}/changelog.Debian.gz
    DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/doc/${CPACK_DEBIAN_${upper}_PACKAGE_NAME}
    COMPONENT ${component} EXCLUDE_FROM_ALL)
endforeach()
include(CPack)
