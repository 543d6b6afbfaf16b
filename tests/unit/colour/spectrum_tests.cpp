// Spectra against published colours: white points, metals, glasses, lamps; and reading spectrum files.

#include "colour/spectrum.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

#include "colour/cie_1931.h"
#include "colour/rgb_space.h"

namespace alhazen::impl::test {
namespace {

void expect_near(const Vec3d& actual, const Vec3d& expected, double tolerance, const std::string& what) {
  for (int channel = 0; channel < 3; ++channel)
    EXPECT_NEAR(actual[channel], expected[channel], tolerance) << what << ", channel " << channel;
}

/// Linear sRGB with luminance 1 and this chromaticity.
Vec3d srgb_of(double x, double y) { return xyz_to_srgb({x / y, 1, (1 - x - y) / y}); }

const Spectrum& named(const std::string& name) {
  const Spectrum* const spectrum = named_spectrum(name);
  if (!spectrum) throw std::runtime_error("no spectrum " + name);
  return *spectrum;
}

TEST(Spectrum, IsLinearBetweenItsValuesAndZeroBeyond) {
  const Spectrum spectrum{{400, 500, 700}, {1, 3, 2}};
  EXPECT_EQ(spectrum.at(399.999), 0);
  EXPECT_EQ(spectrum.at(400), 1);
  EXPECT_EQ(spectrum.at(450), 2);
  EXPECT_EQ(spectrum.at(500), 3);
  EXPECT_EQ(spectrum.at(600), 2.5);
  EXPECT_EQ(spectrum.at(700), 2);
  EXPECT_EQ(spectrum.at(700.001), 0);
  EXPECT_EQ(Spectrum().at(500), 0);
  EXPECT_EQ(constant_spectrum(0.3).at(360), 0.3);
  EXPECT_EQ(constant_spectrum(0.3).at(830), 0.3);
}

TEST(Cie1931, Observer) {
  Vec3d sum;
  for (int nanometres = first_visible; nanometres <= last_visible; ++nanometres) sum += cie_1931(nanometres);
  // The sums of the 1 nm table as published (CIE 018.2).
  expect_near(sum, {106.865, 106.857, 106.892}, 1e-3, "integrals of the matching functions");
  EXPECT_NEAR(cie_1931(555).y, 1, 1e-9);
  EXPECT_EQ(cie_1931(359.9), Vec3d());
  EXPECT_EQ(cie_1931(830.1), Vec3d());
  EXPECT_EQ(cie_1931(std::numeric_limits<double>::quiet_NaN()), Vec3d());
  EXPECT_GT(cie_1931(830).x, 0);
}

TEST(Reflectance, ConstantIsGrey) {
  EXPECT_EQ(reflectance_rgb(constant_spectrum(1)), (Vec3d{1, 1, 1}));
  expect_near(reflectance_rgb(constant_spectrum(0.18)), splat(0.18), 1e-15, "grey");
  expect_near(reflectance_rgb(constant_spectrum(7)), splat(7.0), 1e-13, "unbounded");
  EXPECT_EQ(reflectance_rgb(Spectrum()), Vec3d());
}

TEST(Illuminant, HasLuminanceOne) {
  expect_near(illuminant_rgb(constant_spectrum(5)), {1.2048, 0.9483, 0.9087}, 1e-3, "equal energy");
  expect_near(illuminant_rgb(named("stdillum-D65")), {1, 1, 1}, 1e-3, "D65");
  for (const char* const name : {"stdillum-A", "stdillum-F2", "stdillum-F11"})
    EXPECT_NEAR(luminance(illuminant_rgb(named(name))), 1, 1e-9) << name;
  EXPECT_EQ(illuminant_rgb(Spectrum()), Vec3d()) << "no light, no division by zero";
}

TEST(Illuminant, ChromaticitiesOfTheStandardIlluminants) {
  struct Chromaticity {
    const char* name;
    double x, y;
  };
  // CIE 015, tables of chromaticities; D60 from SMPTE ST 2065-1. They are sums in steps of 5 nm, ours of 1 nm: lamps
  // with narrow lines (F10 to F12) differ most.
  for (const Chromaticity& c : {Chromaticity{"stdillum-A", 0.44758, 0.40745},
                                {"stdillum-D50", 0.34567, 0.35851},
                                {"illum-acesD60", 0.32168, 0.33767},
                                {"stdillum-D65", 0.31272, 0.32903},
                                {"stdillum-F1", 0.31310, 0.33727},
                                {"stdillum-F2", 0.37208, 0.37529},
                                {"stdillum-F3", 0.40910, 0.39430},
                                {"stdillum-F4", 0.44018, 0.40329},
                                {"stdillum-F5", 0.31379, 0.34531},
                                {"stdillum-F6", 0.37790, 0.38835},
                                {"stdillum-F7", 0.31292, 0.32933},
                                {"stdillum-F8", 0.34588, 0.35875},
                                {"stdillum-F9", 0.37417, 0.37281},
                                {"stdillum-F10", 0.34609, 0.35986},
                                {"stdillum-F11", 0.38052, 0.37713},
                                {"stdillum-F12", 0.43695, 0.40441}})
    expect_near(illuminant_rgb(named(c.name)), srgb_of(c.x, c.y), 5e-3, c.name);
}

TEST(Blackbody, ColoursOfTemperature) {
  // Chromaticities on the Planckian locus.
  expect_near(illuminant_rgb(blackbody_spectrum(6500)), srgb_of(0.3135, 0.3237), 2e-3, "6500 K");
  expect_near(illuminant_rgb(blackbody_spectrum(6500)), {1, 1, 1}, 0.07, "6500 K is near white");
  expect_near(illuminant_rgb(blackbody_spectrum(2700)), srgb_of(0.4599, 0.4106), 2e-3, "2700 K");
  const Vec3d warm = illuminant_rgb(blackbody_spectrum(2700));
  EXPECT_GT(warm.x, 1.5 * warm.y);
  EXPECT_GT(warm.y, 2 * warm.z);
  EXPECT_NEAR(luminance(warm), 1, 1e-9);
}

TEST(Blackbody, LargestValueIsOne) {
  const auto largest = [](double kelvin) {
    const std::vector<double> values = blackbody_spectrum(kelvin).values;
    return *std::max_element(values.begin(), values.end());
  };
  EXPECT_NEAR(largest(6500), 1, 1e-5) << "peak at 446 nm";
  EXPECT_NEAR(blackbody_spectrum(6500).at(446), 1, 1e-5);
  EXPECT_LT(largest(2700), 1) << "peak in the infrared";
  for (const double kelvin :
       {0.0, -5.0, 1e-300, 20.0, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()})
    EXPECT_EQ(largest(kelvin), 0) << kelvin;
  EXPECT_TRUE(std::isfinite(largest(1e300)));
}

/// Fresnel reflectance at normal incidence.
Vec3d reflectance_of(const ConductorRgb& metal) {
  const Vec3d below = metal.eta - splat(1.0), above = metal.eta + splat(1.0), k2 = metal.k * metal.k;
  return (below * below + k2) / (above * above + k2);
}

TEST(Conductor, MetalsReflectAsPublished) {
  struct Metal {
    const char* name;
    Vec3d reflectance;
  };
  // Linear sRGB at normal incidence: Akenine-Moeller et al., Real-Time Rendering, 4th edition, table 9.2.
  for (const Metal& metal : {Metal{"Au", {1.022, 0.782, 0.344}},
                             {"Ag", {0.972, 0.960, 0.915}},
                             {"Cu", {0.955, 0.638, 0.538}},
                             {"Al", {0.913, 0.922, 0.924}}}) {
    const std::string name = std::string("metal-") + metal.name;
    const ConductorRgb rgb = conductor_rgb(named(name + "-eta"), named(name + "-k"));
    expect_near(reflectance_of(rgb), min(metal.reflectance, splat(1.0)), 0.04, name);
  }
}

TEST(Conductor, ReflectanceIsTheProjectionOfTheSpectralOne) {
  for (const char* const metal : {"Ag", "Al", "Au", "Cu", "CuZn", "MgO", "TiO2"}) {
    const std::string name = std::string("metal-") + metal;
    const Spectrum &eta = named(name + "-eta"), &k = named(name + "-k");
    Spectrum reflectance;
    for (int nanometres = first_visible; nanometres <= last_visible; ++nanometres) {
      const double n = eta.at(nanometres), kappa = k.at(nanometres);
      reflectance.wavelengths.push_back(nanometres);
      reflectance.values.push_back(((n - 1) * (n - 1) + kappa * kappa) / ((n + 1) * (n + 1) + kappa * kappa));
    }
    const Vec3d expected = min(max(reflectance_rgb(reflectance), Vec3d()), splat(0.9999));
    const ConductorRgb rgb = conductor_rgb(eta, k);
    expect_near(reflectance_of(rgb), expected, 1e-12, name);
    for (int channel = 0; channel < 3; ++channel) {
      EXPECT_GT(rgb.eta[channel], 0) << name;
      EXPECT_GE(rgb.k[channel], 0) << name;
    }
  }
}

TEST(Conductor, ConstantSpectraComeBack) {
  const ConductorRgb rgb = conductor_rgb(constant_spectrum(0.2), constant_spectrum(3));
  expect_near(rgb.eta, splat(0.2), 1e-12, "eta");
  expect_near(rgb.k, splat(3.0), 1e-9, "k");
  const ConductorRgb transparent = conductor_rgb(constant_spectrum(1.5), constant_spectrum(0));
  expect_near(reflectance_of(transparent), splat(0.04), 1e-12, "glass");
  // Narrow spectra: values beyond the measurement repeat the last one and are not zero.
  const Spectrum eta{{500, 600}, {0.2, 0.2}}, k{{550, 560}, {3, 3}};
  expect_near(conductor_rgb(eta, k).k, splat(3.0), 1e-9, "k of a narrow measurement");
}

TEST(NamedSpectrum, Glasses) {
  struct Glass {
    const char* name;
    double n_d;  ///< at 587.6 nm, from Schott's catalogue
  };
  for (const Glass& glass : {Glass{"BK7", 1.51680},
                             {"BAF10", 1.67003},
                             {"FK51A", 1.48656},
                             {"LASF9", 1.85025},
                             {"F5", 1.67270},
                             {"F10", 1.72825},
                             {"F11", 1.78472}})
    EXPECT_NEAR(named(std::string("glass-") + glass.name).at(587.6), glass.n_d, 2e-4) << glass.name;
}

TEST(NamedSpectrum, CoversTheVisibleRange) {
  EXPECT_EQ(named_spectrum("metal-Unobtainium-eta"), nullptr);
  EXPECT_EQ(named_spectrum(""), nullptr);
  for (const char* const name : {"metal-MgO-eta", "metal-TiO2-k", "glass-LASF9", "stdillum-F1", "stdillum-D65"}) {
    const Spectrum& spectrum = named(name);
    EXPECT_EQ(&spectrum, named_spectrum(name));
    EXPECT_LE(spectrum.wavelengths.front(), 360) << name;
    EXPECT_GE(spectrum.wavelengths.back(), 830) << name;
    EXPECT_EQ(spectrum.wavelengths.size(), spectrum.values.size()) << name;
    EXPECT_EQ(std::adjacent_find(spectrum.wavelengths.begin(), spectrum.wavelengths.end(), std::greater_equal<>()),
              spectrum.wavelengths.end())
        << name;
  }
}

TEST(RgbSpace, PrimariesAndWhites) {
  EXPECT_EQ(to_srgb("srgb", {0.1, 0.2, 0.3}), (Vec3d{0.1, 0.2, 0.3}));
  for (const char* const space : {"rec2020", "dci-p3", "aces2065-1"}) {
    EXPECT_TRUE(is_rgb_space(space));
    expect_near(to_srgb(space, {1, 1, 1}), {1, 1, 1}, 1e-12, space);
  }
  expect_near(to_srgb("rec2020", {1, 0, 0}), {1.6605, -0.1246, -0.0182}, 1e-4, "red of rec2020");
  expect_near(to_srgb("rec2020", {0, 1, 0}), {-0.5876, 1.1329, -0.1006}, 1e-4, "green of rec2020");
  expect_near(to_srgb("dci-p3", {1, 0, 0}), {1.2249, -0.0421, -0.0196}, 1e-4, "red of P3");
  expect_near(to_srgb("aces2065-1", {1, 0, 0}), {2.5217, -0.2765, -0.0154}, 1e-3, "red of ACES");
  EXPECT_FALSE(is_rgb_space("adobe"));
  EXPECT_THROW(to_srgb("adobe", {1, 1, 1}), InputError);
}

TEST(RgbSpace, LuminanceIsY) {
  for (const Vec3d& xyz : {Vec3d{0.3, 0.4, 0.5}, {1, 0, 0}, {0, 0, 1}})
    EXPECT_NEAR(luminance(xyz_to_srgb(xyz)), xyz.y, 1e-9);
}

/// A file that is removed at the end of the test.
class SpectrumFile {
 public:
  explicit SpectrumFile(const std::string& text)
      : path_(std::filesystem::temp_directory_path() / ("spectrum_test_" + std::to_string(getpid()) + ".spd")) {
    std::ofstream(path_, std::ios::binary) << text;
  }
  ~SpectrumFile() { std::filesystem::remove(path_); }
  std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

/// The message for a file with this text, without the path.
std::string message_of(const std::string& text) {
  const SpectrumFile file(text);
  try {
    read_spectrum(file.path());
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_TRUE(message.starts_with(file.path())) << message;
    return message.substr(file.path().size());
  }
  return "no error";
}

TEST(SpectrumFile, Pairs) {
  const SpectrumFile file("# of gold\r\n400 0.5\r\n\t500.5 1e-3 # a comment\n600 +2 700\n-4");
  const Spectrum spectrum = read_spectrum(file.path());
  EXPECT_EQ(spectrum.wavelengths, (std::vector<double>{400, 500.5, 600, 700}));
  EXPECT_EQ(spectrum.values, (std::vector<double>{0.5, 1e-3, 2, -4}));
}

TEST(SpectrumFile, Malformed) {
  const char* const none = "no spectrum; expected pairs of a wavelength in nanometres and a value";
  EXPECT_EQ(message_of(""), std::string(":1:1: ") + none);
  EXPECT_EQ(message_of("# nothing\n"), std::string(":2:1: ") + none);
  EXPECT_EQ(message_of("400 1\n500 x1\n"), ":2:5: 'x1' is not a finite number");
  EXPECT_EQ(message_of("400 1\n\n  nm 2"), ":3:3: 'nm' is not a finite number");
  EXPECT_EQ(message_of("400, 1"), ":1:1: '400,' is not a finite number");
  EXPECT_EQ(message_of("400 nan"), ":1:5: 'nan' is not a finite number");
  EXPECT_EQ(message_of("400 1e999"), ":1:5: '1e999' is not a finite number");
  EXPECT_EQ(message_of(std::string("400 1\0", 6)), ":1:5: '1\\x00' is not a finite number");
  EXPECT_EQ(message_of("400 1\n500"), ":2:1: a wavelength without a value after it");
  EXPECT_EQ(message_of("400 1\n400 2"), ":2:1: wavelengths must ascend; this one is not above the previous one");
  EXPECT_EQ(message_of("400 1 # x\n 300 2"), ":2:2: wavelengths must ascend; this one is not above the previous one");
  EXPECT_THROW(read_spectrum("no_such.spd"), InputError);
  EXPECT_THROW(read_spectrum(std::filesystem::temp_directory_path().string()), InputError);
}

TEST(SpectrumFile, GoldOfTheSharedScenes) {
  const std::filesystem::path scenes = std::filesystem::path(ALHAZEN_SOURCE_DIR) / "../shared/scenes/pbrt";
  int found = 0;
  for (const char* const scene : {"cornell-box-variants", "killeroos"}) {
    const std::filesystem::path folder = scenes / scene / "spds";
    if (!std::filesystem::exists(folder)) continue;
    ++found;
    const Spectrum eta = read_spectrum((folder / "Au.eta.spd").string());
    const Spectrum k = read_spectrum((folder / "Au.k.spd").string());
    // The file has the same measurement as a named spectrum.
    for (const double nanometres : {400.0, 500.0, 600.0, 700.0}) {
      EXPECT_NEAR(eta.at(nanometres), named("metal-Au-eta").at(nanometres), 1e-4);
      EXPECT_NEAR(k.at(nanometres), named("metal-Au-k").at(nanometres), 1e-4);
    }
  }
  if (found == 0) GTEST_SKIP() << "the shared scenes are not here: " << scenes;
}

}  // namespace
}  // namespace alhazen::impl::test
