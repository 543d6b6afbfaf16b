#pragma once

// The OpenMP strategies, for all backends that run on CPU threads.

#include "render/backend.h"

namespace alhazen::impl {

/// The first is the fastest.
enum class OpenMpStrategy : uint32_t { tiles, rows, collapse, rows_with_reduction, reduction };

/// Returns the names of the strategies, in the order of the enumerators.
std::vector<std::string> openmp_strategies();

/// Renders a pass with the strategy, schedule and number of threads of its settings.
void render_openmp(const RenderPass<float>& pass);
void render_openmp(const RenderPass<double>& pass);

}  // namespace alhazen::impl
