// Animations: channels that move a property of a node by keyframes (glTF 2.0, 3.11 and appendix C).

#include <algorithm>

#include "io/gltf/nodes.h"
#include "io/gltf/pointers.h"
#include "util/quoted.h"

namespace alhazen::impl::gltf {

namespace {

using Quaternion = std::array<double, 4>;

/// Spherical interpolation along the shorter arc (appendix C.4).
Quaternion slerp(const Quaternion& a, Quaternion b, double t) {
  double cosine = 0;
  for (size_t i = 0; i < 4; ++i) cosine += a[i] * b[i];
  if (cosine < 0) {
    cosine = -cosine;
    for (double& value : b) value = -value;
  }
  double wa = 1 - t, wb = t;
  if (cosine < 1 - 1e-9) {
    const double angle = std::acos(cosine);
    wa = std::sin((1 - t) * angle) / std::sin(angle);
    wb = std::sin(t * angle) / std::sin(angle);
  }
  Quaternion result;
  for (size_t i = 0; i < 4; ++i) result[i] = wa * a[i] + wb * b[i];
  return result;
}

struct Sampler {
  const Document& document;
  const Json& description;
  std::vector<float> times;
  Values values;
  std::string interpolation;

  size_t elements_a_key() const { return interpolation == "CUBICSPLINE" ? 3 : 1; }

  /// The `width` numbers of a key; part 0 is the in-tangent, 1 the value, 2 the out-tangent of a spline.
  std::vector<double> key(size_t k, size_t width, size_t part) const {
    const size_t scalars = width / values.components;
    const size_t first = (k * elements_a_key() + (elements_a_key() == 3 ? part : 0)) * scalars;
    std::vector<double> result;
    for (size_t i = 0; i < width; ++i)
      result.push_back(static_cast<double>(values.data[first * values.components + i]));
    return result;
  }

  std::vector<double> at(double time, size_t width, bool is_rotation) const {
    if (width == 0) return {};
    if (width % values.components != 0 || values.count != times.size() * elements_a_key() * (width / values.components))
      document.fail(description, "the animation's output has " + std::to_string(values.count) + " elements for " +
                                     std::to_string(times.size()) + " keyframes");
    const size_t last = times.size() - 1;
    if (!(time > static_cast<double>(times[0]))) return key(0, width, 1);
    if (time >= static_cast<double>(times[last])) return key(last, width, 1);
    const size_t next =
        static_cast<size_t>(std::upper_bound(times.begin(), times.end(), time,
                                             [](double t, float key) { return t < static_cast<double>(key); }) -
                            times.begin());
    const size_t k = next - 1;
    const std::vector<double> a = key(k, width, 1), b = key(next, width, 1);
    if (interpolation == "STEP") return a;
    const double span = static_cast<double>(times[next]) - static_cast<double>(times[k]),
                 t = (time - static_cast<double>(times[k])) / span;
    if (interpolation == "CUBICSPLINE") return spline(a, key(k, width, 2), key(next, width, 0), b, span, t);
    std::vector<double> result(width);
    if (is_rotation) {
      const Quaternion q = slerp({a[0], a[1], a[2], a[3]}, {b[0], b[1], b[2], b[3]}, t);
      return {q.begin(), q.end()};
    }
    for (size_t i = 0; i < width; ++i) result[i] = a[i] + (b[i] - a[i]) * t;
    return result;
  }

  static std::vector<double> spline(const std::vector<double>& a, const std::vector<double>& out_tangent,
                                    const std::vector<double>& in_tangent, const std::vector<double>& b, double span,
                                    double t) {
    const double t2 = t * t, t3 = t2 * t;
    std::vector<double> result(a.size());
    for (size_t i = 0; i < a.size(); ++i)
      result[i] = (2 * t3 - 3 * t2 + 1) * a[i] + span * (t3 - 2 * t2 + t) * out_tangent[i] + (3 * t2 - 2 * t3) * b[i] +
                  span * (t3 - t2) * in_tangent[i];
    return result;
  }
};

Sampler read_sampler(const Document& document, Accessors& accessors, const Json& description,
                     std::initializer_list<const char*> types = {"VEC3", "VEC4", "SCALAR"}) {
  Sampler sampler{document, description, {}, {}, document.string(description, "interpolation", "LINEAR")};
  if (sampler.interpolation != "LINEAR" && sampler.interpolation != "STEP" && sampler.interpolation != "CUBICSPLINE")
    document.fail(description, "unknown \"interpolation\" " + quoted(sampler.interpolation) +
                                   ": it may be LINEAR, STEP or CUBICSPLINE");
  sampler.times = accessors.floats(document.required_index(description, "input", "accessors"), {"SCALAR"}).data;
  sampler.values = accessors.floats(document.required_index(description, "output", "accessors"), types);
  for (size_t i = 1; i < sampler.times.size(); ++i)
    if (!(sampler.times[i] > sampler.times[i - 1]))
      document.fail(description,
                    "the times of the keyframes must increase; the one with index " + std::to_string(i) + " does not");
  return sampler;
}

/// The sampler that a channel refers to.
const Json& sampler_of(const Document& document, const Json& samplers, const Json& channel) {
  const uint64_t index = document.required_whole(channel, "sampler");
  if (index >= samplers.items.size())
    document.fail(channel, "index out of range: \"samplers\" has " + std::to_string(samplers.items.size()) + " items");
  return samplers.items[static_cast<size_t>(index)];
}

const Json& list_of(const Document& document, const Json& animation, const char* key) {
  const Json* items = document.list(animation, key);
  if (items == nullptr) document.fail(animation, std::string("\"") + key + "\" is missing here");
  for (const Json& item : items->items)
    if (item.kind != JsonKind::object)
      document.fail(item, std::string("every item of \"") + key + "\" must be an object");
  return *items;
}

/// The number of morph targets of the node's mesh.
size_t weight_count(const Document& document, const Json& node) {
  const auto index = document.index(node, "mesh", "meshes");
  if (!index) document.fail(node, "the weights of the node are animated, and it has no mesh");
  const Json* primitives = document.list(document.item("meshes", *index), "primitives");
  if (primitives == nullptr || primitives->items.empty()) return 0;
  const Json* targets = document.list(primitives->items[0], "targets");
  return targets == nullptr ? 0 : targets->items.size();
}

}  // namespace

void Nodes::animate(const Json& animation, double time_asked, double step_time) {
  const Json& samplers = list_of(document_, animation, "samplers");
  for (const Json& channel : list_of(document_, animation, "channels").items) {
    const Json* target = document_.object(channel, "target");
    if (target == nullptr) document_.fail(channel, "\"target\" is missing here");
    const auto node = document_.index(*target, "node", "nodes");
    if (!node) continue;  // for extensions
    const Sampler sampler = read_sampler(document_, accessors_, sampler_of(document_, samplers, channel));
    const std::string path = document_.string(*target, "path");
    const double time = sampler.interpolation == "STEP" ? step_time : time_asked;
    NodePose& pose = poses_[*node];
    if (path == "weights") {
      pose.weights = sampler.at(time, weight_count(document_, document_.item("nodes", *node)), false);
      continue;
    }
    const bool is_rotation = path == "rotation";
    if (!is_rotation && path != "translation" && path != "scale")
      document_.fail(*target,
                     "unknown \"path\" " + quoted(path) + ": it may be translation, rotation, scale or weights");
    const std::vector<double> value = sampler.at(time, is_rotation ? 4 : 3, is_rotation);
    pose.matrix.reset();
    if (is_rotation)
      pose.rotation = {value[0], value[1], value[2], value[3]};
    else
      (path == "scale" ? pose.scale : pose.translation) = {value[0], value[1], value[2]};
  }
}

std::vector<PointedValue> pointed_values(const Document& document, const Json& animation, double time) {
  Buffers buffers(document);
  Accessors accessors(document, buffers);
  std::vector<PointedValue> all;
  const Json& samplers = list_of(document, animation, "samplers");
  for (const Json& channel : list_of(document, animation, "channels").items) {
    const Json* target = document.object(channel, "target");
    const Json* extension = target == nullptr ? nullptr : document.extension(*target, "KHR_animation_pointer");
    if (extension == nullptr || document.string(*target, "path") != "pointer") continue;
    const Sampler sampler =
        read_sampler(document, accessors, sampler_of(document, samplers, channel), {"SCALAR", "VEC2", "VEC3", "VEC4"});
    const std::string pointer = document.string(*extension, "pointer");
    const size_t keys = sampler.times.size() * sampler.elements_a_key();
    const size_t width = keys == 0 ? 0 : sampler.values.count / keys * sampler.values.components;
    if (width == 0) document.fail(channel, "the output of the animation is too short for its keyframes");
    const bool is_rotation = pointer.starts_with("/nodes/") && pointer.ends_with("/rotation") && width == 4;
    all.push_back({pointer, sampler.at(time, width, is_rotation), &channel});
  }
  return all;
}

}  // namespace alhazen::impl::gltf
