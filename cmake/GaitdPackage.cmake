# What authors of plugins need, in the build tree and installed: the CMake package gaitd (headers,
# static libraries without an ABI promise, gaitd_plugin()), and what `gaitctl plugin new` begins with.
foreach(library interfaces dynamics qp terrain walking json_reader sim)
  if(NOT TARGET gaitd_${library})
    return()
  endif()
  list(APPEND libraries gaitd_${library})
  set_target_properties(gaitd_${library} PROPERTIES EXPORT_NAME ${library})
endforeach()

set(package ${CMAKE_BINARY_DIR}/lib/cmake/gaitd)
file(CONFIGURE OUTPUT ${package}/gaitd-build.cmake CONTENT "set(gaitd_MARCH @GAITD_MARCH@)\n" @ONLY)
foreach(file gaitd-config.cmake GaitdPlugin.cmake)
  configure_file(cmake/${file} ${package}/${file} COPYONLY)
endforeach()
install(TARGETS ${libraries} EXPORT gaitd ARCHIVE DESTINATION lib COMPONENT dev)
export(EXPORT gaitd NAMESPACE gaitd:: FILE ${package}/gaitd-targets.cmake)
install(EXPORT gaitd NAMESPACE gaitd:: DESTINATION lib/cmake/gaitd FILE gaitd-targets.cmake
        COMPONENT dev)
include(CMakePackageConfigHelpers)
write_basic_package_version_file(${package}/gaitd-config-version.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${package}/gaitd-build.cmake ${package}/gaitd-config.cmake
        ${package}/gaitd-config-version.cmake ${package}/GaitdPlugin.cmake
        DESTINATION lib/cmake/gaitd COMPONENT dev)
foreach(folder interfaces dynamics qp terrain walking sim/plant)
  install(DIRECTORY ${folder}/include/gaitd DESTINATION include COMPONENT dev)
endforeach()

set(share ${CMAKE_BINARY_DIR}/share/gaitd)
file(MAKE_DIRECTORY ${share})
if(IS_SYMLINK ${share}/plugin-sources)  # of an earlier version
  file(REMOVE ${share}/plugin-sources)
endif()
file(MAKE_DIRECTORY ${share}/plugin-sources/backend)
foreach(layer state_estimator icp_planner step_adjuster toe_off whole_body_controller task_source)
  file(CREATE_LINK ${PROJECT_SOURCE_DIR}/plugins/${layer} ${share}/plugin-sources/${layer} SYMBOLIC)
endforeach()
file(CREATE_LINK ${PROJECT_SOURCE_DIR}/sim/mujoco ${share}/plugin-sources/backend/mujoco SYMBOLIC)
file(CREATE_LINK ${PROJECT_SOURCE_DIR}/cli/plugin_template ${share}/plugin-template SYMBOLIC)
install(DIRECTORY plugins/ DESTINATION share/gaitd/plugin-sources
        FILES_MATCHING PATTERN "*.h" PATTERN "*.cc" PATTERN test EXCLUDE)
install(DIRECTORY sim/mujoco DESTINATION share/gaitd/plugin-sources/backend
        FILES_MATCHING PATTERN "*.h" PATTERN "*.cc")
install(DIRECTORY cli/plugin_template/ DESTINATION share/gaitd/plugin-template)
