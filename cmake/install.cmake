# What `cmake --install` puts where. Everything finds everything else from where it is itself, so that the tree can be moved.
# Components: command, library, development, documentation, and for Debian python; cmake/packages.cmake makes a package of each.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(LIMNER_CONFIG_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/limner)
set(made ${PROJECT_BINARY_DIR}/install)

# --- libraries ---
install(TARGETS limner EXPORT limner-targets
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library NAMELINK_COMPONENT development
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development
        INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
if(TARGET limner_step)
  install(TARGETS limner_step LIBRARY DESTINATION ${LIMNER_MODULE_FOLDER} COMPONENT step)
endif()
install(EXPORT limner-targets NAMESPACE limner:: DESTINATION ${LIMNER_CONFIG_DIR} COMPONENT development)
if(TARGET limner_static)
  set_target_properties(limner_static PROPERTIES EXPORT_NAME static)
  install(TARGETS limner_static EXPORT limner-static-targets
          ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
  install(EXPORT limner-static-targets NAMESPACE limner:: DESTINATION ${LIMNER_CONFIG_DIR} COMPONENT development)
endif()
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/limner DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development
        FILES_MATCHING PATTERN *.h PATTERN *.hpp)

# --- CMake package ---
if(BUILD_SHARED_LIBS)
  set(LIMNER_IS_SHARED ON)
else()
  set(LIMNER_IS_SHARED OFF)
endif()
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/limner-config.cmake.in ${made}/limner-config.cmake
                              INSTALL_DESTINATION ${LIMNER_CONFIG_DIR} NO_SET_AND_CHECK_MACRO)
# Until 1.0 the minor version is what can break programs.
write_basic_package_version_file(${made}/limner-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${made}/limner-config.cmake ${made}/limner-config-version.cmake DESTINATION ${LIMNER_CONFIG_DIR} COMPONENT development)

# --- pkg-config ---
# How to come from the folder of .pc files to the prefix.
if(IS_ABSOLUTE ${CMAKE_INSTALL_LIBDIR})
  set(LIMNER_PC_PREFIX ${CMAKE_INSTALL_PREFIX})
else()
  file(RELATIVE_PATH up /x/${CMAKE_INSTALL_LIBDIR}/pkgconfig /x)
  string(REGEX REPLACE "/$" "" up ${up})
  set(LIMNER_PC_PREFIX "\${pcfiledir}/${up}")
endif()
# function(limner_pc_path output path): as it is when absolute, else below the prefix.
function(limner_pc_path output path)
  if(IS_ABSOLUTE ${path})
    set(${output} ${path} PARENT_SCOPE)
  else()
    set(${output} "\${prefix}/${path}" PARENT_SCOPE)
  endif()
endfunction()
limner_pc_path(LIMNER_PC_LIBDIR ${CMAKE_INSTALL_LIBDIR})
limner_pc_path(LIMNER_PC_INCLUDEDIR ${CMAKE_INSTALL_INCLUDEDIR})
set(modules ${LIMNER_MODULES})
list(TRANSFORM modules REPLACE ".*=" "")
list(JOIN modules ", " modules)
list(JOIN LIMNER_PLAIN_LIBRARIES " " plain)
# A shared library has its libraries with it; only who links the static one names them.
set(LIMNER_PC_NOTE "")
set(LIMNER_PC_LIB -llimner)
if(BUILD_SHARED_LIBS)
  set(LIMNER_PC_REQUIRES "Requires.private: ${modules}\nLibs.private: ${plain}")
else()
  set(LIMNER_PC_REQUIRES "Requires: ${modules}")
  string(APPEND LIMNER_PC_LIB " ${plain}")
endif()
configure_file(${PROJECT_SOURCE_DIR}/cmake/limner.pc.in ${made}/limner.pc @ONLY)
install(FILES ${made}/limner.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)
if(TARGET limner_static)
  # Beside a shared library of the same name the linker takes that one, unless it is told the file.
  set(LIMNER_PC_NOTE ", linked into the program")
  set(LIMNER_PC_LIB "-l:liblimner.a ${plain}")
  set(LIMNER_PC_REQUIRES "Requires: ${modules}")
  configure_file(${PROJECT_SOURCE_DIR}/cmake/limner.pc.in ${made}/limner-static.pc @ONLY)
  install(FILES ${made}/limner-static.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)
endif()

# --- the command ---
if(LIMNER_COMMAND AND NOT LIMNER_FUZZ)
  # The library is looked for from where the command is, except where the system finds it by itself.
  if(BUILD_SHARED_LIBS AND NOT CMAKE_INSTALL_FULL_LIBDIR IN_LIST CMAKE_C_IMPLICIT_LINK_DIRECTORIES)
    file(RELATIVE_PATH up ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_LIBDIR})
    set_target_properties(limner_command PROPERTIES INSTALL_RPATH $ORIGIN/${up})
  endif()
  install(TARGETS limner_command RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT command)
  list(GET LIMNER_COMPLETIONS 0 bash)
  list(GET LIMNER_COMPLETIONS 1 zsh)
  list(GET LIMNER_COMPLETIONS 2 fish)
  if(LIMNER_DEBIAN)
    set(zsh_folder zsh/vendor-completions)
  else()
    set(zsh_folder zsh/site-functions)
  endif()
  install(FILES ${bash} DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME limner COMPONENT command)
  install(FILES ${zsh} DESTINATION ${CMAKE_INSTALL_DATADIR}/${zsh_folder} COMPONENT command)
  install(FILES ${fish} DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d COMPONENT command)
  foreach(page IN LISTS LIMNER_MANUALS)
    string(REGEX REPLACE ".*[.]" "" section ${page})
    if(LIMNER_DEBIAN)
      set(page ${page}.gz)
    endif()
    install(FILES ${page} DESTINATION ${CMAKE_INSTALL_MANDIR}/man${section} COMPONENT command)
  endforeach()
endif()

# --- documentation ---
set(folder ${CMAKE_INSTALL_DOCDIR})
if(LIMNER_DEBIAN)
  set(folder ${CMAKE_INSTALL_DATADIR}/doc/limner-doc)
  find_program(LIMNER_GZIP gzip REQUIRED)
  configure_file(${PROJECT_SOURCE_DIR}/CHANGELOG.md ${made}/changelog COPYONLY)
  execute_process(COMMAND ${LIMNER_GZIP} -9nkf ${made}/changelog COMMAND_ERROR_IS_FATAL ANY)
  set(changes ${made}/changelog.gz)
else()
  set(changes ${PROJECT_SOURCE_DIR}/CHANGELOG.md)
  install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${folder} COMPONENT library)
endif()
install(FILES ${PROJECT_SOURCE_DIR}/README.md ${PROJECT_SOURCE_DIR}/SECURITY.md ${changes}
        DESTINATION ${folder} COMPONENT documentation)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/docs DESTINATION ${folder} COMPONENT documentation PATTERN make_images EXCLUDE)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/examples DESTINATION ${folder} COMPONENT documentation PATTERN CMakeLists.txt EXCLUDE)

# --- the Python package, which pip installs elsewhere ---
if(LIMNER_DEBIAN)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/bindings/python/limner DESTINATION lib/python3/dist-packages COMPONENT python
          FILES_MATCHING PATTERN *.py PATTERN py.typed PATTERN __pycache__ EXCLUDE)
  install(FILES ${PROJECT_SOURCE_DIR}/bindings/python/README.md DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/python3-limner COMPONENT python)
endif()

# --- the viewer ---
if(TARGET limner_viewer)
  if(TARGET limner_command)
    get_target_property(rpath limner_command INSTALL_RPATH)
    if(rpath)
      set_target_properties(limner_viewer PROPERTIES INSTALL_RPATH "${rpath}")
    endif()
  endif()
  set(viewer ${PROJECT_SOURCE_DIR}/packaging/viewer)
  install(TARGETS limner_viewer RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT viewer)
  install(FILES ${viewer}/io.github.limner.Viewer.desktop DESTINATION ${CMAKE_INSTALL_DATADIR}/applications COMPONENT viewer)
  install(FILES ${viewer}/io.github.limner.Viewer.svg DESTINATION ${CMAKE_INSTALL_DATADIR}/icons/hicolor/scalable/apps COMPONENT viewer)
  install(FILES ${viewer}/io.github.limner.Viewer.metainfo.xml DESTINATION ${CMAKE_INSTALL_DATADIR}/metainfo COMPONENT viewer)
  if(TARGET translations)
    install(DIRECTORY ${PROJECT_BINARY_DIR}/locale DESTINATION ${CMAKE_INSTALL_DATADIR} COMPONENT viewer)
  endif()
  install(FILES ${viewer}/limner.thumbnailer DESTINATION ${CMAKE_INSTALL_DATADIR}/thumbnailers COMPONENT viewer)
endif()

# --- what Debian wants in each package ---
if(LIMNER_DEBIAN)
  execute_process(COMMAND date -u -R -d ${LIMNER_DATE} OUTPUT_VARIABLE LIMNER_DATE_LONG OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
  configure_file(${PROJECT_SOURCE_DIR}/packaging/debian/changelog.in ${made}/changelog.Debian @ONLY)
  execute_process(COMMAND ${LIMNER_GZIP} -9nkf ${made}/changelog.Debian COMMAND_ERROR_IS_FATAL ANY)
  set(packages command=limner library=liblimner${LIMNER_ABI} development=liblimner-dev documentation=limner-doc python=python3-limner)
  if(TARGET limner_viewer)
    list(APPEND packages viewer=limner-viewer)
    # Its manual page is that of the command `limner view`.
    file(WRITE ${made}/limner-viewer.1 ".so man1/limner-view.1\n")
    execute_process(COMMAND ${LIMNER_GZIP} -9nkf ${made}/limner-viewer.1 COMMAND_ERROR_IS_FATAL ANY)
    install(FILES ${made}/limner-viewer.1.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT viewer)
  endif()
  foreach(pair IN LISTS packages)
    string(REGEX REPLACE "=.*" "" component ${pair})
    string(REGEX REPLACE ".*=" "" package ${pair})
    install(FILES ${PROJECT_SOURCE_DIR}/packaging/debian/copyright ${made}/changelog.Debian.gz
            DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${package} COMPONENT ${component})
    set(LIMNER_PACKAGE ${package})
    configure_file(${PROJECT_SOURCE_DIR}/packaging/debian/${component}.lintian-overrides.in ${made}/lintian/${package} @ONLY)
    install(FILES ${made}/lintian/${package} DESTINATION ${CMAKE_INSTALL_DATADIR}/lintian/overrides COMPONENT ${component})
  endforeach()
endif()
