#include "study/folder.h"

#include <filesystem>

#include "files/input_file.h"
#include "study/json.h"
#include "study/plots.h"
#include "study/read_json.h"
#include "util/diagnostics.h"

namespace alhazen::impl::study {

namespace {

namespace fs = std::filesystem;

bool is_there(const std::string& path) {
  std::error_code error;
  return fs::exists(fs::symlink_status(path, error));
}

/// Without study.json all files belong to the user.
void refuse_files_of_the_user(const std::string& folder) {
  for (const std::string& name : study_file_names())
    if (const std::string path = in_folder(folder, name); is_there(path))
      throw InputError({path},
                       "this file is of no study, since there is no study.json beside it, and could be overwritten: "
                       "give another --output, or move the file away");
}

/// Neither a folder nor a pipe, which would wait for a reader, can be replaced.
void refuse_other_than_files(const std::string& folder) {
  for (const std::string& name : study_file_names()) {
    const std::string path = in_folder(folder, name);
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (error && status.type() != fs::file_type::not_found)
      throw InputError({path},
                       "this file cannot be replaced: " + error.message() + ": move it away, or give another --output");
    if (fs::exists(status) && !fs::is_regular_file(status))
      throw InputError({path},
                       "this is not a file, and the study's file of this name cannot be written: move it away, "
                       "or give another --output");
  }
}

/// A file of this name may be another program's.
void refuse_other_than_studies(const std::string& path) {
  const std::string advice = "move it away, or give another --output";
  const auto json = read_json<nlohmann::json>(path, advice);
  const auto schema = json.is_object() ? json.value("schema", nlohmann::json()) : nlohmann::json();
  if (!schema.is_string() || !schema.get<std::string>().starts_with("alhazen-study-"))
    throw InputError({path}, "this is not a study of 'alhazen study report', and would be overwritten: " + advice);
}

}  // namespace

const std::vector<std::string>& study_file_names() {
  static const std::vector<std::string> all = [] {
    std::vector<std::string> names{"study.json",  "tables.csv",  "tables.md",         "index.html",
                                   "figure1.svg", "figure2.png", "figure3-naive.pfm", "figure3-chunked.pfm"};
    for (const Plot& plot : all_plots())
      for (const char* extension : plot_extensions) names.push_back(std::string(plot.name) + extension);
    return names;
  }();
  return all;
}

std::string in_folder(const std::string& folder, const std::string& name) { return (fs::path(folder) / name).string(); }

void check_folder(const std::string& folder, bool resume, bool overwrite) {
  if (folder.empty()) throw InputError("--output is empty: give it the name of a folder");
  std::error_code error;
  const fs::file_status status = fs::status(folder, error);
  if (status.type() == fs::file_type::none)
    throw InputError({folder}, "this folder cannot be used: " + error.message() + ": give another --output");
  if (fs::exists(status) && !fs::is_directory(status))
    throw InputError({folder}, "this is not a folder: give --output the name of a folder");
  const std::string json = in_folder(folder, "study.json");
  if (!is_there(json)) {
    if (resume) throw InputError({json}, "there is no study here to continue: leave out --resume");
    return refuse_files_of_the_user(folder);
  }
  refuse_other_than_files(folder);
  refuse_other_than_studies(json);
  if (!resume && !overwrite)
    throw InputError({folder},
                     "there is a study in this folder: give --resume to continue it, --overwrite to replace it, "
                     "or another --output");
}

bool holds_incomplete_study(const std::string& folder) {
  const std::string path = in_folder(folder, "study.json");
  if (!is_there(path) || !input_problem(path).message.empty()) return false;
  try {
    return read_study_json(path).value("complete", nlohmann::json()) == false;
  } catch (const InputError&) {
    return false;
  }
}

void refuse_inputs(const std::string& folder, const InputRecord& inputs) {
  for (const std::string& name : study_file_names())
    inputs.refuse(in_folder(folder, name), "a file of the study in --output " + folder);
}

bool create_folder(const std::string& folder) {
  std::error_code error;
  const bool is_new = fs::create_directories(folder, error);
  if (error) throw InputError({folder}, "the folder cannot be created: " + error.message() + ": give another --output");
  return is_new;
}

void remove_replaced_files(const std::string& folder) {
  std::error_code ignored;
  for (const std::string& name : study_file_names()) {
    if (name == "study.json") continue;
    const std::string path = in_folder(folder, name);
    const fs::file_status status = fs::symlink_status(path, ignored);
    if (fs::is_regular_file(status) || fs::is_symlink(status)) fs::remove(path, ignored);
  }
}

}  // namespace alhazen::impl::study
