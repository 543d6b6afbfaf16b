#include "io/gltf/draco.h"

#ifdef ALHAZEN_WITH_DRACO
#include <draco/compression/decode.h>
#endif

#include <cmath>

namespace alhazen::impl::gltf {

#ifdef ALHAZEN_WITH_DRACO

namespace {

/// The divisor of normalized integers of the accessor that the attribute replaces, else 1.
float divisor_of(const Document& document, const Json& primitive, const std::string& name) {
  const Json* attributes = document.object(primitive, "attributes");
  const auto index = attributes == nullptr ? std::nullopt : document.index(*attributes, name.c_str(), "accessors");
  if (!index) return 1;
  const Json& accessor = document.item("accessors", *index);
  if (!document.flag(accessor, "normalized", false)) return 1;
  switch (document.whole(accessor, "componentType").value_or(0)) {
    case 5120:
      return 127;
    case 5121:
      return 255;
    case 5122:
      return 32767;
    case 5123:
      return 65535;
    default:
      return 1;
  }
}

Values values_of(const Document& document, const Json& place, draco::PointAttribute& attribute, size_t count,
                 float divisor) {
  Values values{count, static_cast<size_t>(static_cast<uint8_t>(attribute.num_components())), {}};
  if (values.components < 1 || values.components > 4)
    document.fail(place, "an attribute of the Draco data has " + std::to_string(values.components) + " components");
  attribute.set_normalized(false);
  values.data.resize(count * values.components);
  for (size_t i = 0; i < count; ++i) {
    const draco::AttributeValueIndex at = attribute.mapped_index(draco::PointIndex(static_cast<uint32_t>(i)));
    float element[4] = {};
    if (at.value() >= attribute.size() ||
        !attribute.ConvertValue<float>(at, static_cast<int8_t>(values.components), element))
      document.fail(place, "an attribute of the Draco data cannot be read");
    for (size_t c = 0; c < values.components; ++c) {
      if (!std::isfinite(element[c])) document.fail(place, "the Draco data have a value that is not finite");
      values.data[i * values.components + c] = std::max(element[c] / divisor, divisor == 1 ? element[c] : -1.0f);
    }
  }
  return values;
}

}  // namespace

DracoMesh decode_draco(const Document& document, Buffers& buffers, const Json& primitive, const Json& compression) {
  const BufferView& view = buffers.view(document.required_index(compression, "bufferView", "bufferViews"));
  draco::DecoderBuffer source;
  source.Init(reinterpret_cast<const char*>(view.bytes.data()), view.bytes.size());
  draco::Decoder decoder;
  auto decoded = decoder.DecodeMeshFromBuffer(&source);
  if (!decoded.ok())
    document.fail(compression, "the Draco data cannot be decompressed: " + decoded.status().error_msg_string());
  const std::unique_ptr<draco::Mesh> mesh = std::move(decoded).value();
  DracoMesh result;
  result.vertex_count = mesh->num_points();
  result.indices.reserve(size_t{mesh->num_faces()} * 3);
  for (uint32_t f = 0; f < mesh->num_faces(); ++f)
    for (const draco::PointIndex& point : mesh->face(draco::FaceIndex(f))) result.indices.push_back(point.value());
  const Json* attributes = document.object(compression, "attributes");
  if (attributes == nullptr) document.fail(compression, "\"attributes\" is missing here");
  for (size_t i = 0; i < attributes->items.size(); ++i) {
    const std::string& name = attributes->keys[i];
    const uint64_t id = document.whole(*attributes, name.c_str()).value_or(0);
    const int place = id > 0xffffffffu ? -1 : mesh->GetAttributeIdByUniqueId(static_cast<uint32_t>(id));
    if (place < 0) document.fail(attributes->items[i], "the Draco data have no attribute " + std::to_string(id));
    result.attributes[name] = values_of(document, attributes->items[i], *mesh->attribute(place), result.vertex_count,
                                        divisor_of(document, primitive, name));
  }
  return result;
}

#else

DracoMesh decode_draco(const Document& document, Buffers&, const Json&, const Json& compression) {
  document.fail(compression,
                "the mesh is compressed by Draco, and this program was built without that library: install "
                "libdraco-dev and build again");
}

#endif

}  // namespace alhazen::impl::gltf
