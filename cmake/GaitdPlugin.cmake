# gaitd_plugin(LAYER VARIANT ADAPTER [LIBRARIES...] [COMPONENT NAME]): the shared library of one plugin
# variant, at lib/gaitd/plugins/LAYER/VARIANT.so below the build tree. No unique symbols and no lazy
# binding, so that the library can be retired and never resolves a symbol inside a tick.
function(gaitd_plugin layer variant adapter)
  cmake_parse_arguments(PLUGIN "" "COMPONENT" "" ${ARGN})
  set(target plugin_${layer}_${variant})
  add_library(${target} MODULE ${adapter})
  target_link_libraries(${target} PRIVATE gaitd::interfaces ${PLUGIN_UNPARSED_ARGUMENTS})
  target_compile_options(${target} PRIVATE -fno-gnu-unique -fvisibility=hidden)
  target_link_options(${target} PRIVATE -Wl,-z,now -Wl,--no-undefined)
  set_target_properties(${target} PROPERTIES
    PREFIX "" OUTPUT_NAME ${variant}
    LIBRARY_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/lib/gaitd/plugins/${layer}")
  set(destination LIBRARY DESTINATION lib/gaitd/plugins/${layer})
  if(PLUGIN_COMPONENT)
    list(APPEND destination COMPONENT ${PLUGIN_COMPONENT})
  endif()
  install(TARGETS ${target} ${destination})
endfunction()
