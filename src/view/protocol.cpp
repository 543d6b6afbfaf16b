#include "view/protocol.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "util/diagnostics.h"
#include "util/quoted.h"

namespace alhazen::impl {

namespace {

using Json = nlohmann::ordered_json;

constexpr size_t max_message_bytes = 64 * 1024;
constexpr int max_message_depth = 8;
/// So that squares of lengths are finite in single precision.
constexpr double max_length = 1e18;
/// Integers up to it are exact in JavaScript.
constexpr uint64_t max_id = uint64_t{1} << 53;

/// The fields of a message, each of which must be asked for.
class Fields {
 public:
  Fields(const Json& object, std::string name) : object_(object), name_(std::move(name)) {
    if (!object_.is_object()) throw InputError(name_ + " must be an object");
  }

  const Json& get(const char* field) {
    known_.insert(field);
    const auto found = object_.find(field);
    if (found == object_.end()) throw InputError(name_ + " needs the field '" + field + "'");
    return *found;
  }

  /// Throws where there is a field that nobody has asked for.
  void finish() const {
    for (const auto& [field, value] : object_.items())
      if (!known_.contains(field)) throw InputError(name_ + " has no field " + quoted(field));
  }

  bool flag(const char* field) {
    const Json& value = get(field);
    if (!value.is_boolean()) refuse(field, "true or false");
    return value.get<bool>();
  }

  double number(const char* field, double low, double high, bool is_open = false) {
    return checked_number(get(field), field, low, high, is_open);
  }

  std::optional<double> optional_number(const char* field, double low, double high) {
    const Json& value = get(field);
    if (value.is_null()) return {};
    return checked_number(value, field, low, high, true);
  }

  uint64_t integer(const char* field, uint64_t low, uint64_t high) {
    const Json& value = get(field);
    if (!value.is_number_unsigned() || value.get<uint64_t>() < low || value.get<uint64_t>() > high)
      refuse(field, "a whole number from " + std::to_string(low) + " to " + std::to_string(high));
    return value.get<uint64_t>();
  }

  Vec3 point(const char* field) {
    const Json& value = get(field);
    if (!value.is_array() || value.size() != 3) refuse(field, "an array of three numbers");
    return {checked_number(value[0], field, -max_length, max_length, false),
            checked_number(value[1], field, -max_length, max_length, false),
            checked_number(value[2], field, -max_length, max_length, false)};
  }

  [[noreturn]] void refuse(const char* field, const std::string& wanted) const {
    throw InputError(name_ + ": '" + field + "' must be " + wanted);
  }

 private:
  double checked_number(const Json& value, const char* field, double low, double high, bool is_open) const {
    const double number = value.is_number() ? value.get<double>() : std::nan("");
    if (is_open ? !(number > low && number < high) : !(number >= low && number <= high)) {
      const Json limits{low, high};
      refuse(field, "a number " + std::string(is_open ? "between " : "from ") + limits[0].dump() +
                        (is_open ? " and " : " to ") + limits[1].dump());
    }
    return number;
  }

  const Json& object_;
  std::string name_;
  std::set<std::string> known_;
};

Vec3 difference(const Vec3& a, const Vec3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
double length(const Vec3& v) { return std::hypot(v.x, v.y, v.z); }
Vec3 unit(const Vec3& v) { return {v.x / length(v), v.y / length(v), v.z / length(v)}; }
Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

PageCamera read_camera(const Json& json) {
  Fields fields(json, "camera");
  PageCamera camera;
  camera.position = fields.point("position");
  camera.target = fields.point("target");
  camera.up = fields.point("up");
  camera.fov = fields.optional_number("fov", 0, 180);
  camera.aperture = fields.number("aperture", 0, max_length);
  camera.focus = fields.optional_number("focus", 0, max_length);
  fields.finish();
  const Vec3 view = difference(camera.target, camera.position);
  const double size = std::max({length(camera.target), length(camera.position), 1e-30});
  if (!(length(view) > 1e-12 * size)) throw InputError("camera: 'target' must not be where 'position' is");
  if (!(length(camera.up) > 0)) fields.refuse("up", "a direction, and not zero");
  if (!(length(cross(unit(view), unit(camera.up))) > 1e-6))
    throw InputError("camera: 'up' must not be parallel to the direction from 'position' to 'target'");
  return camera;
}

std::vector<std::string> read_names(Fields& fields, const char* field) {
  constexpr size_t max_names = 32, max_bytes = 200;
  const Json& value = fields.get(field);
  std::vector<std::string> names;
  if (!value.is_array() || value.size() > max_names) fields.refuse(field, "an array of at most 32 names");
  for (const Json& name : value) {
    if (!name.is_string() || name.get_ref<const std::string&>().size() > max_bytes)
      fields.refuse(field, "an array of names of at most 200 bytes");
    names.push_back(name.get<std::string>());
  }
  return names;
}

MaterialMessage read_material(Fields& fields) {
  MaterialMessage message;
  message.material = fields.integer("material", 0, 1'000'000'000);
  const Json& values = fields.get("values");
  if (!values.is_object()) fields.refuse("values", "an object");
  Fields inner(values, "values");
  for (const auto& [name, value] : values.items()) {
    if (value.is_boolean()) {
      message.values[name] = value.get<bool>();
    } else if (value.is_array()) {
      const Vec3 colour = inner.point(name.c_str());
      message.values[name] = std::array{colour.x, colour.y, colour.z};
    } else {
      message.values[name] = inner.number(name.c_str(), -max_length, max_length);
    }
  }
  return message;
}

SizeMessage read_size(Fields& fields) {
  SizeMessage size;
  size.width = static_cast<int>(fields.integer("width", 1, 100'000));
  size.height = static_cast<int>(fields.integer("height", 1, 100'000));
  if (int64_t{size.width} * size.height > max_view_pixels)
    throw InputError("size: a view has at most " + std::to_string(max_view_pixels) + " pixels");
  return size;
}

CameraMessage read_camera_message(Fields& fields) {
  CameraMessage message;
  message.camera = read_camera(fields.get("camera"));
  message.moving = fields.flag("moving");
  message.id = fields.integer("id", 0, max_id);
  return message;
}

EnvironmentMessage read_environment(Fields& fields) {
  EnvironmentMessage message;
  message.rotation = fields.number("rotation", -1e6, 1e6);
  message.strength = fields.number("strength", 0, 1e6);
  message.light_scale = fields.number("light_scale", 0, 1e6);
  return message;
}

PickMessage read_pick(Fields& fields) {
  PickMessage message;
  message.x = static_cast<int>(fields.integer("x", 0, 100'000));
  message.y = static_cast<int>(fields.integer("y", 0, 100'000));
  message.id = fields.integer("id", 0, max_id);
  return message;
}

PageMessage read_message(const std::string& type, Fields& fields) {
  if (type == "hello") return HelloMessage{};
  if (type == "layers") {
    LayersMessage message;
    message.layers = read_names(fields, "layers");
    message.exact = fields.flag("exact");
    return message;
  }
  if (type == "ack") return AckMessage{fields.integer("frame", 0, max_id)};
  if (type == "camera") return read_camera_message(fields);
  if (type == "reset") return ResetMessage{};
  if (type == "select_camera") return SelectCameraMessage{fields.integer("camera", 0, 1'000'000)};
  if (type == "size") return read_size(fields);
  if (type == "samples") return SamplesMessage{static_cast<int64_t>(fields.integer("samples", 1, 1'000'000))};
  if (type == "pause") return PauseMessage{fields.flag("paused")};
  if (type == "denoise") return DenoiseMessage{fields.flag("on")};
  if (type == "environment") return read_environment(fields);
  if (type == "pick") return read_pick(fields);
  if (type == "material") return read_material(fields);
  if (type == "time") return TimeMessage{fields.number("time", -1e9, 1e9)};
  if (type == "stop") return StopMessage{};
  if (type == "save") return SaveMessage{};
  throw InputError("there is no message of the type " + quoted(type.substr(0, 40)));
}

/// Text that is not UTF-8, such as the name of a file, is replaced.
std::string text_of(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

Json json_of(const Vec3& v) { return Json::array({v.x, v.y, v.z}); }

template <class Value>
Json json_of(const std::optional<Value>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json json_of(const EnvironmentMessage& e) {
  return {{"rotation", e.rotation}, {"strength", e.strength}, {"light_scale", e.light_scale}};
}

}  // namespace

PageMessage parse_page_message(std::string_view text) {
  if (text.size() > max_message_bytes)
    throw InputError("the message is longer than " + std::to_string(max_message_bytes) + " bytes");
  const auto check_depth = [](int depth, Json::parse_event_t event, Json&) {
    const bool is_opened = event == Json::parse_event_t::object_start || event == Json::parse_event_t::array_start;
    if (is_opened && depth >= max_message_depth) throw InputError("the message is nested too deeply");
    return true;
  };
  const Json json = Json::parse(text.begin(), text.end(), check_depth, false);
  if (json.is_discarded()) throw InputError("the message is not JSON");
  Fields outer(json, "a message");
  const Json& type = outer.get("type");
  if (!type.is_string()) outer.refuse("type", "a text");
  const std::string name = type.get<std::string>();
  Fields fields(json, name.size() <= 40 ? name : "a message");
  fields.get("type");
  PageMessage message = read_message(name, fields);
  fields.finish();
  return message;
}

std::string scene_message(const SceneText& s) {
  Json layers = Json::array();
  for (const auto& [name, channels] : s.layers) layers.push_back({{"name", name}, {"channels", channels}});
  Json animation = nullptr;
  if (s.animation) animation = {{"start", (*s.animation)[0]}, {"end", (*s.animation)[1]}, {"fps", (*s.animation)[2]}};
  return text_of({{"type", "scene"},
                  {"name", s.name},
                  {"path", s.path},
                  {"version", version()},
                  {"read_only", s.read_only},
                  {"size", Json::array({s.width, s.height})},
                  {"up", json_of(s.up)},
                  {"left_handed", s.left_handed},
                  {"middle", json_of(s.middle)},
                  {"radius", s.radius},
                  {"cameras", s.cameras},
                  {"layers", std::move(layers)},
                  {"animation", std::move(animation)},
                  {"environment", s.environment ? json_of(*s.environment) : Json(nullptr)},
                  {"materials", s.materials},
                  {"reference", s.reference},
                  {"samples", s.samples},
                  {"exposure", s.exposure},
                  {"tone_map", s.tone_map},
                  {"options", s.options}});
}

std::string camera_message(const PageCamera& c, std::optional<uint64_t> id) {
  const Json camera{{"position", json_of(c.position)}, {"target", json_of(c.target)}, {"up", json_of(c.up)},
                    {"fov", json_of(c.fov)},           {"aperture", c.aperture},      {"focus", json_of(c.focus)}};
  return text_of({{"type", "camera"}, {"camera", camera}, {"id", json_of(id)}});
}

std::string status_message(const StatusText& s) {
  return text_of({{"type", "status"},
                  {"activity", s.activity},
                  {"samples", s.samples},
                  {"samples_total", s.samples_total},
                  {"seconds", s.seconds},
                  {"remaining", json_of(s.remaining)},
                  {"mrays", json_of(s.mrays)},
                  {"viewers", s.viewers},
                  {"error", json_of(s.error)},
                  {"curve", s.curve},
                  {"denoising", s.denoising}});
}

std::string picked_message(const PickedText& picked) {
  Json json{{"type", "picked"},    {"id", picked.id},     {"object", nullptr},        {"instance", nullptr},
            {"where", nullptr},    {"material", nullptr}, {"material_name", nullptr}, {"kind", nullptr},
            {"position", nullptr}, {"normal", nullptr},   {"distance", nullptr},      {"fields", Json::array()}};
  const auto set = [&](const char* name, const std::string& text) {
    if (!text.empty()) json[name] = text;
  };
  if (picked.point) {
    const PickedPoint& point = *picked.point;
    set("object", point.object);
    set("instance", point.instance_name);
    set("where", point.where);
    json["position"] = json_of(point.position);
    json["normal"] = json_of(point.normal);
    json["distance"] = point.distance;
  }
  json["material"] = json_of(picked.material_index);
  set("material_name", picked.material_name);
  set("kind", picked.kind);
  constexpr const char* kinds[] = {"number", "bool", "colour"};  // in the order of FieldValue
  for (const MaterialField& field : picked.fields)
    json["fields"].push_back({{"name", field.name},
                              {"label", field.label},
                              {"kind", kinds[field.value.index()]},
                              {"value", std::visit([](const auto& value) { return Json(value); }, field.value)},
                              {"textured", field.is_textured},
                              {"min", field.min},
                              {"max", field.max}});
  return text_of(json);
}

std::string changes_message(const std::vector<std::string>& changes) {
  return text_of({{"type", "changes"}, {"changes", changes}});
}

std::string error_message(const std::string& message, bool is_fatal) {
  return text_of({{"type", "error"}, {"message", message}, {"fatal", is_fatal}});
}

std::string log_message(const std::string& message) { return text_of({{"type", "log"}, {"message", message}}); }

}  // namespace alhazen::impl
