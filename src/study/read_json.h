#pragma once

// Reads the JSON files that the program itself has written, but others may have changed, and the text of new ones.

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "files/input_file.h"
#include "util/json_depth.h"

namespace alhazen::impl::study {

/// Reads a file of JSON. Throws InputError, whose message ends with `advice` ("give ..."), if it is malformed or nested
/// deeper than max_json_depth.
template <class Json>
Json read_json(const std::string& path, const std::string& advice) {
  const std::vector<uint8_t> bytes = InputFile(path).read_all();
  const auto check_depth = [&](int depth, typename Json::parse_event_t event, Json&) {
    const bool is_opened = event == Json::parse_event_t::object_start || event == Json::parse_event_t::array_start;
    if (is_opened && depth >= max_json_depth)
      throw InputError({path},
                       "the JSON is nested deeper than " + std::to_string(max_json_depth) + " levels: " + advice);
    return true;
  };
  Json json = Json::parse(bytes.begin(), bytes.end(), check_depth, false);
  if (json.is_discarded()) throw InputError({path}, "this is not JSON: " + advice);
  return json;
}

/// The text of a file. What is not UTF-8, as in a path, is replaced.
template <class Json>
std::string json_text(const Json& json) {
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace alhazen::impl::study
