#pragma once

// Mitsuba scenes in memory.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "io/mitsuba/mitsuba.h"
#include "io/mitsuba/xml.h"

namespace alhazen::impl::test {

/// What a scene became.
struct ParsedMitsuba {
  Scene scene;
  std::vector<std::string> warnings;
};

inline ParsedMitsuba parse_xml_text(const std::string& text, const std::vector<std::string>& definitions = {},
                                    const std::string& folder = {}, const FileSearch& search = {}) {
  Diagnostics diagnostics;
  ReadOptions options;
  options.search = search;
  options.definitions = definitions;
  ParsedMitsuba parsed{parse_mitsuba(text, "s.xml", folder, options, diagnostics), {}};
  for (const Diagnostics::Warning& warning : diagnostics.warnings()) parsed.warnings.push_back(warning.to_string());
  return parsed;
}

/// The content of a scene, with a sensor of a small image, a light and the elements `content` from line 2 on.
inline std::string with_sensor(const std::string& content) {
  return "<scene version=\"3.0.0\">\n" + content +
         "\n<sensor type=\"perspective\"><film type=\"hdrfilm\"><integer name=\"width\" value=\"8\"/>"
         "<integer name=\"height\" value=\"8\"/></film></sensor><emitter type=\"constant\"/></scene>";
}

inline ParsedMitsuba parse_content(const std::string& content) { return parse_xml_text(with_sensor(content)); }

/// The first line of the error, without the excerpt.
inline std::string mitsuba_error(const std::string& text, const std::vector<std::string>& definitions = {},
                                 const std::string& folder = {}, const FileSearch& search = {}) {
  try {
    parse_xml_text(text, definitions, folder, search);
  } catch (const InputError& error) {
    const std::string message = error.what();
    return message.substr(0, message.find('\n'));
  }
  return "no error";
}

inline std::string content_error(const std::string& content) { return mitsuba_error(with_sensor(content)); }

/// Tests that need the XML parser, which not every build has.
class MitsubaTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!mitsuba::reads_xml()) GTEST_SKIP() << "this build has no Expat";
  }
};

}  // namespace alhazen::impl::test
