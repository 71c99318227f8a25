# Installs the library as others find it: find_package(roio), pkg-config, one include folder.
option(ROIO_INSTALL "Make the install target put Roio there" ${PROJECT_IS_TOP_LEVEL})
if(NOT ROIO_INSTALL)
  return()
endif()
include(CMakePackageConfigHelpers)

# Two components, which become packages: tools, as the tools' folders say, and what is not of theirs.
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME development)
set(roio_config_dir ${CMAKE_INSTALL_LIBDIR}/cmake/roio)
set(roio_pkgconfig_dir ${CMAKE_INSTALL_LIBDIR}/pkgconfig)

# --- headers ----------------------------------------------------------------------------------------

# The two include roots become one, so a name may be in one of them only.
file(GLOB_RECURSE core_headers CONFIGURE_DEPENDS
     RELATIVE ${PROJECT_SOURCE_DIR}/libroio/core/include libroio/core/include/*.hpp)
file(GLOB_RECURSE host_headers CONFIGURE_DEPENDS
     RELATIVE ${PROJECT_SOURCE_DIR}/libroio/host/include libroio/host/include/*.hpp)
foreach(header IN LISTS core_headers)
  if(header IN_LIST host_headers)
    message(FATAL_ERROR "${header} is in libroio/core and in libroio/host; one of them needs another name")
  endif()
endforeach()

if(NOT ROIO_BUILD_JSON)
  foreach(header json kind robot robot_json)
    list(APPEND headers_left_out PATTERN roio/${header}.hpp EXCLUDE)
  endforeach()
endif()
install(DIRECTORY libroio/core/include/ libroio/host/include/ TYPE INCLUDE
        FILES_MATCHING PATTERN *.hpp ${headers_left_out})

# --- targets: those that read JSON in exports of their own, so that they may be absent ------------------

install(TARGETS roio_core roio_host EXPORT roio-targets)
install(EXPORT roio-targets NAMESPACE roio:: DESTINATION ${roio_config_dir})
if(ROIO_BUILD_JSON)
  foreach(library IN ITEMS json robot)
    install(TARGETS roio_${library}_library EXPORT roio-${library}-targets)
    install(EXPORT roio-${library}-targets NAMESPACE roio:: DESTINATION ${roio_config_dir})
  endforeach()
endif()

configure_package_config_file(cmake/roio-config.cmake.in roio-config.cmake
                              INSTALL_DESTINATION ${roio_config_dir}
                              NO_SET_AND_CHECK_MACRO)
# Before 1.0 a minor version may change what programs rely on.
write_basic_package_version_file(roio-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/roio-config.cmake
              ${CMAKE_CURRENT_BINARY_DIR}/roio-config-version.cmake
        DESTINATION ${roio_config_dir})

# --- pkg-config: paths relative to the .pc file, so an installed tree can be moved -----------------------

file(RELATIVE_PATH roio_prefix_from_pc /prefix/${roio_pkgconfig_dir} /prefix)
string(REGEX REPLACE "/$" "" roio_prefix_from_pc "${roio_prefix_from_pc}")
set(pc_files roio.pc)
if(BUILD_SHARED_LIBS)
  set(roio_pc_definitions " -DROIO_SHARED")
endif()
if(ROIO_BUILD_JSON)
  list(APPEND pc_files roio-json.pc roio-robot.pc)
endif()
foreach(pc_file IN LISTS pc_files)
  configure_file(cmake/${pc_file}.in ${pc_file} @ONLY)
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/${pc_file} DESTINATION ${roio_pkgconfig_dir})
endforeach()

# --- kinds of boards, and what an editor knows of them and of robots -------------------------------------

if(ROIO_BUILD_JSON)
  set(roio_share_dir ${CMAKE_INSTALL_DATADIR}/roio)
  install(DIRECTORY kinds/ DESTINATION ${roio_share_dir}/kinds COMPONENT tools FILES_MATCHING PATTERN *.kind.json)
  install(DIRECTORY libroio/host/schema/ DESTINATION ${roio_share_dir}/schema COMPONENT tools
          FILES_MATCHING PATTERN *.schema.json)
endif()

# --- and away again ---------------------------------------------------------------------------------

install(FILES LICENSE README.md CHANGELOG.md TYPE DOC COMPONENT tools)
if(PROJECT_IS_TOP_LEVEL)
  add_custom_target(uninstall
    COMMAND ${CMAKE_COMMAND} -DMANIFEST=${CMAKE_CURRENT_BINARY_DIR}/install_manifest.txt
            -P ${CMAKE_CURRENT_SOURCE_DIR}/cmake/uninstall.cmake
    COMMENT "Removing what was installed last" VERBATIM)
endif()
