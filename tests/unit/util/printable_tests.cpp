// Text that acts on a terminal is never printed unchanged.

#include "util/printable.h"

#include <gtest/gtest.h>

#include "util/diagnostics.h"

namespace alhazen::impl::test {

namespace {

TEST(Printable, LeavesTextOfEveryScript) {
  for (const char* text : {"", "scene.pbrt:3:1: a word", "Löwe, Ворона, 獅子, \xf0\x9f\xa6\x81", "C:\\scene"})
    EXPECT_EQ(printable(text), text);
}

TEST(Printable, EscapesWhatATerminalActsUpon) {
  const std::pair<std::string, std::string> cases[] = {
      {"\x1b[31mred", "\\x1b[31mred"},
      {"\x1b]0;title\x07", "\\x1b]0;title\\x07"},
      {std::string("a\0b", 3), "a\\x00b"},
      {"a\nb\tc\rd\x7f", "a\\nb\\tc\\x0dd\\x7f"},
      {"\xc2\x9b"
       "31m",
       "\\u009b31m"},  // CSI as one C1 character
      {"\x9b"
       "31m",
       "\\x9b31m"},  // and as a byte of ISO 8859-1
      {"\xe2\x80\xae"
       "gnp.exe",
       "\\u202egnp.exe"},  // right-to-left override
      {"\xe2\x81\xa6"
       "x\xe2\x81\xa9",
       "\\u2066x\\u2069"},
      {"\xe2\x80\xa8", "\\u2028"},
      {"\xef\xbb\xbf", "\\ufeff"},
      {"\xf3\xa0\x80\x81", "\\U000e0001"},
  };
  for (const auto& [text, shown] : cases) {
    EXPECT_EQ(printable(text), shown);
    EXPECT_EQ(printable(printable(text)), shown);
  }
}

TEST(Printable, EscapesBytesThatAreNotUtf8) {
  const std::pair<std::string, std::string> cases[] = {
      {"\xff\xfe", "\\xff\\xfe"},
      {"\xc3", "\\xc3"},
      {"\xc3(", "\\xc3("},
      {"\xc0\x9b", "\\xc0\\x9b"},  // an overlong encoding of an escape
      {"\xe0\x80\x9b", "\\xe0\\x80\\x9b"},
      {"\xed\xa0\x80", "\\xed\\xa0\\x80"},
      {"\xf5\x80\x80\x80", "\\xf5\\x80\\x80\\x80"},
  };
  for (const auto& [text, shown] : cases) EXPECT_EQ(printable(text), shown);
}

TEST(Printable, LinesAndColumnsAreKept) {
  EXPECT_EQ(printable_lines("a\x1b\nb"), "a\\x1b\nb");
  size_t columns = 0;
  EXPECT_EQ(printable_columns("\t\xc3\xa9\x1b\xff"
                              "x",
                              columns),
            " \xc3\xa9??x");
  EXPECT_EQ(columns, 5u);
}

TEST(Printable, ErrorsAndWarningsAre) {
  const SourceLocation where{"evil\x1b[2J\n.pbrt", 1, 2};
  EXPECT_STREQ(InputError(where, "name \x1b]0;x\x07", "1 | \x9b\n  | ^").what(),
               "evil\\x1b[2J\\n.pbrt:1:2: name \\x1b]0;x\\x07\n1 | \\x9b\n  | ^");
  EXPECT_STREQ(InputError("a\nb").what(), "a\\nb");
  EXPECT_STREQ(RenderError("cannot write \x1b.exr").what(), "cannot write \\x1b.exr");
  Diagnostics diagnostics;
  diagnostics.warn(where, "\x1b");
  EXPECT_EQ(diagnostics.warnings()[0].to_string(), "evil\\x1b[2J\\n.pbrt:1:2: \\x1b");
}

}  // namespace

}  // namespace alhazen::impl::test
