#pragma once

// Every way in which our own kernels take samples, for tests that the bits of an image do not depend on it.

#include <tuple>

#include "alhazen/alhazen.h"

namespace alhazen::impl::test {

/// Calls check(other) with settings that differ from `settings` in the backend, strategy, schedule, number of threads
/// or size of passes.
template <class Check>
void visit_engines(const Settings& settings, const Check& check) {
  Settings other = settings;
  other.backend = "openmp";
  for (const auto& [strategy, schedule, threads] : {std::tuple{"tiles", "dynamic", 2},
                                                    {"tiles", "guided", 3},
                                                    {"rows", "static", 3},
                                                    {"collapse", "dynamic,3", 2},
                                                    {"rows+reduction", "guided,2", 2},
                                                    {"reduction", "static", 3}}) {
    other.strategy = strategy;
    other.schedule = schedule;
    other.threads = threads;
    check(other);
  }
  other = settings;
  other.backend = "cuda";
  other.device = "host";
  for (const char* strategy : {"pixel", "chunk", "persistent", "wavefront"}) {
    other.strategy = strategy;
    check(other);
  }
  other = settings;
  other.time_limit = 1e6;  // other sizes of passes
  check(other);
}

}  // namespace alhazen::impl::test
