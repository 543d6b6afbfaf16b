#include "io/gltf/uri.h"

#include <array>
#include <filesystem>

#include "images/codecs/image_bytes.h"
#include "util/quoted.h"

namespace alhazen::impl::gltf {

namespace {

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

std::string percent_decoded(std::string_view text) {
  std::string result;
  for (size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '%' && i + 2 < text.size() && hex_digit(text[i + 1]) >= 0 && hex_digit(text[i + 2]) >= 0) {
      result += static_cast<char>(hex_digit(text[i + 1]) * 16 + hex_digit(text[i + 2]));
      i += 2;
    } else {
      result += text[i];
    }
  }
  return result;
}

constexpr std::array<int8_t, 256> base64_values = [] {
  std::array<int8_t, 256> values{};
  values.fill(-1);
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (size_t i = 0; i < digits.size(); ++i) values[static_cast<uint8_t>(digits[i])] = static_cast<int8_t>(i);
  values['-'] = 62;
  values['_'] = 63;
  return values;
}();

std::vector<uint8_t> base64_decoded(const Document& document, const Json& at, std::string_view text) {
  std::vector<uint8_t> bytes;
  bytes.reserve(text.size() / 4 * 3 + 3);
  uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    if (c == '=') break;
    const int value = base64_values[static_cast<uint8_t>(c)];
    if (value < 0)
      document.fail(at, "the data URI has " + impl::quoted(std::string_view(&c, 1)) + ", which is not base64");
    bits = bits << 6 | static_cast<uint32_t>(value);
    count += 6;
    if (count >= 8) {
      count -= 8;
      bytes.push_back(static_cast<uint8_t>(bits >> count));
    }
  }
  return bytes;
}

Resource data_of(const Document& document, const Json& uri) {
  const std::string_view text = uri.string;
  const size_t comma = text.find(',');
  if (comma == text.npos) document.fail(uri, "the data URI has no comma before its data");
  if (text.substr(0, comma).ends_with(";base64"))
    return {base64_decoded(document, uri, text.substr(comma + 1)), "a data URI"};
  const std::string plain = percent_decoded(text.substr(comma + 1));
  return {{plain.begin(), plain.end()}, "a data URI"};
}

bool has_scheme(std::string_view uri) {
  const size_t colon = uri.find(':');
  return colon != uri.npos && colon > 1 && uri.substr(0, colon).find_first_of("/?#") == uri.npos;
}

}  // namespace

std::optional<Resource> find_uri(const Document& document, const Json& uri) {
  if (uri.kind != JsonKind::string) document.fail(uri, "\"uri\" must be a string");
  if (uri.string.starts_with("data:")) return data_of(document, uri);
  if (has_scheme(uri.string))
    document.fail(uri, impl::quoted(uri.string) + " is not a file: only data URIs and relative paths are read");
  const std::string decoded = percent_decoded(uri.string);
  if (uri.string.empty() || decoded.find('\0') != decoded.npos || std::filesystem::path(decoded).is_absolute())
    document.fail(uri, "the path " + impl::quoted(decoded) + " must be a relative one");
  const auto look_for = [&](const std::string& name) {
    return find_file(document.folder(), name, document.scope(), document.search());
  };
  FoundFile found = look_for(decoded);
  if (!found.problem.message.empty() && decoded != uri.string && !std::filesystem::path(uri.string).is_absolute()) {
    // Some exporters do not percent-encode.
    FoundFile as_written = look_for(uri.string);
    if (as_written.problem.message.empty()) found = std::move(as_written);
  }
  if (found.problem.is_missing) return std::nullopt;
  if (!found.problem.message.empty())
    document.fail(uri, "the file " + impl::quoted(decoded) + " " + found.problem.message);
  return Resource{read_bytes(found.path), found.path.name};
}

Resource load_uri(const Document& document, const Json& uri) {
  std::optional<Resource> resource = find_uri(document, uri);
  if (!resource)
    document.fail(uri, "the file " + impl::quoted(percent_decoded(uri.string)) +
                           " does not exist; it must be beside the glTF file" + search_hint(document.search()));
  return std::move(*resource);
}

}  // namespace alhazen::impl::gltf
