// Selection of the channels and the part of an EXR file that are its image.

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfStandardAttributes.h>
#include <gtest/gtest.h>

#include "images/codecs/decoders.h"
#include "support/temporary_folder.h"

namespace alhazen::impl::test {
namespace {

/// The colour of a one-pixel file whose channels hold 0, 1, 2, ... in this order.
std::vector<float> colour_of(const std::vector<std::string>& channels) {
  const TemporaryFolder folder;
  Image image{1, 1, channels, {}};
  for (size_t i = 0; i < channels.size(); ++i) image.planes.push_back({static_cast<float>(i)});
  write_exr(folder.file("a.exr"), source_of(image), {});
  return read_texture(folder.file("a.exr"), TextureEncoding::automatic).floats;
}

std::string error_of(const std::vector<std::string>& channels) {
  try {
    colour_of(channels);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

using Colour = std::vector<float>;

TEST(ExrLayers, TheBaseLayerIsTheImage) {
  EXPECT_EQ(colour_of({"R", "G", "B", "albedo.R", "albedo.G", "albedo.B"}), Colour({0, 1, 2}));
  EXPECT_EQ(colour_of({"Y", "diffuse.R", "diffuse.G", "diffuse.B"}), Colour({0, 0, 0}));
  EXPECT_EQ(colour_of({"Z"}), Colour({0, 0, 0})) << "the only channel";
}

TEST(ExrLayers, OneLayerIsTheImageByWhateverName) {
  EXPECT_EQ(colour_of({"layer.R", "layer.G", "layer.B"}), Colour({0, 1, 2}));
  EXPECT_EQ(colour_of({"A", "Z", "layer.R", "layer.G", "layer.B", "layer.A"}), Colour({2, 3, 4}));
  EXPECT_EQ(colour_of({"View Layer.Combined.R", "View Layer.Combined.G", "View Layer.Combined.B", "depth.Z"}),
            Colour({0, 1, 2}));
  EXPECT_EQ(colour_of({"layer.Y", "layer.A", "normal.X", "normal.Z"}), Colour({0, 0, 0}));
  EXPECT_EQ(colour_of({"grey.Y", "layer.R", "layer.G", "layer.B"}), Colour({1, 2, 3})) << "colours before grey";
}

TEST(ExrLayers, OfSeveralTheOneThatIsCalledTheWhole) {
  EXPECT_EQ(colour_of({"AO.R", "AO.G", "AO.B", "V.Combined.R", "V.Combined.G", "V.Combined.B"}), Colour({3, 4, 5}));
  EXPECT_EQ(colour_of({"rgba.R", "rgba.G", "rgba.B", "spec.R", "spec.G", "spec.B"}), Colour({0, 1, 2}));
  const std::string error = error_of({"left.R", "left.G", "left.B", "right.R", "right.G", "right.B"});
  EXPECT_NE(error.find("'left', 'right'"), std::string::npos) << error;
  EXPECT_NE(error_of({"normal.X", "normal.Y", "normal.Z"}), "") << "this Y is no grey";
  EXPECT_NE(error_of({"X", "Y", "Z"}).find("has X, Y, Z and no R, G, B"), std::string::npos);
  EXPECT_NE(error_of({"Y", "RY", "BY"}).find("chroma (Y, RY, BY)"), std::string::npos);
  EXPECT_EQ(colour_of({"Y", "Z"}), Colour({0, 0, 0})) << "grey and a depth";
  EXPECT_NE(error_of({"layer.R", "layer.G"}).find("neither channels R, G, B nor grey"), std::string::npos);
}

/// The texel of a one-pixel file whose R, G and B have those primaries.
std::vector<float> texel_of(const Imf::Chromaticities& primaries, const Colour& rgb, TextureEncoding encoding) {
  const TemporaryFolder folder;
  Imf::Header header(1, 1);
  Imf::addChromaticities(header, primaries);
  Imf::FrameBuffer frame;
  Colour values = rgb;
  for (size_t c = 0; c < 3; ++c) {
    const std::string name(1, "RGB"[c]);
    header.channels().insert(name, Imf::Channel(Imf::FLOAT));
    frame.insert(name, Imf::Slice::Make(Imf::FLOAT, &values[c], header.dataWindow()));
  }
  {
    Imf::OutputFile file(folder.file("a.exr").c_str(), header);
    file.setFrameBuffer(frame);
    file.writePixels(1);
  }
  return read_texture(folder.file("a.exr"), encoding).floats;
}

TEST(ExrPrimaries, ColoursAreTurnedToSrgb) {
  const Imf::Chromaticities rec2020({0.708f, 0.292f}, {0.170f, 0.797f}, {0.131f, 0.046f}, {0.3127f, 0.3290f});
  const Imf::Chromaticities aces({0.7347f, 0.2653f}, {0.0f, 1.0f}, {0.0001f, -0.0770f}, {0.32168f, 0.33767f});
  const Colour rgb{0.25f, 0.5f, 0.125f}, green{0, 0.5f, 0};
  for (const TextureEncoding encoding : {TextureEncoding::automatic, TextureEncoding::linear})
    for (const auto& [primaries, name] : {std::pair{rec2020, "rec2020"}, {aces, "aces2065-1"}})
      for (const Colour& colour : {rgb, green, Colour{1, 1, 1}}) {
        const Vec3d expected = to_srgb(name, {colour[0], colour[1], colour[2]});
        const Colour texel = texel_of(primaries, colour, encoding);
        EXPECT_NEAR(texel[0], expected.x, 1e-5) << name;
        EXPECT_NEAR(texel[1], expected.y, 1e-5) << name;
        EXPECT_NEAR(texel[2], expected.z, 1e-5) << name;
      }
  EXPECT_EQ(texel_of(aces, rgb, TextureEncoding::data), rgb) << "numbers that are no colours";
  EXPECT_EQ(texel_of(Imf::Chromaticities(), rgb, TextureEncoding::automatic), rgb) << "those of sRGB, bit for bit";
}

TEST(ExrPrimaries, ThoseOfNoColourSpaceAreRefused) {
  for (const Imf::Chromaticities& primaries :
       {Imf::Chromaticities({0, 0}, {0, 0}, {0, 0}, {0, 0}), Imf::Chromaticities({0.6f, 0.3f}, {0.6f, 0.3f}),
        Imf::Chromaticities({0.6f, 0.3f}, {0.3f, 0.6f}, {0.1f, 0.1f}, {0.3f, 0})})
    EXPECT_THROW(texel_of(primaries, {1, 1, 1}, TextureEncoding::automatic), InputError);
}

/// Writes a part of one pixel for each list of channels; part n holds n, n + 0.25, n + 0.5, ...
std::string write_parts(const TemporaryFolder& folder, const std::vector<std::vector<std::string>>& parts) {
  std::vector<Imf::Header> headers;
  for (size_t n = 0; n < parts.size(); ++n) {
    headers.emplace_back(1, 1);
    headers.back().setName("part" + std::to_string(n));
    headers.back().setType(Imf::SCANLINEIMAGE);
    for (const std::string& channel : parts[n]) headers.back().channels().insert(channel, Imf::Channel(Imf::FLOAT));
  }
  Imf::MultiPartOutputFile file(folder.file("parts.exr").c_str(), headers.data(), static_cast<int>(headers.size()));
  for (size_t n = 0; n < parts.size(); ++n) {
    std::vector<float> values(parts[n].size());
    Imf::FrameBuffer frame;
    for (size_t i = 0; i < values.size(); ++i) {
      values[i] = static_cast<float>(n) + 0.25f * static_cast<float>(i);
      frame.insert(parts[n][i], Imf::Slice::Make(Imf::FLOAT, &values[i], headers[n].dataWindow()));
    }
    Imf::OutputPart output(file, static_cast<int>(n));
    output.setFrameBuffer(frame);
    output.writePixels(1);
  }
  return folder.file("parts.exr");
}

Colour colour_of_parts(const std::vector<std::vector<std::string>>& parts) {
  const TemporaryFolder folder;
  return read_texture(write_parts(folder, parts), TextureEncoding::automatic).floats;
}

TEST(ExrLayers, ThePartWithColoursIsTheImage) {
  EXPECT_EQ(colour_of_parts({{"R", "G", "B"}, {"R", "G", "B"}}), Colour({0, 0.25f, 0.5f})) << "the first of two";
  EXPECT_EQ(colour_of_parts({{"Z"}, {"R", "G", "B", "A"}}), Colour({1, 1.25f, 1.5f}));
  EXPECT_EQ(colour_of_parts({{"X", "Y", "Z"}, {"l.R", "l.G", "l.B"}}), Colour({1, 1.25f, 1.5f}));
  EXPECT_EQ(colour_of_parts({{"depth.Z"}, {"id.A", "id.B"}, {"Y"}}), Colour({2, 2, 2}));
  EXPECT_EQ(colour_of_parts({{"Z"}, {"u", "v"}}), Colour({0, 0, 0}));
}

}  // namespace
}  // namespace alhazen::impl::test
