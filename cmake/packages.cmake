# Debian packages of the components: `cmake --preset package && cmake --build --preset package` (tools/package does both) writes them into
# build/package. tools/package_check tries them in a bare system.

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME limner)
set(CPACK_PACKAGE_VENDOR "Limner")
set(CPACK_PACKAGE_CONTACT "${LIMNER_MAINTAINER}")
set(CPACK_PACKAGING_INSTALL_PREFIX ${CMAKE_INSTALL_PREFIX})
set(CPACK_COMPONENTS_ALL command library development documentation python)
if(TARGET limner_viewer)
  list(APPEND CPACK_COMPONENTS_ALL viewer)
endif()
if(TARGET limner_step)
  list(APPEND CPACK_COMPONENTS_ALL step)
endif()
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PACKAGE_RELEASE ${LIMNER_REVISION})
set(CPACK_DEBIAN_PACKAGE_SOURCE limner)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS_POLICY ">=")
set(CPACK_DEBIAN_ENABLE_COMPONENT_DEPENDS ON)

# Whoever installs the command gets its library, whatever dpkg-shlibdeps finds.
set(CPACK_COMPONENT_COMMAND_DEPENDS library)
set(CPACK_COMPONENT_DEVELOPMENT_DEPENDS library)
set(CPACK_COMPONENT_PYTHON_DEPENDS library)

set(CPACK_DEBIAN_COMMAND_PACKAGE_NAME limner)
set(CPACK_DEBIAN_COMMAND_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_COMMAND_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR})
set(CPACK_DEBIAN_COMMAND_PACKAGE_SUGGESTS "ffmpeg, gdal-bin, limner-step, openscad, limner-doc")
set(CPACK_COMPONENT_COMMAND_DESCRIPTION "draw 3D models the way people draw
Outlines and hatching, blueprints, sketches, engravings and cartoons of
glTF, STL, OBJ, PLY and OpenSCAD models, as pictures, as vectors (SVG, PDF
and DXF) and as films. It needs no display, and no graphics card.
.
This package has the command.")

set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME liblimner${LIMNER_ABI})
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SHLIBDEPS ON)
# OpenGL is found at run time, so that it is not among what is linked.
set(CPACK_DEBIAN_LIBRARY_PACKAGE_DEPENDS "libegl1, libopengl0, libgl1-mesa-dri")
# Texts that name no font are set in it.
set(CPACK_DEBIAN_LIBRARY_PACKAGE_RECOMMENDS fonts-liberation)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_CONTROL_EXTRA ${PROJECT_SOURCE_DIR}/packaging/debian/triggers)
set(CPACK_COMPONENT_LIBRARY_DESCRIPTION "draw 3D models the way people draw (library)
Outlines and hatching, blueprints, sketches, engravings and cartoons of
3D models, as pictures, vectors and films, into memory or files.
.
This package has the shared library.")

# On its own, since it brings OpenCASCADE with it.
set(CPACK_COMPONENT_STEP_DEPENDS library)
set(CPACK_DEBIAN_STEP_PACKAGE_NAME limner-step)
set(CPACK_DEBIAN_STEP_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_STEP_PACKAGE_SHLIBDEPS ON)
set(CPACK_COMPONENT_STEP_DESCRIPTION "draw 3D models the way people draw (STEP files)
What liblimner reads STEP files with: OpenCASCADE, in a process of its own.")

set(CPACK_COMPONENT_VIEWER_DEPENDS command)
set(CPACK_DEBIAN_VIEWER_PACKAGE_NAME limner-viewer)
set(CPACK_DEBIAN_VIEWER_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_VIEWER_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_VIEWER_PACKAGE_RECOMMENDS adwaita-icon-theme)
set(CPACK_COMPONENT_VIEWER_DESCRIPTION "draw 3D models the way people draw (viewer)
Outlines and hatching, blueprints, sketches, engravings and cartoons of
3D models: turn them, try looks, cut sections, play animations, and export
pictures, vector drawings and films.
.
This package has the window behind `limner view`.")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME liblimner-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "draw 3D models the way people draw (development files)
Outlines and hatching, blueprints, sketches, engravings and cartoons of
3D models, as pictures, vectors and films, into memory or files.
.
This package has the headers, the static library and the files for
pkg-config and CMake.")

set(CPACK_DEBIAN_DOCUMENTATION_PACKAGE_NAME limner-doc)
set(CPACK_DEBIAN_DOCUMENTATION_PACKAGE_SECTION doc)
set(CPACK_DEBIAN_DOCUMENTATION_PACKAGE_ARCHITECTURE all)
set(CPACK_COMPONENT_DOCUMENTATION_DESCRIPTION "draw 3D models the way people draw (documentation)
Outlines and hatching, blueprints, sketches, engravings and cartoons of
3D models, as pictures, vectors and films.
.
This package has guides, the reference of looks and files, theory, and
example models with the programs that made them.")

set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-limner)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3:any (>= 3.9)")
set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "python3-numpy, limner-doc")
set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA ${PROJECT_SOURCE_DIR}/packaging/debian/python/postinst
    ${PROJECT_SOURCE_DIR}/packaging/debian/python/prerm)
set(CPACK_COMPONENT_PYTHON_DESCRIPTION "draw 3D models the way people draw (Python)
Outlines and hatching, blueprints, sketches, engravings and cartoons of
3D models and of meshes in memory, as pictures that NumPy and notebooks
show, and as vectors.
.
This package has the Python module limner.")

# The static library, and pkg-config for either, take the development packages of all that Limner is linked with: those that have its modules here.
set(files "")
foreach(pair IN LISTS LIMNER_MODULES)
  string(REGEX REPLACE ".*=" "" module ${pair})
  execute_process(COMMAND ${PKG_CONFIG_EXECUTABLE} --variable=pcfiledir ${module} OUTPUT_VARIABLE where OUTPUT_STRIP_TRAILING_WHITESPACE)
  list(APPEND files ${where}/${module}.pc)
endforeach()
list(APPEND files ${MESHOPTIMIZER_LIBRARY})
if(LIMNER_DRACO)
  execute_process(COMMAND ${CMAKE_CXX_COMPILER} -print-file-name=libstdc++.so OUTPUT_VARIABLE where OUTPUT_STRIP_TRAILING_WHITESPACE)
  cmake_path(NORMAL_PATH where)
  list(APPEND files ${DRACO_LIBRARY} ${where})
endif()
execute_process(COMMAND dpkg-query -S ${files} OUTPUT_VARIABLE owners COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "(^|\n)[a-z0-9.+-]+" owners "${owners}")
list(TRANSFORM owners STRIP)
list(REMOVE_DUPLICATES owners)
list(SORT owners)
list(JOIN owners ", " owners)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "${owners}")

include(CPack)
add_custom_target(package_check COMMAND ${PROJECT_SOURCE_DIR}/tools/package_check USES_TERMINAL VERBATIM)
