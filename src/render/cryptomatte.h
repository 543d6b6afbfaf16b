#pragma once

// Cryptomatte (Friedman and Jones 2015): how much of each pixel every object, or every material, covers, in a form from
// which compositors make mattes. The hash and the names of channels and metadata are those of its specification, 1.2.

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace alhazen::impl {

/// MurmurHash3_x86_32 (Appleby) with seed 0.
uint32_t murmur3_32(std::string_view text);

/// The float with the bits of a hash, of which some are changed where they would be no normal number.
float cryptomatte_id(uint32_t hash);

/// The number of (id, coverage) pairs that an image has per pixel, two in each of the layers `NAME00`, `NAME01`, ...
inline constexpr int cryptomatte_levels = 6;

/// Channels of the levels: `CryptoObject00.R`, `.G`, `.B`, `.A`, `CryptoObject01.R`, ...
std::vector<std::string> cryptomatte_channels(const std::string& layer);

/// What a header says about one layer. `names` are those that appear in the image.
std::map<std::string, std::string> cryptomatte_metadata(const std::string& layer,
                                                        const std::vector<std::string>& names);

}  // namespace alhazen::impl
