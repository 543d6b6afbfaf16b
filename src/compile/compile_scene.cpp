#include "compile/compile_scene.h"

#include <algorithm>
#include <cmath>
#include <new>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "compile/camera.h"
#include "compile/emission.h"
#include "compile/images.h"
#include "compile/lights.h"
#include "compile/lost_light.h"
#include "compile/materials.h"
#include "compile/open_backs.h"
#include "compile/render_space.h"
#include "compile/trees.h"
#include "core/shapes/interaction.h"
#include "scene/mixes.h"
#include "util/memory_limit.h"
#include "util/thread_limit.h"

namespace alhazen {

namespace {

/// The final placement of a shape: its own transform, or an instance's applied to it.
struct Placement {
  const Shape* shape;
  MovingTransform world_from_object;
  bool reverse_orientation;
};

template <class Real>
class SceneCompiler {
 public:
  SceneCompiler(Scene& scene, const CompileOptions& options, Diagnostics& diagnostics)
      : scene_(scene), options_(options), diagnostics_(diagnostics) {}

  /// The message for a scene that does not fit into memory.
  std::string too_large() const {
    uint64_t texels = 0;
    for (const ImageTexels& image : scene_.images)
      texels += static_cast<uint64_t>(image.width) * static_cast<uint64_t>(image.height);
    return "the scene is too large for the memory of this machine, or for a limit set on it (ulimit -v, a "
           "container's): it "
           "places " +
           std::to_string(placed_shapes_) + " shapes, meshes of " + std::to_string(placed_triangles_) +
           " triangles among them, and has images of " + std::to_string(texels >> 20) +
           " million texels; give it fewer instances, less geometry or smaller images (--texture-budget)";
  }

  CompiledScene<Real> run() {
    check_film();
    CompiledScene<Real> flat;
    if (options_.in_render_space) move_to_render_space(scene_);
    compile_camera(scene_, width_, height_, out_, flat.view, diagnostics_);
    check_mixes(scene_);
    fit_images(scene_, options_.texture_budget, diagnostics_);
    materials_ = compile_materials(scene_, out_);
    for (const MaterialRecord<Real>& material : out_.materials) {
      if (material.features & MaterialFeatures::cutout) flat.view.has_cutouts = 1;
      if (material.opacity.count > 0) flat.view.lets_light_through = 1;
      if (material.features & MaterialFeatures::one_sided) has_one_sided_ = true;
      if (has_trait<&MaterialTraits::has_lobes>(material.kind)) flat.view.has_lobes = 1;
    }
    add_described_lights(scene_, out_, flat.view, light_measures_);
    place_shapes();
    weigh_emission_textures(out_, light_measures_);
    warn_of_dropped_triangles();
    for (const TriangleRecord& triangle : out_.triangles) {
      const uint32_t* v = triangle.vertex;
      if (is_narrow(out_.positions[v[0]], out_.positions[v[1]], out_.positions[v[2]])) {
        flat.view.has_narrow_triangles = 1;
        break;
      }
    }
    build_trees_and_query(flat);
    count_primitives(flat.statistics);
    flat.statistics.lights = out_.lights.size();
    flat.statistics.instances = out_.instances.size();
    out_.move_into(flat);
    return flat;
  }

 private:
  /// Builds the trees, then runs the queries that need rays. They use the binary tree.
  void build_trees_and_query(CompiledScene<Real>& flat) {
    if (has_one_sided_) split_coincident_sides(out_);
    const bool checks_lost_light = options_.path_segments > 0 && may_lose_light(out_.view());
    CompileOptions options = options_;
    if (has_one_sided_ || checks_lost_light) options.layouts.add(BvhLayout::bvh2);
    build_trees(options, out_, flat.statistics);
    add_triangle_emitters(out_);
    assign_light_probabilities(light_measures_, scene_.light_sampling, out_, flat.view);
    if (has_one_sided_ && open_seen_backs(whole_view(flat), static_cast<uint32_t>(width_),
                                          static_cast<uint32_t>(height_), options_.threads, out_))
      flat.view.lets_light_through = 1;
    if (checks_lost_light)
      if (const auto lost = find_lost_light(whole_view(flat), options_.path_segments))
        warn_of_lost_light(*lost, scene_, surface_shapes_[lost->surface]->where, diagnostics_);
    if (options_.layouts.has(BvhLayout::bvh2) || out_.bvh2_nodes.empty()) return;
    flat.statistics.tree_bytes -= out_.bvh2_nodes.size() * sizeof(out_.bvh2_nodes[0]);
    flat.statistics.nodes = out_.bvh8_nodes.size();
    std::vector<Bvh2Node<Real>>().swap(out_.bvh2_nodes);
  }

  void count_primitives(SceneStatistics& statistics) const {
    const auto count = [&](PrimitiveKind kind, const char* name, uint64_t number) {
      if (kind == PrimitiveKind::triangle)
        statistics.triangles = number;
      else if (kind == PrimitiveKind::sphere || kind == PrimitiveKind::moving_sphere)
        statistics.spheres += number;
      else
        statistics.others.push_back({name, number});
    };
#define ALHAZEN_COUNT(X, kind, Record, records, Block, blocks) \
  count(PrimitiveKind::kind, #records, out_.records.size());
    ALHAZEN_PRIMITIVES(ALHAZEN_COUNT, )
#undef ALHAZEN_COUNT
  }

  /// The settings of `flat` over the arrays as they are.
  SceneView<Real> whole_view(const CompiledScene<Real>& flat) const {
    SceneView<Real> view = out_.view();
    view.camera = flat.view.camera;
    view.has_cutouts = flat.view.has_cutouts;
    view.has_narrow_triangles = flat.view.has_narrow_triangles;
    view.lets_light_through = flat.view.lets_light_through;
    return view;
  }

  void check_film() {
    width_ = options_.width > 0 ? options_.width : scene_.film.width;
    height_ = options_.height > 0 ? options_.height : scene_.film.height;
    if (width_ < 1 || height_ < 1 || width_ > 100'000 || height_ > 100'000)
      throw InputError({scene_.name}, "an image of " + std::to_string(width_) + " x " + std::to_string(height_) +
                                          " pixels cannot be rendered: give sides between 1 and 100000");
  }

  /// Turns moving meshes into groups of their own, with one instance for those in the world, and one for each instance
  /// of the object that contains them.
  void group_moving_meshes() {
    const size_t group_count = scene_.groups.size();
    std::vector<std::vector<Instance>> instances(group_count);
    instances.at(0).emplace_back();  // the world itself
    for (const Instance& instance : scene_.instances)
      if (instance.group < group_count) instances[instance.group].push_back(instance);
    for (size_t g = 0; g < group_count; ++g) {
      std::vector<Shape> still;
      for (Shape& shape : std::exchange(scene_.groups[g].shapes, {}))
        if (shape.world_from_object.is_moving() && is_in_object(shape))
          move_by_instances(std::move(shape), instances[g]);
        else
          still.push_back(std::move(shape));
      scene_.groups[g].shapes = std::move(still);
    }
  }

  /// If the instance moves too, the positions at start and end are exact, and points move linearly in between.
  void move_by_instances(Shape shape, const std::vector<Instance>& of_object) {
    const MovingTransform inner = std::exchange(shape.world_from_object, {});
    for (Instance instance : of_object) {
      const MovingTransform& outer = instance.world_from_group;
      if (instance.group == no_index) instance.where = shape.where;
      instance.world_from_group = {outer.start * inner.start, outer.end * inner.end};
      instance.group = static_cast<uint32_t>(scene_.groups.size());
      scene_.instances.push_back(std::move(instance));
    }
    scene_.groups.push_back({{}, {std::move(shape)}});
  }

  /// Selects the groups that become objects: those that move, and those with several instances, unless all copies
  /// together have few triangles.
  std::vector<bool> find_objects() const {
    std::vector<uint64_t> uses(scene_.groups.size()), triangles(scene_.groups.size());
    std::vector<bool> moves(scene_.groups.size());
    for (const Instance& instance : scene_.instances) {
      if (instance.group >= scene_.groups.size()) throw InputError(instance.where, "the instance names no object");
      ++uses[instance.group];
      if (instance.world_from_group.is_moving()) moves[instance.group] = true;
    }
    uint64_t copied = 0;
    for (size_t g = 0; g < scene_.groups.size(); ++g) {
      for (const Shape& shape : scene_.groups[g].shapes)
        if (is_in_object(shape)) triangles[g] += mesh_of(shape).triangle_count();
      if (uses[g] > 1) copied += uses[g] * triangles[g];
    }
    std::vector<bool> is_object(scene_.groups.size());
    for (size_t g = 0; g < is_object.size(); ++g)
      is_object[g] = triangles[g] > 0 && (moves[g] || (copied > options_.max_copied_triangles && uses[g] > 1));
    return is_object;
  }

  /// Returns whether an object contains this shape of its group: lights, spheres and cylinders are copied to the world
  /// instead.
  static bool is_in_object(const Shape& shape) { return shape.type == ShapeType::mesh && !emits(shape); }

  const Mesh& mesh_of(const Shape& shape) const {
    if (shape.mesh >= scene_.meshes.size()) throw InputError(shape.where, "the shape names no mesh");
    return scene_.meshes[shape.mesh];
  }

  std::vector<Placement> world_placements() const {
    std::vector<Placement> all;
    for (const Shape& shape : scene_.groups.at(0).shapes)
      all.push_back({&shape, shape.world_from_object, shape.reverse_orientation});
    for (const Instance& instance : scene_.instances) {
      const MovingTransform& outer = instance.world_from_group;
      for (const Shape& shape : scene_.groups[instance.group].shapes)
        if (!is_object_[instance.group] || !is_in_object(shape))
          all.push_back({&shape,
                         {outer.start * shape.world_from_object.start, outer.end * shape.world_from_object.end},
                         shape.reverse_orientation != instance.reverse_orientation});
    }
    return all;
  }

  std::vector<Placement> object_placements(const ShapeGroup& group) const {
    std::vector<Placement> all;
    for (const Shape& shape : group.shapes)
      if (is_in_object(shape)) all.push_back({&shape, shape.world_from_object, shape.reverse_orientation});
    return all;
  }

  void place_shapes() {
    group_moving_meshes();
    is_object_ = find_objects();
    check_placements();
    const std::vector<Placement> world = world_placements();
    std::vector<std::vector<Placement>> objects(scene_.groups.size());
    for (size_t g = 0; g < objects.size(); ++g)
      if (is_object_[g]) objects[g] = object_placements(scene_.groups[g]);
    reserve(world, objects);
    for (const Placement& p : world) place(p);
    std::vector<uint32_t> object_of(objects.size(), no_index);
    for (size_t g = 0; g < objects.size(); ++g) {
      ObjectRecord object{};
      object.first_triangle = static_cast<uint32_t>(out_.triangles.size());
      for (const Placement& p : objects[g]) place(p);
      object.triangle_count = static_cast<uint32_t>(out_.triangles.size()) - object.first_triangle;
      if (object.triangle_count == 0) continue;
      object_of[g] = static_cast<uint32_t>(out_.objects.size());
      out_.objects.push_back(object);
    }
    for (const Instance& instance : scene_.instances)
      if (object_of[instance.group] != no_index) add_instance(instance, object_of[instance.group]);
  }

  /// Counts the shapes to be placed and the uses of each mesh.
  void reserve(const std::vector<Placement>& world, const std::vector<std::vector<Placement>>& objects) {
    uses_.assign(scene_.meshes.size(), 0);
    size_t triangles = 0, vertices = 0, normals = 0, uvs = 0;
    const auto count = [&](const std::vector<Placement>& placements) {
      for (const Placement& p : placements) {
        if (p.shape->type != ShapeType::mesh) continue;
        const Mesh& mesh = mesh_of(*p.shape);
        ++uses_[p.shape->mesh];
        triangles += mesh.triangle_count();
        vertices += mesh.positions.size();
        normals += mesh.normals.size();
        uvs += mesh.uvs.size() + mesh.second_uvs.size();
      }
    };
    count(world);
    for (const std::vector<Placement>& object : objects) count(object);
    placed_triangles_ = triangles;
    if (triangles > max_primitives_of_a_kind || vertices > 0xfffffff0u || world.size() > max_primitives_of_a_kind)
      throw InputError({scene_.name}, "the scene has " + std::to_string(triangles) + " triangles with " +
                                          std::to_string(vertices) + " vertices, more than 2^29 or 2^32: split it");
    if (scene_.instances.size() > Bvh8Child::max_index_count)
      throw InputError({scene_.name}, "the scene has " + std::to_string(scene_.instances.size()) +
                                          " instances, more than 2^26: split it");
    check_memory(triangles, vertices);
    out_.triangles.reserve(triangles);
    out_.positions.reserve(vertices);
    out_.normals.reserve(normals);
    out_.uvs.reserve(uvs);
  }

  /// Checks memory for the copies of spheres, cylinders and lights of objects.
  void check_placements() {
    placed_shapes_ = scene_.groups.at(0).shapes.size();
    for (const Instance& instance : scene_.instances)
      if (!is_object_[instance.group]) placed_shapes_ += scene_.groups[instance.group].shapes.size();
    if (placed_shapes_ * sizeof(Placement) > physical_memory() / 10 * 9) throw InputError({scene_.name}, too_large());
  }

  void check_memory(uint64_t triangles, uint64_t vertices) const {
    const uint64_t min_bytes =
        triangles * (sizeof(TriangleRecord) + sizeof(TriangleBlock<Real>) / 4) + vertices * sizeof(Vec3<Real>);
    if (min_bytes > physical_memory() / 10 * 9) throw InputError({scene_.name}, too_large());
  }

  void place(const Placement& p) {
    if (p.shape->type == ShapeType::sphere) return place_sphere(p);
    if (p.shape->type == ShapeType::cylinder) return place_cylinder(p);
    Mesh& mesh = scene_.meshes[p.shape->mesh];
    place_mesh(p, mesh);
    if (--uses_[p.shape->mesh] == 0) mesh = Mesh{};
  }

  void add_instance(const Instance& instance, uint32_t object) {
    const Transform opening = transform_at(instance, scene_.camera.shutter_open);
    const Transform closing = transform_at(instance, scene_.camera.shutter_close);
    const Matrix4 &there = opening.matrix(), back = opening.inverse().matrix(), in_the_end = closing.matrix();
    InstanceRecord<Real> record{};
    InstanceMotion<Real> motion{};
    for (size_t i = 0; i < 3; ++i)
      for (size_t j = 0; j < 4; ++j) {
        record.world_from_object[i][j] = static_cast<Real>(there[i][j]);
        record.object_from_world[i][j] = static_cast<Real>(back[i][j]);
        motion.change[i][j] = static_cast<Real>(in_the_end[i][j] - there[i][j]);
        if (!std::isfinite(record.world_from_object[i][j]) || !std::isfinite(record.object_from_world[i][j]) ||
            !std::isfinite(motion.change[i][j]))
          throw InputError(instance.where, "the transform of the object is not finite, or makes it flat");
      }
    record.object = object;
    record.flip_normal = instance.reverse_orientation ? 1 : 0;
    record.motion = no_motion;
    if (!(opening == closing)) {
      record.motion = static_cast<uint32_t>(out_.instance_motions.size());
      out_.instance_motions.push_back(motion);
    }
    out_.instances.push_back(record);
  }

  /// Matrices are interpolated linearly.
  Transform transform_at(const Instance& instance, double time) const {
    const MovingTransform& transform = instance.world_from_group;
    const double s = fraction_of_motion(transform, time);
    if (s == 0) return transform.start;
    Matrix4 matrix;
    for (size_t i = 0; i < 4; ++i)
      for (size_t j = 0; j < 4; ++j)
        matrix[i][j] = transform.start.matrix()[i][j] * (1 - s) + transform.end.matrix()[i][j] * s;
    try {
      return Transform(matrix);
    } catch (const std::domain_error&) {
      throw InputError(instance.where, "the transform makes the object flat while it moves");
    }
  }

  /// The fraction of its motion that a transform has completed at `time`.
  double fraction_of_motion(const MovingTransform& transform, double time) const {
    const double span = scene_.transform_end_time - scene_.transform_start_time;
    if (!transform.is_moving() || !(span > 0)) return 0;
    return clamp((time - scene_.transform_start_time) / span, 0.0, 1.0);
  }

  uint32_t material_of(const Shape& shape) const {
    if (shape.material == no_index) return static_cast<uint32_t>(scene_.materials.size());
    if (shape.material >= scene_.materials.size()) throw InputError(shape.where, "the shape names no material");
    return shape.material;
  }

  uint32_t add_surface(const Shape& shape, uint32_t light, uint32_t normal_offset, uint32_t uv_offset, bool flip,
                       uint32_t attributes = no_offset) {
    out_.surfaces.push_back({material_of(shape), light, normal_offset, uv_offset, flip ? 1u : 0u, attributes});
    surface_shapes_.push_back(&shape);
    return static_cast<uint32_t>(out_.surfaces.size() - 1);
  }

  /// Transparent emitters are found by BSDF sampling alone: light samples do not account for their transparency.
  uint32_t add_light(const Shape& shape, LightKind kind, size_t primitive, double area) {
    const Emission& emission = *shape.emission;
    static const Material opaque;
    const Material& material = shape.material == no_index ? opaque : scene_.materials[material_of(shape)];
    LightRecord<Real> light{};
    light.kind = kind;
    light.primitive = static_cast<uint32_t>(primitive);
    light.radiance = convert<Real>(emission.radiance);
    if (!is_finite(light.radiance))
      throw InputError(shape.where, "the radiance of the light is not finite in this precision: reduce it");
    light.two_sided = emission.two_sided && material.double_sided ? 1 : 0;
    if (emission.texture != no_index) light.texture = materials_.emission.at(emission.texture);
    out_.lights.push_back(light);
    light_measures_.push_back(material.alpha == no_index ? area : 0);
    return static_cast<uint32_t>(out_.lights.size() - 1);
  }

  static bool emits(const Shape& shape) { return shape.emission && max_component(shape.emission->radiance) > 0; }

  void place_sphere(const Placement& p) {
    const Shape& shape = *p.shape;
    if (!(shape.radius > 0) || !std::isfinite(shape.radius))
      throw InputError(shape.where, "the radius of a sphere must be above 0, not " + std::to_string(shape.radius));
    double scale = 1;
    if (!p.world_from_object.start.is_similarity(scale))
      diagnostics_.warn(shape.where,
                        "a sphere is stretched by an instance; it is rendered as a sphere of the same volume");
    const double radius = shape.radius * scale;
    const auto [centre, motion] = motion_of(p.world_from_object);
    check_sphere_range(shape, abs(centre) + abs(motion), radius);
    if (is_too_small(shape, radius)) return;
    const bool moves = !is_zero(motion);
    const size_t index = moves ? out_.moving_spheres.size() : out_.spheres.size();
    uint32_t light = no_light;
    if (emits(shape))
      light = add_light(shape, moves ? LightKind::moving_sphere : LightKind::sphere, index,
                        4 * pi<double> * radius * radius);
    const uint32_t surface = add_surface(shape, light, no_offset, no_offset, p.reverse_orientation);
    const uint32_t frame = sphere_frame(shape, p.world_from_object.start);
    if (moves)
      out_.moving_spheres.push_back(
          {convert<Real>(centre), static_cast<Real>(radius), convert<Real>(motion), surface, frame});
    else
      out_.spheres.push_back({convert<Real>(centre), static_cast<Real>(radius), surface, frame});
  }

  /// `farthest` bounds the coordinates of the centre.
  static void check_sphere_range(const Shape& shape, const Vec3d& farthest, double radius) {
    if (!(max_component(farthest) + radius <= max_coordinate))
      throw too_large(shape, "the sphere is too large or too far away");
  }

  /// Returns whether intersection tests miss it in this precision; they divide by the square of the radius.
  bool is_too_small(const Shape& shape, double radius) {
    const Real squared = sqr(static_cast<Real>(radius));
    if (squared > 0 && std::isfinite(1 / squared)) return false;
    diagnostics_.warn(shape.where, "a sphere is too small for this precision and is left out: scale the scene up");
    return true;
  }

  void place_cylinder(const Placement& p) {
    const Shape& shape = *p.shape;
    if (!(shape.radius > 0 && shape.z_min < shape.z_max && shape.phi_max > 0))
      throw InputError(shape.where, "a cylinder must have a radius, a height and an angle above 0");
    if (emits(shape)) diagnostics_.warn(shape.where, "a cylinder that is no mesh does not emit");
    if (p.world_from_object.is_moving())
      diagnostics_.warn(shape.where, "a cylinder moves; it is rendered at rest, where it is at the start");
    CylinderRecord<Real> record = cylinder_record(shape, p.world_from_object.start);
    if (!is_resolved(record)) {
      diagnostics_.warn(shape.where, "a cylinder is too small or too thin for this precision and is left out");
      return;
    }
    record.surface = add_surface(shape, no_light, no_offset, no_offset, p.reverse_orientation);
    out_.cylinders.push_back(record);
  }

  static CylinderRecord<Real> cylinder_record(const Shape& shape, const Transform& transform) {
    const bool is_whole = shape.phi_max >= 360;
    const double half = is_whole ? pi<double> : shape.phi_max / 2 * (pi<double> / 180);
    const Vec3d x{is_whole ? -1 : std::cos(half), is_whole ? 0 : std::sin(half), 0};
    CylinderRecord<Real> record{};
    record.cosine = static_cast<Real>(x.x);
    record.sine = static_cast<Real>(x.y);
    record.phi_max = static_cast<Real>(2 * half);
    const Vec3d centre = transform.point({0, 0, (shape.z_min + shape.z_max) / 2});
    const Vec3d axes[3] = {transform.direction(x * shape.radius),
                           transform.direction(Vec3d{-x.y, x.x, 0} * shape.radius),
                           transform.direction({0, 0, (shape.z_max - shape.z_min) / 2})};
    if (!(max_component(abs(centre) + abs(axes[0]) + abs(axes[1]) + abs(axes[2])) <= max_coordinate))
      throw too_large(shape, "the cylinder is too large or too far away");
    record.centre = convert<Real>(centre);
    long double columns[3][4]{}, rows[3][4];
    for (int i = 0; i < 3; ++i) {
      record.world_from_object[i] = convert<Real>(axes[i]);
      for (int j = 0; j < 3; ++j) columns[j][i] = static_cast<long double>(record.world_from_object[i][j]);
    }
    invert(columns, rows);  // the rounded one: error_of_point counts no rounding of it
    for (int i = 0; i < 3; ++i)
      record.object_from_world[i] = convert<Real>(Vec3<long double>{rows[i][0], rows[i][1], rows[i][2]});
    return record;
  }

  /// Returns whether lengths in both spaces can be squared in this precision.
  static bool is_resolved(const CylinderRecord<Real>& cylinder) {
    for (const auto& vectors : {cylinder.world_from_object, cylinder.object_from_world})
      for (int i = 0; i < 3; ++i)
        if (const Real squared = length_squared(vectors[i]);
            !(squared > 0 && std::isfinite(1 / squared) && std::isfinite(squared)))
          return false;
    return true;
  }

  /// The centre when the shutter opens, and its displacement until the shutter closes.
  std::pair<Vec3d, Vec3d> motion_of(const MovingTransform& transform) const {
    const Vec3d start = transform.start.point({}), end = transform.end.point({});
    const auto at = [&](double time) { return lerp(start, end, fraction_of_motion(transform, time)); };
    const Vec3d open = at(scene_.camera.shutter_open);
    return {open, at(scene_.camera.shutter_close) - open};
  }

  bool needs_uv(const Shape& shape) const {
    const bool has_emission_texture = shape.emission && shape.emission->texture != no_index;
    return has_emission_texture || (shape.material != no_index && materials_.needs_uv[shape.material]);
  }

  uint32_t sphere_frame(const Shape& shape, const Transform& world_from_object) {
    if (!needs_uv(shape)) return no_sphere_frame;
    const auto axis = [&](const Vec3d& a) { return convert<Real>(normalize(world_from_object.direction(a))); };
    out_.sphere_frames.push_back({axis({1, 0, 0}), axis({0, 1, 0}), axis({0, 0, 1})});
    return static_cast<uint32_t>(out_.sphere_frames.size() - 1);
  }

  /// Intersection multiplies three coordinates, normals four: beyond this they overflow.
  static constexpr double max_coordinate = sizeof(Real) == sizeof(float) ? 1e12 : 1e75;

  static InputError too_large(const Shape& shape, const std::string& what) {
    const std::string remedy =
        sizeof(Real) == sizeof(float) ? "use --precision double, or scale the scene down" : "scale the scene down";
    return InputError(shape.where, what + " for this precision: " + remedy);
  }

  void check_mesh(const Shape& shape, const Mesh& mesh) const {
    const size_t vertices = mesh.positions.size();
    if (mesh.indices.size() % 3 != 0)
      throw InputError(shape.where, "the number of the mesh's indices is not a multiple of 3");
    for (const uint32_t index : mesh.indices)
      if (index >= vertices)
        throw InputError(shape.where, "vertex index " + std::to_string(index) + " is out of range: the mesh has " +
                                          std::to_string(vertices) + " vertices");
    const auto fits = [&](const auto& values) { return values.empty() || values.size() == vertices; };
    if (!fits(mesh.normals) || !fits(mesh.uvs))
      throw InputError(shape.where, "the mesh has a different number of normals or uvs than of vertices");
    if (!fits(mesh.second_uvs) || !fits(mesh.colours) || !fits(mesh.tangents))
      throw InputError(shape.where,
                       "the mesh has a different number of second uvs, colours or tangents than of vertices");
  }

  void place_mesh(const Placement& p, const Mesh& mesh) {
    const Shape& shape = *p.shape;
    check_mesh(shape, mesh);
    if (p.world_from_object.is_moving())
      diagnostics_.warn(shape.where, "an emissive mesh moves; it is rendered at rest, where it is at the start");
    const Transform& transform = p.world_from_object.start;
    const uint32_t base = static_cast<uint32_t>(out_.positions.size());
    const auto offset_to = [&](size_t count) { return static_cast<uint32_t>(count) - base; };
    for (const Vec3d& position : mesh.positions) {
      const Vec3<Real> moved = convert<Real>(transform.point(position));
      if (!is_finite(moved)) throw InputError(shape.where, "a vertex of the mesh is not finite");
      if (static_cast<double>(max_component(abs(moved))) > max_coordinate)
        throw too_large(shape, "a vertex of the mesh is too far away");
      out_.positions.push_back(moved);
    }
    const uint32_t normal_offset = mesh.normals.empty() ? no_offset : offset_to(out_.normals.size());
    for (const Vec3f& normal : mesh.normals) {
      const Vec3d n = transform.normal(convert<double>(normal));
      out_.normals.push_back(length_squared(n) > 0 ? convert<Real>(normalize(n)) : Vec3<Real>{});
    }
    const uint32_t uv_offset = mesh.uvs.empty() ? no_offset : offset_to(out_.uvs.size());
    for (const Vec2f& uv : mesh.uvs) out_.uvs.push_back({static_cast<Real>(uv.x), static_cast<Real>(uv.y)});
    // Shading normals define the front if there are any; otherwise the winding in object space does.
    const bool flip =
        mesh.normals.empty() ? p.reverse_orientation != transform.swaps_handedness() : p.reverse_orientation;
    add_triangles(shape, mesh, base, normal_offset, uv_offset, flip, add_attributes(p, mesh, base));
  }

  /// Adds the vertex attributes other than normals and uvs.
  uint32_t add_attributes(const Placement& p, const Mesh& mesh, uint32_t base) {
    const Transform& transform = p.world_from_object.start;
    // Flipping a normal changes the handedness, as a mirror transform does.
    const bool swaps_handedness = transform.swaps_handedness() != p.reverse_orientation;
    if (mesh.second_uvs.empty() && mesh.colours.empty() && mesh.tangents.empty()) return no_offset;
    const auto offset_to = [&](const auto& values, size_t count) {
      return values.empty() ? no_offset : static_cast<uint32_t>(count) - base;
    };
    const AttributesRecord record{offset_to(mesh.second_uvs, out_.uvs.size()),
                                  offset_to(mesh.colours, out_.vertex_colours.size()),
                                  offset_to(mesh.tangents, out_.vertex_tangents.size())};
    for (const Vec2f& uv : mesh.second_uvs) out_.uvs.push_back({static_cast<Real>(uv.x), static_cast<Real>(uv.y)});
    for (const auto& c : mesh.colours) out_.vertex_colours.push_back({c[0], c[1], c[2], c[3]});
    for (const auto& t : mesh.tangents) {
      const Vec3d along = transform.direction(convert<double>(Vec3f{t[0], t[1], t[2]}));
      const double size = length(along);
      const Vec3f unit = size > 0 ? convert<float>(along / size) : Vec3f{};
      const float handedness = (t[3] < 0) != swaps_handedness ? -1.0f : 1.0f;
      out_.vertex_tangents.push_back({unit.x, unit.y, unit.z, handedness});
    }
    out_.vertex_attributes.push_back(record);
    return static_cast<uint32_t>(out_.vertex_attributes.size() - 1);
  }

  void add_triangles(const Shape& shape, const Mesh& mesh, uint32_t base, uint32_t normal_offset, uint32_t uv_offset,
                     bool flip, uint32_t attributes) {
    const uint32_t shared = emits(shape) ? 0 : add_surface(shape, no_light, normal_offset, uv_offset, flip, attributes);
    const bool has_default_uv = uv_offset == no_offset && needs_uv(shape);  // by the order of the vertices
    size_t without_area = 0;
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
      TriangleRecord triangle{{base + mesh.indices[i], base + mesh.indices[i + 1], base + mesh.indices[i + 2]}, shared};
      if (!has_default_uv) turn_if_narrow(triangle);
      const Vec3<Real> p0 = out_.positions[triangle.vertex[0]];
      const Real twice_area =
          length(cross(out_.positions[triangle.vertex[1]] - p0, out_.positions[triangle.vertex[2]] - p0));
      if (!std::isfinite(twice_area)) throw too_large(shape, "a triangle of the mesh is too large");
      if (!(twice_area > 0) || !std::isfinite(1 / twice_area)) {
        ++without_area;
        continue;
      }
      if (emits(shape)) {
        const uint32_t light =
            add_light(shape, LightKind::triangle, out_.triangles.size(), 0.5 * static_cast<double>(twice_area));
        triangle.surface = add_surface(shape, light, normal_offset, uv_offset, flip, attributes);
      }
      out_.triangles.push_back(triangle);
    }
    if (without_area > 0 && without_area_ == 0) without_area_place_ = shape.where;
    without_area_ += without_area;
  }

  /// Makes the longest edge of a narrow triangle the one opposite to vertex 0. The normal and the area are computed
  /// from the other two, whose product loses nothing if one of them is short.
  void turn_if_narrow(TriangleRecord& triangle) const {
    uint32_t(&v)[3] = triangle.vertex;
    const Vec3<Real> p[3] = {out_.positions[v[0]], out_.positions[v[1]], out_.positions[v[2]]};
    if (!is_narrow(p[0], p[1], p[2])) return;
    const Real opposite[3] = {length_squared(p[2] - p[1]), length_squared(p[0] - p[2]), length_squared(p[1] - p[0])};
    std::rotate(v, v + (std::max_element(opposite, opposite + 3) - opposite), v + 3);
  }

  void warn_of_dropped_triangles() {
    if (without_area_ == 0) return;
    const char* const what = sizeof(Real) == sizeof(float)
                                 ? " triangles have no area, or less than --precision float resolves, and are left out "
                                   "(the first of them here)"
                                 : " triangles have no area and are left out (the first of them here)";
    diagnostics_.warn(without_area_place_, std::to_string(without_area_) + " of " +
                                               std::to_string(without_area_ + out_.triangles.size()) + what);
  }

  Scene& scene_;
  const CompileOptions& options_;
  Diagnostics& diagnostics_;
  int64_t width_ = 0, height_ = 0;
  SceneArrays<Real> out_;
  CompiledMaterials materials_;
  bool has_one_sided_ = false;
  std::vector<const Shape*> surface_shapes_;  ///< by surface
  std::vector<bool> is_object_;               ///< by group
  std::vector<uint32_t> uses_;                ///< by mesh: placements still to come
  std::vector<double> light_measures_;        ///< by light, see assign_light_probabilities
  uint64_t placed_shapes_ = 0, placed_triangles_ = 0;
  size_t without_area_ = 0;
  SourceLocation without_area_place_;
};

}  // namespace

template <class Real>
CompiledScene<Real> compile_scene(Scene&& scene, const CompileOptions& options, Diagnostics& diagnostics) {
  limit_default_team();
  SceneCompiler<Real> compiler(scene, options, diagnostics);
  try {
    return compiler.run();
  } catch (const std::bad_alloc&) {
  } catch (const std::length_error&) {
  }
  throw InputError({scene.name}, compiler.too_large());
}

template CompiledScene<float> compile_scene(Scene&&, const CompileOptions&, Diagnostics&);
template CompiledScene<double> compile_scene(Scene&&, const CompileOptions&, Diagnostics&);

}  // namespace alhazen
