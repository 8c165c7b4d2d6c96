# embed_files(OUTPUT TABLE ROOT FILES): a C file with a table of the files' bytes (base/embedded.h), made anew when one
# of them changes.
function(embed_files output table root files)
  set(paths ${files})
  list(TRANSFORM paths PREPEND ${root}/)
  string(REPLACE ";" "|" joined "${files}")
  add_custom_command(OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} -DOUTPUT=${output} -DTABLE=${table} -DROOT=${root} "-DFILES=${joined}"
            -P ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/embed_run.cmake
    DEPENDS ${paths} ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/embed_run.cmake VERBATIM)
endfunction()
