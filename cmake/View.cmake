# `alhazen view`: a library of the program and its tests. Its server needs headers of Boost (Beast and Asio) and none of its
# libraries; without them all else is built, and the server says what it lacks. Sets ALHAZEN_WITH_VIEW_SERVER.

find_path(ALHAZEN_BOOST_INCLUDE_DIR boost/beast/websocket.hpp)
mark_as_advanced(ALHAZEN_BOOST_INCLUDE_DIR)
set(ALHAZEN_WITH_VIEW_SERVER OFF)
if(ALHAZEN_BOOST_INCLUDE_DIR)
  file(STRINGS ${ALHAZEN_BOOST_INCLUDE_DIR}/boost/version.hpp boost_version REGEX "^#define BOOST_VERSION ")
  string(REGEX MATCH "[0-9]+" boost_version "${boost_version}")
  if(boost_version GREATER_EQUAL 107400)
    set(ALHAZEN_WITH_VIEW_SERVER ON)
  endif()
endif()
if(NOT ALHAZEN_WITH_VIEW_SERVER)
  message(STATUS "The server of alhazen view is off: install libboost-dev (1.74 or later)")
endif()

# The page, of one file.
set(page ${CMAKE_CURRENT_BINARY_DIR}/page_html.cpp)
file(GLOB page_files CONFIGURE_DEPENDS
     ${PROJECT_SOURCE_DIR}/src/view/page/*.html ${PROJECT_SOURCE_DIR}/src/view/page/*.css
     ${PROJECT_SOURCE_DIR}/src/view/page/*.js)
add_custom_command(OUTPUT ${page}
  COMMAND ${CMAKE_COMMAND} -DFOLDER=${PROJECT_SOURCE_DIR}/src/view/page -DOUTPUT=${page}
          -P ${PROJECT_SOURCE_DIR}/cmake/EmbedPage.cmake
  DEPENDS ${page_files} ${PROJECT_SOURCE_DIR}/cmake/EmbedPage.cmake VERBATIM COMMENT "Embedding the page of alhazen view")

file(GLOB view_sources CONFIGURE_DEPENDS
     ${PROJECT_SOURCE_DIR}/src/view/*.cpp ${PROJECT_SOURCE_DIR}/src/view/server/*.cpp)
set(absent page_server)
if(ALHAZEN_WITH_VIEW_SERVER)
  set(absent page_server_absent)
  # Most of its time is that of Beast's templates.
  set_source_files_properties(${PROJECT_SOURCE_DIR}/src/view/page_server.cpp PROPERTIES COMPILE_OPTIONS -O1)
endif()
list(FILTER view_sources EXCLUDE REGEX "/view/${absent}\\.cpp$")
add_library(alhazen_view STATIC ${view_sources} ${page})
target_include_directories(alhazen_view PRIVATE ${PROJECT_SOURCE_DIR}/src)
if(ALHAZEN_WITH_VIEW_SERVER)
  target_include_directories(alhazen_view SYSTEM PRIVATE ${ALHAZEN_BOOST_INCLUDE_DIR})
endif()
target_link_libraries(alhazen_view
  PUBLIC alhazen PRIVATE alhazen_options Threads::Threads ZLIB::ZLIB nlohmann_json::nlohmann_json fmt::fmt)
