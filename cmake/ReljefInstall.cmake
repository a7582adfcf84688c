# cmake --install BUILD --prefix DIR [--component programs|library|docs], and cpack -G DEB.

include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

# Before anything is installed.
install(CODE [[
  set(reljef_prefix "$ENV{DESTDIR}${CMAKE_INSTALL_PREFIX}")
  execute_process(COMMAND ${CMAKE_COMMAND} -E make_directory "${reljef_prefix}"
    RESULT_VARIABLE reljef_failed ERROR_QUIET)
  execute_process(COMMAND test -w "${reljef_prefix}" RESULT_VARIABLE reljef_unwritable)
  if(reljef_failed OR reljef_unwritable)
    message(FATAL_ERROR "${reljef_prefix}: cannot be written, an install prefix that can be was expected")
  endif()
]] ALL_COMPONENTS)

if(RELJEF_PROGRAMS)
  install(TARGETS reljef COMPONENT programs)
endif()
if(RELJEF_PROGRAMS OR RELJEF_BENCH)
  install(TARGETS reljef-mesh-import COMPONENT programs DESTINATION ${CMAKE_INSTALL_LIBEXECDIR}/reljef)
endif()
if(RELJEF_BENCH)
  install(TARGETS reljef-bench COMPONENT programs)
endif()
# What programs load. Those of others find it beside the static libraries: reljefConfig.cmake names
# the folder to them.
install(TARGETS reljef_pictures LIBRARY DESTINATION ${CMAKE_INSTALL_LIBEXECDIR}/reljef COMPONENT programs)
set(reljef_parts_dir ${CMAKE_INSTALL_LIBDIR}/reljef)
install(TARGETS reljef_pictures LIBRARY DESTINATION ${reljef_parts_dir} COMPONENT library)

# Written by the manual targets of app and bench.
install(DIRECTORY ${PROJECT_BINARY_DIR}/share/man DESTINATION ${CMAKE_INSTALL_DATADIR}
  COMPONENT programs)
install(DIRECTORY ${PROJECT_BINARY_DIR}/share/bash-completion ${PROJECT_BINARY_DIR}/share/zsh
  DESTINATION ${CMAKE_INSTALL_DATADIR} COMPONENT programs)

# Headers keep their paths from the root of the project: they are included with the same words.
install(TARGETS ${reljef_library} EXPORT reljefTargets
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}/reljef COMPONENT library
  FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/reljef COMPONENT library)
set(reljef_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/reljef)
install(EXPORT reljefTargets NAMESPACE reljef:: DESTINATION ${reljef_package_dir} COMPONENT library)
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/reljefConfig.cmake.in
  ${PROJECT_BINARY_DIR}/reljefConfig.cmake INSTALL_DESTINATION ${reljef_package_dir} PATH_VARS reljef_parts_dir)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/reljefConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/reljefConfig.cmake ${PROJECT_BINARY_DIR}/reljefConfigVersion.cmake
  DESTINATION ${reljef_package_dir} COMPONENT library)

install(FILES README.md ARCHITECTURE.md CHANGELOG.md SECURITY.md LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR}
  COMPONENT docs)
install(FILES docs/findings.md docs/irrlicht.md docs/scene_files.md DESTINATION ${CMAKE_INSTALL_DOCDIR}/docs COMPONENT docs)
install(DIRECTORY docs/techniques docs/pictures DESTINATION ${CMAKE_INSTALL_DOCDIR}/docs
  COMPONENT docs FILES_MATCHING PATTERN "*.md" PATTERN "*.jpg" PATTERN "*.png" PATTERN "*.svg")
install(DIRECTORY terrains/pictures DESTINATION ${CMAKE_INSTALL_DOCDIR}/terrains COMPONENT docs)
install(FILES terrains/example_dem.toml terrains/example_tiles.toml
  DESTINATION ${CMAKE_INSTALL_DOCDIR}/terrains COMPONENT docs)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT "The reljef developers")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY ${PROJECT_DESCRIPTION})
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL programs library docs)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_NAME reljef)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_RECOMMENDS
  "fonts-open-sans | fonts-dejavu-core, libosmesa6, libegl1, libgl1-mesa-dri, ffmpeg, reljef-doc")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME libreljef-dev)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_DEPENDS
  "libglm-dev, libfmt-dev, libgdal-dev, libpng-dev, libexpat1-dev, libcurl4-openssl-dev | libcurl-ssl-dev, libglfw3-dev, libtomlplusplus-dev, libgeographiclib-dev, libhwy-dev, libembree-dev, libmeshoptimizer-dev")
set(CPACK_DEBIAN_DOCS_PACKAGE_NAME reljef-doc)
set(CPACK_DEBIAN_DOCS_PACKAGE_SECTION doc)
include(CPack)
cpack_add_component(programs DESCRIPTION "The programs reljef and reljef-bench")
cpack_add_component(library DESCRIPTION "Headers, static libraries and the CMake package")
cpack_add_component(docs DESCRIPTION "README, architecture and the pages of the techniques")
