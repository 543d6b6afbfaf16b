#include "scene/subject.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace alhazen::impl {

namespace {

/// The most that a mesh counts by its vertices, and what a corner of the box about another shape counts.
constexpr double max_weight_of_mesh = 1000, weight_of_corner = 16;
/// Vertices that are kept of all shapes together, about as many, but at least so many of each.
constexpr size_t kept_points = 200'000, min_kept_of_mesh = 8;
/// Fraction of the points beyond each side of the box about the middle.
constexpr double outside = 0.05;
constexpr double min_ratio_to_smaller = 30, min_ratio_to_middle = 3;
/// Of the size of the subject: no point is nearer to the camera.
constexpr double min_distance = 1e-3;

struct WeightedPoint {
  Vec3d position;
  double weight;
};

struct Measured {
  PlacedShape placed;
  ViewReach reach;
  std::vector<WeightedPoint> points;

  double size() const { return length(placed.box.diagonal()); }
  double weight() const {
    double sum = 0;
    for (const WeightedPoint& point : points) sum += point.weight;
    return sum;
  }
};

std::vector<Measured> measure(const Scene& scene, const std::optional<ViewFrame>& frame) {
  size_t count = 0;
  for_each_placed_shape(scene, [&](const Shape&, const Transform&) { ++count; });
  const size_t kept = std::max(kept_points / std::max<size_t>(count, 1), min_kept_of_mesh);
  std::vector<Measured> all;
  for_each_placed_shape(scene, [&](const Shape& shape, const Transform& world_from_object) {
    Measured measured{{&shape, world_from_object, {}}, {}, {}};
    const bool is_mesh = shape.type == ShapeType::mesh;
    const size_t vertices = is_mesh ? scene.meshes[shape.mesh].positions.size() : 0;
    const size_t step = vertices / std::min<size_t>(kept, static_cast<size_t>(max_weight_of_mesh)) + 1;
    const double weight =
        is_mesh ? std::min(static_cast<double>(step), max_weight_of_mesh * static_cast<double>(step) /
                                                          static_cast<double>(std::max<size_t>(vertices, 1)))
                : weight_of_corner;
    size_t index = 0;
    for_each_point(scene, shape, world_from_object, [&](const Vec3d& p) {
      measured.placed.box.extend(p);
      if (frame) measured.reach.add(*frame, p);
      if (index++ % step == 0) measured.points.push_back({p, weight});
    });
    if (!measured.placed.box.is_empty()) all.push_back(std::move(measured));
  });
  return all;
}

/// The coordinates below and above which that fraction of the weight is.
std::pair<double, double> middle_range(std::vector<std::pair<double, double>>& weighted) {
  std::sort(weighted.begin(), weighted.end());
  double total = 0;
  for (const auto& [value, weight] : weighted) total += weight;
  const auto beyond = [&](auto first, auto last) {
    double sum = 0;
    for (; first != last; ++first) {
      sum += first->second;
      if (sum > outside * total) return first->first;
    }
    return 0.0;
  };
  return {beyond(weighted.begin(), weighted.end()), beyond(weighted.rbegin(), weighted.rend())};
}

Bounds3<double> middle_box(const std::vector<Measured>& shapes) {
  Bounds3<double> box;
  if (shapes.empty()) return box;
  Vec3d low, high;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<std::pair<double, double>> weighted;
    for (const Measured& shape : shapes)
      for (const WeightedPoint& point : shape.points) weighted.emplace_back(point.position[axis], point.weight);
    const auto [least, most] = middle_range(weighted);
    low[axis] = least, high[axis] = most;
  }
  box.extend(low);
  box.extend(high);
  return box;
}

/// `shapes` by increasing size.
void leave_out_larger_than_all_smaller(std::vector<Measured>& shapes) {
  Bounds3<double> smaller;
  for (size_t i = 0; i + 1 < shapes.size(); ++i) {
    smaller.extend(shapes[i].placed.box);
    const double size = length(smaller.diagonal());
    if (shapes[i + 1].size() > min_ratio_to_smaller * size && size > 0 && i + 1 >= shapes.size() / 2) {
      shapes.erase(shapes.begin() + static_cast<std::ptrdiff_t>(i) + 1, shapes.end());
      return;
    }
  }
}

void leave_out_larger_than_middle(std::vector<Measured>& shapes) {
  const double largest = min_ratio_to_middle * length(middle_box(shapes).diagonal());
  const auto is_small = [&](const Measured& shape) { return shape.size() <= largest; };
  const auto large = std::stable_partition(shapes.begin(), shapes.end(), is_small);
  double small_weight = 0, large_weight = 0;
  for (auto shape = shapes.begin(); shape != shapes.end(); ++shape)
    (shape < large ? small_weight : large_weight) += shape->weight();
  if (small_weight > large_weight) shapes.erase(large, shapes.end());
}

}  // namespace

Subject find_subject(const Scene& scene, const std::optional<ViewFrame>& frame) {
  std::vector<Measured> shapes = measure(scene, frame);
  std::stable_sort(shapes.begin(), shapes.end(),
                   [](const Measured& a, const Measured& b) { return a.size() < b.size(); });
  leave_out_larger_than_all_smaller(shapes);
  leave_out_larger_than_middle(shapes);
  Subject subject;
  const Bounds3<double> middle = middle_box(shapes);
  if (!middle.is_empty()) subject.middle = middle.centre();
  Bounds3<double> box;
  for (Measured& shape : shapes) {
    box.extend(shape.placed.box);
    subject.reach.add(shape.reach);
    subject.shapes.push_back(std::move(shape.placed));
  }
  if (!box.is_empty()) subject.size = length(box.diagonal());
  if (frame && shapes.empty()) subject.reach.add(*frame, subject.middle);
  return subject;
}

namespace {

double min_distance_of(const Subject& subject) { return min_distance * (subject.size > 0 ? subject.size / 2 : 1e-6); }

}  // namespace

Vec3d fitting_eye(const Subject& subject, const ViewFrame& frame) {
  return subject.reach.eye(frame, min_distance_of(subject));
}

Vec3d all_round_fitting_eye(const Scene& scene, const Subject& subject, const ViewFrame& frame, const Vec3d& up) {
  ViewReach reach;
  const auto visit = [&](const Vec3d& p) { reach.add_all_round(frame, p - subject.middle, up); };
  for (const PlacedShape& placed : subject.shapes)
    for_each_point(scene, *placed.shape, placed.world_from_object, visit);
  if (subject.shapes.empty()) visit(subject.middle);
  return subject.middle + reach.eye(frame, min_distance_of(subject));
}

}  // namespace alhazen::impl
