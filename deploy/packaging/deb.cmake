# `cpack -G DEB` (deploy/package): two packages, the vehicle's and the one that guidance software is built with.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME fathom)
set(CPACK_PACKAGE_VENDOR fathom)
set(CPACK_PACKAGE_CONTACT "fathom developers <fathom@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "Navigation as services on a vehicle network")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL fathom client)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_FATHOM_PACKAGE_NAME fathom)
set(CPACK_DEBIAN_FATHOM_PACKAGE_SECTION science)
set(CPACK_DEBIAN_FATHOM_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_FATHOM_PACKAGE_DEPENDS systemd)
set(CPACK_DEBIAN_FATHOM_DESCRIPTION "Navigation as services on a vehicle network
 Bridges from instruments to DDS, the estimator, the monitor, and their systemd units.")
set(CPACK_DEBIAN_FATHOM_PACKAGE_CONTROL_EXTRA ${CMAKE_CURRENT_BINARY_DIR}/conffiles
    ${CMAKE_CURRENT_SOURCE_DIR}/postinst ${CMAKE_CURRENT_SOURCE_DIR}/prerm)
set(CPACK_DEBIAN_FATHOM_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_CLIENT_PACKAGE_NAME fathom-client-dev)
set(CPACK_DEBIAN_CLIENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_CLIENT_PACKAGE_DEPENDS "libfastrtps-dev, libfastcdr-dev, libssl-dev, libtinyxml2-dev")
set(CPACK_DEBIAN_CLIENT_DESCRIPTION "What guidance software needs to receive fathom's navigation state
 Library, headers, CMake package and QoS profiles.")

# The configuration is the vehicle's: dpkg asks before it replaces what was changed. It goes below the prefix as
# everything does; with /usr, which is the package's, that is /etc (GNU coding standards). The prefix is known at
# installation only.
file(GLOB configurations ${PROJECT_SOURCE_DIR}/deploy/config/*.json)
install(CODE "
  set(etc \"\${CMAKE_INSTALL_PREFIX}/etc\")
  if(CMAKE_INSTALL_PREFIX MATCHES \"^/usr/?\$\")
    set(etc /etc)
  endif()
  file(INSTALL DESTINATION \"\${etc}/fathom\" TYPE FILE FILES ${configurations})" COMPONENT fathom)
set(conffiles "")
foreach(file ${configurations})
  get_filename_component(name ${file} NAME)
  string(APPEND conffiles "/etc/fathom/${name}\n")
endforeach()
file(GENERATE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/conffiles CONTENT "${conffiles}")
include(CPack)
