# What Debian wants of a package beside what is installed elsewhere; CPack runs this on what it has
# gathered, each component in a folder of its own, before it packs.
if(NOT CPACK_GENERATOR STREQUAL "DEB")
  return()
endif()

find_program(gzip gzip REQUIRED)

function(compress)
  foreach(file IN LISTS ARGN)
    execute_process(COMMAND ${gzip} --best --no-name --force ${file} COMMAND_ERROR_IS_FATAL ANY)
  endforeach()
endfunction()

file(READ ${CPACK_ROIO_SOURCE_DIR}/LICENSE license)
string(REGEX MATCH "Copyright[^\n]*" copyright "${license}")
string(REGEX REPLACE "^Copyright (\\([cC]\\) )?" "" copyright "${copyright}")
string(REGEX MATCH "Permission is hereby.*" terms "${license}")
string(STRIP "${terms}" terms)
string(REGEX REPLACE "\n\n" "\n.\n" terms "${terms}")
string(REGEX REPLACE "\n" "\n " terms "${terms}")
string(CONCAT copyright_file
  "Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/\n"
  "Upstream-Name: Roio\n\n"
  "Files: *\nCopyright: ${copyright}\nLicense: Expat\n\n"
  "License: Expat\n ${terms}\n")

file(TIMESTAMP ${CPACK_ROIO_SOURCE_DIR}/CHANGELOG.md date "%a, %d %b %Y %H:%M:%S +0000" UTC)
string(CONCAT debian_changelog
  "roio (${CPACK_PACKAGE_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE}) unstable; urgency=medium\n\n"
  "  * What is new is in changelog.gz.\n\n"
  " -- ${CPACK_PACKAGE_CONTACT}  ${date}\n")

foreach(component IN ITEMS tools development)
  set(share ${CPACK_TEMPORARY_DIRECTORY}/${component}/usr/share)
  string(TOUPPER ${component} upper)
  set(doc ${share}/doc/${CPACK_DEBIAN_${upper}_PACKAGE_NAME})
  if(NOT EXISTS ${CPACK_TEMPORARY_DIRECTORY}/${component})
    continue()
  endif()
  file(MAKE_DIRECTORY ${doc})
  file(WRITE ${doc}/copyright "${copyright_file}")
  file(REMOVE ${doc}/LICENSE ${doc}/CHANGELOG.md)
  configure_file(${CPACK_ROIO_SOURCE_DIR}/CHANGELOG.md ${doc}/changelog COPYONLY)
  file(WRITE ${doc}/changelog.Debian "${debian_changelog}")
  if(EXISTS ${share}/zsh/site-functions)
    # Debian's zsh looks there for what packages bring.
    file(RENAME ${share}/zsh/site-functions ${share}/zsh/vendor-completions)
  endif()
  file(GLOB pages ${share}/man/man1/*.1)
  compress(${doc}/changelog ${doc}/changelog.Debian ${pages})
  file(GLOB_RECURSE archives ${CPACK_TEMPORARY_DIRECTORY}/${component}/usr/lib/*.a)
  foreach(archive IN LISTS archives)
    execute_process(COMMAND strip --strip-debug --enable-deterministic-archives ${archive}
                    COMMAND_ERROR_IS_FATAL ANY)
  endforeach()
  file(GLOB_RECURSE all LIST_DIRECTORIES true ${CPACK_TEMPORARY_DIRECTORY}/${component}/*)
  foreach(path IN LISTS all)
    if(IS_SYMLINK ${path})
    elseif(IS_DIRECTORY ${path} OR path MATCHES "/bin/")
      file(CHMOD ${path} PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE
           WORLD_READ WORLD_EXECUTE)
    else()
      file(CHMOD ${path} PERMISSIONS OWNER_READ OWNER_WRITE GROUP_READ WORLD_READ)
    endif()
  endforeach()
endforeach()
