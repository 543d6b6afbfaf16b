# cmake -DFOLDER=FOLDER -DOUTPUT=FILE -P EmbedPage.cmake: the page of alhazen view as a C++ file. In the place of the lines
# <!-- style --> and <!-- script --> of index.html it has all files *.css and *.js, in the order of their names.

cmake_minimum_required(VERSION 3.25)

file(READ ${FOLDER}/index.html page)
foreach(pair "style;css" "script;js")
  list(GET pair 0 element)
  list(GET pair 1 suffix)
  file(GLOB files ${FOLDER}/*.${suffix})
  list(SORT files)
  set(text "")
  foreach(file IN LISTS files)
    file(READ ${file} part)
    string(TOLOWER "${part}" lower)
    string(FIND "${lower}" "</${element}" end)
    if(NOT end EQUAL -1)
      message(FATAL_ERROR "${file} has \"</${element}\", which would end it within the page: write \"<\\/${element}\"")
    endif()
    string(APPEND text "${part}")
  endforeach()
  string(FIND "${page}" "<!-- ${element} -->" place)
  if(place EQUAL -1)
    message(FATAL_ERROR "${FOLDER}/index.html has no line <!-- ${element} -->")
  endif()
  # src/view/server/header_text.h
  string(REPLACE "<!-- ${element} -->" "<${element} nonce=\"NONCE_OF_THIS_ANSWER\">\n${text}</${element}>" page "${page}")
endforeach()
file(WRITE ${OUTPUT}.html "${page}")
file(READ ${OUTPUT}.html bytes HEX)
string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${bytes}")
file(WRITE ${OUTPUT} "#include \"view/page_server.h\"

namespace alhazen::impl {

static const unsigned char page_bytes[] = {${bytes}};

std::string_view page_html() { return {reinterpret_cast<const char*>(page_bytes), sizeof(page_bytes)}; }

}  // namespace alhazen::impl
")
