# npm ci in a folder of the build: cmake -DNPM=npm -DFROM=dir-with-lock-file -DTO=dir -P fetch.cmake
file(MAKE_DIRECTORY ${TO})
foreach(name package.json package-lock.json .npmrc)
  configure_file(${FROM}/${name} ${TO}/${name} COPYONLY)
endforeach()
# Three times: a registry may stumble, and a build should not end for it.
foreach(attempt RANGE 1 3)
  execute_process(COMMAND ${NPM} ci --ignore-scripts --no-audit --no-fund WORKING_DIRECTORY ${TO}
                  RESULT_VARIABLE failed OUTPUT_VARIABLE said ERROR_VARIABLE said)
  if(NOT failed)
    file(TOUCH ${TO}/fetched)
    return()
  endif()
  execute_process(COMMAND ${CMAKE_COMMAND} -E sleep ${attempt})
endforeach()
message(FATAL_ERROR "${said}\nnpm could not fetch what ${FROM}/package-lock.json names. Look for the reason above: "
                    "the machine must reach npm's registry once. Without the operator console: -DFATHOM_CONSOLE=OFF.")
