# The library itself, out of the objects of all folders: `limner`, shared unless BUILD_SHARED_LIBS is off, and `limner_static` beside a shared one.

# Whatever links them sees the headers alone.
function(limner_finish target)
  target_include_directories(${target} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>)
  target_link_libraries(${target} PRIVATE ${LIMNER_LIBRARIES})
  # GCC's front end for C links, whatever is inside.
  set_target_properties(${target} PROPERTIES LINKER_LANGUAGE C)
endfunction()

# In the static library one object holds everything, and only lmn_* can be seen from outside: names of functions inside are short and could be
# those of the program. Where that cannot be done (instrumented code, objects of the link-time optimiser) it is a plain archive.
function(limner_add_static target)
  if(LIMNER_SANITIZE OR LIMNER_FUZZ OR CMAKE_INTERPROCEDURAL_OPTIMIZATION OR APPLE OR NOT CMAKE_OBJCOPY)
    add_library(${target} STATIC ${LIMNER_OBJECTS})
  else()
    set(whole ${PROJECT_BINARY_DIR}/limner_whole.o)
    add_custom_command(OUTPUT ${whole}
      COMMAND ${CMAKE_LINKER} -r --force-group-allocation -o ${whole} ${LIMNER_OBJECTS}
      COMMAND ${CMAKE_OBJCOPY} --localize-hidden ${whole}
      DEPENDS ${LIMNER_OBJECTS} COMMAND_EXPAND_LISTS VERBATIM COMMENT "Putting the static library into one object")
    add_library(${target} STATIC ${whole})
  endif()
  set_target_properties(${target} PROPERTIES OUTPUT_NAME limner)
  limner_finish(${target})
endfunction()

if(BUILD_SHARED_LIBS)
  add_library(limner SHARED ${LIMNER_OBJECTS})
  limner_finish(limner)
  set(symbols ${PROJECT_SOURCE_DIR}/cmake/limner.map)
  target_link_options(limner PRIVATE LINKER:--version-script=${symbols})
  set_target_properties(limner PROPERTIES SOVERSION ${LIMNER_ABI} LINK_DEPENDS ${symbols}
                        VERSION ${LIMNER_ABI}.${PROJECT_VERSION_MINOR}.${PROJECT_VERSION_PATCH})
  if(LIMNER_STATIC)
    limner_add_static(limner_static)
    add_library(limner::static ALIAS limner_static)
  endif()
else()
  limner_add_static(limner)
  add_library(limner::static ALIAS limner)
endif()
add_library(limner::limner ALIAS limner)
