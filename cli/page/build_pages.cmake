# Builds the pages: cmake -DNPM= -DSOURCE= -DWORK= -DFOLDER= "-DPAGES=a;b" -P build_pages.cmake
# Without the registry everything but the commands with a page works: that is a warning, not an error.
file(REMOVE_RECURSE ${WORK}/src)  # of files that were removed or have moved
file(MAKE_DIRECTORY ${WORK})
file(COPY ${SOURCE}/ DESTINATION ${WORK})

function(run what)
  execute_process(COMMAND ${CMAKE_COMMAND} -E env CI=true ${NPM} --prefix ${WORK} ${ARGN}
                  RESULT_VARIABLE result OUTPUT_VARIABLE text ERROR_VARIABLE text)
  if(NOT result EQUAL 0)
    message(WARNING "the pages of gaitctl were not built, gaitctl report, view and campaign report will not work: "
                    "${what} failed. Build again when the npm registry can be reached.\n${text}")
    set(failed TRUE PARENT_SCOPE)
  endif()
endfunction()

# Versions and hashes of all packages stand in the lock file. Nothing that a package wants to run is
# run. In the lock file rollup's builds for systems that gaitd is not for are left out.
file(SHA256 ${SOURCE}/package-lock.json wanted)
set(installed "")
if(EXISTS ${WORK}/installed)
  file(READ ${WORK}/installed installed)
endif()
if(NOT installed STREQUAL wanted)
  run("npm ci" ci --ignore-scripts --no-audit --no-fund --loglevel=error)
  if(failed)
    return()
  endif()
  file(WRITE ${WORK}/installed ${wanted})
endif()
foreach(page IN LISTS PAGES)
  run("vite build of ${page}" run --silent build -- --mode ${page} --logLevel warn)
  if(NOT failed)
    file(COPY_FILE ${WORK}/dist/${page}.html ${FOLDER}/${page}.html)
  endif()
endforeach()
