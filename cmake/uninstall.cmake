# cmake -DMANIFEST=.../install_manifest.txt -P uninstall.cmake: removes the files that the last
# install put there, and Roio's own folders when nothing else is left in them. What scripts/install
# put there is for scripts/uninstall.
if(NOT EXISTS "${MANIFEST}")
  message(FATAL_ERROR "${MANIFEST} is not there: nothing has been installed from this build folder")
endif()

file(STRINGS "${MANIFEST}" files)
foreach(file IN LISTS files)
  set(path "$ENV{DESTDIR}${file}")
  if(EXISTS "${path}" OR IS_SYMLINK "${path}")
    message(STATUS "Removing ${path}")
    file(REMOVE "${path}")
  endif()
  get_filename_component(folder "${path}" DIRECTORY)
  while(folder MATCHES "/roio(/|$)")  # up to our own, though it may have folders alone
    list(APPEND folders "${folder}")
    get_filename_component(folder "${folder}" DIRECTORY)
  endwhile()
endforeach()

list(REMOVE_DUPLICATES folders)
list(SORT folders ORDER DESCENDING)  # the innermost first
foreach(folder IN LISTS folders)
  file(GLOB left "${folder}/*")
  if(NOT left)
    file(REMOVE_RECURSE "${folder}")
  endif()
endforeach()
