# Decoders of compressed meshes in glTF files, where their libraries are. A file that needs a missing one is refused with
# the name of the package.

find_package(draco QUIET CONFIG)
find_package(meshoptimizer QUIET CONFIG)
set(ALHAZEN_WITH_DRACO ${draco_FOUND})
set(ALHAZEN_WITH_MESHOPTIMIZER ${meshoptimizer_FOUND})
if(NOT ALHAZEN_WITH_DRACO)
  message(STATUS "Draco is off: install libdraco-dev to read meshes of glTF files that it compressed")
endif()
if(NOT ALHAZEN_WITH_MESHOPTIMIZER)
  message(STATUS "meshoptimizer is off: install libmeshoptimizer-dev to read meshes of glTF files that it compressed")
endif()

function(alhazen_link_mesh_decoders target)
  if(ALHAZEN_WITH_DRACO)
    target_compile_definitions(${target} PRIVATE ALHAZEN_WITH_DRACO)
    target_link_libraries(${target} PRIVATE draco::draco)
  endif()
  if(ALHAZEN_WITH_MESHOPTIMIZER)
    target_compile_definitions(${target} PRIVATE ALHAZEN_WITH_MESHOPTIMIZER)
    target_link_libraries(${target} PRIVATE meshoptimizer::meshoptimizer)
  endif()
endfunction()
