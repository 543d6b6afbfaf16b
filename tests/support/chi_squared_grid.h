#pragma once

// Tests with chi-squared whether numbers are uniform, over equal cells of the unit interval or square.

#include <cstddef>
#include <vector>

#include "support/chi_squared.h"

namespace alhazen::impl::test {

class UniformGrid {
 public:
  /// With one row, the cells divide an interval.
  UniformGrid(size_t columns, size_t rows) : columns_(columns), rows_(rows), counts_(columns * rows) {}

  void add(double x, double y = 0) {
    ++counts_.at(static_cast<size_t>(y * static_cast<double>(rows_)) * columns_ +
                 static_cast<size_t>(x * static_cast<double>(columns_)));
    ++total_;
  }

  ChiSquared test() const {
    return chi_squared_test(counts_, std::vector<double>(counts_.size(), total_ / static_cast<double>(counts_.size())));
  }

 private:
  size_t columns_, rows_;
  std::vector<double> counts_;
  double total_ = 0;
};

}  // namespace alhazen::impl::test
