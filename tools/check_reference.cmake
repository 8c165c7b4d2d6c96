# Is docs/reference/looks.md what `limner looks --markdown` prints?
execute_process(COMMAND ${LIMNER} looks --markdown OUTPUT_VARIABLE made RESULT_VARIABLE status)
if(NOT status EQUAL 0)
  message(FATAL_ERROR "${LIMNER} looks --markdown failed: ${status}")
endif()
file(READ ${PAGE} committed)
if(NOT made STREQUAL committed)
  message(FATAL_ERROR "${PAGE} is not current; make it anew: cmake --build --preset dev --target reference")
endif()
