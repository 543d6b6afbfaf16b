#include "io/mitsuba/dielectric_index.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>

#include "core/materials/lobes/fresnel.h"
#include "core/materials/lobes/microfacet.h"
#include "util/quoted.h"

namespace alhazen::impl::mitsuba {

namespace {

/// Around 589 nm, at room temperature; those that Mitsuba 3 names.
const std::map<std::string, double> indices{
    {"vacuum", 1},        {"helium", 1.000036},        {"hydrogen", 1.000132},
    {"air", 1.000277},    {"carbon dioxide", 1.00045}, {"water", 1.3330},
    {"acetone", 1.36},    {"ethanol", 1.361},          {"carbon tetrachloride", 1.461},
    {"glycerol", 1.4729}, {"benzene", 1.501},          {"silicone oil", 1.52045},
    {"bromine", 1.661},   {"water ice", 1.31},         {"fused quartz", 1.458},
    {"pyrex", 1.470},     {"acrylic glass", 1.49},     {"polypropylene", 1.49},
    {"bk7", 1.5046},      {"sodium chloride", 1.544},  {"amber", 1.55},
    {"pet", 1.5750},      {"diamond", 2.419}};

double index_of(ObjectReader& reader, const char* parameter, const char* fallback) {
  const Property* property = reader.find(parameter);
  std::string name = fallback;
  if (property && property->kind != ValueKind::text) return reader.positive(parameter, 1);
  if (property) name = property->text;
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const auto found = indices.find(name);
  if (found != indices.end()) return found->second;
  std::string known;
  for (const auto& [each, value] : indices) known += (known.empty() ? "" : ", ") + each;
  fail(reader.place_of(parameter), "no index of refraction is known for " + quoted(name) + "; known are " + known);
}

}  // namespace

double relative_ior(ObjectReader& reader, const char* interior) {
  return index_of(reader, "int_ior", interior) / index_of(reader, "ext_ior", "air");
}

double internal_diffuse_reflectance(double ior, double alpha) {
  constexpr int rows = 64, columns = 16;
  double sum = 0;
  for (int i = 0; i < rows; ++i) {
    const double cosine = (i + 0.5) / rows;
    const Vec3d o{std::sqrt(1 - cosine * cosine), 0, cosine};
    double reflected = 0, transmitted_cosine = 0;
    if (is_smooth(alpha)) {
      reflected = fresnel_dielectric(cosine, 1 / ior, transmitted_cosine);
    } else {
      for (int x = 0; x < columns; ++x)
        for (int y = 0; y < columns; ++y) {
          const Vec3d m = sample_visible_normal(o, alpha, Vec2d{(x + 0.5) / columns, (y + 0.5) / columns});
          const double facing = std::fmax(dot(o, m), 0);
          const Vec3d r = m * (2 * facing) - o;
          if (r.z > 0) reflected += fresnel_dielectric(facing, 1 / ior, transmitted_cosine) * ggx_g1(r, alpha);
        }
      reflected /= columns * columns;
    }
    sum += reflected * 2 * cosine / rows;
  }
  return sum;
}

}  // namespace alhazen::impl::mitsuba
