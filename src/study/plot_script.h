#pragma once

#include <string_view>

namespace alhazen::impl::study {

/// The text of python/alhazen/study_plots.py (src/study/plot_script.cpp.in).
std::string_view plot_script();

}  // namespace alhazen::impl::study
