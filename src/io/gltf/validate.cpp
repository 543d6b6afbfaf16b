#include "io/gltf/validate.h"

#include <algorithm>

#include "io/gltf/accessors.h"
#include "io/gltf/validate_extensions.h"

namespace alhazen::impl::gltf {

namespace {

class Validator {
 public:
  explicit Validator(const Document& document) : d_(document) {}

  void run() {
    each("buffers", [&](const Json& o) { check_buffer(o); });
    each("bufferViews", [&](const Json& o) { check_view(o); });
    each("accessors", [&](const Json& o) { check_accessor(o); });
    each("images", [&](const Json& o) { check_image(o); });
    each("samplers", [](const Json&) {});
    each("textures", [&](const Json& o) {
      d_.index(o, "source", "images");
      d_.index(o, "sampler", "samplers");
    });
    each("materials", [&](const Json& o) { check_textures(o, 0); });
    each("meshes", [&](const Json& o) { check_mesh(o); });
    each("cameras", [](const Json&) {});
    each("skins", [&](const Json& o) { check_skin(o); });
    each("nodes", [&](const Json& o) { check_node(o); });
    each("animations", [&](const Json& o) { check_animation(o); });
    each("scenes", [&](const Json& o) { check_indices(o, "nodes", "nodes"); });
    d_.index(d_.root(), "scene", "scenes");
    validate_extensions(d_);
  }

 private:
  template <class Check>
  void each(const char* array, const Check& check) {
    for (size_t i = 0; i < d_.array(array).size(); ++i) check(d_.item(array, i));
  }

  template <class Check>
  void each_object(const Json& owner, const char* list, const Check& check) {
    const Json* items = d_.list(owner, list);
    if (items == nullptr) return;
    for (const Json& item : items->items) {
      if (item.kind != JsonKind::object) d_.fail(item, "every item of \"" + std::string(list) + "\" must be an object");
      check(item);
    }
  }

  void check_indices(const Json& owner, const char* list, const char* array) {
    const Json* items = d_.list(owner, list);
    if (items == nullptr) return;
    for (const Json& item : items->items) d_.as_index(item, array);
  }

  void check_buffer(const Json& o) {
    if (d_.required_whole(o, "byteLength") == 0) d_.fail(o, "\"byteLength\" of a buffer must be at least 1");
    d_.string(o, "uri");
  }

  void check_view(const Json& o) {
    const uint32_t buffer = d_.required_index(o, "buffer", "buffers");
    const uint64_t size = d_.required_whole(d_.item("buffers", buffer), "byteLength");
    const uint64_t offset = d_.whole(o, "byteOffset").value_or(0), length = d_.required_whole(o, "byteLength");
    if (offset > size || length > size - offset)
      d_.fail(o, "the buffer view ends at byte " + std::to_string(offset + length) + " of a buffer of " +
                     std::to_string(size) + " bytes");
    const uint64_t stride = d_.whole(o, "byteStride").value_or(4);
    if (stride < 4 || stride > 252) d_.fail(o, "\"byteStride\" must be from 4 to 252, not " + std::to_string(stride));
  }

  struct ViewSize {
    uint64_t length = 0, stride = 0;  ///< bytes; stride 0: tightly packed
  };

  /// After decompression.
  ViewSize size_of_view(uint32_t index) const {
    const Json& view = d_.item("bufferViews", index);
    for (const char* name : {"EXT_meshopt_compression", "KHR_meshopt_compression"})
      if (const Json* compression = d_.extension(view, name)) {
        const uint64_t stride = d_.required_whole(*compression, "byteStride");
        const uint64_t count = d_.required_whole(*compression, "count");
        // Whether the two are sensible is checked where the view is decompressed.
        const bool fits = stride <= 256 && count <= uint64_t{1} << 40;
        return {fits ? stride * count : d_.required_whole(view, "byteLength"), stride};
      }
    return {d_.required_whole(view, "byteLength"), d_.whole(view, "byteStride").value_or(0)};
  }

  /// Written so that it cannot overflow, whatever the file contains.
  void check_fits(const Json& o, const ViewSize& view, uint64_t count, uint64_t element, bool is_strided) {
    const uint64_t offset = d_.whole(o, "byteOffset").value_or(0);
    const uint64_t stride = is_strided && view.stride != 0 ? view.stride : element;
    if (stride < element)
      d_.fail(o, "elements of " + std::to_string(element) + " bytes overlap in a buffer view whose stride is " +
                     std::to_string(stride));
    if (offset > view.length || element > view.length - offset ||
        (count - 1) > (view.length - offset - element) / stride)
      d_.fail(o, "the accessor's " + std::to_string(count) + " elements do not fit into its buffer view of " +
                     std::to_string(view.length) + " bytes");
  }

  void check_accessor(const Json& o) {
    const auto view = d_.index(o, "bufferView", "bufferViews");
    const uint64_t count = d_.required_whole(o, "count");
    if (count == 0) d_.fail(o, "the accessor is empty: \"count\" must be at least 1");
    d_.required_whole(o, "componentType");
    const uint64_t element = element_bytes(d_, o);
    if (view) check_fits(o, size_of_view(*view), count, element, true);
    const Json* sparse = d_.object(o, "sparse");
    if (sparse == nullptr) return;
    const uint64_t replaced = d_.required_whole(*sparse, "count");
    if (replaced == 0 || replaced > count)
      d_.fail(*sparse, "\"sparse\" must replace at least one element and at most all of them");
    for (const char* part : {"indices", "values"}) {
      const Json* object = d_.object(*sparse, part);
      if (object == nullptr) d_.fail(*sparse, "\"sparse\" needs \"indices\" and \"values\"");
      const uint32_t from = d_.required_index(*object, "bufferView", "bufferViews");
      const bool is_indices = part[0] == 'i';
      const uint64_t size =
          is_indices ? component_bytes(d_, *object, d_.required_whole(*object, "componentType")) : element;
      check_fits(*object, size_of_view(from), replaced, size, false);
    }
  }

  void check_image(const Json& o) {
    d_.string(o, "uri");
    const bool has_view = d_.index(o, "bufferView", "bufferViews").has_value();
    if (has_view == (o.find("uri") != nullptr)) d_.fail(o, "an image has either a \"uri\" or a \"bufferView\"");
  }

  /// Checks members whose names end in "Texture", wherever extensions of the material have them.
  void check_textures(const Json& o, int depth) {
    for (size_t i = 0; i < o.items.size() && depth < 8; ++i) {
      const Json& member = o.items[i];
      if (member.kind != JsonKind::object || o.keys.empty() || o.keys[i] == "extras") continue;
      if (o.keys[i].ends_with("Texture")) {
        // Unknown extensions may or may not need one.
        if (depth < 2)
          d_.required_index(member, "index", "textures");
        else
          d_.index(member, "index", "textures");
      }
      check_textures(member, depth + 1);
    }
  }

  /// Returns the number of elements of the attributes, which must all have the same.
  std::optional<uint64_t> check_attributes(const Json& attributes, std::optional<uint64_t> count) {
    for (size_t i = 0; i < attributes.items.size(); ++i) {
      const std::string& name = attributes.keys[i];
      const Json& accessor = d_.item("accessors", d_.as_index(attributes.items[i], "accessors"));
      const uint64_t elements = d_.required_whole(accessor, "count");
      if (count && *count != elements)
        d_.fail(attributes.items[i], "\"" + name + "\" has " + std::to_string(elements) +
                                         " elements and another attribute has " + std::to_string(*count));
      count = elements;
    }
    return count;
  }

  void check_mesh(const Json& o) {
    const Json* primitives = d_.list(o, "primitives");
    if (primitives == nullptr || primitives->items.empty()) d_.fail(o, "the mesh has no primitives");
    std::optional<size_t> targets;
    each_object(o, "primitives", [&](const Json& primitive) {
      const Json* attributes = d_.object(primitive, "attributes");
      if (attributes == nullptr) d_.fail(primitive, "\"attributes\" is missing here");
      const std::optional<uint64_t> count = check_attributes(*attributes, std::nullopt);
      d_.index(primitive, "indices", "accessors");
      d_.index(primitive, "material", "materials");
      size_t own_targets = 0;
      each_object(primitive, "targets", [&](const Json& target) {
        check_attributes(target, count);
        ++own_targets;
      });
      if (targets && *targets != own_targets)
        d_.fail(primitive, "the primitives of a mesh must have equally many morph targets");
      targets = own_targets;
    });
    if (const Json* weights = d_.list(o, "weights"); weights != nullptr && weights->items.size() != targets.value_or(0))
      d_.fail(*weights, "the mesh has " + std::to_string(weights->items.size()) + " weights and " +
                            std::to_string(targets.value_or(0)) + " morph targets");
  }

  void check_skin(const Json& o) {
    check_indices(o, "joints", "nodes");
    const auto matrices = d_.index(o, "inverseBindMatrices", "accessors");
    if (const Json* joints = d_.list(o, "joints"); joints != nullptr && matrices) {
      const uint64_t count = d_.required_whole(d_.item("accessors", *matrices), "count");
      if (count < joints->items.size())
        d_.fail(o, "the skin has " + std::to_string(joints->items.size()) + " joints and only " +
                       std::to_string(count) + " inverse bind matrices");
    }
    d_.index(o, "skeleton", "nodes");
  }

  void check_node(const Json& o) {
    check_indices(o, "children", "nodes");
    d_.index(o, "camera", "cameras");
    const auto mesh = d_.index(o, "mesh", "meshes");
    const auto skin = d_.index(o, "skin", "skins");
    if (skin && !mesh) d_.fail(o, "the node has a skin and no mesh");
    if (o.find("weights") != nullptr && !mesh) d_.fail(o, "the node has weights and no mesh");
    if (o.find("matrix") != nullptr)
      for (const char* part : {"translation", "rotation", "scale"})
        if (o.find(part) != nullptr)
          d_.fail(o, std::string("a node has either \"matrix\" or \"translation\", \"rotation\" and \"scale\""));
  }

  void check_animation(const Json& o) {
    const Json* samplers = d_.list(o, "samplers");
    const size_t sampler_count = samplers == nullptr ? 0 : samplers->items.size();
    each_object(o, "samplers", [&](const Json& sampler) {
      d_.required_index(sampler, "input", "accessors");
      d_.required_index(sampler, "output", "accessors");
    });
    each_object(o, "channels", [&](const Json& channel) {
      if (d_.required_whole(channel, "sampler") >= sampler_count)
        d_.fail(channel, "index out of range: \"samplers\" has " + std::to_string(sampler_count) + " items");
      const Json* target = d_.object(channel, "target");
      if (target == nullptr) d_.fail(channel, "\"target\" is missing here");
      d_.index(*target, "node", "nodes");
    });
  }

  const Document& d_;
};

}  // namespace

void validate(const Document& document) { Validator(document).run(); }

}  // namespace alhazen::impl::gltf
