#include "study/json.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <filesystem>
#include <vector>

#include "files/input_file.h"
#include "study/disturbance.h"
#include "study/read_json.h"

namespace alhazen::impl::study {

namespace {

using Json = nlohmann::ordered_json;

Json machine_json(const Machine& m) {
  Json engines = Json::array();
  for (const Engine& e : m.engines)
    engines.push_back({{"name", e.name}, {"available", e.available}, {"details", e.details}, {"devices", e.devices}});
  return {{"processor", m.processor},   {"processors", m.processors}, {"instructions", m.instructions},
          {"memory_gib", m.memory_gib}, {"system", m.system},         {"governor", m.governor},
          {"engines", engines}};
}

Json scale_json(const Scale& s) {
  return {{"name", s.name},
          {"width", s.width},
          {"height", s.height},
          {"samples", s.samples},
          {"gpu_samples", s.gpu_samples},
          {"repeats", s.repeats}};
}

Json seconds_json(const std::vector<double>& seconds) {
  if (seconds.empty()) return nullptr;
  const Spread spread = spread_of(seconds);
  return {{"median", spread.median}, {"min", spread.min}, {"max", spread.max}, {"samples", seconds}};
}

Json trial_json(const Trial& t, int repeats) {
  Json j{{"key", t.key}, {"status", to_string(t.status)}};
  if (!t.reason.empty()) j["reason"] = t.reason;
  if (t.seconds.empty()) return j;
  j["seconds"] = seconds_json(t.seconds);
  j["busy_seconds"] = t.busy_seconds;
  j["processor_shares"] = t.processor_fractions;
  j["involuntary_switches"] = t.switches;
  if (!t.disturbed_seconds.empty()) j["disturbed_seconds"] = t.disturbed_seconds;
  j["build_seconds"] = t.build_seconds;
  j["width"] = t.width;
  j["height"] = t.height;
  j["spp"] = t.samples_per_pixel;
  j["camera_samples"] = t.samples;
  j["rays"] = t.rays;
  j["shadow_rays"] = t.shadow_rays;
  if (t.rmse >= 0) j["rmse"] = t.rmse;
  if (const std::string doubt = doubt_of(t, repeats); !doubt.empty()) j["doubt"] = doubt;
  return j;
}

Json report_json(const std::vector<ReportFigure>& figures) {
  Json list = Json::array();
  for (const ReportFigure& f : figures) {
    Json j{{"machine", f.machine}, {"seconds", f.seconds > 0 ? Json(f.seconds) : Json(nullptr)}};
    if (f.speedup > 0) j["speedup"] = f.speedup;
    list.push_back(j);
  }
  return list;
}

Json cell_json(const Study& study, const Table& table, const Cell& cell) {
  const Trial& trial = *study.find(cell.trial);
  Json j{{"row", cell.row}, {"column", cell.column}, {"status", to_string(trial.status)}};
  if (!trial.reason.empty()) j["reason"] = trial.reason;
  if (!cell.note.empty()) j["note"] = cell.note;
  j["trial"] = cell.trial;
  if (!cell.baseline.empty()) j["baseline"] = cell.baseline;
  if (trial.has_times()) {
    j["seconds"] = seconds_json(trial.seconds);
    j["spp"] = trial.samples_per_pixel;
    if (trial.samples > 0) j["nanoseconds_per_sample"] = cost_of(trial, Measure::seconds) * 1e9;
    if (trial.rays > 0) {
      j["nanoseconds_per_ray"] = cost_of(trial, Measure::nanoseconds_per_ray) * 1e9;
      j["rays_per_sample"] = static_cast<double>(trial.rays + trial.shadow_rays) / static_cast<double>(trial.samples);
    }
    if (const double speedup = speedup_of(study, table, cell); speedup > 0) j["speedup"] = speedup;
    if (table.measure == Measure::load_balance) {
      j["busiest_over_mean"] = busiest_over_mean(trial);
      j["gini"] = gini_of_busy(trial);
    }
    if (trial.rmse >= 0) j["rmse"] = trial.rmse;
    if (const std::string doubt = doubt_of(study, cell); !doubt.empty()) j["doubt"] = doubt;
  }
  if (!cell.report.empty()) j["report"] = report_json(cell.report);
  return j;
}

Json table_json(const Study& study, const Table& table) {
  Json cells = Json::array();
  for (const Cell& cell : table.cells) cells.push_back(cell_json(study, table, cell));
  return {{"id", table.id},
          {"title", table.title},
          {"text", table.text},
          {"row_title", table.row_title},
          {"measure", to_string(table.measure)},
          {"columns", table.columns},
          {"rows", table.rows()},
          {"cells", cells}};
}

Json grid_json(const ThreadGrid& grid, const std::string& file) {
  return {{"threads_x", grid.width},
          {"threads_y", grid.height},
          {"mean", grid.mean()},
          {"largest", grid.largest_mean()},
          {"smallest", grid.smallest_mean()},
          {"total", grid.total()},
          {"busiest_over_mean", grid.busiest_over_mean()},
          {"gini", gini(grid.segments)},
          {"picture", file}};
}

Json figure3_json(const WorkPerThread& w) {
  return {{"width", w.width},
          {"height", w.height},
          {"spp", w.samples_per_pixel},
          {"chunks", std::to_string(w.chunks_x) + "x" + std::to_string(w.chunks_y)},
          {"statistic_mean", w.statistic_mean},
          {"naive", grid_json(w.naive, "figure3-naive.pfm")},
          {"chunked", grid_json(w.chunked, "figure3-chunked.pfm")}};
}

}  // namespace

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json to_json(const Study& study) {
  Json conditions = Json::array(), tables = Json::array(), trials = Json::array();
  for (const Conditions& c : study.conditions)
    conditions.push_back({{"seconds", c.seconds}, {"load", c.load}, {"megahertz", c.megahertz}});
  for (const Table& table : study.tables) tables.push_back(table_json(study, table));
  for (const Trial& trial : study.trials) trials.push_back(trial_json(trial, study.scale.repeats));
  const SceneFacts& s = study.scene;
  Json j{{"schema", schema_name},
         {"version", study.machine.version},
         {"date", study.date},
         {"complete", study.is_complete},
         {"runs", {{"measured", study.runs_measured()}, {"planned", study.runs_planned()}}},
         {"seconds", study.seconds},
         {"machine", machine_json(study.machine)},
         {"build", {{"compiler", study.machine.compiler}, {"flags", study.machine.flags}, {"id", study.machine.build}}},
         {"scene",
          {{"name", s.name},
           {"hash", s.hash},
           {"width", s.width},
           {"height", s.height},
           {"D", s.segments},
           {"spheres", s.spheres},
           {"triangles", s.triangles},
           {"lights", s.lights}}},
         {"scale", scale_json(study.scale)},
         {"conditions", conditions},
         {"tables", tables}};
  if (study.work_per_thread.is_there()) j["figure3"] = figure3_json(study.work_per_thread);
  j["trials"] = trials;
  return j;
}

namespace {

InputError damaged_study(const std::string& path, const nlohmann::json::exception& error) {
  return {{path}, std::string("this study is damaged (") + error.what() + "): give another --output"};
}

}  // namespace

nlohmann::json read_study_json(const std::string& given) {
  std::error_code error;
  const bool is_folder = std::filesystem::is_directory(given, error);
  const std::string path = is_folder ? (std::filesystem::path(given) / "study.json").string() : given;
  if (const InputProblem problem = input_problem(path); problem.is_missing)
    throw InputError({given}, is_folder ? "there is no study.json in this folder: give the folder that 'alhazen study "
                                          "report' wrote"
                                        : "there is no such file: give the study.json that 'alhazen study report' "
                                          "wrote, or its folder");
  nlohmann::json j = read_json<nlohmann::json>(path, "give the study.json of 'alhazen study report'");
  if (!j.is_object() || j.value("schema", nlohmann::json()) != schema_name)
    throw InputError({path}, std::string("this is not a study of the schema ") + schema_name +
                                 ": give the study.json that this version of 'alhazen study report' wrote");
  return j;
}

namespace {

void read_runs(const nlohmann::json& j, Trial& trial) {
  trial.seconds = j.at("seconds").at("samples").get<std::vector<double>>();
  trial.busy_seconds = j.at("busy_seconds").get<std::vector<std::vector<double>>>();
  trial.processor_fractions = j.at("processor_shares").get<std::vector<double>>();
  trial.switches = j.at("involuntary_switches").get<std::vector<uint64_t>>();
  const size_t runs = trial.seconds.size();
  if (trial.busy_seconds.size() != runs || trial.processor_fractions.size() != runs || trial.switches.size() != runs)
    throw nlohmann::json::other_error::create(501, "the runs of a trial do not match", &j);
  if (j.contains("disturbed_seconds")) trial.disturbed_seconds = j.at("disturbed_seconds").get<std::vector<double>>();
  trial.build_seconds = j.at("build_seconds");
  trial.width = j.at("width");
  trial.height = j.at("height");
  trial.samples_per_pixel = j.at("spp");
  trial.samples = j.at("camera_samples");
  trial.rays = j.at("rays");
  trial.shadow_rays = j.at("shadow_rays");
  trial.rmse = j.value("rmse", -1.0);
}

void read_trial(const nlohmann::json& j, Trial& trial) {
  const std::string status = j.at("status");
  for (const TrialStatus failure : {TrialStatus::unavailable, TrialStatus::failed}) {
    if (status != to_string(failure)) continue;
    trial.status = failure;
    trial.reason = j.value("reason", "");
  }
  // Without seconds there is no measurement, whatever the status says.
  if (!j.contains("seconds")) return;
  read_runs(j, trial);
  if (status == to_string(TrialStatus::ok) && !trial.seconds.empty()) trial.status = TrialStatus::ok;
}

/// Makes a trial of an earlier run measure again what was disturbed or could not be run.
void forget_failures(Trial& trial) {
  if (trial.status != TrialStatus::ok) trial.status = TrialStatus::not_run;
  trial.reason.clear();
  trial.disturbed_seconds.clear();
  const std::vector<bool> repeated = runs_to_repeat(trial);
  for (size_t i = repeated.size(); i-- > 0;)
    if (repeated[i]) trial.erase_run(i);
  if (trial.seconds.empty()) trial.status = TrialStatus::not_run;
}

/// What must be the same for two runs to be of one study: its name, and its values in the earlier study and now.
std::vector<std::string> differences_of(const nlohmann::json& earlier, const Study& study) {
  const Machine& m = study.machine;
  const std::string no_id;
  std::vector<std::string> differences;
  const auto compare = [&](const char* name, const nlohmann::json& then, const nlohmann::json& now) {
    if (then != now) differences.push_back(fmt::format("{}: {}, now {}", name, then.dump(), now.dump()));
  };
  compare("version", earlier.at("version"), m.version);
  if (earlier.at("version") == m.version && earlier.at("build").value("id", no_id) != m.build)
    differences.emplace_back("another build of the program");
  compare("processor", earlier.at("machine").at("processor"), m.processor);
  compare("processors", earlier.at("machine").at("processors"), m.processors);
  compare("scene, by its hash", earlier.at("scene").at("hash"), study.scene.hash);
  const Json scale = scale_json(study.scale);
  for (const auto& [name, value] : earlier.at("scale").items())
    if (name != "repeats") compare(name == "name" ? "level" : name.c_str(), value, nlohmann::json(scale.at(name)));
  return differences;
}

}  // namespace

std::vector<std::string> tables_of(const nlohmann::json& study, const std::string& path) try {
  std::vector<std::string> ids;
  for (const auto& table : study.at("tables")) ids.push_back(table.at("id"));
  return ids;
} catch (const nlohmann::json::exception& error) {
  throw damaged_study(path, error);
}

void resume_from(const nlohmann::json& earlier, const std::string& path, Study& study) try {
  if (const std::vector<std::string> differences = differences_of(earlier, study); !differences.empty())
    throw InputError({path},
                     fmt::format("this study cannot be continued, since its runs would not be comparable ({}): "
                                 "run the same program and command again, or give --overwrite or another --output",
                                 fmt::join(differences, "; ")));
  for (const auto& j : earlier.at("trials")) {
    const std::string key = j.at("key");
    for (Trial& trial : study.trials) {
      if (trial.key != key) continue;
      read_trial(j, trial);
      if (trial.is_asked) forget_failures(trial);
    }
  }
  for (const auto& j : earlier.at("conditions"))
    study.conditions.push_back({j.at("seconds"), j.at("load"), j.at("megahertz")});
  study.seconds = earlier.at("seconds");
  study.is_complete = earlier.at("complete");
  if (const auto figure3 = earlier.find("figure3"); figure3 != earlier.end()) {
    study.work_per_thread.width = figure3->at("width");
    study.work_per_thread.height = figure3->at("height");
    study.work_per_thread.samples_per_pixel = figure3->at("spp");
    study.work_per_thread.statistic_mean = figure3->at("statistic_mean");
  }
} catch (const nlohmann::json::exception& error) {
  throw damaged_study(path, error);
}

}  // namespace alhazen::impl::study
