#pragma once

// The strategies of OpenMP, for the backends that trace by them.

#include "render/backend.h"

namespace alhazen {

/// The first is the fastest.
enum class OpenMpStrategy : uint32_t { tiles, rows, collapse, rows_with_reduction, reduction };

/// Their names, in order.
std::vector<std::string> openmp_strategies();

/// Takes the pass by the strategy, schedule and number of threads of its settings.
void render_openmp(const RenderPass<float>& pass);
void render_openmp(const RenderPass<double>& pass);

}  // namespace alhazen
