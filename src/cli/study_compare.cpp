// `alhazen study compare`: reports differences of two studies beyond noise.

#include <fmt/format.h>

#include <memory>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/subcommands.h"
#include "study/cell_text.h"
#include "study/compare.h"
#include "study/json.h"
#include "util/printable.h"

namespace alhazen::impl {

namespace {

struct StudyCompareOptions {
  std::string a, b;
  double threshold = 5;
  bool json = false;
};

void print_json(const study::StudyComparison& c) {
  nlohmann::ordered_json changes = nlohmann::ordered_json::array();
  for (const study::Change& change : c.changes)
    changes.push_back({{"table", change.table},
                       {"row", change.row},
                       {"column", change.column},
                       {"a_nanoseconds", change.a},
                       {"b_nanoseconds", change.b},
                       {"ratio", change.ratio()},
                       {"a_speedup", change.a_speedup},
                       {"b_speedup", change.b_speedup},
                       {"doubt", change.doubt}});
  const nlohmann::ordered_json j{{"differences", c.differences},
                                 {"compared", c.compared},
                                 {"by_chance", c.by_chance},
                                 {"changes", changes},
                                 {"states", c.states}};
  print_out("{}\n", j.dump());
}

void print_list(const study::StudyComparison& c) {
  for (const std::string& difference : c.differences) print_out("different {}\n", printable(difference));
  for (const study::Change& change : c.changes) {
    const double ratio = change.ratio();
    print_out("{:<10} {:<28} {:<24} {:>9} {}, {} to {} ns", printable(change.table), printable(change.row),
              printable(change.column), fmt::format("{:.3f}x", ratio > 1 ? ratio : 1 / ratio),
              ratio > 1 ? "slower" : "faster", study::short_number(change.a), study::short_number(change.b));
    if (change.a_speedup > 0 && change.b_speedup > 0)
      print_out("; speedup {} to {}", study::times_text(change.a_speedup), study::times_text(change.b_speedup));
    print_out("{}\n", change.doubt.empty() ? "" : "; in doubt: " + printable(change.doubt));
  }
  for (const std::string& state : c.states) print_out("{}\n", printable(state));
  print_out("{} of {} cells changed beyond noise; {} would by chance, at most\n", c.changes.size(), c.compared,
            c.by_chance);
}

void run(const StudyCompareOptions& o) {
  const study::StudyComparison comparison =
      study::compare_studies(study::read_study_json(o.a), study::read_study_json(o.b), o.threshold / 100, o.a, o.b);
  o.json ? print_json(comparison) : print_list(comparison);
}

}  // namespace

void register_study_compare(Command& study) {
  Command command = study.add_subcommand("compare", "Report differences of two studies beyond noise");
  auto o = std::make_shared<StudyCompareOptions>();
  command.add_option("A", o->a, "The folder of a study, or its study.json").required().value_name("");
  command.add_option("B", o->b, "A later one").required().value_name("");
  command.add_option("--threshold", o->threshold, "Ignore smaller changes (5)")
      .within(0.0, 1000.0)
      .value_name("PERCENT");
  command.add_flag("--json", o->json, "One JSON object instead of the list");
  command.on_run([o] { run(*o); });
}

}  // namespace alhazen::impl
