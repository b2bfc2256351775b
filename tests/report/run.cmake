# Runs page_test.mjs, or says what is missing for it.
if(NOT NODE OR NOT CHROMIUM)
  message("skipped: Node or Chromium is missing")
elseif(NOT EXISTS ${REPORT}/report.js OR NOT EXISTS ${REPORT}/node_modules/playwright-core)
  message("skipped: the build made no report.js, for it could not get its npm packages")
else()
  execute_process(COMMAND ${NODE} ${SOURCE}/tests/report/page_test.mjs ${LATERNA} ${REPORT}/node_modules ${CHROMIUM} ${SOURCE} ${SCRATCH}
                  RESULT_VARIABLE failed)
  if(NOT failed EQUAL 0)
    message(FATAL_ERROR "the page is not right; screenshots are in ${SCRATCH}")
  endif()
endif()
