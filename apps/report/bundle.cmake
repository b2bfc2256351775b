# Makes BUILD/report.js of SOURCE/src. npm runs only where node_modules is not of this very lock file.
function(give_up reason)
  file(REMOVE ${BUILD}/report.js)
  message("laterna: no report page: ${reason}\nlaterna: `laterna report` will write static figures; the next build tries again")
endfunction()

file(SHA256 ${SOURCE}/package-lock.json lock)
set(stamp ${BUILD}/node_modules/.laterna-${lock}-${OMIT})
if(NOT EXISTS ${stamp})
  file(COPY ${SOURCE}/package.json ${SOURCE}/package-lock.json ${SOURCE}/.npmrc DESTINATION ${BUILD})
  set(words ci --loglevel=error --fetch-retries=1 --fetch-retry-mintimeout=1000)
  if(OMIT STREQUAL dev)
    list(APPEND words --omit=dev)
  endif()
  execute_process(COMMAND ${NPM} ${words} WORKING_DIRECTORY ${BUILD} RESULT_VARIABLE failed OUTPUT_VARIABLE said ERROR_VARIABLE said)
  if(NOT failed EQUAL 0)
    give_up("npm ci failed:\n${said}")
    return()
  endif()
  file(TOUCH ${stamp})
endif()

execute_process(
  COMMAND ${CMAKE_COMMAND} -E env NODE_PATH=${BUILD}/node_modules ${BUILD}/node_modules/.bin/esbuild ${SOURCE}/src/main.js --bundle
          --minify --format=iife --target=es2022 --charset=ascii --loader:.css=text --legal-comments=inline --log-level=warning
          --outfile=${BUILD}/report.js
  RESULT_VARIABLE failed OUTPUT_VARIABLE said ERROR_VARIABLE said)
if(NOT failed EQUAL 0)
  give_up("esbuild failed:\n${said}")
endif()
