// PLY files: every format and type, skipped data, errors and their locations.

#include "io/ply/ply.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <utility>

#include "io/ply/parse_ply.h"

namespace alhazen::test {
namespace {

Mesh parse(const std::string& bytes, Diagnostics& diagnostics) {
  MemorySource source(bytes);
  return parse_ply(source, "test.ply", diagnostics);
}

Mesh parse(const std::string& bytes) {
  Diagnostics diagnostics;
  const Mesh mesh = parse(bytes, diagnostics);
  EXPECT_TRUE(diagnostics.warnings().empty()) << diagnostics.warnings().front().to_string();
  return mesh;
}

std::string message_of(const std::string& bytes) {
  Diagnostics diagnostics;
  try {
    parse(bytes, diagnostics);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

/// A file that is removed at the end of the test.
class TemporaryFile {
 public:
  TemporaryFile() : path_(std::filesystem::temp_directory_path() / ("ply_test_" + std::to_string(getpid()))) {}
  ~TemporaryFile() { std::filesystem::remove(path_); }
  std::string path() const { return path_.string(); }

  void write(const std::string& bytes) const {
    std::ofstream(path_, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  }
  void write_compressed(const std::string& bytes) const {
    const gzFile file = gzopen(path().c_str(), "wb");
    gzwrite(file, bytes.data(), static_cast<unsigned>(bytes.size()));
    gzclose(file);
  }

 private:
  std::filesystem::path path_;
};

/// Appends values as in binary data.
class Bytes {
 public:
  explicit Bytes(std::endian order) : order_(order) {}

  template <class Value>
  Bytes& add(Value value) {
    std::array<char, sizeof(Value)> bytes;
    std::memcpy(bytes.data(), &value, sizeof value);
    if (order_ != std::endian::native) std::reverse(bytes.begin(), bytes.end());
    text_.append(bytes.data(), bytes.size());
    return *this;
  }
  const std::string& text() const { return text_; }

 private:
  std::endian order_;
  std::string text_;
};

std::string header_of(const std::string& format, const std::string& elements) {
  return "ply\nformat " + format + " 1.0\n" + elements + "end_header\n";
}

const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
const std::string triangle_elements =
    "element vertex 3\n" + xyz + "element face 1\nproperty list uchar int vertex_indices\n";
const std::string triangle_rows = "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

void expect_triangle(const Mesh& mesh) {
  EXPECT_EQ(mesh.positions, (std::vector<Vec3d>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_EQ(mesh.indices, (std::vector<uint32_t>{0, 1, 2}));
}

TEST(Ply, Ascii) {
  const Mesh mesh = parse(header_of("ascii", triangle_elements) + triangle_rows);
  expect_triangle(mesh);
  EXPECT_EQ(mesh.name, "test.ply");
  EXPECT_TRUE(mesh.normals.empty());
  EXPECT_TRUE(mesh.uvs.empty());
}

TEST(Ply, AsciiWithCarriageReturnsBlankLinesAndNoLastLineEnd) {
  std::string text = header_of("ascii", "comment made by hand\nobj_info none\n\n" + triangle_elements) +
                     "0 0 0\n\n  1\t0 0 \n0 +1.0e0 0\n\n3 0 1 2";
  for (size_t at = text.find('\n'); at != text.npos; at = text.find('\n', at + 2)) text.insert(at, "\r");
  expect_triangle(parse(text));
}

template <class Value>
void expect_type(const std::string& type) {
  for (const std::endian order : {std::endian::little, std::endian::big}) {
    Bytes rows(order);
    for (const int value : {0, 1, 2, 3, 4, 5, 6, 7, 127}) rows.add(static_cast<Value>(value));
    rows.add<uint8_t>(3).add<int32_t>(2).add<int32_t>(0).add<int32_t>(1);
    const std::string elements = "element vertex 3\nproperty " + type + " x\nproperty " + type + " y\nproperty " +
                                 type + " z\nelement face 1\nproperty list uchar int vertex_indices\n";
    const std::string format = order == std::endian::little ? "binary_little_endian" : "binary_big_endian";
    const Mesh mesh = parse(header_of(format, elements) + rows.text());
    EXPECT_EQ(mesh.positions, (std::vector<Vec3d>{{0, 1, 2}, {3, 4, 5}, {6, 7, 127}})) << type << " " << format;
    EXPECT_EQ(mesh.indices, (std::vector<uint32_t>{2, 0, 1})) << type << " " << format;
  }
}

TEST(Ply, CoordinatesOfEveryType) {
  for (const char* const name : {"char", "int8"}) expect_type<int8_t>(name);
  for (const char* const name : {"uchar", "uint8"}) expect_type<uint8_t>(name);
  for (const char* const name : {"short", "int16"}) expect_type<int16_t>(name);
  for (const char* const name : {"ushort", "uint16"}) expect_type<uint16_t>(name);
  for (const char* const name : {"int", "int32"}) expect_type<int32_t>(name);
  for (const char* const name : {"uint", "uint32"}) expect_type<uint32_t>(name);
  for (const char* const name : {"float", "float32"}) expect_type<float>(name);
  for (const char* const name : {"double", "float64"}) expect_type<double>(name);
}

template <class Length, class Index>
void expect_list(const std::string& length, const std::string& index) {
  for (const std::endian order : {std::endian::little, std::endian::big}) {
    Bytes rows(order);
    for (int i = 0; i < 12; ++i) rows.add(static_cast<float>(i) + 0.25f);
    rows.add(static_cast<Length>(4));
    for (const int i : {3, 2, 1, 0}) rows.add(static_cast<Index>(i));
    const std::string elements =
        "element vertex 4\n" + xyz + "element face 1\nproperty list " + length + " " + index + " vertex_index\n";
    const std::string format = order == std::endian::little ? "binary_little_endian" : "binary_big_endian";
    const Mesh mesh = parse(header_of(format, elements) + rows.text());
    EXPECT_EQ(mesh.positions.at(1), (Vec3d{3.25, 4.25, 5.25})) << format;
    EXPECT_EQ(mesh.indices, (std::vector<uint32_t>{3, 2, 1, 3, 1, 0})) << length << " " << index << " " << format;
  }
}

TEST(Ply, ListsOfEveryIntegerType) {
  expect_list<int8_t, uint32_t>("char", "uint");
  expect_list<uint8_t, int32_t>("uint8", "int32");
  expect_list<int16_t, uint16_t>("short", "ushort");
  expect_list<uint16_t, int16_t>("uint16", "int16");
  expect_list<int32_t, uint8_t>("int", "uchar");
  expect_list<uint32_t, int8_t>("uint32", "int8");
}

TEST(Ply, NegativeAndLargeValues) {
  Bytes rows(std::endian::big);
  rows.add<int8_t>(-128).add<int16_t>(-32768).add<int32_t>(std::numeric_limits<int32_t>::min());
  rows.add<uint8_t>(3).add<uint32_t>(0).add<uint32_t>(0).add<uint32_t>(0);
  const Mesh mesh = parse(header_of("binary_big_endian",
                                    "element vertex 1\nproperty char x\nproperty short y\nproperty int z\n"
                                    "element face 1\nproperty list uchar uint vertex_indices\n") +
                          rows.text());
  EXPECT_EQ(mesh.positions.at(0), (Vec3d{-128, -32768, -2147483648.0}));
  EXPECT_EQ(mesh.triangle_count(), 1u) << "a triangle of one point is kept";
}

TEST(Ply, AnyOrderAndUnknownPropertiesAndElements) {
  const std::string elements =
      "element material 2\nproperty list uchar float ambient\nproperty int id\n"
      "element face 2\nproperty uchar flags\nproperty list uchar int vertex_indices\nproperty list int double "
      "texcoord\n"
      "element nothing 4000000000\n"
      "element vertex 3\nproperty uchar red\nproperty float t\nproperty float z\nproperty float nz\n"
      "property list uchar int neighbours\nproperty float s\nproperty double x\nproperty float ny\nproperty float y\n"
      "property float nx\n";
  const auto expect = [](const Mesh& mesh) {
    EXPECT_EQ(mesh.positions, (std::vector<Vec3d>{{0.5, 2, 1}, {1.5, 3, 2}, {2.5, 4, 3}}));
    EXPECT_EQ(mesh.normals, (std::vector<Vec3f>{{0, 0, 1}, {0, 1, 0}, {1, 0, 0}}));
    EXPECT_EQ(mesh.uvs, (std::vector<Vec2f>{{0, 0.5f}, {1, 0.5f}, {2, 0.5f}}));
    EXPECT_EQ(mesh.indices, (std::vector<uint32_t>{0, 1, 2, 2, 2, 0}));
  };
  expect(parse(header_of("ascii", elements) +
               "3 0.1 0.2 0.3 7\n0 8\n255 3 0 1 2 2 0.5 0.5\n1 3 2 2 0 0\n"
               "9 0.5 1 1 2 5 6 0 0.5 0 2 0\n9 0.5 2 0 0 1 1.5 1 3 0\n9 0.5 3 0 1 5 2 2.5 0 4 1\n"));

  Bytes rows(std::endian::little);
  rows.add<uint8_t>(3).add(0.1f).add(0.2f).add(0.3f).add<int32_t>(7).add<uint8_t>(0).add<int32_t>(8);
  rows.add<uint8_t>(255).add<uint8_t>(3).add<int32_t>(0).add<int32_t>(1).add<int32_t>(2);
  rows.add<int32_t>(2).add(0.5).add(0.5);
  rows.add<uint8_t>(1).add<uint8_t>(3).add<int32_t>(2).add<int32_t>(2).add<int32_t>(0).add<int32_t>(0);
  for (int i = 0; i < 3; ++i) {
    const float f = static_cast<float>(i);
    rows.add<uint8_t>(9).add(0.5f).add(f + 1).add(i == 0 ? 1.0f : 0.0f);
    rows.add(static_cast<uint8_t>(i));
    for (int k = 0; k < i; ++k) rows.add<int32_t>(k);
    rows.add(f).add(i + 0.5).add(i == 1 ? 1.0f : 0.0f).add(f + 2).add(i == 2 ? 1.0f : 0.0f);
  }
  expect(parse(header_of("binary_little_endian", elements) + rows.text()));
}

TEST(Ply, NamesOfTextureCoordinates) {
  using Names = std::pair<const char*, const char*>;
  for (const auto& [u, v] : {Names{"u", "v"}, {"s", "t"}, {"texture_u", "texture_v"}, {"texture_s", "texture_t"}}) {
    const std::string elements = "element vertex 1\n" + xyz + "property float " + u + "\nproperty float " + v +
                                 "\nelement face 1\nproperty list uchar int vertex_indices\n";
    EXPECT_EQ(parse(header_of("ascii", elements) + "0 0 0 0.25 0.75\n3 0 0 0\n").uvs.at(0), (Vec2f{0.25f, 0.75f}));
  }
}

TEST(Ply, PolygonsAreCutIntoFans) {
  const std::string elements = "element vertex 5\n" + xyz + "element face 2\nproperty list uchar int vertex_indices\n";
  const std::string rows = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n5 4 3 2 1 0\n4 0 1 2 3\n";
  EXPECT_EQ(parse(header_of("ascii", elements) + rows).indices,
            (std::vector<uint32_t>{4, 3, 2, 4, 2, 1, 4, 1, 0, 0, 1, 2, 0, 2, 3}));
}

TEST(Ply, StripsKeepTheirWinding) {
  const std::string elements =
      "element vertex 5\n" + xyz + "element tristrips 1\nproperty list int int vertex_indices\n";
  const std::string rows = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n9 0 1 2 3 4 -1 4 3 2\n";
  EXPECT_EQ(parse(header_of("ascii", elements) + rows).indices,
            (std::vector<uint32_t>{0, 1, 2, 2, 1, 3, 2, 3, 4, 4, 3, 2}));
}

TEST(Ply, NumbersBeyondDoubles) {
  const Mesh mesh =
      parse(header_of("ascii", triangle_elements) + "1e-400 -0.1 1E2\n-1e-999 .5 5.\n1e308 +3 -0\n3 0 1 2");
  EXPECT_EQ(mesh.positions, (std::vector<Vec3d>{{0, -0.1, 100}, {0, 0.5, 5}, {1e308, 3, 0}}));
}

TEST(Ply, FilesPlainAndCompressed) {
  // Larger than the buffer, so that values cross its end.
  constexpr int count = 40000;
  std::string ascii_rows;
  Bytes binary_rows(std::endian::little);
  for (int i = 0; i < count; ++i) {
    ascii_rows += std::to_string(i) + ".5 0 -" + std::to_string(i) + "\n";
    binary_rows.add(static_cast<float>(i) + 0.5f).add(0.0f).add(static_cast<float>(-i));
  }
  for (int i = 2; i < count; ++i) {
    ascii_rows += "3 0 " + std::to_string(i - 1) + " " + std::to_string(i) + "\n";
    binary_rows.add<uint8_t>(3).add(0).add(i - 1).add(i);
  }
  const std::string elements = "element vertex " + std::to_string(count) + "\n" + xyz + "element face " +
                               std::to_string(count - 2) + "\nproperty list uchar int vertex_indices\n";
  const TemporaryFile file;
  for (const std::string& text :
       {header_of("ascii", elements) + ascii_rows, header_of("binary_little_endian", elements) + binary_rows.text()}) {
    for (const bool compressed : {false, true}) {
      compressed ? file.write_compressed(text) : file.write(text);
      Diagnostics diagnostics;
      const Mesh mesh = read_ply(file.path(), diagnostics);
      EXPECT_TRUE(diagnostics.warnings().empty());
      EXPECT_EQ(mesh.name, file.path());
      ASSERT_EQ(mesh.positions.size(), size_t{count});
      ASSERT_EQ(mesh.triangle_count(), size_t{count - 2});
      EXPECT_EQ(mesh.positions[count - 1], (Vec3d{count - 0.5, 0, 1 - count}));
      EXPECT_EQ(mesh.indices.back(), uint32_t{count - 1});
      if (!compressed) {
        EXPECT_EQ(mesh.positions.capacity(), mesh.positions.size());
        EXPECT_EQ(mesh.indices.capacity(), mesh.indices.size());
      }
    }
  }
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

TEST(Ply, FilesThatCannotBeRead) {
  EXPECT_EQ(read_error("no_such.ply"), "no_such.ply: cannot be opened: No such file or directory");
  const std::string folder = std::filesystem::temp_directory_path().string();
  EXPECT_EQ(read_error(folder), folder + ": is a folder; give the name of a file");

  const TemporaryFile file;
  std::string rows;
  for (int i = 0; i < 3000; ++i) rows += std::to_string(i * 7919 % 3001) + " 0 1\n";
  file.write_compressed(header_of("ascii", "element vertex 3000\n" + xyz) + rows);
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
    expect_early_end(header_of(format, many_vertices) + "1 2 3 0 0 1 0 0\n");

  Bytes polygon(std::endian::little);
  polygon.add(0.0f).add(0.0f).add(0.0f).add(0xffffffffu).add(0).add(0).add(0);
  expect_early_end(header_of("binary_little_endian", "element vertex 1\n" + xyz + faces) + polygon.text());

  const TemporaryFile file;
  file.write_compressed(header_of("binary_big_endian", many_vertices) + "1 2 3 0 0 1 0 0\n");
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

TEST(Ply, HeaderThatLiesTakesNoMemory) {
  read_false_header();
  if (!memory_can_be_limited) return;
  const auto under_limit = [] {
    limit_memory(64u << 20);
    read_false_header();
    std::_Exit(testing::Test::HasFailure() ? 1 : 0);
  };
  EXPECT_EXIT(under_limit(), ::testing::ExitedWithCode(0), "");
}

TEST(Ply, Warnings) {
  const auto warning = [](const std::string& text, size_t normals, size_t uvs, size_t triangles) {
    Diagnostics diagnostics;
    const Mesh mesh = parse(text, diagnostics);
    EXPECT_EQ(mesh.normals.size(), normals);
    EXPECT_EQ(mesh.uvs.size(), uvs);
    EXPECT_EQ(mesh.triangle_count(), triangles);
    return diagnostics.warnings().size() == 1 ? diagnostics.warnings()[0].to_string() : "not one warning";
  };
  const std::string normal = "property float nx\nproperty float ny\nproperty float nz\n";
  const std::string faces = "element face 1\nproperty list uchar int vertex_indices\n";

  EXPECT_EQ(warning(header_of("ascii", "element vertex 1\n" + xyz) + "0 0 0\n", 0, 0, 0),
            "test.ply: the mesh has no faces");
  EXPECT_EQ(warning(header_of("ascii", "element vertex 0\n" + xyz + "element face 0\n"), 0, 0, 0),
            "test.ply: the mesh has no faces");
  EXPECT_EQ(warning(header_of("ascii", triangle_elements) + triangle_rows + "\n 3 0 1 2\n", 0, 0, 1),
            "test.ply:15:2: data after the last element are ignored");
  for (const char* const bad : {"0 0 0", "nan 0 1", "0 1e39 0", "0 0 1e-30"})
    EXPECT_EQ(warning(header_of("ascii", "element vertex 3\n" + xyz + normal + faces) + "0 0 0 0 0 1\n1 0 0 " + bad +
                          "\n0 1 0 0 0 1\n3 0 1 2\n",
                      0, 0, 1),
              "test.ply: the normal of vertex 1 has no direction: all normals are ignored");
  EXPECT_EQ(warning(header_of("ascii", "element vertex 1\n" + xyz + "property float u\nproperty float v\n" + faces) +
                        "0 0 0 inf 0\n3 0 0 0\n",
                    0, 0, 1),
            "test.ply: the uv of vertex 0 is not finite: all uvs are ignored");
  EXPECT_EQ(warning(header_of("ascii", "element vertex 1\n" + xyz + "property float nx\n" + faces) + "0 0 0 1\n3 0 0 0",
                    0, 0, 1),
            "test.ply:3: some of nx, ny, nz are missing: the normals are ignored");
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

TEST(Ply, MalformedHeaders) {
  for (const Malformed& malformed : malformed_headers) expect_malformed(malformed);
  expect_malformed({"ply\ncomment made\nformat bonary 1.0\n", "test.ply:3:8: ", "\n  format bonary 1.0"});
  const std::string endless = message_of("ply\ncomment " + std::string(2 << 20, 'x'));
  EXPECT_NE(endless.find("no 'end_header' within its first MiB"), std::string::npos) << endless;
}

TEST(Ply, MalformedAsciiRows) {
  for (const Malformed& malformed : malformed_rows) expect_malformed(malformed);
  const std::string long_word = TRIANGLE "0 0 " + std::string(5000, '1');
  EXPECT_NE(message_of(long_word).find("too long for a number"), std::string::npos) << message_of(long_word);
}

TEST(Ply, MalformedBinaryRows) {
  const auto message = [](auto&&... values) {
    Bytes rows(std::endian::big);
    for (int i = 0; i < 8; ++i) rows.add(0.0f).add(1.0f).add(2.0f);
    for (int i = 0; i < 17; ++i) rows.add<int16_t>(3).add(0).add(1).add(2);
    (rows.add(values), ...);
    const std::string elements =
        "element vertex 8\n" + xyz + "element face 18\nproperty list short int vertex_indices\n";
    return message_of(header_of("binary_big_endian", elements) + rows.text());
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

  Bytes nan(std::endian::little);
  nan.add(0.0f).add(1.0f).add(std::numeric_limits<float>::quiet_NaN());
  EXPECT_EQ(message_of(header_of("binary_little_endian", "element vertex 1\n" + xyz) + nan.text()),
            "test.ply: vertex 0: z is nan; coordinates must be finite");
}

}  // namespace
}  // namespace alhazen::test
