# `cpack -G DEB` (deploy/package): three packages, the vehicle's, the one that guidance software is built with, and the one
# that guidance software in Python imports.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME fathom)
set(CPACK_PACKAGE_VENDOR fathom)
set(CPACK_PACKAGE_CONTACT "fathom developers <fathom@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "Navigation as services on a vehicle network")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL fathom client)
if(FATHOM_PYTHON)
  list(APPEND CPACK_COMPONENTS_ALL python)
endif()
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_FATHOM_PACKAGE_NAME fathom)
set(CPACK_DEBIAN_FATHOM_PACKAGE_SECTION science)
set(CPACK_DEBIAN_FATHOM_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_FATHOM_PACKAGE_DEPENDS systemd)
set(CPACK_DEBIAN_FATHOM_DESCRIPTION "Navigation as services on a vehicle network
 Bridges from instruments to DDS, the estimator, the monitor, and their systemd units.")
set(CPACK_DEBIAN_FATHOM_PACKAGE_CONTROL_EXTRA ${CMAKE_CURRENT_SOURCE_DIR}/postinst ${CMAKE_CURRENT_SOURCE_DIR}/prerm
    ${CMAKE_CURRENT_SOURCE_DIR}/postrm)
set(CPACK_DEBIAN_FATHOM_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_CLIENT_PACKAGE_NAME fathom-client-dev)
set(CPACK_DEBIAN_CLIENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_CLIENT_PACKAGE_DEPENDS "libfastrtps-dev, libfastcdr-dev, libssl-dev, libtinyxml2-dev")
set(CPACK_DEBIAN_CLIENT_DESCRIPTION "What guidance software needs to receive fathom's navigation state
 Library, headers, CMake package and QoS profiles.")
set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-fathom)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "${FATHOM_PYTHON_DEPENDS}")
set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS python3-numpy)
set(CPACK_DEBIAN_PYTHON_DESCRIPTION "fathom's navigation state for guidance software in Python
 Package fathom: states, health, alarms, routes, with the QoS profiles.")
set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA ${CMAKE_CURRENT_SOURCE_DIR}/python/postinst ${CMAKE_CURRENT_SOURCE_DIR}/python/prerm)
set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_STRICT_PERMISSION ON)

# The configuration is the vehicle's: the package brings an example, which postinst puts in place where nothing is yet. A
# file of the package would come with an upgrade as well, beneath the files of single services that a vehicle has so far.
# Without the package it goes below the prefix as everything does, and with /usr to /etc (GNU coding standards). The prefix
# is known at installation only. CPack stages what it packs in a folder of its own, which is named so.
install(CODE "
  set(etc \"\${CMAKE_INSTALL_PREFIX}/etc\")
  if(CMAKE_INSTALL_PREFIX MATCHES \"^/usr/?\$\")
    set(etc /etc)
  endif()
  file(GLOB there \"\$ENV{DESTDIR}\${etc}/fathom/*.json\")
  if(NOT there AND NOT \"\$ENV{DESTDIR}\" MATCHES \"_CPack_Packages\")
    file(INSTALL DESTINATION \"\${etc}/fathom\" TYPE FILE FILES ${PROJECT_SOURCE_DIR}/deploy/config/vehicle.json)
  endif()" COMPONENT fathom)
include(CPack)
