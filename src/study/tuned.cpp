#include "study/tuned.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "files/atomic_file.h"
#include "files/input_file.h"
#include "render/setting_table.h"
#include "study/machine.h"
#include "study/read_json.h"
#include "study/write.h"

namespace alhazen::impl::study {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* tuned_schema = "alhazen-tuned-2";

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

/// What a tuned engine sets.
constexpr const char* engine_settings[] = {"backend", "strategy", "schedule", "threads", "block", "chunk"};

Json engine_json(const Settings& s) {
  Json engine = Json::object();
  for (const char* name : engine_settings)
    if (const std::string text = setting_text(s, name); !text.empty()) engine[name] = text;
  return engine;
}

Settings with_engine(Settings settings, const Settings& engine) {
  for (const char* name : engine_settings)
    if (const std::string text = setting_text(engine, name); !text.empty()) setting_entry(name).set(settings, text);
  return settings;
}

Json entry_json(const TunedEntry& e) {
  return {{"machine", e.machine},
          {"scene", e.scene},
          {"precision", e.precision},
          {"integrator", e.integrator},
          {"engine", engine_json(e.engine)},
          {"scene_name", e.scene_name},
          {"version", e.version},
          {"date", e.date},
          {"nanoseconds_per_sample", e.nanoseconds_per_sample}};
}

TunedEntry entry_of(const Json& j) {
  TunedEntry e;
  e.machine = j.at("machine");
  e.scene = j.at("scene");
  e.precision = j.at("precision");
  e.integrator = j.at("integrator");
  e.scene_name = j.at("scene_name");
  e.version = j.at("version");
  e.date = j.at("date");
  e.nanoseconds_per_sample = j.at("nanoseconds_per_sample");
  for (const auto& [name, value] : j.at("engine").items())
    if (std::count(std::begin(engine_settings), std::end(engine_settings), name) > 0)
      setting_entry(name).set(e.engine, value.is_string() ? value.get<std::string>() : value.dump());
  return e;
}

bool is_for_the_same(const TunedEntry& a, const TunedEntry& b) {
  return a.machine == b.machine && a.scene == b.scene && a.precision == b.precision && a.integrator == b.integrator;
}

/// Returns whether the user has left the choice of an engine entirely open.
bool is_open(const Settings& s) {
  for (const SettingEntry& entry : setting_table()) {
    if (entry.group != SettingGroup::engine || entry.name == std::string("precision")) continue;
    if (const std::string text = entry.text(s); !text.empty() && text != "auto") return false;
  }
  return true;
}

std::optional<TunedEntry> find_tuned(const std::string& path, const Settings& asked, const std::string& integrator,
                                     const std::string& scene_path) {
  const std::vector<TunedEntry> entries = read_tuned(path);
  if (entries.empty()) return std::nullopt;
  TunedEntry wanted;
  wanted.machine = machine_key();
  wanted.precision = asked.precision;
  wanted.integrator = integrator;
  for (const std::string& scene : {scene_key(scene_path), std::string(any_scene)}) {
    wanted.scene = scene;
    for (const TunedEntry& entry : entries)
      if (is_for_the_same(entry, wanted)) return entry;
  }
  return std::nullopt;
}

}  // namespace

std::string tuned_path() {
  if (const char* path = std::getenv("ALHAZEN_TUNED")) return path;
  const std::string config = variable("XDG_CONFIG_HOME"), home = variable("HOME");
  if (!config.empty()) return (fs::path(config) / "alhazen/tuned.json").string();
  return home.empty() ? "" : (fs::path(home) / ".config/alhazen/tuned.json").string();
}

std::string machine_key() {
  const Machine machine = this_machine();
  return fmt::format("{}, {} processors", machine.processor, machine.processors);
}

std::string scene_key(const std::string& path) {
  if (!input_problem(path).message.empty()) return {};
  InputFile file(path);
  uint64_t hash = 0xcbf29ce484222325u;  // FNV-1a
  uint8_t buffer[65536];
  while (const size_t count = file.read(buffer, sizeof(buffer)))
    for (size_t i = 0; i < count; ++i) hash = (hash ^ buffer[i]) * 0x100000001b3u;
  return fmt::format("{:016x}", hash);
}

std::vector<TunedEntry> read_tuned(const std::string& path) {
  if (path.empty() || input_problem(path).is_missing) return {};
  const std::string advice = "remove it, or tune again with 'alhazen study tune SCENE --store'";
  try {
    const Json j = read_json<Json>(path, advice);
    if (j.at("schema") != tuned_schema) throw InputError({path}, "this is of another version: " + advice);
    std::vector<TunedEntry> entries;
    for (const Json& entry : j.at("entries")) entries.push_back(entry_of(entry));
    return entries;
  } catch (const nlohmann::json::exception&) {
    throw InputError({path}, "the file of tuned engines is damaged: " + advice);
  }
}

void check_tuned_target(const std::string& path) {
  if (path.empty())
    throw InputError("there is no location for the file of tuned engines: name one in the variable ALHAZEN_TUNED");
  read_tuned(path);
  std::error_code error;
  if (const fs::path folder = fs::path(path).parent_path(); !folder.empty()) fs::create_directories(folder, error);
  if (error)
    throw InputError({path}, "the folder of the file of tuned engines cannot be created: " + error.message() +
                                 ": name another file in the variable ALHAZEN_TUNED");
  check_target(path);
}

void store_tuned(const std::string& path, const TunedEntry& entry) {
  check_tuned_target(path);
  std::vector<TunedEntry> entries = read_tuned(path);
  std::erase_if(entries, [&](const TunedEntry& other) { return is_for_the_same(other, entry); });
  entries.push_back(entry);
  Json list = Json::array();
  for (const TunedEntry& each : entries) list.push_back(entry_json(each));
  write_text(path, json_text(Json{{"schema", tuned_schema}, {"entries", list}}));
}

RenderSettings resolve_with_tuned(const Settings& asked, const Scene& scene, const std::string& scene_path,
                                  Diagnostics& diagnostics) {
  const RenderSettings usual = resolve_settings(asked, scene);
  if (!is_open(asked)) return usual;
  const std::string path = tuned_path();
  try {
    const std::optional<TunedEntry> entry = find_tuned(path, asked, to_string(usual.integrator), scene_path);
    if (!entry) return usual;
    if (entry->version != version()) {
      diagnostics.warn({path}, "the engine tuned for this scene is of version " + entry->version +
                                   " and is not used: tune again with 'alhazen study tune SCENE --store'");
      return usual;
    }
    return resolve_settings(with_engine(asked, entry->engine), scene);
  } catch (const Error& error) {  // bad input, or a device that is gone
    const std::string message = error.what();
    diagnostics.warn({message.find(path) == std::string::npos ? path : ""},
                     "no tuned engine is used: " + message.substr(0, message.find('\n')));
    return usual;
  }
}

}  // namespace alhazen::impl::study
