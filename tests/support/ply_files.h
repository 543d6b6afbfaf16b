#pragma once

// PLY files for tests: their headers and rows in text and in binary, as bytes and as temporary files.

#include <gtest/gtest.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>

#include "io/ply/parse_ply.h"

namespace alhazen::impl::test {

inline Mesh parse_bytes(const std::string& bytes, Diagnostics& diagnostics) {
  MemorySource source(bytes);
  return parse_ply(source, "test.ply", diagnostics);
}

inline Mesh parse_bytes(const std::string& bytes) {
  Diagnostics diagnostics;
  const Mesh mesh = parse_bytes(bytes, diagnostics);
  EXPECT_TRUE(diagnostics.warnings().empty()) << diagnostics.warnings().front().to_string();
  return mesh;
}

/// A file that is removed at the end of the test.
class TemporaryPly {
 public:
  TemporaryPly() : path_(std::filesystem::temp_directory_path() / ("ply_test_" + std::to_string(getpid()))) {}
  ~TemporaryPly() { std::filesystem::remove(path_); }
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
class BinaryRows {
 public:
  explicit BinaryRows(std::endian order) : order_(order) {}

  template <class Value>
  BinaryRows& add(Value value) {
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

inline std::string ply_header(const std::string& format, const std::string& elements) {
  return "ply\nformat " + format + " 1.0\n" + elements + "end_header\n";
}

inline const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
inline const std::string triangle_elements =
    "element vertex 3\n" + xyz + "element face 1\nproperty list uchar int vertex_indices\n";
inline const std::string triangle_rows = "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

}  // namespace alhazen::impl::test
