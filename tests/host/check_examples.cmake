# Does docs/EMBEDDING.md show the examples as they are?
file(READ ${SOURCE}/docs/EMBEDDING.md page)
foreach(name host_glfw host_offscreen)
  file(READ ${SOURCE}/examples/${name}.c code)
  string(FIND "${page}" "```c\n${code}```" found)
  if(found EQUAL -1)
    message(FATAL_ERROR "docs/EMBEDDING.md does not show examples/${name}.c as it is")
  endif()
endforeach()
