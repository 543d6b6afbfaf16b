// Measurements beyond the report: other schedules and engines, ray queries, depth, objects, load balance, error.

#include <fmt/format.h>

#include <algorithm>

#include "study/names.h"
#include "study/plan.h"

namespace alhazen::impl::study {

namespace {

void plan_engines(Plan& plan) {
  Table& table =
      plan.add(Table{"engines",
                     "Engines and schedules that the report does not have",
                     "Batches of paths on one core, tiles of 16 x 16 pixels, Embree, and two schedules of CUDA: "
                     "persistent threads that take samples from a queue, and a wavefront with one kernel per stage "
                     "over queues. Those of the CPU take paths in batches, and their speedups are over a path at a "
                     "time, like all others. Embree supports float only.",
                     "engine",
                     Measure::seconds,
                     {"double", "float"},
                     {}});
  const auto add = [&](const std::string& row, Work work) {
    add_cell(table, row, work.settings.precision, plan.add(work), plan.one_core(work.settings.precision));
  };
  const int all = plan.processors();
  for (const char* precision : {"double", "float"}) {
    add(name::core_in_batches, plan.on_cpu("serial", precision, 1));
    Work tiles = plan.on_cpu("openmp", precision, all);
    tiles.settings.strategy = "tiles";
    tiles.settings.schedule = "dynamic";
    add(fmt::format("OpenMP tiles, {} threads", all), tiles);
  }
  Work embree = plan.on_cpu("embree", "float", 1);
  embree.settings.strategy = "tiles";
  add("Embree, 1 thread", embree);
  embree.settings.threads = all;
  add(fmt::format("Embree tiles, {} threads", all), embree);
  for (const char* strategy : {"persistent", "wavefront"})
    for (const char* precision : {"double", "float"}) {
      Work work = plan.on_gpu("cuda", precision);
      work.settings.strategy = strategy;
      add(fmt::format("CUDA {}", strategy), work);
    }
}

void plan_batches(Plan& plan) {
  Table& table =
      plan.add(Table{"batches",
                     fmt::format("What batches bring, {} threads", plan.processors()),
                     "The forms of Table 2 and the tiles, with the same bits: a path at a time, and in "
                     "batches, of which many paths are in flight together, so that SIMD instructions and "
                     "prefetches serve many rays. A reduction works on one block of 4 samples at a time, and "
                     "its batches are no larger. One core first; dynamic schedule, float. "
                     "Speedups are over the same form a path at a time.",
                     "form",
                     Measure::seconds,
                     {name::single, name::batches},
                     {}});
  for (const char* strategy : {"", "rows", "collapse", "rows+reduction", "reduction", "tiles"}) {
    const bool is_serial = std::string(strategy).empty();
    Work work = plan.path_at_a_time(is_serial ? "serial" : "openmp", "float", plan.processors());
    work.settings.strategy = strategy;
    if (!is_serial) work.settings.schedule = "dynamic";
    const std::string single = plan.add(work), row = is_serial ? name::one_core : strategy;
    work.queries = Queries::of_backend;
    add_cell(table, row, name::single, single, single);
    add_cell(table, row, name::batches, plan.add(work), single);
  }
}

void plan_queries(Plan& plan) {
  Table& table =
      plan.add(Table{"queries",
                     "Ray queries",
                     "One thread, the same paths; the time of a whole render divided by its rays. The linear scan is "
                     "the report's Algorithm 5; the binary BVH is traversed by single rays; the wide one has 8 "
                     "children per node, which SIMD tests at once, and is the one that the CPU backends use. "
                     "All are compiled for the same instruction set.",
                     "by",
                     Measure::nanoseconds_per_ray,
                     {"double", "float"},
                     {}});
  for (const char* precision : {"double", "float"}) {
    Work linear = plan.on_cpu("serial", precision, 1);
    const int64_t largest = std::min(linear.settings.width ? linear.settings.width : plan.scene().width, int64_t{800});
    linear.settings.width = linear.settings.height =
        plan.linear_size(plan.scene().spheres + plan.scene().triangles, largest);
    linear.settings.samples_per_pixel = 4;
    linear.queries = Queries::linear_scan;
    const std::string baseline = plan.add(linear);
    Work binary = plan.on_cpu("serial", precision, 1);
    binary.queries = Queries::binary_bvh;
    add_cell(table, "linear scan", precision, baseline, baseline,
             fmt::format("{0} x {0} pixels, S = 4", linear.settings.width));
    add_cell(table, name::binary_bvh, precision, plan.add(binary), baseline);
    add_cell(table, name::wide_bvh, precision, plan.one_core_in_batches(precision), baseline);
    if (std::string(precision) == "float") {
      Work embree = plan.on_cpu("embree", "float", 1);
      embree.settings.strategy = "tiles";
      add_cell(table, name::embree, precision, plan.add(embree), baseline);
    }
  }
}

void plan_balance(Plan& plan) {
  Table& table = plan.add(Table{
      "balance",
      fmt::format("Load balance, {} threads", plan.processors()),
      "Time that each thread is busy, from its start to the end of its last row or tile: the maximum over the mean (1: "
      "all end together), and the Gini coefficient (0: all equal). Medians over the repeats. A path at a time; rows "
      "are those of Table 3.",
      "strategy, schedule",
      Measure::load_balance,
      {"double", "float"},
      {}});
  for (const char* strategy : {"rows", "tiles"})
    for (const char* schedule : {"static", "dynamic", "guided"})
      for (const char* precision : {"double", "float"}) {
        Work work = plan.path_at_a_time("openmp", precision, plan.processors());
        work.settings.strategy = strategy;
        work.settings.schedule = schedule;
        add_cell(table, fmt::format("{} {}", strategy, schedule), precision, plan.add(work), plan.one_core(precision));
      }
}

void plan_depth(Plan& plan) {
  Table& table = plan.add(Table{"depth",
                                "Cost against depth: O(2^D) against O(D)",
                                "Algorithm 2 follows both rays at glass, so the rays of a path may double with every "
                                "segment; Algorithms 3 and 5 choose one of them. D is the maximum number of segments "
                                "of a path. One thread, a path at a time, float. Rays are per camera sample.",
                                "D",
                                Measure::seconds,
                                {name::branching, name::recursive, name::iterative},
                                {}});
  table.shows_rays = true;
  for (int depth = 1; depth <= 12; ++depth) {
    std::string baseline;
    for (size_t i = table.columns.size(); i-- > 0;) {
      Work work = plan.on_cpu("serial", "float", 1);
      work.settings.integrator = table.columns[i].substr(0, table.columns[i].find(' '));
      if (table.columns[i] == name::iterative) work.queries = Queries::path_at_a_time;
      work.settings.max_depth = depth - 1;
      work.settings.width = work.settings.height = plan.scale().depth_size;
      work.settings.samples_per_pixel = plan.scale().depth_samples;
      const std::string trial = plan.add(work);
      if (baseline.empty()) baseline = trial;
      add_cell(table, std::to_string(depth), table.columns[i], trial, baseline);
    }
  }
}

void plan_glass(Plan& plan) {
  Table& table = plan.add(
      Table{"glass",
            "The worst case of depth: nothing but glass",
            "A dense cloud of 1000 glass spheres, from which hardly any path escapes: every segment "
            "of Algorithm 2 branches. D is the maximum number of segments of a path. One thread, a path at a time, "
            "float.",
            "D",
            Measure::seconds,
            {name::branching, name::iterative},
            {}});
  table.shows_rays = true;
  for (int depth = 1; depth <= 12; ++depth) {
    Work work = plan.on_cpu("serial", "float", 1);
    work.objects = 1000;
    work.is_glass = true;
    work.settings.max_depth = depth - 1;
    work.settings.width = work.settings.height = plan.scale().depth_size / 4;
    work.settings.samples_per_pixel = plan.scale().depth_samples;
    work.queries = Queries::path_at_a_time;
    const std::string baseline = plan.add(work);
    work.queries = Queries::of_backend;  // its kernel takes a path at a time anyway
    work.settings.integrator = "branching";
    add_cell(table, std::to_string(depth), table.columns[0], plan.add(work), baseline);
    add_cell(table, std::to_string(depth), table.columns[1], baseline, baseline);
  }
}

void plan_objects(Plan& plan) {
  Table& table = plan.add(
      Table{"objects",
            "Cost against the number of objects: O(n) against O(log n)",
            "A cloud of n spheres under a white sky, with radii proportional to 1 / sqrt(n), so that path "
            "length is constant. One thread, float; the time of a whole render divided by its rays. The linear "
            "scan renders smaller images for more objects, as stated in its cells.",
            "spheres",
            Measure::nanoseconds_per_ray,
            {"linear scan", name::wide_bvh, name::embree},
            {}});
  for (uint64_t count = 10; count <= 1'000'000; count *= 10) {
    const std::string row = std::to_string(count);
    Work work = plan.on_cpu("serial", "float", 1);
    work.objects = count;
    work.settings.width = work.settings.height = plan.scale().objects_size;
    work.settings.samples_per_pixel = plan.scale().objects_samples;
    Work linear = work;
    linear.queries = Queries::linear_scan;
    linear.settings.samples_per_pixel = 4;
    linear.settings.width = linear.settings.height = plan.linear_size(count, plan.scale().objects_size);
    const std::string baseline = plan.add(linear);
    add_cell(table, row, table.columns[0], baseline, baseline,
             fmt::format("{0} x {0} pixels, S = 4", linear.settings.width));
    add_cell(table, row, table.columns[1], plan.add(work), baseline);
    work.settings.backend = "embree";
    work.settings.threads = 1;
    work.settings.strategy = "tiles";
    add_cell(table, row, table.columns[2], plan.add(work), baseline);
  }
}

void plan_error(Plan& plan) {
  Table& table =
      plan.add(Table{"error",
                     "Time to equal error",
                     fmt::format("S is the number of samples per pixel. The report's algorithms find light by BSDF "
                                 "sampling alone; `path` also samples lights "
                                 "(next-event estimation with multiple importance sampling). RMSE over "
                                 "red, green and blue against {} samples per pixel of `path` with another seed; "
                                 "{} x {} pixels, all threads, float.",
                                 plan.scale().reference_samples, plan.scale().error_size, plan.scale().error_size),
                     "S",
                     Measure::error,
                     {"iterative", "path"},
                     {}});
  for (int64_t samples = 4; samples <= 256; samples *= 4)
    for (const std::string& integrator : table.columns) {
      Work work = plan.on_cpu("openmp", "float", plan.processors());
      work.settings.strategy = "tiles";
      work.settings.schedule = "dynamic";
      work.settings.integrator = integrator;
      work.settings.width = work.settings.height = plan.scale().error_size;
      work.settings.samples_per_pixel = samples;
      work.is_compared = true;
      add_cell(table, std::to_string(samples), integrator, plan.add(work), "");
    }
}

}  // namespace

void plan_beyond(Plan& plan) {
  plan_engines(plan);
  plan_batches(plan);
  plan_queries(plan);
  plan_balance(plan);
  plan_depth(plan);
  plan_glass(plan);
  plan_objects(plan);
  plan_error(plan);
}

}  // namespace alhazen::impl::study
