// Tables 1 to 5 of the report and its OptiX measurement.

#include <fmt/format.h>

#include "core/film/block_sum.h"
#include "study/names.h"
#include "study/plan.h"

namespace alhazen::impl::study {

namespace {

const char* const precisions[] = {"double", "float"};

const char* const comparable =
    "The report's speedups may be compared with those here, its seconds may not: they are of other machines, another "
    "scene file and S = 1,000 samples per pixel.";

void plan_table1(Plan& plan) {
  Table& table =
      plan.add(Table{"table1",
                     "Table 1: one core",
                     "The serial algorithm, a path at a time. The report's serial program is recursive "
                     "(Algorithm 3); speedups of all its tables are relative to the loop of Algorithm 5 in the same "
                     "precision. Only double against float is comparable with the report.",
                     "algorithm",
                     Measure::seconds,
                     {"double", "float"},
                     {}});
  for (const char* integrator : {"iterative", "recursive"})
    for (const char* precision : precisions) {
      const bool is_loop = std::string(integrator) == "iterative";
      // The recursive kernel takes a path at a time anyway.
      Work work = is_loop ? plan.path_at_a_time("serial", precision, 1) : plan.on_cpu("serial", precision, 1);
      work.settings.integrator = integrator;
      add_cell(table, is_loop ? name::iterative : name::recursive, precision, plan.add(work), plan.one_core(precision));
    }
}

void plan_table2(Plan& plan) {
  Table& table =
      plan.add(Table{"table2",
                     fmt::format("Table 2: four forms of OpenMP, {} threads", plan.processors()),
                     "The loops that run in parallel: rows, rows and columns collapsed, rows and the sum over samples "
                     "(reduction), that sum alone. All follow a path at a time, as the report's do. A thread of the "
                     "reduction takes blocks of 4 samples, since a sum must not depend on the number of threads: with "
                     "S = 4 or less, a pixel has one block, and nothing is divided. "
                     "Schedule: dynamic. The report used 8 threads on cuda2; the order of the four is comparable.",
                     "form",
                     Measure::seconds,
                     {"float"},
                     {}});
  const std::pair<const char*, const char*> forms[] = {{"rows", "rows (simple)"},
                                                       {"collapse", "collapse"},
                                                       {"rows+reduction", "rows+reduction"},
                                                       {"reduction", "reduction"}};
  for (const auto& [strategy, row] : forms) {
    Work work = plan.path_at_a_time("openmp", "float", plan.processors());
    work.settings.strategy = strategy;
    work.settings.schedule = "dynamic";
    const bool is_undivided = std::string(strategy) == "reduction" && plan.scale().samples > 0 &&
                              plan.scale().samples <= static_cast<int64_t>(samples_per_block);
    add_cell(table, row, "float", plan.add(work), plan.one_core("float"),
             is_undivided ? "S is one block of 4 samples, which one thread takes: nothing is divided" : "");
  }
}

void plan_table3(Plan& plan) {
  Table& table = plan.add(Table{
      "table3",
      "Table 3: threads and schedules of OpenMP",
      std::string("Rows in parallel (Algorithm 4), a path at a time. The report has no guided schedule. ") + comparable,
      "threads, schedule",
      Measure::seconds,
      {"double", "float"},
      {}});
  for (const int threads : plan.thread_counts())
    for (const char* schedule : {"static", "dynamic", "guided"})
      for (const char* precision : precisions) {
        Work work = plan.path_at_a_time("openmp", precision, threads);
        work.settings.strategy = "rows";
        work.settings.schedule = schedule;
        const bool crowded = threads > plan.processors();
        add_cell(table, fmt::format("{} {}", threads, schedule), precision, plan.add(work), plan.one_core(precision),
                 crowded ? fmt::format("more threads than the {} processors here", plan.processors()) : "");
      }
}

void plan_table4(Plan& plan) {
  Table& table = plan.add(Table{"table4",
                                "Table 4: CUDA, one thread per pixel",
                                std::string("Algorithm 6 by size of block. ") + comparable,
                                "block",
                                Measure::seconds,
                                {"double", "float"},
                                {}});
  for (const char* block : {"8x8", "16x16", "16x32", "32x32"})
    for (const char* precision : precisions) {
      Work work = plan.on_gpu("cuda", precision);
      work.settings.strategy = "pixel";
      work.settings.block = block;
      add_cell(table, block, precision, plan.add(work), plan.one_core(precision));
    }
}

void plan_table5(Plan& plan) {
  Table& table = plan.add(Table{"table5",
                                "Table 5: CUDA, one thread for several chunks",
                                std::string("Algorithm 7 by size of block and number of chunks. ") + comparable,
                                "block, chunks",
                                Measure::seconds,
                                {"double", "float"},
                                {}});
  for (const char* block : {"8x8", "16x16"})
    for (const char* chunk : {"1x1", "2x2", "4x4", "5x5"})
      for (const char* precision : precisions) {
        Work work = plan.on_gpu("cuda", precision);
        work.settings.strategy = "chunk";
        work.settings.block = block;
        work.settings.chunk = chunk;
        add_cell(table, fmt::format("{}, {}", block, chunk), precision, plan.add(work), plan.one_core(precision));
      }
}

void plan_optix(Plan& plan) {
  Table& table =
      plan.add(Table{"optix",
                     "OptiX: rays traced by RT cores",
                     "The report needed 2 s with OptiX 6.5 on cuda2 and calls it 65 times as fast as its best "
                     "CUDA program there. Its OptiX program is another one, after NVIDIA's samples; here it is "
                     "the same light transport.",
                     "engine",
                     Measure::seconds,
                     {"float"},
                     {}});
  add_cell(table, name::optix, "float", plan.add(plan.on_gpu("optix", "float")), plan.one_core("float"));
}

}  // namespace

void plan_report(Plan& plan) {
  plan_table1(plan);
  plan_table2(plan);
  plan_table3(plan);
  plan_table4(plan);
  plan_table5(plan);
  plan_optix(plan);
}

}  // namespace alhazen::impl::study
