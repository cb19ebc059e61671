# gaitd_plugin(LAYER VARIANT ADAPTER [LIBRARIES...]): the shared library of one plugin variant, at
# lib/gaitd/plugins/LAYER/VARIANT.so below the build tree. No unique symbols and no lazy binding, so
# that the library can be retired and never resolves a symbol inside a tick.
function(gaitd_plugin layer variant adapter)
  set(target plugin_${layer}_${variant})
  add_library(${target} MODULE ${adapter})
  target_link_libraries(${target} PRIVATE gaitd::interfaces ${ARGN})
  target_compile_options(${target} PRIVATE -fno-gnu-unique -fvisibility=hidden)
  target_link_options(${target} PRIVATE -Wl,-z,now -Wl,--no-undefined)
  set_target_properties(${target} PROPERTIES
    PREFIX "" OUTPUT_NAME ${variant}
    LIBRARY_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/lib/gaitd/plugins/${layer}")
  install(TARGETS ${target} LIBRARY DESTINATION lib/gaitd/plugins/${layer})
endfunction()
