#pragma once

// study.json, which docs/study.md describes.

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "study/study.h"

namespace alhazen::impl::study {

inline constexpr const char* schema_name = "alhazen-study-1";

nlohmann::ordered_json to_json(const Study& study);

/// Reads a study.json of this schema, given as a file or its folder. Throws InputError.
nlohmann::json read_study_json(const std::string& path);

/// The ids of its tables. `path` is for messages. Throws InputError.
std::vector<std::string> tables_of(const nlohmann::json& study, const std::string& path);

/// Copies what an earlier run measured to the trials of `study`, and of Figure 3 the numbers that its files do not
/// hold. Trials with is_asked, which are measured now, receive only undisturbed runs; the others receive all. Throws
/// InputError, which names the differences, if that run had another scene, scale, machine, version or build.
void resume_from(const nlohmann::json& earlier, const std::string& path, Study& study);

/// A number for JSON: null if it is not finite.
nlohmann::ordered_json number(double value);

}  // namespace alhazen::impl::study
