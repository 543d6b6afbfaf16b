#pragma once

// Whether other programs disturbed a measurement. Three signs are used, since none sees everything: what a thread ran
// of the time in which it was busy, what other programs ran on the processors meanwhile, and how far repeats of the
// same work differ. The last one also sees what the first two cannot: a shared core, memory bus or frequency.

#include <cstdint>
#include <string>
#include <vector>

#include "render/control.h"
#include "study/study.h"

namespace alhazen::impl::study {

/// A run that received a smaller fraction of its processors was disturbed.
inline constexpr double min_processor_fraction = 0.9;
/// Repeats that differ by a larger fraction of their median are unsteady, where the slowest quarter is left out.
inline constexpr double max_steady_spread = 0.1;

/// What a run used.
struct RunUsage {
  double seconds = 0;            ///< of the render
  double processor_seconds = 0;  ///< of all threads of this process
  double idle_seconds = 0;       ///< of the processors that this process may use, together
};

/// The fraction of its processors that a run received: 1 if it had them to itself. A schedule can be as slow as its
/// slowest thread, so it is that of the thread that lost most, over the longest time that one was busy. Where threads
/// share processors with each other, or do not know their processor time, it is that of all together: what neither they
/// used nor was idle, others used.
double processor_fraction(const RunUsage& usage, const std::vector<ThreadStatistics>& threads, int processors);

/// Idle time since the machine started of the processors that this process may use; 0 if unknown. Its resolution is
/// that of the kernel, often 10 ms.
double idle_seconds();

/// The difference of the fastest and the slowest run over the median, without the slowest quarter of the runs, which
/// other programs may have slowed down; 0 for a single run.
double steady_spread(const std::vector<double>& seconds);
bool is_unsteady(const Trial& trial);
size_t disturbed_runs(const Trial& trial);

/// The runs of a trial that its next measurement replaces: the disturbed ones, and of unsteady ones the slowest.
std::vector<bool> runs_to_repeat(const Trial& trial);

/// Why the times of a trial may not be those of the machine alone, or are too few; empty if there is no reason.
std::string doubt_of(const Trial& trial, int repeats);
/// The same of a cell: of its times, or of those that its speedup relates to.
std::string doubt_of(const Study& study, const Cell& cell);

/// The speedup of a cell, or 0 if it is in doubt.
double trusted_speedup_of(const Study& study, const Table& table, const Cell& cell);

/// Whether all repeats of one trial are slower than all of the other, per sample or per ray.
bool are_separated(const Trial& a, const Trial& b, Measure measure);

}  // namespace alhazen::impl::study
