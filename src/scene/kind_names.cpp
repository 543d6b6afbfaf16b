#include "scene/kind_names.h"

namespace alhazen::impl {

const char* camera_name(CameraKind kind) {
  switch (kind) {
    case CameraKind::perspective:
      return "perspective";
    case CameraKind::orthographic:
      return "orthographic";
    case CameraKind::equirectangular:
    case CameraKind::equal_area:
      break;
  }
  return "spherical";
}

const char* material_kind_name(MaterialKind kind) {
  switch (kind) {
#define ALHAZEN_CASE(name, Name) \
  case MaterialKind::name:       \
    return #name;
    ALHAZEN_MATERIALS(ALHAZEN_CASE)
#undef ALHAZEN_CASE
  }
  return "";
}

const char* texture_kind_name(TextureKind kind) {
  switch (kind) {
#define ALHAZEN_CASE(name, Name) \
  case TextureKind::name:        \
    return #name;
    ALHAZEN_TEXTURES(ALHAZEN_CASE)
#undef ALHAZEN_CASE
  }
  return "";
}

std::string light_name(const Light& light) {
  return std::string(light_traits(light.kind).name) + ", " + light.where.to_string();
}

}  // namespace alhazen::impl
