#pragma once

// Path guiding over the passes of a render (docs/guiding.md): when it learns, how the trees of core/guiding are built
// from what it has learned, whether it pays, and by how much the samples of each iteration count.

#include <cstdint>
#include <string>
#include <vector>

#include "compile/compiled_scene.h"
#include "render/film.h"
#include "render/settings.h"

namespace alhazen {

/// The arrays of a GuideView.
struct GuideArrays {
  std::vector<uint32_t> cells;
  std::vector<GuideRegion> regions;
  std::vector<GuideQuad> quads;
  std::vector<uint64_t> light;
  std::vector<GuideTally> tallies;
};

/// What a render with guiding did, for reports.
struct GuidingState {
  bool is_used = false;     ///< the samples that are taken now are guided
  uint32_t iterations = 0;  ///< that were learned from
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
  /// The number of samples per pixel at which the iteration ends that sample number `samples` belongs to.
  uint32_t iteration_end(uint32_t samples) const;
  /// Where kernels find what was learned and add what they learn. It is valid until the iteration ends.
  GuideView<Real> view();
  /// Adds sums that a device has collected in arrays like those of view(). May be called from several threads.
  void add(const uint64_t* light, const GuideTally* tallies);
  /// Changes whenever the arrays of view() do.
  uint64_t generation() const { return generation_; }

  /// Ends an iteration: measures the variance of its samples and adds them to those of earlier ones, learns, and
  /// decides whether guiding goes on. Does nothing if `samples` per pixel do not end one.
  void end_iteration(Film<Real>& film, uint32_t samples);
  /// Weighs the samples of the present iteration in the image.
  void weigh_samples(Film<Real>& film) const;
  GuidingState state() const;

  /// The state for a checkpoint, and back. Returns false if the bytes are damaged.
  std::vector<std::byte> bytes() const;
  bool restore(const std::vector<std::byte>& bytes);

 private:
  bool is_learning() const { return is_on_ && to_fixed_ > 0; }
  double variance(const FilmView<Real>& film, std::vector<float>& tiles, double& plain) const;
  template <class Visit>
  void visit_state(Visit& visit);
  void learn();

  bool decides_;  ///< guiding ends where it does not pay
  uint64_t max_quads_;
  uint32_t first_;
  int width_, height_;
  double exposure_;
  Bounds3<Real> bounds_;
  bool is_on_ = true;
  uint32_t iteration_ = 0, guided_ = 0;               ///< ended; ended and guided
  double to_fixed_ = 0, gain_ = 0, last_weight_ = 1;  ///< the weight of the last iteration that has ended
  std::vector<float> plain_variance_;                 ///< of samples that were not guided, by tiles
  GuideArrays arrays_;
  uint64_t generation_ = 0;
};

}  // namespace alhazen
