#pragma once

namespace alhazen::impl {

/// One function for std::visit of several, each for its type.
template <class... Functions>
struct Overloaded : Functions... {
  using Functions::operator()...;
};

}  // namespace alhazen::impl
