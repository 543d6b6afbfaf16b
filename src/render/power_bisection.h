#pragma once

// Powers of which every machine computes the same bits.

#include <cmath>

namespace alhazen::impl {

/// The powers x^a of one x >= 1, for an exponent a that is found from its largest binary digit, 1/8, to its smallest.
/// They consist of square roots and products, which IEEE 754 rounds in one way; std::pow may differ from machine to
/// machine.
class PowerBisection {
 public:
  explicit PowerBisection(double x) : root_(std::sqrt(std::sqrt(std::sqrt(x)))) {}
  /// x^a for the digits that were taken.
  double power() const { return power_; }
  /// x^a if the next digit is taken too.
  double next() const { return power_ * root_; }
  /// Goes on to the digit after the next.
  void step(bool takes_next) {
    if (takes_next) power_ = next();
    root_ = std::sqrt(root_);
  }

 private:
  double power_ = 1, root_;
};

}  // namespace alhazen::impl
