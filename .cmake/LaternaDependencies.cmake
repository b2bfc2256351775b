# What Laterna links, in one place: the build and the installed package's config both read it.
include(CMakeFindDependencyMacro)
list(APPEND CMAKE_MODULE_PATH "${CMAKE_CURRENT_LIST_DIR}")
foreach(package IN ITEMS glm TBB fmt nlohmann_json ZLIB mrcal Eigen3 Ceres CLI11 hwy meshoptimizer yaml-cpp pugixml)
  find_package(${package} REQUIRED)
endforeach()
find_package(embree 3 REQUIRED)
set(CMAKE_MESSAGE_LOG_LEVEL WARNING)  # Imath's config misses, aloud, a Python library that is in a package of its own
find_package(OpenImageIO REQUIRED)
unset(CMAKE_MESSAGE_LOG_LEVEL)
find_package(OpenCV 4 REQUIRED COMPONENTS core calib3d imgproc aruco)
find_package(tomlplusplus REQUIRED)
find_package(LibArchive REQUIRED)
find_package(OpenSSL REQUIRED COMPONENTS Crypto)
