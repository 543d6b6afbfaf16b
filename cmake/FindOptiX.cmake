# Headers of NVIDIA OptiX 9.0 or later: OptiX_ROOT is the folder that holds include/optix.h. Sets OptiX_FOUND,
# OptiX_INCLUDE_DIR and OptiX_VERSION.

find_path(OptiX_INCLUDE_DIR optix.h PATH_SUFFIXES include)
mark_as_advanced(OptiX_INCLUDE_DIR)
if(OptiX_INCLUDE_DIR)
  file(STRINGS ${OptiX_INCLUDE_DIR}/optix.h number REGEX "#define OPTIX_VERSION ")
  string(REGEX MATCH "[0-9]+" number "${number}")
  math(EXPR major "${number} / 10000")
  math(EXPR minor "${number} % 10000 / 100")
  set(OptiX_VERSION ${major}.${minor})
endif()
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(OptiX REQUIRED_VARS OptiX_INCLUDE_DIR VERSION_VAR OptiX_VERSION)
