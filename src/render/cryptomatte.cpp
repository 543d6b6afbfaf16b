#include "render/cryptomatte.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <nlohmann/json.hpp>

namespace alhazen::impl {

namespace {

uint32_t scramble(uint32_t block) { return std::rotl(block * 0xcc9e2d51u, 15) * 0x1b873593u; }

}  // namespace

uint32_t murmur3_32(std::string_view text) {
  uint32_t hash = 0;
  const size_t whole = text.size() / 4 * 4;
  for (size_t i = 0; i < whole; i += 4) {
    uint32_t block;  // the hash is defined on little-endian words
    std::memcpy(&block, text.data() + i, sizeof(block));
    hash = std::rotl(hash ^ scramble(block), 13) * 5 + 0xe6546b64u;
  }
  uint32_t rest = 0;
  for (size_t i = text.size(); i > whole; --i) rest = rest << 8 | static_cast<unsigned char>(text[i - 1]);
  hash ^= scramble(rest) ^ static_cast<uint32_t>(text.size());
  hash = (hash ^ hash >> 16) * 0x85ebca6bu;
  hash = (hash ^ hash >> 13) * 0xc2b2ae35u;
  return hash ^ hash >> 16;
}

float cryptomatte_id(uint32_t hash) {
  const uint32_t exponent = std::clamp(hash >> 23 & 255u, 1u, 254u);
  return std::bit_cast<float>((hash & 0x807fffffu) | exponent << 23);
}

std::vector<std::string> cryptomatte_channels(const std::string& layer) {
  std::vector<std::string> channels;
  for (int rank = 0; rank < cryptomatte_levels / 2; ++rank)
    for (const char component : {'R', 'G', 'B', 'A'})
      channels.push_back(fmt::format("{}{:02}.{}", layer, rank, component));
  return channels;
}

std::map<std::string, std::string> cryptomatte_metadata(const std::string& layer,
                                                        const std::vector<std::string>& names) {
  nlohmann::json manifest = nlohmann::json::object();
  for (const std::string& name : names)
    manifest[name] = fmt::format("{:08x}", std::bit_cast<uint32_t>(cryptomatte_id(murmur3_32(name))));
  const std::string prefix = fmt::format("cryptomatte/{:08x}", murmur3_32(layer)).substr(0, 19) + "/";
  return {{prefix + "name", layer},
          {prefix + "hash", "MurmurHash3_32"},
          {prefix + "conversion", "uint32_to_float32"},
          {prefix + "manifest", manifest.dump()}};
}

}  // namespace alhazen::impl
