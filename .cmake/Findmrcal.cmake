# mrcal (Debian: libmrcal-dev) ships neither a pkg-config nor a CMake file. Defines mrcal::mrcal.
find_path(mrcal_INCLUDE_DIR mrcal/mrcal.h)
find_library(mrcal_LIBRARY mrcal)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(mrcal REQUIRED_VARS mrcal_LIBRARY mrcal_INCLUDE_DIR)
if(mrcal_FOUND AND NOT TARGET mrcal::mrcal)
  add_library(mrcal::mrcal UNKNOWN IMPORTED)
  set_target_properties(mrcal::mrcal PROPERTIES IMPORTED_LOCATION "${mrcal_LIBRARY}"
                        INTERFACE_INCLUDE_DIRECTORIES "${mrcal_INCLUDE_DIR}")
endif()
