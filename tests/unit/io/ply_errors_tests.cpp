// PLY files that cannot be read: truncated and damaged files, headers that promise too much, and malformed headers and
// rows with their locations.

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <bit>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

#include "io/ply/ply.h"
#include "support/ply_files.h"

namespace alhazen::impl::test {
namespace {

std::string message_of(const std::string& bytes) {
  Diagnostics diagnostics;
  try {
    parse_bytes(bytes, diagnostics);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

std::string read_error(const std::string& path) {
  Diagnostics diagnostics;
  try {
    read_ply(path, diagnostics);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(PlyErrors, FilesThatCannotBeRead) {
  EXPECT_EQ(read_error("no_such.ply"), "no_such.ply: cannot be opened: No such file or directory");
  const std::string folder = std::filesystem::temp_directory_path().string();
  EXPECT_EQ(read_error(folder), folder + ": is a folder; give the name of a file");

  const TemporaryPly file;
  std::string rows;
  for (int i = 0; i < 3000; ++i) rows += std::to_string(i * 7919 % 3001) + " 0 1\n";
  file.write_compressed(ply_header("ascii", "element vertex 3000\n" + xyz) + rows);
  std::filesystem::resize_file(file.path(), std::filesystem::file_size(file.path()) / 2);
  EXPECT_EQ(read_error(file.path()), file.path() + ": the compressed data end early; the file is truncated");

  file.write(std::string("\x1f\x8b\x08\0\0\0\0\0\0\3", 10) + std::string(100, '\xff'));
  EXPECT_TRUE(read_error(file.path()).starts_with(file.path() + ": the compressed data are damaged: "));
  EXPECT_EQ(read_error(file.path()).find("<fd:"), std::string::npos) << read_error(file.path());
}

void expect_early_end(const std::string& bytes) {
  const std::string message = message_of(bytes);
  EXPECT_NE(message.find("the file ends here"), std::string::npos) << message;
}

/// Headers that promise more than any machine can hold, over data of a few bytes.
void read_false_header() {
  const std::string faces = "element face 18446744073709551615\nproperty list uint int vertex_indices\n";
  const std::string many_vertices = "element vertex 4000000000\n" + xyz +
                                    "property float nx\nproperty float ny\nproperty float nz\n"
                                    "property float u\nproperty float v\n" +
                                    faces;
  for (const char* const format : {"ascii", "binary_little_endian"})
    expect_early_end(ply_header(format, many_vertices) + "1 2 3 0 0 1 0 0\n");

  BinaryRows polygon(std::endian::little);
  polygon.add(0.0f).add(0.0f).add(0.0f).add(0xffffffffu).add(0).add(0).add(0);
  expect_early_end(ply_header("binary_little_endian", "element vertex 1\n" + xyz + faces) + polygon.text());

  const TemporaryPly file;
  file.write_compressed(ply_header("binary_big_endian", many_vertices) + "1 2 3 0 0 1 0 0\n");
  Diagnostics diagnostics;
  EXPECT_THROW(read_ply(file.path(), diagnostics), InputError);
}

// The address sanitizer maps memory of its own; GCC and clang indicate its presence differently.
#if defined(__SANITIZE_ADDRESS__)
constexpr bool memory_can_be_limited = false;
#elif defined(__has_feature)
constexpr bool memory_can_be_limited = !__has_feature(address_sanitizer);
#else
constexpr bool memory_can_be_limited = true;
#endif

/// Lets this process map at most `bytes` more than now.
void limit_memory(rlim_t bytes) {
  rlim_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  const rlim_t limit = pages * static_cast<rlim_t>(sysconf(_SC_PAGESIZE)) + bytes;
  const rlimit both{limit, limit};
  setrlimit(RLIMIT_AS, &both);
}

TEST(PlyErrors, HeaderThatLiesTakesNoMemory) {
  read_false_header();
  if (!memory_can_be_limited) return;
  const auto under_limit = [] {
    limit_memory(64u << 20);
    read_false_header();
    std::_Exit(testing::Test::HasFailure() ? 1 : 0);
  };
  EXPECT_EXIT(under_limit(), ::testing::ExitedWithCode(0), "");
}

struct Malformed {
  const char* text;
  const char* place;    ///< the beginning of the message
  const char* keyword;  ///< what it must contain
};

#define XYZ "property float x\nproperty float y\nproperty float z\n"
#define LIST "property list uchar int vertex_indices\n"
#define ASCII "ply\nformat ascii 1.0\n"
#define TRIANGLE ASCII "element vertex 3\n" XYZ "element face 1\n" LIST "end_header\n"

const Malformed malformed_headers[] = {
    {"", "test.ply:1:1: ", "not a PLY file"},
    {"pl", "test.ply:1:1: ", "not a PLY file"},
    {"plyformat ascii 1.0\n", "test.ply:1:1: ", "not a PLY file"},
    {"solid cube\n", "test.ply:1:1: ", "first line must be 'ply'"},
    {"ply\rformat ascii 1.0\rend_header\r", "test.ply:3: ", "no element 'vertex'"},
    {"ply\rformat ascii 1.0\rend_header\n", "test.ply:3:", "the file ends within the header"},
    {"ply\rformat text 1.0\r", "test.ply:2:8: ", "unknown format 'text'"},
    {"ply\nformat ascii 1.0\n", "test.ply:3:1: ", "the file ends within the header"},
    {"ply\nformat ascii 1.0\nelement ver", "test.ply:3:12: ", "the file ends within the header"},
    {"ply\nformat text 1.0\n", "test.ply:2:8: ", "unknown format 'text'"},
    {"ply\nformat ascii 2.0\n", "test.ply:2:14: ", "unknown version '2.0'"},
    {"ply\nformat ascii\n", "test.ply:2:13: ", "ends too early"},
    {"ply\nformat ascii 1.0 x\n", "test.ply:2:18: ", "unexpected 'x'"},
    {ASCII "format ascii 1.0\n", "test.ply:3:1: ", "a second 'format'"},
    {"ply\nelement vertex 1\n" XYZ "end_header\n0 0 0\n", "test.ply:6:1: ", "no line 'format'"},
    {ASCII "elements vertex 1\n", "test.ply:3:1: ", "unknown keyword 'elements'"},
    {ASCII "element vertex\n", "test.ply:3:15: ", "element NAME COUNT"},
    {ASCII "element vertex -1\n", "test.ply:3:16: ", "'-1' is not a count"},
    {ASCII "element vertex 3.5\n", "test.ply:3:16: ", "'3.5' is not a count"},
    {ASCII "element vertex 99999999999999999999\n", "test.ply:3:16: ", "is not a count"},
    {ASCII "element vertex 1\nelement vertex 1\n", "test.ply:4:9: ", "a second element 'vertex'"},
    {ASCII "property float x\n", "test.ply:3:1: ", "before the first element"},
    {ASCII "element vertex 1\nproperty half x\n", "test.ply:4:10: ", "unknown type 'half'"},
    {ASCII "element vertex 1\nproperty float\n", "test.ply:4:15: ", "property TYPE NAME"},
    {ASCII "element face 1\nproperty list uchar int\n", "test.ply:4:24: ", "property list LENGTH_TYPE TYPE NAME"},
    {ASCII "element face 1\nproperty list float int a\n", "test.ply:4:15: ", "integer type"},
    {ASCII "element vertex 1\nproperty float x\n  property int x\n", "test.ply:5:16: ", "a second property 'x'"},
    {ASCII "element vertex 1\nproperty float \x1b[31m\x07 x\n", "test.ply:4:23: ", "unexpected 'x'"},
    {ASCII "end_header\n", "test.ply:3: ", "no element 'vertex'"},
    {ASCII "element vertex 1\nproperty float x\nproperty float z\nend_header\n", "test.ply:3: ", "no property 'y'"},
    {ASCII "element vertex 1\nproperty float x\nproperty float y\nproperty list int int z\nend_header\n",
     "test.ply:3: ", "no property 'z' that is a number"},
    {ASCII "element vertex 4294967295\n" XYZ "end_header\n", "test.ply:3: ", "too many vertices"},
    {ASCII "element vertex 0\n" XYZ "element face 1\nproperty list uchar int corners\nend_header\n",
     "test.ply:7: ", "no list 'vertex_indices'"},
    {ASCII "element vertex 0\n" XYZ "element face 1\nproperty int vertex_indices\nend_header\n",
     "test.ply:7: ", "must be a list"},
    {ASCII "element vertex 0\n" XYZ "element face 1\nproperty list uchar float vertex_index\nend_header\n",
     "test.ply:7: ", "must list integers"},
};

const Malformed malformed_rows[] = {
    {TRIANGLE, "test.ply:10:1: ", "vertex 0: the file ends here; the header promises 3 of element 'vertex'"},
    {TRIANGLE "0 0 0\n1 0 0\n0 1 0\n", "test.ply:13:1: ", "face 0: the file ends here"},
    {TRIANGLE "0 0 0\n1 0\n0 1 0\n", "test.ply:11:4: ", "vertex 1: the line ends where a value of 'z' is expected"},
    {TRIANGLE "0 0 0\n1 0 0 7\n", "test.ply:11:7: ", "vertex 1: there is one value too many"},
    {TRIANGLE "0 0 0\n1 x 0\n", "test.ply:11:3: ", "vertex 1: 'x' is not a number; expected a value of 'y'"},
    {TRIANGLE "0 0 0\n1 0,5 0\n", "test.ply:11:3: ", "'0,5' is not a number"},
    {TRIANGLE "0 0 0\n1 0x10 0\n", "test.ply:11:3: ", "'0x10' is not a number"},
    {TRIANGLE "0 0 0\n1 +-1 0\n", "test.ply:11:3: ", "'+-1' is not a number"},
    {TRIANGLE "0 0 0\n1   nan 0\n", "test.ply:11:5: ", "vertex 1: y is nan; coordinates must be finite"},
    {TRIANGLE "0 0 -inf\n", "test.ply:10:5: ", "vertex 0: z is -inf"},
    {TRIANGLE "1e999 0 0\n", "test.ply:10:1: ", "vertex 0: x is inf"},
    {TRIANGLE "0 0 0\n1 0 0\n0 1 0\n3 0 1\n", "test.ply:13:6: ", "face 0: the line ends"},
    {TRIANGLE "0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n",
     "test.ply:13:7: ", "face 0: vertex index 3 is out of range (the file has 3 vertices)"},
    {TRIANGLE "0 0 0\n1 0 0\n0 1 0\n3 0 -1 2\n", "test.ply:13:5: ", "vertex index -1 is out of range"},
    {TRIANGLE "0 0 0\n1 0 0\n0 1 0\n3 0 1.5 2\n", "test.ply:13:5: ", "'1.5' is not an integer"},
    {TRIANGLE "0 0 0\n1 0 0\n0 1 0\n3 0 1 99999999999999999999\n", "test.ply:13:7: ", "is not an integer"},
    {TRIANGLE "0 0 0\n1 0 0\n0 1 0\n2 0 1\n", "test.ply:13:1: ", "3 vertices or more, this one has 2"},
    {TRIANGLE "0 0 0\n1 0 0\n0 1 0\n-3 0 1 2\n", "test.ply:13:1: ", "a list of -3 values"},
};

void expect_malformed(const Malformed& malformed) {
  const std::string message = message_of(malformed.text);
  EXPECT_TRUE(message.starts_with(malformed.place)) << message << "\nin\n" << malformed.text;
  EXPECT_NE(message.find(malformed.keyword), std::string::npos) << message << "\nin\n" << malformed.text;
  EXPECT_EQ(message.find('\x1b'), std::string::npos) << "control characters must not reach a terminal";
}

TEST(PlyErrors, MalformedHeaders) {
  for (const Malformed& malformed : malformed_headers) expect_malformed(malformed);
  expect_malformed({"ply\ncomment made\nformat bonary 1.0\n", "test.ply:3:8: ", "\n  format bonary 1.0"});
  const std::string endless = message_of("ply\ncomment " + std::string(2 << 20, 'x'));
  EXPECT_NE(endless.find("no 'end_header' within its first MiB"), std::string::npos) << endless;
}

TEST(PlyErrors, MalformedAsciiRows) {
  for (const Malformed& malformed : malformed_rows) expect_malformed(malformed);
  const std::string long_word = TRIANGLE "0 0 " + std::string(5000, '1');
  EXPECT_NE(message_of(long_word).find("too long for a number"), std::string::npos) << message_of(long_word);
}

TEST(PlyErrors, MalformedBinaryRows) {
  const auto message = [](auto&&... values) {
    BinaryRows rows(std::endian::big);
    for (int i = 0; i < 8; ++i) rows.add(0.0f).add(1.0f).add(2.0f);
    for (int i = 0; i < 17; ++i) rows.add<int16_t>(3).add(0).add(1).add(2);
    (rows.add(values), ...);
    const std::string elements =
        "element vertex 8\n" + xyz + "element face 18\nproperty list short int vertex_indices\n";
    return message_of(ply_header("binary_big_endian", elements) + rows.text());
  };
  EXPECT_EQ(message(int16_t{3}, 0, 900, 1),
            "test.ply: face 17: vertex index 900 is out of range (the file has 8 vertices)");
  EXPECT_EQ(message(int16_t{3}, 0, 1, -1),
            "test.ply: face 17: vertex index -1 is out of range (the file has 8 vertices)");
  EXPECT_EQ(message(int16_t{2}, 0, 1), "test.ply: face 17: a face needs 3 vertices or more, this one has 2");
  EXPECT_EQ(message(int16_t{-1}), "test.ply: face 17: a list of -1 values");
  const char* const ends = "test.ply: face 17: the file ends here; the header promises 18 of element 'face'";
  EXPECT_EQ(message(), ends);
  EXPECT_EQ(message(int8_t{0}), ends);
  EXPECT_EQ(message(int16_t{3}, 0, 1), ends);
  EXPECT_EQ(message(int16_t{30000}, 0, 1), ends);

  BinaryRows nan(std::endian::little);
  nan.add(0.0f).add(1.0f).add(std::numeric_limits<float>::quiet_NaN());
  EXPECT_EQ(message_of(ply_header("binary_little_endian", "element vertex 1\n" + xyz) + nan.text()),
            "test.ply: vertex 0: z is nan; coordinates must be finite");
}

}  // namespace
}  // namespace alhazen::impl::test
