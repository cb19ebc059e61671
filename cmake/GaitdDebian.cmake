# Debian packages by CPack: gaitd (programs, plugins, robots, service), gaitd-dev (headers and
# libraries for plugins and whole-body controllers), gaitd-mujoco (the backend mujoco), gaitd-tune (the optimiser of
# gaitctl campaign tune), gaitd-ros2 (the
# bridge to ROS 2), gaitd-unitree (the backend unitree_dds) and python3-gaitd (the Python package).
configure_file(cmake/package/gaitd.pc.in gaitd.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/gaitd.pc DESTINATION lib/pkgconfig COMPONENT dev)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/docs/examples/plugin
        DESTINATION share/doc/gaitd-dev/examples COMPONENT dev)

# ---- gaitd: what belongs to a system and not to a prefix goes into the package only.
function(gaitd_system_files destination)
  install(FILES ${ARGN} DESTINATION ${destination} COMPONENT system EXCLUDE_FROM_ALL)
endfunction()
set(gaitd_etc ${PROJECT_SOURCE_DIR}/etc)
gaitd_system_files(/etc/gaitd ${gaitd_etc}/gaitd.yaml)
gaitd_system_files(/lib/systemd/system ${gaitd_etc}/systemd/gaitd.service)
install(FILES ${gaitd_etc}/systemd/gaitd.sysusers.conf DESTINATION /usr/lib/sysusers.d
        RENAME gaitd.conf COMPONENT system EXCLUDE_FROM_ALL)
install(FILES ${gaitd_etc}/systemd/gaitd.tmpfiles.conf DESTINATION /usr/lib/tmpfiles.d
        RENAME gaitd.conf COMPONENT system EXCLUDE_FROM_ALL)
install(FILES ${gaitd_etc}/systemd/gaitd.rules DESTINATION /usr/lib/udev/rules.d
        RENAME 60-gaitd.rules COMPONENT system EXCLUDE_FROM_ALL)
install(DIRECTORY ${gaitd_etc}/network DESTINATION /usr/share/doc/gaitd/examples COMPONENT system
        EXCLUDE_FROM_ALL)
gaitd_system_files(/usr/share/doc/gaitd ${PROJECT_SOURCE_DIR}/cmake/package/copyright)
install(FILES ${gaitd_etc}/systemd/gaitd.limits.conf DESTINATION /etc/security/limits.d
        RENAME gaitd.conf COMPONENT system EXCLUDE_FROM_ALL)
# The pages that programs and files refer to.
install(DIRECTORY ${PROJECT_SOURCE_DIR}/docs DESTINATION /usr/share/doc/gaitd COMPONENT system EXCLUDE_FROM_ALL
        FILES_MATCHING PATTERN "*.md" PATTERN "*.png" PATTERN "*.svg" PATTERN "examples" EXCLUDE)

# ---- gaitd-ros2
if(TARGET gaitd-ros2)
  install(FILES ${gaitd_etc}/systemd/gaitd-ros2.service DESTINATION /lib/systemd/system
          COMPONENT ros2_system EXCLUDE_FROM_ALL)
  install(FILES ${PROJECT_SOURCE_DIR}/cmake/package/copyright DESTINATION /usr/share/doc/gaitd-ros2
          COMPONENT ros2_system EXCLUDE_FROM_ALL)
endif()

# ---- gaitd-unitree
if(TARGET plugin_backend_unitree_dds)
  install(FILES ${gaitd_etc}/systemd/gaitd-unitree.conf DESTINATION /usr/share/doc/gaitd-unitree/examples
          RENAME unitree.conf COMPONENT unitree_system EXCLUDE_FROM_ALL)
  install(FILES ${PROJECT_SOURCE_DIR}/cmake/package/copyright DESTINATION /usr/share/doc/gaitd-unitree
          COMPONENT unitree_system EXCLUDE_FROM_ALL)
endif()

# ---- python3-gaitd
if(TARGET gaitd_python)
  install(FILES ${PROJECT_SOURCE_DIR}/cmake/package/copyright DESTINATION /usr/share/doc/python3-gaitd
          COMPONENT python_system EXCLUDE_FROM_ALL)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/python/notebooks DESTINATION /usr/share/doc/python3-gaitd/examples
          COMPONENT python_system EXCLUDE_FROM_ALL FILES_MATCHING PATTERN "*.ipynb")
endif()

# cpack packs what is built, it does not build the tests first.
set(CMAKE_SKIP_INSTALL_ALL_DEPENDENCY TRUE)
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME gaitd)
set(CPACK_PACKAGE_VENDOR gaitd)
set(CPACK_PACKAGE_CONTACT "gaitd developers <gaitd@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PACKAGE_DIRECTORY ${CMAKE_BINARY_DIR}/packages)
set(CPACK_COMPONENTS_ALL gaitd system dev)
if(TARGET plugin_backend_mujoco)
  list(APPEND CPACK_COMPONENTS_ALL mujoco)
endif()
if(TARGET gaitd-cma-es)
  list(APPEND CPACK_COMPONENTS_ALL tune)
endif()
if(TARGET gaitd-ros2)
  list(APPEND CPACK_COMPONENTS_ALL ros2 ros2_system)
endif()
if(TARGET plugin_backend_unitree_dds)
  list(APPEND CPACK_COMPONENTS_ALL unitree unitree_system)
endif()
if(TARGET gaitd_python)
  list(APPEND CPACK_COMPONENTS_ALL python python_system)
endif()
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_COMPONENT_GAITD_GROUP gaitd)
set(CPACK_COMPONENT_SYSTEM_GROUP gaitd)
set(CPACK_COMPONENT_DEV_GROUP gaitd-dev)
set(CPACK_COMPONENT_MUJOCO_GROUP gaitd-mujoco)
set(CPACK_COMPONENT_TUNE_GROUP gaitd-tune)
set(CPACK_COMPONENT_ROS2_GROUP gaitd-ros2)
set(CPACK_COMPONENT_ROS2_SYSTEM_GROUP gaitd-ros2)
set(CPACK_COMPONENT_UNITREE_GROUP gaitd-unitree)
set(CPACK_COMPONENT_UNITREE_SYSTEM_GROUP gaitd-unitree)
set(CPACK_COMPONENT_PYTHON_GROUP python3-gaitd)
set(CPACK_COMPONENT_PYTHON_SYSTEM_GROUP python3-gaitd)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_GAITD_PACKAGE_NAME gaitd)
set(CPACK_DEBIAN_GAITD_PACKAGE_SECTION science)
set(CPACK_DEBIAN_GAITD_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_GAITD_PACKAGE_DEPENDS "systemd")
set(CPACK_DEBIAN_GAITD_PACKAGE_RECOMMENDS "can-utils, iproute2")
set(gaitd_scripts ${PROJECT_SOURCE_DIR}/cmake/package)
set(CPACK_DEBIAN_GAITD_PACKAGE_CONTROL_EXTRA
    ${gaitd_scripts}/conffiles ${gaitd_scripts}/postinst ${gaitd_scripts}/prerm
    ${gaitd_scripts}/postrm)
set(CPACK_DEBIAN_GAITD-DEV_PACKAGE_NAME gaitd-dev)
set(CPACK_DEBIAN_GAITD-DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_GAITD-DEV_PACKAGE_DEPENDS
    "gaitd (= ${PROJECT_VERSION}-1), libeigen3-dev, libpng-dev, libyaml-cpp-dev, nlohmann-json3-dev, g++, cmake")
set(CPACK_DEBIAN_GAITD-MUJOCO_PACKAGE_NAME gaitd-mujoco)
set(CPACK_DEBIAN_GAITD-MUJOCO_PACKAGE_SECTION science)
set(CPACK_DEBIAN_GAITD-MUJOCO_DESCRIPTION "MuJoCo as a second physics engine of gaitd")
set(CPACK_DEBIAN_GAITD-MUJOCO_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_GAITD-MUJOCO_PACKAGE_DEPENDS "gaitd (= ${PROJECT_VERSION}-1)")
set(CPACK_DEBIAN_GAITD-TUNE_PACKAGE_NAME gaitd-tune)
set(CPACK_DEBIAN_GAITD-TUNE_PACKAGE_SECTION science)
set(CPACK_DEBIAN_GAITD-TUNE_DESCRIPTION "CMA-ES for gaitctl campaign tune, by pagmo")
set(CPACK_DEBIAN_GAITD-TUNE_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_GAITD-TUNE_PACKAGE_DEPENDS "gaitd (= ${PROJECT_VERSION}-1)")
set(CPACK_DEBIAN_GAITD-ROS2_PACKAGE_NAME gaitd-ros2)
set(CPACK_DEBIAN_GAITD-ROS2_PACKAGE_SECTION science)
set(CPACK_DEBIAN_GAITD-ROS2_DESCRIPTION "gaitd on the topics of ROS 2, over CycloneDDS")
set(CPACK_DEBIAN_GAITD-ROS2_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_GAITD-ROS2_PACKAGE_DEPENDS "gaitd (= ${PROJECT_VERSION}-1)")
set(CPACK_DEBIAN_GAITD-ROS2_PACKAGE_CONTROL_EXTRA
    ${gaitd_scripts}/ros2/postinst ${gaitd_scripts}/ros2/prerm ${gaitd_scripts}/postrm)
set(CPACK_DEBIAN_GAITD-UNITREE_PACKAGE_NAME gaitd-unitree)
set(CPACK_DEBIAN_GAITD-UNITREE_PACKAGE_SECTION science)
set(CPACK_DEBIAN_GAITD-UNITREE_DESCRIPTION "Unitree's humanoids as a backend of gaitd, over CycloneDDS")
set(CPACK_DEBIAN_GAITD-UNITREE_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_GAITD-UNITREE_PACKAGE_DEPENDS "gaitd (= ${PROJECT_VERSION}-1)")
set(CPACK_DEBIAN_PYTHON3-GAITD_PACKAGE_NAME python3-gaitd)
set(CPACK_DEBIAN_PYTHON3-GAITD_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON3-GAITD_DESCRIPTION "gaitd from Python: robots, scenarios, campaigns and logs")
set(CPACK_DEBIAN_PYTHON3-GAITD_PACKAGE_SHLIBDEPS ON)
# The binding is of one version of Python: what Debian calls python3 must be that one.
set(CPACK_DEBIAN_PYTHON3-GAITD_PACKAGE_DEPENDS "gaitd (= ${PROJECT_VERSION}-1), python3-numpy")
if(TARGET gaitd_python)
  math(EXPR next_python "${Python3_VERSION_MINOR} + 1")
  string(PREPEND CPACK_DEBIAN_PYTHON3-GAITD_PACKAGE_DEPENDS
         "python3 (>= 3.${Python3_VERSION_MINOR}), python3 (<< 3.${next_python}), ")
endif()
set(CPACK_DEBIAN_PYTHON3-GAITD_PACKAGE_RECOMMENDS "python3-pandas, python3-matplotlib")
include(CPack)
