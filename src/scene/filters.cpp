#include "scene/filters.h"

namespace alhazen::impl {

const std::map<std::string, Filter>& named_filters() {
  static const std::map<std::string, Filter> filters{{"box", {FilterType::box, 0.5, 0.5}},
                                                     {"gaussian", {FilterType::gaussian, 1.5, 1.5}},
                                                     {"mitchell", {FilterType::mitchell, 2, 2}},
                                                     {"sinc", {FilterType::sinc, 4, 4}},
                                                     {"triangle", {FilterType::triangle, 2, 2}}};
  return filters;
}

}  // namespace alhazen::impl
