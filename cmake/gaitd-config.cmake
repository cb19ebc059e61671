# What plugins build with: find_package(gaitd), then
#   gaitd_plugin(LAYER VARIANT ADAPTER [LIBRARIES...])   see GaitdPlugin.cmake
#   gaitd::interfaces gaitd::dynamics gaitd::qp gaitd::walking   for layers
#   gaitd::sim                                                   for simulated backends
#   ${gaitd_GAITCTL}   the gaitctl of this gaitd
include(CMakeFindDependencyMacro)
find_dependency(Eigen3 3.4 NO_MODULE)
find_dependency(Threads)
find_dependency(nlohmann_json 3.11)
find_dependency(PNG)
find_dependency(yaml-cpp 0.7)
include(${CMAKE_CURRENT_LIST_DIR}/gaitd-targets.cmake)
include(${CMAKE_CURRENT_LIST_DIR}/GaitdPlugin.cmake)
include(${CMAKE_CURRENT_LIST_DIR}/gaitd-build.cmake)

# The instruction set decides how Eigen aligns: plugins must have the one of the libraries.
set_target_properties(gaitd::interfaces PROPERTIES
  INTERFACE_COMPILE_FEATURES cxx_std_20
  INTERFACE_COMPILE_OPTIONS "-march=${gaitd_MARCH};-fno-gnu-unique;-fvisibility=hidden"
  INTERFACE_POSITION_INDEPENDENT_CODE ON)
get_filename_component(gaitd_PREFIX ${CMAKE_CURRENT_LIST_DIR}/../../.. ABSOLUTE)
set(gaitd_GAITCTL ${gaitd_PREFIX}/bin/gaitctl)
