# cmake -DBUILD=... -DSOURCE=... -DSCRATCH=... -DPYTHON=... -P run.cmake: installs, configures, builds and runs the outside project;
# with PYTHON, the outside script too.
file(REMOVE_RECURSE ${SCRATCH})
foreach(step IN ITEMS
    "${CMAKE_COMMAND};--install;${BUILD};--prefix;${SCRATCH}/prefix"
    "${CMAKE_COMMAND};-S;${SOURCE};-B;${SCRATCH}/build;-DCMAKE_PREFIX_PATH=${SCRATCH}/prefix;-DCMAKE_BUILD_TYPE=Release"
    "${CMAKE_COMMAND};--build;${SCRATCH}/build"
    "${SCRATCH}/build/outside"
    "${SCRATCH}/prefix/bin/laterna;--version")
  execute_process(COMMAND ${step} RESULT_VARIABLE failed OUTPUT_VARIABLE text ERROR_VARIABLE text)
  if(failed)
    message(FATAL_ERROR "${step}: ${failed}\n${text}")
  endif()
endforeach()
if(PYTHON)
  execute_process(COMMAND ${CMAKE_COMMAND} -E env PYTHONPATH=${SCRATCH}/prefix/lib/python3/dist-packages ${PYTHON} ${SOURCE}/outside.py
                          ${SCRATCH}/prefix RESULT_VARIABLE failed OUTPUT_VARIABLE text ERROR_VARIABLE text)
  if(failed)
    message(FATAL_ERROR "outside.py: ${failed}\n${text}")
  endif()
endif()
