# Writes OUT: MODULES joined, and STYLE, as texts of C++.
set(script "")
foreach(module ${MODULES})
  file(READ ${module} text)
  string(REGEX REPLACE "\nimport [^\n]*" "" text "\n${text}")
  string(REGEX REPLACE "\nexport " "\n" text "${text}")
  string(APPEND script "${text}")
endforeach()
file(READ ${STYLE} style)
file(WRITE ${OUT} "namespace laterna {
extern const char live_script[], live_style[];
const char live_script[] = R\"live(${script})live\";
const char live_style[] = R\"live(${style})live\";
}  // namespace laterna
")
