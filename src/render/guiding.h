#pragma once

// Path guiding over the passes of a render (docs/guiding.md): when it learns, how the trees of core/guiding are built
// from what it has learned, whether it pays, and by how much the samples of each iteration count.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "compile/compiled_scene.h"
#include "render/film.h"
#include "render/settings.h"

namespace alhazen::impl {

/// The arrays of a GuideView.
struct GuideArrays {
  std::vector<uint32_t> cells;
  std::vector<GuideRegion> regions;
  std::vector<GuideQuad> quads;
  std::vector<uint64_t> light;
  std::vector<GuideTally> tallies;
};

/// Sums over pixels of the variance of samples without guiding, and of those of the present iteration, both relative to
/// the luminance of the image. Only pixels that take samples in it count, in both.
struct VarianceComparison {
  double plain = 0, present = 0;
  double samples = 0;                ///< of the present iteration, less one for each pixel
  double earlier_samples = 0;        ///< of the iterations before
  std::vector<float> present_tiles;  ///< the mean variance of the pixels of each tile, not relative
};

/// What a render with guiding did, for reports.
struct GuidingState {
  bool is_used = false;     ///< the last samples were guided
  uint32_t iterations = 0;  ///< that were guided, the last of which may be incomplete
  uint64_t regions = 0, bytes = 0;
  double gain = 0;  ///< variance without guiding over that with it, as last measured; 0: not measured
};

/// Iterations end at 2^k times a first number of samples per pixel. In the first, paths are not guided and nothing is
/// learned but the brightness of the image; in the second they are not guided, but learned from; from the third on they
/// are guided by what the iterations before have learned.
template <class Real>
class Guiding {
 public:
  Guiding(const RenderSettings& settings, const SceneView<Real>& scene);

  /// How the samples of the present iteration are taken.
  IntegratorKind integrator() const { return is_learning() ? IntegratorKind::guided_path : IntegratorKind::path; }
  /// Called before each pass, with the number of samples that every pixel has. If an iteration ended with them, the
  /// next one begins: the samples of the old one are weighed and added to those before, it is learned from, and it is
  /// decided whether guiding goes on.
  void begin_pass(Film<Real>& film, uint32_t samples);
  /// How many samples per pixel are left of the iteration that the next one, number `samples`, belongs to.
  uint32_t samples_left(uint32_t samples) const;
  /// Where kernels find what was learned and add what they learn. It is valid until the iteration ends.
  GuideView<Real> view();
  /// Adds sums that a device has collected in arrays like those of view(). May be called from several threads.
  void add(const uint64_t* light, const GuideTally* tallies);
  /// Changes whenever the arrays of view() do.
  uint64_t generation() const { return generation_; }

  /// Weighs the samples of the present iteration in the image: by 1 if they are not guided, else by the ratio of the
  /// variance without guiding to theirs.
  void weigh_samples(Film<Real>& film);
  /// With the number of samples that every pixel has.
  GuidingState state(uint32_t samples) const;

  /// The state for a checkpoint, and back. Returns false if the bytes are damaged.
  std::vector<std::byte> bytes() const;
  bool restore(const std::vector<std::byte>& bytes);

 private:
  bool is_learning() const { return is_on_ && to_fixed_ > 0; }
  /// The number of samples per pixel with which the present iteration ends.
  uint64_t iteration_end() const { return uint64_t{first_} << iteration_; }
  /// Whether the samples of the present iteration are guided.
  bool is_guided() const { return is_on_ && !plain_variance_.empty(); }
  /// Nothing if there are too few samples to compare.
  std::optional<double> measured_weight(const VarianceComparison& variances) const;
  void end_iteration(Film<Real>& film);
  void learn();
  /// Visits what a checkpoint keeps, of a Guiding or a const one.
  template <class Self, class Visit>
  static void visit_state(Self& self, Visit& visit);

  bool decides_;  ///< guiding ends where it does not pay
  uint64_t max_bytes_;
  uint32_t first_;
  int width_, height_;
  double exposure_;
  Bounds3<Real> bounds_;
  bool is_on_ = true;
  uint32_t iteration_ = 0, guided_ = 0;  ///< ended; ended and guided
  double to_fixed_ = 0;
  double last_weight_ = 1;             ///< of the last iteration that ended
  double gain_ = 0;                    ///< as in GuidingState
  std::vector<float> plain_variance_;  ///< of samples that were not guided: mean over the pixels of each tile
  GuideArrays arrays_;
  uint64_t generation_ = 0;
};

}  // namespace alhazen::impl
