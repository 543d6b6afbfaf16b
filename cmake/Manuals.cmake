# Manual pages and completions for shells, which the program writes itself: they have the options that it has.

set(folder ${PROJECT_BINARY_DIR}/share)
set(page_names alhazen)
foreach(subcommand render view compare devices info study study-report study-tune study-compare completion)
  list(APPEND page_names alhazen-${subcommand})
endforeach()
set(pages)
foreach(name IN LISTS page_names)
  string(REPLACE "alhazen" "" words ${name})
  string(REGEX MATCHALL "[a-z]+" words "${words}")
  set(page ${folder}/man/${name}.1)
  add_custom_command(OUTPUT ${page}
    COMMAND ${CMAKE_COMMAND} -E make_directory ${folder}/man
    COMMAND ${PROJECT_SOURCE_DIR}/scripts/man-page.sh $<TARGET_FILE:alhazen_cli> ${words} > ${page}
    DEPENDS alhazen_cli ${PROJECT_SOURCE_DIR}/scripts/man-page.sh VERBATIM COMMENT "Writing the manual page of ${name}")
  list(APPEND pages ${page})
endforeach()

set(completions)
function(alhazen_completion shell file destination)
  set(script ${folder}/${shell}/${file})
  add_custom_command(OUTPUT ${script}
    COMMAND ${CMAKE_COMMAND} -E make_directory ${folder}/${shell}
    COMMAND alhazen_cli completion ${shell} > ${script}
    DEPENDS alhazen_cli VERBATIM COMMENT "Writing the completion for ${shell}")
  install(FILES ${script} DESTINATION ${CMAKE_INSTALL_DATADIR}/${destination} COMPONENT program)
  set(completions ${completions} ${script} PARENT_SCOPE)
endfunction()
alhazen_completion(bash alhazen bash-completion/completions)
# Zsh looks into this folder of /usr/local, and Debian's also into this one of /usr.
if(CMAKE_INSTALL_PREFIX STREQUAL "/usr")
  alhazen_completion(zsh _alhazen zsh/vendor-completions)
else()
  alhazen_completion(zsh _alhazen zsh/site-functions)
endif()
alhazen_completion(fish alhazen.fish fish/vendor_completions.d)

add_custom_target(alhazen_manuals ALL DEPENDS ${pages} ${completions})
install(FILES ${pages} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program)
