# One object library a folder of src/. The order is that of docs/ARCHITECTURE.md, lowest first; tools/check_layers.c holds
# the includes against it.
include(cmake/embed.cmake)

set(LIMNER_FOLDERS base fence scene sheet technique gpu construct csg_tree pose cut field stroke_texture csg info light halftone marks stroke import export film layer lines surface perturb compose motion finish look plan stage solids frame vector draw api)

set(LIMNER_SHAPE_LIBRARIES PkgConfig::GEOS PkgConfig::QHULL PkgConfig::FREETYPE PkgConfig::FONTCONFIG PkgConfig::HARFBUZZ)

add_library(limner SHARED)
foreach(folder IN LISTS LIMNER_FOLDERS)
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/src/${folder}/*.c)
  if(sources)
    add_library(limner_${folder} OBJECT ${sources})
    target_include_directories(limner_${folder} PUBLIC ${CMAKE_SOURCE_DIR}/include ${CMAKE_SOURCE_DIR}/src)
    target_link_libraries(limner_${folder} PRIVATE PkgConfig::EPOXY PkgConfig::JANSSON PkgConfig::PNG PkgConfig::JPEG
                                                   PkgConfig::WEBP PkgConfig::ZLIB PkgConfig::DEFLATE PkgConfig::ASSIMP PkgConfig::GLU)
    # Only what reads drawings sees the XML library.
    if(folder STREQUAL stroke_texture)
      target_link_libraries(limner_${folder} PRIVATE PkgConfig::XML)
    endif()
    if(folder STREQUAL fence AND SECCOMP_FOUND)
      target_compile_definitions(limner_${folder} PRIVATE LIMNER_HAVE_SECCOMP)
      target_link_libraries(limner_${folder} PRIVATE PkgConfig::SECCOMP)
    endif()
    if(folder STREQUAL film AND WEBPMUX_FOUND)
      target_compile_definitions(limner_${folder} PRIVATE LIMNER_HAVE_WEBPMUX)
      target_link_libraries(limner_${folder} PRIVATE PkgConfig::WEBPMUX)
    endif()
    # Only what writes PDF sees the libraries for it.
    if(folder STREQUAL export)
      target_link_libraries(limner_${folder} PRIVATE PkgConfig::CAIRO PkgConfig::PANGO)
    endif()
    # Only what makes shapes sees the libraries for them.
    if(folder STREQUAL construct)
      target_link_libraries(limner_${folder} PRIVATE ${LIMNER_SHAPE_LIBRARIES})
    endif()
    target_link_libraries(limner PRIVATE limner_${folder})
    list(APPEND LIMNER_OBJECTS $<TARGET_OBJECTS:limner_${folder}>)
  endif()
endforeach()

# The one C++ file, with its own warning flags.
if(LIMNER_DRACO)
  target_compile_definitions(limner_import PRIVATE LIMNER_HAVE_DRACO)
  add_library(limner_draco OBJECT ${CMAKE_SOURCE_DIR}/src/import/draco_decode.cpp)
  set_target_properties(limner_draco PROPERTIES CXX_STANDARD 17 CXX_VISIBILITY_PRESET hidden COMPILE_OPTIONS "-Wall;-Wextra")
  target_include_directories(limner_draco PRIVATE ${CMAKE_SOURCE_DIR}/include ${CMAKE_SOURCE_DIR}/src)
  target_include_directories(limner_draco SYSTEM PRIVATE ${DRACO_INCLUDE})
  if(LIMNER_SANITIZE)
    target_compile_options(limner_draco PRIVATE -fsanitize=address,undefined -fno-omit-frame-pointer)
  endif()
  target_link_libraries(limner PRIVATE limner_draco)
  list(APPEND LIMNER_OBJECTS $<TARGET_OBJECTS:limner_draco>)
  set(LIMNER_DRACO_LIBRARIES ${DRACO_LIBRARY} stdc++)
endif()

# Shaders and looks travel inside the library.
file(GLOB_RECURSE shaders CONFIGURE_DEPENDS RELATIVE ${CMAKE_SOURCE_DIR}/src ${CMAKE_SOURCE_DIR}/src/*.frag
     ${CMAKE_SOURCE_DIR}/src/*.vert ${CMAKE_SOURCE_DIR}/src/*.glsl ${CMAKE_SOURCE_DIR}/src/*.comp)
embed_files(${CMAKE_BINARY_DIR}/embedded_shaders.c embedded_shaders ${CMAKE_SOURCE_DIR}/src "${shaders}")
file(GLOB looks CONFIGURE_DEPENDS RELATIVE ${CMAKE_SOURCE_DIR}/looks ${CMAKE_SOURCE_DIR}/looks/*.json)
embed_files(${CMAKE_BINARY_DIR}/embedded_looks.c embedded_looks ${CMAKE_SOURCE_DIR}/looks "${looks}")
add_library(limner_embedded OBJECT ${CMAKE_BINARY_DIR}/embedded_shaders.c ${CMAKE_BINARY_DIR}/embedded_looks.c)
target_include_directories(limner_embedded PRIVATE ${CMAKE_SOURCE_DIR}/include ${CMAKE_SOURCE_DIR}/src)
target_link_libraries(limner PRIVATE limner_embedded)
list(APPEND LIMNER_OBJECTS $<TARGET_OBJECTS:limner_embedded>)

if(SECCOMP_FOUND)
  set(LIMNER_SECCOMP PkgConfig::SECCOMP)
endif()
if(WEBPMUX_FOUND)
  set(LIMNER_WEBPMUX PkgConfig::WEBPMUX)
endif()
set(LIMNER_LIBRARIES ${LIMNER_SECCOMP} ${LIMNER_WEBPMUX} PkgConfig::EPOXY PkgConfig::JANSSON PkgConfig::PNG PkgConfig::JPEG PkgConfig::WEBP PkgConfig::ZLIB PkgConfig::DEFLATE
    PkgConfig::ASSIMP PkgConfig::GLU PkgConfig::XML ${LIMNER_SHAPE_LIBRARIES} PkgConfig::CAIRO PkgConfig::PANGO ${MESHOPTIMIZER_LIBRARY} ${LIMNER_DRACO_LIBRARIES} Threads::Threads m ${CMAKE_DL_LIBS})
target_link_libraries(limner PRIVATE ${LIMNER_LIBRARIES})
target_include_directories(limner PUBLIC ${CMAKE_SOURCE_DIR}/include)
set_target_properties(limner PROPERTIES VERSION ${PROJECT_VERSION} SOVERSION 0)

# The same objects with every symbol in reach, for unit tests.
add_library(limner_inside INTERFACE)
target_sources(limner_inside INTERFACE ${LIMNER_OBJECTS})
target_include_directories(limner_inside INTERFACE ${CMAKE_SOURCE_DIR}/include ${CMAKE_SOURCE_DIR}/src)
target_link_libraries(limner_inside INTERFACE ${LIMNER_LIBRARIES})
