// Checkpoint files: every changed bit is detected, and checkpoints of other renders are recognized.

#include "render/checkpoint.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <cstring>
#include <memory>
#include <vector>

#include "render/renderer.h"
#include "support/temporary_folder.h"

namespace alhazen::impl::test {

namespace {

constexpr uint64_t scene = 0x123456789abcdefu;

template <class Real>
class CheckpointFiles : public ::testing::Test {
 protected:
  CheckpointFiles() {
    settings_.asked.checkpoint = folder_.file("state");
    settings_.precision = sizeof(Real) == 4 ? Precision::single : Precision::double_;
    settings_.window = {0, 3, 0, 2};
    settings_.width = 3;
    settings_.height = 2;
    settings_.samples_per_pixel = 64;
    settings_.aovs.albedo = settings_.aovs.samples = true;
    Film<Real> film = make_film();
    fill(film);
    CheckpointFile(settings_, scene).template save<Real>(film, 8);
  }

  Film<Real> make_film() const { return Film<Real>(settings_.window, settings_.aovs); }

  /// Eight samples in every pixel, with different values.
  static void fill(Film<Real>& film) {
    const FilmView<Real> planes = film.view();
    for (uint32_t i = 0; i < 6; ++i) {
      planes.samples[i] = 8;
      planes.radiance[i] = {Real(i + 1), Real(0.5), Real(1) / Real(i + 3)};
      planes.albedo[i] = {Real(0.25), Real(i), Real(2)};
    }
  }

  /// The message of the refusal; empty if the file was accepted.
  std::string refusal(const RenderSettings& settings, uint64_t of_scene = scene) const {
    Film<Real> film = make_film();
    try {
      EXPECT_EQ(CheckpointFile(settings, of_scene).template load<Real>(film), 8u);
      return {};
    } catch (const InputError& error) {
      return error.what();
    }
  }
  std::string refusal_of(const Bytes& bytes) const {
    folder_.write("state", bytes);
    return refusal(settings_);
  }

  RenderSettings settings_;
  TemporaryFolder folder_;
};

using Reals = ::testing::Types<float, double>;
TYPED_TEST_SUITE(CheckpointFiles, Reals);

TYPED_TEST(CheckpointFiles, BringsBackTheFilm) {
  Film<TypeParam> film = this->make_film(), expected = this->make_film();
  this->fill(expected);
  EXPECT_EQ(CheckpointFile(this->settings_, scene).template load<TypeParam>(film), 8u);
  std::vector<std::vector<char>> planes;
  expected.visit_planes([&](const void* data, size_t size) {
    planes.emplace_back(static_cast<const char*>(data), static_cast<const char*>(data) + size);
  });
  size_t plane = 0;
  film.visit_planes([&](const void* data, size_t size) {
    const char* bytes = static_cast<const char*>(data);
    EXPECT_EQ(planes.at(plane++), std::vector<char>(bytes, bytes + size));
  });
}

/// Identifies an image that was stopped before its first sample: it is black, and not worth writing.
TYPED_TEST(CheckpointFiles, AnEmptyFilmIsToldFromOneWithSamples) {
  Rendering rendering;
  rendering.film = std::make_unique<Film<TypeParam>>(this->settings_.window, this->settings_.aovs);
  EXPECT_FALSE(rendering.has_samples());
  std::get<std::unique_ptr<Film<TypeParam>>>(rendering.film)->view().samples[5] = 4;
  EXPECT_TRUE(rendering.has_samples());
}

TYPED_TEST(CheckpointFiles, EveryFlippedBitIsFound) {
  const Bytes whole = read_file(this->folder_.file("state"));
  ASSERT_GT(whole.size(), 64u);
  for (size_t at = 0; at < whole.size(); ++at)
    for (int bit = 0; bit < 8; ++bit) {
      Bytes flipped = whole;
      flipped[at] = static_cast<uint8_t>(flipped[at] ^ (1 << bit));
      const std::string refusal = this->refusal_of(flipped);
      ASSERT_FALSE(refusal.empty()) << "bit " << bit << " of byte " << at;
      const bool is_magic = at < 8;
      ASSERT_TRUE(is_magic || refusal.find("damaged") != std::string::npos) << refusal;
    }
  EXPECT_EQ(this->refusal_of(whole), "");
}

TYPED_TEST(CheckpointFiles, EveryOtherLengthIsFound) {
  const Bytes whole = read_file(this->folder_.file("state"));
  for (size_t size = 0; size < whole.size(); ++size)
    ASSERT_NE(this->refusal_of({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)}), "") << size;
  for (const size_t more : {1u, 4u, 4096u}) {
    Bytes extended = whole;
    extended.insert(extended.end(), more, uint8_t{0});
    EXPECT_NE(this->refusal_of(extended).find("damaged"), std::string::npos) << more;
  }
  Bytes twice = whole;
  twice.insert(twice.end(), whole.begin(), whole.end());
  EXPECT_NE(this->refusal_of(twice), "");
}

TYPED_TEST(CheckpointFiles, OfAnotherVersionIsRefusedAsThat) {
  Bytes other = read_file(this->folder_.file("state"));
  constexpr size_t version_at = 8, checksum_at = 60;
  ASSERT_EQ(std::string(other.begin() + version_at, other.begin() + version_at + 5),
            std::string(version()).substr(0, 5));
  other[version_at] = '7';
  const auto checksum = static_cast<uint32_t>(crc32_z(0, other.data(), checksum_at));
  std::memcpy(other.data() + checksum_at, &checksum, sizeof(checksum));
  EXPECT_NE(this->refusal_of(other).find("another version"), std::string::npos) << this->refusal_of(other);
  // The format before checksums.
  Bytes older = read_file(this->folder_.file("state"));
  older[7] = '1';
  EXPECT_NE(this->refusal_of(older).find("another version"), std::string::npos);
}

TYPED_TEST(CheckpointFiles, OfABackendWithOtherBitsIsRefused) {
  RenderSettings settings = this->settings_;
  settings.backend = "serial";
  Film<TypeParam> film = this->make_film();
  this->fill(film);
  CheckpointFile(settings, scene).template save<TypeParam>(film, 8);
  settings.backend = "openmp";
  EXPECT_EQ(this->refusal(settings), "");
  for (const char* const other : {"embree", "cuda", "optix"}) {
    settings.backend = other;
    const std::string refusal = this->refusal(settings);
    EXPECT_NE(refusal.find("of other settings: it was written with backend serial or openmp, and this render has "
                           "backend " +
                           std::string(other) + ": "),
              std::string::npos)
        << refusal;
  }
  settings.backend = "cuda";
  settings.device = host_device;
  CheckpointFile(settings, scene).template save<TypeParam>(film, 8);
  EXPECT_EQ(this->refusal(settings), "");
  settings.device = 0;
  EXPECT_NE(this->refusal(settings), "");
}

TYPED_TEST(CheckpointFiles, OfAnotherRenderIsRefusedAsThat) {
  EXPECT_NE(this->refusal(this->settings_, scene + 1).find("another scene"), std::string::npos);
  const auto refusal_with = [&](const auto& change) {
    RenderSettings other = this->settings_;
    change(other);
    return this->refusal(other);
  };
  const std::string words = "other settings";
  const std::string with_seed = refusal_with([](RenderSettings& s) { s.seed = 1, s.aovs.normal = true; });
  EXPECT_NE(with_seed.find("written with aov albedo+samples, seed 0, and this render has aov albedo+normal+samples, "
                           "seed 1: "),
            std::string::npos)
      << with_seed;
  EXPECT_NE(refusal_with([](RenderSettings& s) { s.width = 4; }).find(words), std::string::npos);
  EXPECT_NE(refusal_with([](RenderSettings& s) {
              s.precision = s.precision == Precision::single ? Precision::double_ : Precision::single;
            }).find(words),
            std::string::npos);
  EXPECT_NE(refusal_with([](RenderSettings& s) { s.samples_per_pixel = 4; }).find("8 samples"), std::string::npos);
}

}  // namespace

}  // namespace alhazen::impl::test
