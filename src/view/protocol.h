#pragma once

// The messages in text, JSON objects, that a page and the program send each other.

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "alhazen/alhazen.h"
#include "alhazen/geometry.h"
#include "view/scene_edit.h"

namespace alhazen::impl {

/// A camera as pages know it, in world space.
struct PageCamera {
  ::alhazen::Vec3 position, target, up;
  std::optional<double> fov;    ///< degrees over the shorter side; absent: the camera has none, or keeps that it has
  double aperture = 0;          ///< radius of the lens
  std::optional<double> focus;  ///< distance; absent: that of the target
  friend bool operator==(const PageCamera&, const PageCamera&) = default;
};

// What a page asks for.
// ------------------------------------------------------------------------------------------------

struct HelloMessage {};
struct LayersMessage {
  std::vector<std::string> layers;
  bool exact = false;  ///< single precision instead of half
};
struct AckMessage {
  uint64_t frame = 0;
};
struct CameraMessage {
  PageCamera camera;
  bool moving = false;  ///< more are to come
  uint64_t id = 0;
};
struct ResetMessage {};
struct SelectCameraMessage {
  size_t camera = 0;
};
struct SizeMessage {
  int width = 0, height = 0;
};
struct SamplesMessage {
  int64_t samples = 0;
};
struct PauseMessage {
  bool paused = false;
};
struct DenoiseMessage {
  bool on = false;
};
struct EnvironmentMessage {
  double rotation = 0, strength = 1, light_scale = 1;
};
struct PickMessage {
  int x = 0, y = 0;  ///< pixel of the whole picture at full resolution
  uint64_t id = 0;
};
struct MaterialMessage {
  size_t material = 0;
  std::map<std::string, FieldValue> values;
};
struct TimeMessage {
  double time = 0;  ///< seconds
};
struct StopMessage {};
struct SaveMessage {};

using PageMessage =
    std::variant<HelloMessage, LayersMessage, AckMessage, CameraMessage, ResetMessage, SelectCameraMessage, SizeMessage,
                 SamplesMessage, PauseMessage, DenoiseMessage, EnvironmentMessage, PickMessage, MaterialMessage,
                 TimeMessage, StopMessage, SaveMessage>;

/// Pictures of viewers have at most so many pixels.
inline constexpr int64_t max_view_pixels = int64_t{1} << 25;

/// Throws InputError, whose message is one sentence, for all that is no message: another type, a field that is missing,
/// unknown, of another type or out of range.
PageMessage parse_page_message(std::string_view text);

// What the program tells.
// ----------------------------------------------------------------------------------------------

struct SceneText {
  std::string name, path;  ///< of the file; `path` as it was given, to repeat it in commands
  bool read_only = false;
  int width = 0, height = 0;
  ::alhazen::Vec3 up;
  bool left_handed = false;
  ::alhazen::Vec3 middle;
  double radius = 1;
  std::vector<std::string> cameras, materials;
  std::vector<std::pair<std::string, std::vector<std::string>>> layers;  ///< with their channels
  std::optional<std::array<double, 3>> animation;                        ///< start, end, frames per second
  std::optional<EnvironmentMessage> environment;
  bool reference = false;
  int64_t samples = 0;
  double exposure = 0;
  std::string tone_map = "none", options;
};

/// What is under a pixel that was asked for.
struct PickedText {
  uint64_t id = 0;                       ///< of the question
  std::optional<PickedPoint> point;      ///< none: nothing is there
  std::optional<size_t> material_index;  ///< in SceneText::materials
  std::string material_name, kind;
  std::vector<MaterialField> fields;
};

struct StatusText {
  const char* activity = "reading";
  double samples = 0;
  int64_t samples_total = 0;
  double seconds = 0;
  std::optional<double> remaining, mrays, error;
  size_t viewers = 0;
  std::vector<std::array<double, 2>> curve;
  bool denoising = false;
};

std::string scene_message(const SceneText& scene);
std::string camera_message(const PageCamera& camera, std::optional<uint64_t> id);
std::string status_message(const StatusText& status);
std::string picked_message(const PickedText& picked);
std::string changes_message(const std::vector<std::string>& changes);
std::string error_message(const std::string& message, bool is_fatal);
std::string log_message(const std::string& message);

}  // namespace alhazen::impl
