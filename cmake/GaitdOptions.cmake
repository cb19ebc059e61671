# Build-wide settings: language, warnings, instruction set, sanitizers, packages.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_CXX_VISIBILITY_PRESET hidden)
set(CMAKE_VISIBILITY_INLINES_HIDDEN ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/bin")

if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()

option(GAITD_BUILD_TESTS "Build the tests" ON)
option(GAITD_BUILD_BENCHMARKS "Build the benchmarks" ON)
set(GAITD_MARCH "x86-64-v3" CACHE STRING "Instruction set that the build is for (-march)")
set(GAITD_SANITIZE "" CACHE STRING "Sanitizers, e.g. address,undefined or thread")

# Debian's Simbody has data members under #ifndef NDEBUG in its headers: with -DNDEBUG its ABI does
# not match its library. So no target of ours defines NDEBUG; Eigen's checks go by their own switch.
string(REPLACE "-DNDEBUG" "" CMAKE_CXX_FLAGS_RELEASE "${CMAKE_CXX_FLAGS_RELEASE}")
string(REPLACE "-DNDEBUG" "" CMAKE_CXX_FLAGS_RELWITHDEBINFO "${CMAKE_CXX_FLAGS_RELWITHDEBINFO}")
if(CMAKE_BUILD_TYPE STREQUAL "Release")
  add_compile_definitions(EIGEN_NO_DEBUG)
endif()
add_compile_options(-Wall -Wextra -Wno-unused-parameter -march=${GAITD_MARCH})
if(GAITD_SANITIZE)
  add_compile_options(-fsanitize=${GAITD_SANITIZE} -fno-omit-frame-pointer)
  if(GAITD_SANITIZE MATCHES "undefined")
    # What AddressSanitizer sees too; on Eigen's expressions they double the time to compile.
    add_compile_options(-fno-sanitize=null,alignment,object-size,vptr)
  endif()
  add_link_options(-fsanitize=${GAITD_SANITIZE})
endif()

find_package(Threads REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
if(GAITD_BUILD_TESTS)
  enable_testing()
  find_package(GTest REQUIRED)
  include(GoogleTest)
endif()
if(GAITD_BUILD_BENCHMARKS)
  find_package(benchmark REQUIRED)
endif()

# gaitd_never_hot(TARGET): what no tick, simulation or long computation waits for. Most of its code is the
# library headers that it includes; -O3 of that takes half of the time to compile.
function(gaitd_never_hot target)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
endfunction()

# gaitd_in_plugins(TARGET): a static library that ends up in plugins. A library with unique symbols is never
# unloaded; clang makes none and does not know the option.
function(gaitd_in_plugins target)
  target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-fno-gnu-unique>)
endfunction()

# Reading the headers of GoogleTest, Eigen, JSON and the standard library takes half of the time of a test's file:
# they are read once for all. An executable, since the headers of a library are compiled for other addresses.
if(GAITD_BUILD_TESTS)
  file(WRITE ${CMAKE_BINARY_DIR}/test_headers.cc "int main() {}\n")
  add_executable(gaitd_test_headers EXCLUDE_FROM_ALL ${CMAKE_BINARY_DIR}/test_headers.cc)
  find_package(nlohmann_json 3.11 REQUIRED)
  target_link_libraries(gaitd_test_headers PRIVATE Eigen3::Eigen GTest::gtest nlohmann_json::nlohmann_json)
  gaitd_never_hot(gaitd_test_headers)
  target_precompile_headers(gaitd_test_headers PRIVATE
    <gtest/gtest.h> <Eigen/Dense> <nlohmann/json.hpp> <algorithm> <array> <chrono> <cmath> <deque> <filesystem>
    <fstream> <functional> <limits> <map> <memory> <optional> <random> <set> <sstream> <string> <thread>
    <unordered_map> <vector>)
endif()

# gaitd_test(NAME SOURCES... [LIBRARIES...] [OPTIMIZED]): a GoogleTest program registered with CTest. OPTIMIZED: it
# measures times.
function(gaitd_test name)
  if(NOT GAITD_BUILD_TESTS)
    return()
  endif()
  cmake_parse_arguments(ARG "OPTIMIZED" "TIMEOUT" "SOURCES;LIBRARIES" ${ARGN})
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 600)
  endif()
  if(GAITD_SANITIZE)
    math(EXPR ARG_TIMEOUT "10 * ${ARG_TIMEOUT}")
  endif()
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE ${ARG_LIBRARIES} GTest::gtest GTest::gtest_main)
  # Few files at a time: whoever changes one waits for the others.
  set_target_properties(${name} PROPERTIES
    RUNTIME_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/tests" UNITY_BUILD_BATCH_SIZE 4)
  if(ARG_OPTIMIZED)
    set_target_properties(${name} PROPERTIES UNITY_BUILD OFF)
  else()
    gaitd_never_hot(${name})
    # GCC 12 finds them in its own std::string where little is inlined.
    target_compile_options(${name} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-array-bounds>)
    if(NOT ARG_SOURCES MATCHES "\\.c(;|$)")
      target_precompile_headers(${name} REUSE_FROM gaitd_test_headers)
    endif()
  endif()
  add_test(NAME ${name} COMMAND ${name})
  set_tests_properties(${name} PROPERTIES TIMEOUT ${ARG_TIMEOUT})
endfunction()
