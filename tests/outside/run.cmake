# cmake -DBUILD=... -DSOURCE=... -DSCRATCH=... -DPYTHON=... -P run.cmake: installs, configures, builds and runs the outside project, has
# the installed command write a report; with PYTHON, runs the outside script too.
file(REMOVE_RECURSE ${SCRATCH})
foreach(step IN ITEMS
    "${CMAKE_COMMAND};--install;${BUILD};--prefix;${SCRATCH}/prefix"
    "${CMAKE_COMMAND};-S;${SOURCE};-B;${SCRATCH}/build;-DCMAKE_PREFIX_PATH=${SCRATCH}/prefix;-DCMAKE_BUILD_TYPE=Release"
    "${CMAKE_COMMAND};--build;${SCRATCH}/build"
    "${SCRATCH}/build/outside"
    "${SCRATCH}/prefix/bin/laterna;--version"
    "${SCRATCH}/prefix/bin/laterna;report;${SOURCE}/../../data/plan/v_groove.json;-o;${SCRATCH}/report.html")
  execute_process(COMMAND ${step} RESULT_VARIABLE failed OUTPUT_VARIABLE text ERROR_VARIABLE text)
  if(failed)
    message(FATAL_ERROR "${step}: ${failed}\n${text}")
  endif()
endforeach()

# With the installed report.js the page is the whole one, which needs nothing beside it; else it says that its figures are static.
file(READ ${SCRATCH}/report.html page)
set(expected "this Laterna was built without Node")
if(EXISTS ${BUILD}/apps/report/report.js)
  set(expected "<div id=\"report\"></div>")
endif()
string(FIND "${page}" "${expected}" at)
if(at EQUAL -1)
  message(FATAL_ERROR "the installed command's report does not hold: ${expected}")
endif()

if(PYTHON)
  execute_process(COMMAND ${CMAKE_COMMAND} -E env PYTHONPATH=${SCRATCH}/prefix/lib/python3/dist-packages ${PYTHON} ${SOURCE}/outside.py
                          ${SCRATCH}/prefix RESULT_VARIABLE failed OUTPUT_VARIABLE text ERROR_VARIABLE text)
  if(failed)
    message(FATAL_ERROR "outside.py: ${failed}\n${text}")
  endif()
endif()
