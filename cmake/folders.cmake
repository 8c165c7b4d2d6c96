# One object library a folder of src/. The order is that of docs/ARCHITECTURE.md, lowest first; tools/check_layers.c holds
# the includes against it.
include(${CMAKE_CURRENT_LIST_DIR}/embed.cmake)

set(LIMNER_FOLDERS base fence scene sheet technique gpu construct csg_tree pose behaviour cut field stroke_texture contact csg light halftone marks stroke info import export film layer lines surface perturb compose motion finish look plan annotate stage trace solids depict draft frame vector draw api)

# What one folder alone sees of libraries; all see the first.
set(limner_all EPOXY JANSSON PNG JPEG WEBP ZLIB DEFLATE ASSIMP GLU)
set(limner_stroke_texture_sees XML)
set(limner_import_sees XML)
set(limner_export_sees CAIRO PANGO)
set(limner_construct_sees GEOS QHULL FREETYPE FONTCONFIG HARFBUZZ)
set(limner_fence_sees SECCOMP)
set(limner_film_sees WEBPMUX)

set(LIMNER_OBJECTS "")
foreach(folder IN LISTS LIMNER_FOLDERS)
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/${folder}/*.c)
  if(sources)
    add_library(limner_${folder} OBJECT ${sources})
    target_include_directories(limner_${folder} PUBLIC ${PROJECT_SOURCE_DIR}/include ${PROJECT_SOURCE_DIR}/src)
    foreach(name IN LISTS limner_all limner_${folder}_sees)
      if(LIMNER_${name}_FOUND)
        target_link_libraries(limner_${folder} PRIVATE PkgConfig::LIMNER_${name})
      endif()
    endforeach()
    list(APPEND LIMNER_OBJECTS $<TARGET_OBJECTS:limner_${folder}>)
  endif()
endforeach()
# Lines take longest of what has no GPU. Neither changes a result: nobody asks for errno or traps of arithmetic.
target_compile_options(limner_stroke PRIVATE -fno-math-errno -fno-trapping-math)
if(NOT LIMNER_SANITIZE AND NOT LIMNER_FUZZ)
  target_compile_options(limner_stroke PRIVATE $<$<CONFIG:Release,RelWithDebInfo>:-O3>)
endif()
if(LIMNER_SECCOMP_FOUND)
  target_compile_definitions(limner_fence PRIVATE LIMNER_HAVE_SECCOMP)
endif()
if(LIMNER_WEBPMUX_FOUND)
  target_compile_definitions(limner_film PRIVATE LIMNER_HAVE_WEBPMUX)
endif()

# The one C++ file, with its own warning flags.
if(LIMNER_DRACO)
  target_compile_definitions(limner_import PRIVATE LIMNER_HAVE_DRACO)
  add_library(limner_draco OBJECT ${PROJECT_SOURCE_DIR}/src/import/draco_decode.cpp)
  set_target_properties(limner_draco PROPERTIES CXX_STANDARD 17 CXX_VISIBILITY_PRESET hidden COMPILE_OPTIONS "-Wall;-Wextra")
  target_include_directories(limner_draco PRIVATE ${PROJECT_SOURCE_DIR}/include ${PROJECT_SOURCE_DIR}/src)
  target_include_directories(limner_draco SYSTEM PRIVATE ${DRACO_INCLUDE})
  if(LIMNER_SANITIZE)
    target_compile_options(limner_draco PRIVATE -fsanitize=address,undefined -fno-omit-frame-pointer)
  endif()
  list(APPEND LIMNER_OBJECTS $<TARGET_OBJECTS:limner_draco>)
endif()

# A module, not a part of the library (src/import/step_library.c).
if(LIMNER_STEP)
  include(GNUInstallDirs)
  set(LIMNER_MODULE_FOLDER ${CMAKE_INSTALL_LIBDIR}/limner)
  target_compile_definitions(limner_import PRIVATE LIMNER_MODULE_FOLDER="${CMAKE_INSTALL_FULL_LIBDIR}/limner")
  add_library(limner_step MODULE ${PROJECT_SOURCE_DIR}/src/import/step_module.cpp ${PROJECT_SOURCE_DIR}/src/import/step_file.cpp
                             ${PROJECT_SOURCE_DIR}/src/import/iges_file.cpp)
  set_target_properties(limner_step PROPERTIES PREFIX "" OUTPUT_NAME limner-step CXX_STANDARD 17 CXX_VISIBILITY_PRESET hidden
                        COMPILE_OPTIONS "-Wall;-Wextra" LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR})
  target_include_directories(limner_step PRIVATE ${PROJECT_SOURCE_DIR}/src)
  target_include_directories(limner_step SYSTEM PRIVATE ${OCCT_INCLUDE})
  target_link_libraries(limner_step PRIVATE ${OCCT_LIBRARIES})
  target_link_options(limner_step PRIVATE LINKER:--as-needed)
  if(LIMNER_SANITIZE)
    target_compile_options(limner_step PRIVATE -fsanitize=address,undefined -fno-omit-frame-pointer)
  endif()
endif()

# Shaders and looks travel inside the library.
file(GLOB_RECURSE shaders CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR}/src ${PROJECT_SOURCE_DIR}/src/*.frag
     ${PROJECT_SOURCE_DIR}/src/*.vert ${PROJECT_SOURCE_DIR}/src/*.glsl ${PROJECT_SOURCE_DIR}/src/*.comp)
embed_files(${PROJECT_BINARY_DIR}/embedded_shaders.c embedded_shaders ${PROJECT_SOURCE_DIR}/src "${shaders}")
file(GLOB looks CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR}/looks ${PROJECT_SOURCE_DIR}/looks/*.json)
embed_files(${PROJECT_BINARY_DIR}/embedded_looks.c embedded_looks ${PROJECT_SOURCE_DIR}/looks "${looks}")
add_library(limner_embedded OBJECT ${PROJECT_BINARY_DIR}/embedded_shaders.c ${PROJECT_BINARY_DIR}/embedded_looks.c)
target_include_directories(limner_embedded PRIVATE ${PROJECT_SOURCE_DIR}/include ${PROJECT_SOURCE_DIR}/src)
list(APPEND LIMNER_OBJECTS $<TARGET_OBJECTS:limner_embedded>)

# The same objects with every symbol in reach, for unit tests.
add_library(limner_inside INTERFACE)
target_sources(limner_inside INTERFACE ${LIMNER_OBJECTS})
target_include_directories(limner_inside INTERFACE ${PROJECT_SOURCE_DIR}/include ${PROJECT_SOURCE_DIR}/src)
target_link_libraries(limner_inside INTERFACE ${LIMNER_LIBRARIES})
