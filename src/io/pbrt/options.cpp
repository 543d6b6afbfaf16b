#include "io/pbrt/options.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <set>
#include <vector>

#include "io/pbrt/suggestions.h"
#include "scene/filters.h"
#include "scene/limits.h"

namespace alhazen::impl::pbrt {

namespace {

template <class Value>
const Value& known_kind(const std::map<std::string, Value>& kinds, const std::string& what, const std::string& kind,
                        const ParameterList& list) {
  if (const auto found = kinds.find(kind); found != kinds.end()) return found->second;
  std::vector<std::string> names;
  for (const auto& [name, value] : kinds) names.push_back(name);
  fail(list.place(), "unknown " + what + " \"" + kind + "\"" + upgrade_or_suggestion(kind, names));
}

/// The replacement of an integrator of pbrt-v4, and the warning if it renders another image.
struct IntegratorReplacement {
  IntegratorKind type = IntegratorKind::path;
  const char* difference = nullptr;
  bool finds_more = false;  ///< also traces paths from lights, and so finds caustics of delta lights
};

constexpr IntegratorReplacement from_lights_too{.finds_more = true};

constexpr const char* other_quantity = "\"path\" is used instead and shows light, not what it computes";

const std::map<std::string, IntegratorReplacement> integrators{
    {"path", {}},
    {"volpath", {}},
    {"simplepath", {}},
    {"randomwalk", {}},
    {"bdpt", from_lights_too},
    {"mlt", from_lights_too},
    {"sppm", from_lights_too},
    {"lightpath", from_lights_too},
    {"simplevolpath", {IntegratorKind::path, "\"path\" is used instead, without the media"}},
    {"ambientocclusion", {IntegratorKind::path, other_quantity}},
    {"ao", {IntegratorKind::path, other_quantity}},
    {"function", {IntegratorKind::path, other_quantity}},
    {"branching", {IntegratorKind::branching}},
    {"recursive", {IntegratorKind::recursive}},
    {"iterative", {IntegratorKind::iterative}}};

const std::map<std::string, SamplerType> samplers{
    {"independent", SamplerType::independent}, {"halton", SamplerType::sobol}, {"sobol", SamplerType::sobol},
    {"paddedsobol", SamplerType::sobol},       {"zsobol", SamplerType::sobol}, {"pmj02bn", SamplerType::sobol},
    {"stratified", SamplerType::sobol}};

int32_t positive_integer(ParameterList& list, std::string_view name, int32_t fallback) {
  const int32_t value = list.integer(name, fallback);
  if (value < 1)
    fail(list.place_of(name), "\"" + std::string(name) + "\" of " + list.directive() + " must be at least 1");
  return value;
}

bool read_flag(const Lexer& lexer, const Token& token, const std::string& name) {
  if (token.text == "true") return true;
  if (token.text == "false") return false;
  fail(lexer.place(token), "option \"" + name + "\": expected true or false, got " + described(token));
}

}  // namespace

void set_filter(Build& build, const std::string& kind, ParameterList& list) {
  Filter filter = known_kind(named_filters(), "pixel filter", kind, list);
  filter.x_radius = list.positive("xradius", filter.x_radius);
  filter.y_radius = list.positive("yradius", filter.y_radius);
  if (std::max(filter.x_radius, filter.y_radius) > max_filter_radius)
    fail(list.place(), list.directive() + ": its radii can be 64 pixels at most");
  if (filter.type == FilterType::gaussian) filter.sigma = list.positive("sigma", filter.sigma);
  if (filter.type == FilterType::mitchell) {
    filter.b = list.number("B", filter.b);
    filter.c = list.number("C", filter.c);
  }
  if (filter.type == FilterType::sinc) filter.tau = list.positive("tau", filter.tau);
  list.reject_unknown();
  build.scene.filter = filter;
}

void set_sampler(Build& build, const std::string& kind, ParameterList& list) {
  build.scene.sampler = known_kind(samplers, "sampler", kind, list);
  if (kind == "stratified") {
    const int64_t x = positive_integer(list, "xsamples", 4), y = positive_integer(list, "ysamples", 4);
    build.scene.samples_per_pixel = x * y;
    if (build.scene.samples_per_pixel > max_samples_per_pixel)
      fail(list.place(), list.directive() + ": xsamples * ysamples is over 2^24 samples per pixel; give fewer");
    list.ignore({"jitter"});
  } else {
    build.scene.samples_per_pixel = positive_integer(list, "pixelsamples", kind == "independent" ? 4 : 16);
    if (build.scene.samples_per_pixel > max_samples_per_pixel)
      fail(list.place_of("pixelsamples"), "\"pixelsamples\" is over 2^24 samples per pixel; give fewer");
    list.ignore({"randomization"});
  }
  build.scene.seed = static_cast<uint32_t>(list.integer("seed", static_cast<int32_t>(build.scene.seed)));
  list.reject_unknown();
}

namespace {

/// "power" and "bvh" are supported; "uniform" and "exhaustive" leave the choice to the renderer.
void set_light_sampler(Build& build, ParameterList& list) {
  const std::string sampler = list.string("lightsampler", "");
  if (sampler == "power")
    build.scene.light_sampling = LightSampling::power;
  else if (sampler == "bvh")
    build.scene.light_sampling = LightSampling::tree;
  else if (!sampler.empty() && sampler != "uniform" && sampler != "exhaustive")
    fail(list.place_of("lightsampler"), "unknown light sampler \"" + sampler + "\"; use bvh, power or uniform");
}

}  // namespace

void set_integrator(Build& build, const std::string& kind, ParameterList& list) {
  const IntegratorReplacement& replacement = known_kind(integrators, "integrator", kind, list);
  if (replacement.difference) build.warn_replaced(list, replacement.difference);
  build.scene.integrator = replacement.type;
  build.scene.replaced_integrator = replacement.finds_more ? kind : "";
  build.scene.max_depth = list.integer("maxdepth", 5);
  if (build.scene.max_depth < 0) fail(list.place_of("maxdepth"), "\"maxdepth\" cannot be negative");
  if (build.scene.max_depth > max_bounces)
    fail(list.place_of("maxdepth"), "\"maxdepth\" is " + std::to_string(build.scene.max_depth) + "; give at most " +
                                        std::to_string(max_bounces) + " bounces");
  if (list.boolean("regularize", false))
    build.warn(list.place_of("regularize"), "\"regularize\" is not supported; it is ignored");
  // None of these settings changes the expected image; light that `path` cannot find is warned of when the scene is
  // compiled.
  set_light_sampler(build, list);
  list.ignore({"samplelights", "samplebsdf", "visualizestrategies", "visualizeweights", "bootstrapsamples", "chains",
               "mutationsperpixel", "largestepprobability", "sigma", "photonsperiteration", "radius", "seed",
               "cossample", "maxdistance", "function", "filename", "skipbad", "imagefilename"});
  list.reject_unknown();
}

void ignore_accelerator(Build&, const std::string&, ParameterList&) {}

void set_option(Build& build, Lexer& lexer, const Place& place) {
  static const std::set<std::string> without_effect{"disabletexturefiltering",
                                                    "disablewavelengthjitter",
                                                    "displacementedgescale",
                                                    "msereferenceimage",
                                                    "msereferenceout",
                                                    "rendercoordsys",
                                                    "pixelstats",
                                                    "wavefront"};
  static const std::set<std::string> flags_without_support{"disablepixeljitter", "forcediffuse"};
  std::string name = expect_string(lexer, "the name of an option");
  name = name.substr(name.find_last_of(" \t") + 1);
  std::string plain;  // pbrt reads Pixel-Stats and pixelstats alike
  for (const char c : name)
    if (c != '-' && c != '_') plain += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  const Token value = lexer.peek();
  if (value.kind != TokenKind::word && value.kind != TokenKind::string)
    fail(lexer.place(value), "expected a value for option \"" + name + "\", got " + described(value));
  if (plain == "seed") {
    build.scene.seed = static_cast<uint32_t>(integer_of(lexer, value));
  } else if (flags_without_support.contains(plain)) {
    if (read_flag(lexer, value, name)) build.warn(place, "option \"" + plain + "\" is not supported; it is ignored");
  } else if (!without_effect.contains(plain)) {
    std::set<std::string> known = without_effect;
    known.insert(flags_without_support.begin(), flags_without_support.end());
    known.insert("seed");
    fail(place, "unknown option \"" + name + "\"" + suggestion(plain, known));
  }
  lexer.next();
}

}  // namespace alhazen::impl::pbrt
