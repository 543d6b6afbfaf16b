# Run by CPack when the files of packages are in place: Debian has manual pages and changes compressed, without the time.

file(GLOB_RECURSE documents ${CPACK_TEMPORARY_INSTALL_DIRECTORY}/*)
list(FILTER documents INCLUDE REGEX "/man/man1/[^/]*\\.1$|/changelog\\.Debian$")
foreach(document IN LISTS documents)
  execute_process(COMMAND gzip -9nf ${document} COMMAND_ERROR_IS_FATAL ANY)
endforeach()
