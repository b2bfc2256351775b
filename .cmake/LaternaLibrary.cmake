# laterna_library(<folder> [LINKS <folder>...] [PUBLIC <target>...] [PRIVATE <target>...])
#
# One folder, one library. LINKS names the Laterna folders that this one may use. Configuring fails where a link names
# a folder that was not added before (so there can be no cycle), and where a source includes a header of a folder that
# it does not link (so `render` and `calib` stay strangers).
function(laterna_library folder)
  cmake_parse_arguments(arg "" "" "LINKS;PUBLIC;PRIVATE" ${ARGN})
  string(REGEX REPLACE ".*/" "" name "${folder}")
  file(GLOB sources CONFIGURE_DEPENDS *.cpp)
  file(GLOB headers CONFIGURE_DEPENDS *.h)
  foreach(link IN LISTS arg_LINKS)
    if(NOT TARGET laterna_${link})
      message(FATAL_ERROR "${folder} links ${link}, which is not defined before it: a cycle, or a wrong order")
    endif()
  endforeach()
  laterna_check_includes("${folder}" "${name};${arg_LINKS}" ${sources} ${headers})

  add_library(laterna_${name} STATIC ${sources} ${headers})
  add_library(laterna::${name} ALIAS laterna_${name})
  set_target_properties(laterna_${name} PROPERTIES EXPORT_NAME ${name})
  target_include_directories(laterna_${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
                             $<INSTALL_INTERFACE:include/laterna>)
  list(TRANSFORM arg_LINKS PREPEND laterna_)
  target_link_libraries(laterna_${name} PUBLIC laterna_options ${arg_LINKS} ${arg_PUBLIC} PRIVATE ${arg_PRIVATE})
  install(TARGETS laterna_${name} EXPORT laterna)
  install(FILES ${headers} DESTINATION include/laterna/${folder})
endfunction()

# Refuses an include of another Laterna folder that is not among the allowed ones.
function(laterna_check_includes folder allowed)
  foreach(file IN LISTS ARGN)
    file(STRINGS "${file}" includes REGEX "^#include \"(sim|render|calib|apps/lab)/")
    foreach(line IN LISTS includes)
      string(REPLACE "apps/" "" used "${line}")
      string(REGEX REPLACE "^#include \"([a-z]+)/.*" "\\1" used "${used}")
      if(NOT used IN_LIST allowed)
        message(FATAL_ERROR "${file}: `${line}`, but ${folder} does not link ${used}")
      endif()
    endforeach()
  endforeach()
endfunction()
