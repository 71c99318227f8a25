# Writes one fenced block of a document to a file, at configure time, so that what it shows can be
# compiled: the first block of that language that begins with `beginning`, a regular expression.
function(extract_document_block document language beginning output)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${document})
  file(READ ${document} text)
  if(NOT text MATCHES "\n```${language}\n(${beginning}[^`]*)\n```")
    message(FATAL_ERROR "${document} has no ${language} block that begins with \"${beginning}\"")
  endif()
  file(CONFIGURE OUTPUT ${output} CONTENT "${CMAKE_MATCH_1}\n" @ONLY)
endfunction()
