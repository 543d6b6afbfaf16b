#include "io/gltf/meshes.h"

#include <algorithm>
#include <cmath>

#include "geometry/tangents.h"
#include "io/gltf/draco.h"
#include "io/gltf/matrices.h"

namespace alhazen::impl::gltf {

namespace {

/// Values of one attribute with the morph targets added; nothing if the primitive lacks it.
using Attribute = std::optional<Values>;

class PrimitiveReader {
 public:
  PrimitiveReader(const Document& document, Buffers& buffers, Accessors& accessors, const Json& primitive,
                  const UvSets& uv_sets, const Deformation& deformation)
      : document_(document),
        accessors_(accessors),
        primitive_(primitive),
        attributes_(document.object(primitive, "attributes")),
        uv_sets_(uv_sets),
        deformation_(deformation) {
    if (attributes_ == nullptr) document_.fail(primitive, "\"attributes\" is missing here");
    if (const Json* compression = document.extension(primitive, "KHR_draco_mesh_compression"))
      draco_ = decode_draco(document, buffers, primitive, *compression);
  }

  Mesh run(uint64_t mode) {
    const Attribute positions = read("POSITION", {"VEC3"});
    if (!positions) document_.fail(*attributes_, "\"POSITION\" is missing here, so the mesh has no shape");
    vertices_ = positions->count;
    if (vertices_ > 0xfffffff0u) document_.fail(*attributes_, "the mesh has more than 2^32 vertices");
    Mesh mesh;
    mesh.name = document_.path();
    for (size_t i = 0; i < vertices_; ++i) {
      const float* p = (*positions)[i];
      mesh.positions.push_back({static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])});
    }
    read_directions(mesh);
    mesh.uvs = read_uvs(uv_sets_[0]);
    mesh.second_uvs = read_uvs(uv_sets_[1]);
    read_colours(mesh);
    mesh.indices = triangles(mode);
    if (!deformation_.joints.empty()) skin(mesh);
    if (deformation_.baked) {
      for (Vec3d& p : mesh.positions) p = transform_point(*deformation_.baked, p);
      mesh.normals.clear();
      mesh.tangents.clear();
    }
    return mesh;
  }

 private:
  /// From the Draco data if they have it, else from the accessor.
  Attribute base(const std::string& name, std::initializer_list<const char*> types) {
    if (draco_) {
      const auto entry = draco_->attributes.find(name);
      if (entry != draco_->attributes.end()) {
        check_components(name, entry->second, types);
        return entry->second;
      }
    }
    const auto index = document_.index(*attributes_, name.c_str(), "accessors");
    if (!index) return std::nullopt;
    return accessors_.floats(*index, types);
  }

  void check_components(const std::string& name, const Values& values, std::initializer_list<const char*> types) const {
    for (const char* type : types)
      if (values.components == static_cast<size_t>(type[3] - '0')) return;
    document_.fail(*attributes_, "the attribute " + name + " of the Draco data has " +
                                     std::to_string(values.components) + " components");
  }

  Attribute read(const std::string& name, std::initializer_list<const char*> types) {
    Attribute values = base(name, types);
    if (!values) return values;
    if (vertices_ != 0 && values->count != vertices_)
      document_.fail(*attributes_, "\"" + name + "\" has " + std::to_string(values->count) +
                                       " elements and \"POSITION\" " + std::to_string(vertices_));
    add_targets(name, *values);
    return values;
  }

  /// Deltas of tangents have no w; those of colours may lack alpha.
  void add_targets(const std::string& name, Values& values) {
    const Json* targets = document_.list(primitive_, "targets");
    if (targets == nullptr) return;
    for (size_t t = 0; t < targets->items.size() && t < deformation_.weights.size(); ++t) {
      const float weight = static_cast<float>(deformation_.weights[t]);
      if (weight == 0) continue;
      const auto index = document_.index(targets->items[t], name.c_str(), "accessors");
      if (!index) continue;
      const Values delta = accessors_.floats(*index, {"VEC3", "VEC2", "VEC4"});
      if (delta.count != values.count || delta.components > values.components ||
          delta.components + 1 < values.components)
        document_.fail(targets->items[t], "\"" + name + "\" of a morph target does not fit that of the mesh");
      for (size_t i = 0; i < values.count; ++i)
        for (size_t c = 0; c < delta.components; ++c) values.data[i * values.components + c] += weight * delta[i][c];
    }
  }

  void read_directions(Mesh& mesh) {
    // Without normals the triangles are flat, and given tangents are ignored, as the specification demands.
    const Attribute normals = read("NORMAL", {"VEC3"});
    if (!normals) return;
    for (size_t i = 0; i < vertices_; ++i) {
      const float* n = (*normals)[i];
      const Vec3f normal{n[0], n[1], n[2]};
      const float size = length(normal);
      mesh.normals.push_back(size > 0 ? normal / size : Vec3f{});
    }
    const Attribute tangents = read("TANGENT", {"VEC4"});
    if (!tangents) return;
    for (size_t i = 0; i < vertices_; ++i) {
      const float* t = (*tangents)[i];
      const Vec3f tangent{t[0], t[1], t[2]};
      const float size = length(tangent);
      const Vec3f unit = size > 0 ? tangent / size : Vec3f{};
      mesh.tangents.push_back({unit.x, unit.y, unit.z, t[3] < 0 ? -1.0f : 1.0f});
    }
  }

  /// v points down the image in glTF, and up here.
  std::vector<Vec2f> read_uvs(int set) {
    std::vector<Vec2f> uvs;
    const Attribute values = read("TEXCOORD_" + std::to_string(set), {"VEC2"});
    if (values)
      for (size_t i = 0; i < vertices_; ++i) uvs.push_back({(*values)[i][0], 1 - (*values)[i][1]});
    return uvs;
  }

  void read_colours(Mesh& mesh) {
    const Attribute values = read("COLOR_0", {"VEC4", "VEC3"});
    if (!values) return;
    const auto unit = [](float v) { return std::clamp(v, 0.0f, 1.0f); };
    for (size_t i = 0; i < vertices_; ++i) {
      const float* c = (*values)[i];
      mesh.colours.push_back({unit(c[0]), unit(c[1]), unit(c[2]), values->components == 4 ? unit(c[3]) : 1.0f});
    }
  }

  std::vector<uint32_t> vertex_order() {
    if (draco_) return draco_->indices;
    if (const auto index = document_.index(primitive_, "indices", "accessors"))
      return accessors_.integers(*index, "SCALAR");
    std::vector<uint32_t> order(vertices_);
    for (size_t i = 0; i < vertices_; ++i) order[i] = static_cast<uint32_t>(i);
    return order;
  }

  std::vector<uint32_t> triangles(uint64_t mode) {
    std::vector<uint32_t> order = vertex_order();
    for (const uint32_t index : order)
      if (index >= vertices_)
        document_.fail(primitive_, "vertex index " + std::to_string(index) + " is out of range: the mesh has " +
                                       std::to_string(vertices_) + " vertices");
    if (draco_ || mode == 4) {
      if (order.size() % 3 != 0) {
        document_.warn(primitive_,
                       "the number of vertices of the triangles is not a multiple of 3; the remaining vertices "
                       "are not drawn");
        order.resize(order.size() - order.size() % 3);
      }
      return order;
    }
    std::vector<uint32_t> result;
    for (size_t i = 0; i + 2 < order.size(); ++i) {
      if (mode == 5)
        result.insert(result.end(), {order[i], order[i + 1 + i % 2], order[i + 2 - i % 2]});
      else
        result.insert(result.end(), {order[i + 1], order[i + 2], order[0]});
    }
    return result;
  }

  // Skins -------------------------------------------------------------------------------------------------------------

  struct Influences {
    std::vector<uint32_t> joints;
    Values weights;
  };

  std::vector<Influences> read_influences() {
    std::vector<Influences> all;
    for (int set = 0; set < 16; ++set) {
      const std::string number = std::to_string(set);
      Influences influences;
      if (const Attribute joints = draco_attribute("JOINTS_" + number)) {
        // Compressed data may hold any number; those beyond the skin's joints are refused below.
        for (const float joint : joints->data)
          influences.joints.push_back(joint > 0 ? static_cast<uint32_t>(std::min(joint, 0x1p31f)) : 0);
      } else if (const auto index = document_.index(*attributes_, ("JOINTS_" + number).c_str(), "accessors")) {
        influences.joints = accessors_.integers(*index, "VEC4");
      } else {
        break;
      }
      const Attribute weights = base("WEIGHTS_" + number, {"VEC4"});
      if (!weights) document_.fail(*attributes_, "\"JOINTS_" + number + "\" has no \"WEIGHTS_" + number + "\"");
      influences.weights = *weights;
      if (influences.joints.size() != 4 * vertices_ || influences.weights.count != vertices_)
        document_.fail(*attributes_, "there must be as many joints and weights as vertices");
      for (const uint32_t joint : influences.joints)
        if (joint >= deformation_.joints.size())
          document_.fail(*attributes_, "joint " + std::to_string(joint) + " is out of range: the skin has " +
                                           std::to_string(deformation_.joints.size()) + " joints");
      all.push_back(std::move(influences));
    }
    return all;
  }

  Attribute draco_attribute(const std::string& name) const {
    if (!draco_) return std::nullopt;
    const auto entry = draco_->attributes.find(name);
    if (entry == draco_->attributes.end() || entry->second.components != 4) return std::nullopt;
    return entry->second;
  }

  /// Linear blend skinning: transforms each vertex by the weighted mean of its joints' matrices.
  void skin(Mesh& mesh) {
    const std::vector<Influences> influences = read_influences();
    if (influences.empty())
      document_.warn(*attributes_, "a skinned mesh has no \"JOINTS_0\"; its first joint moves the whole mesh");
    for (size_t i = 0; i < vertices_; ++i) {
      Matrix4 blended{};
      double total = 0;
      for (const Influences& set : influences)
        for (size_t k = 0; k < 4; ++k) total += static_cast<double>(set.weights[i][k]);
      for (const Influences& set : influences)
        for (size_t k = 0; k < 4; ++k)
          if (const double weight = static_cast<double>(set.weights[i][k]); weight != 0 && total > 0)
            add_scaled(blended, deformation_.joints[set.joints[4 * i + k]], weight / total);
      if (!(total > 0)) blended = deformation_.joints[0];
      mesh.positions[i] = transform_point(blended, mesh.positions[i]);
      if (!mesh.normals.empty()) {
        const Vec3d n = transform_normal(blended, convert<double>(mesh.normals[i]));
        mesh.normals[i] = length(n) > 0 ? convert<float>(normalize(n)) : Vec3f{};
      }
      if (!mesh.tangents.empty()) {
        auto& t = mesh.tangents[i];
        const Vec3d moved = transform_direction(
            blended, {static_cast<double>(t[0]), static_cast<double>(t[1]), static_cast<double>(t[2])});
        const Vec3f unit = length(moved) > 0 ? convert<float>(normalize(moved)) : Vec3f{};
        t = {unit.x, unit.y, unit.z, determinant(blended) < 0 ? -t[3] : t[3]};
      }
    }
  }

  const Document& document_;
  Accessors& accessors_;
  const Json& primitive_;
  const Json* attributes_;
  const UvSets& uv_sets_;
  const Deformation& deformation_;
  std::optional<DracoMesh> draco_;
  size_t vertices_ = 0;
};

/// Identifies the data of a primitive: appends members with their indices.
void append_key(const Json* value, std::string& key) {
  if (value == nullptr) return;
  for (size_t i = 0; i < value->items.size(); ++i) {
    if (i < value->keys.size()) key += value->keys[i];
    key += ':' + std::to_string(value->items[i].number) + ',';
    append_key(&value->items[i], key);
  }
}

}  // namespace

bool has_vertex_colours(const Document& document, const Json& primitive) {
  const Json* attributes = document.object(primitive, "attributes");
  return attributes != nullptr && attributes->find("COLOR_0") != nullptr;
}

size_t target_count(const Document& document, const Json& primitive) {
  const Json* targets = document.list(primitive, "targets");
  return targets == nullptr ? 0 : targets->items.size();
}

std::optional<uint32_t> Meshes::read(const Json& primitive, const MaterialUse& material,
                                     const Deformation& deformation) {
  const UvSets& uv_sets = material.uv_sets;
  const uint64_t mode = document_.whole(primitive, "mode").value_or(4);
  if (mode > 6) document_.fail(primitive, "unknown \"mode\" " + std::to_string(mode) + ": it may be from 0 to 6");
  if (mode < 4) {
    document_.warn(primitive, "points and lines have no area and are not drawn");
    return std::nullopt;
  }
  const bool is_shared = deformation.joints.empty() && !deformation.baked;
  std::string key = std::to_string(mode) + '/' + std::to_string(uv_sets[0]) + '/' + std::to_string(uv_sets[1]) + '/';
  if (material.tangent_set) key += 't' + std::to_string(*material.tangent_set) + '/';
  if (is_shared) {
    append_key(document_.object(primitive, "attributes"), key);
    key += '/' + std::to_string(document_.index(primitive, "indices", "accessors").value_or(no_index)) + '/';
    append_key(document_.list(primitive, "targets"), key);
    for (const double weight : deformation.weights) key += std::to_string(weight) + ',';
    if (const Json* compression = document_.extension(primitive, "KHR_draco_mesh_compression"))
      key += "/draco" + std::to_string(document_.required_index(*compression, "bufferView", "bufferViews"));
    if (const auto entry = by_key_.find(key); entry != by_key_.end()) return entry->second;
  }
  Mesh mesh = PrimitiveReader(document_, buffers_, accessors_, primitive, uv_sets, deformation).run(mode);
  if (mesh.indices.empty()) return std::nullopt;
  if (material.tangent_set) add_tangents(mesh, *material.tangent_set);
  scene_.meshes.push_back(std::move(mesh));
  const auto index = static_cast<uint32_t>(scene_.meshes.size() - 1);
  if (is_shared) by_key_[key] = index;
  return index;
}

}  // namespace alhazen::impl::gltf
