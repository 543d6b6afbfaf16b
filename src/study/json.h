#pragma once

// study.json: docs/study.md says what is in it.

#include <nlohmann/json.hpp>
#include <string>

#include "study/study.h"

namespace alhazen::study {

inline constexpr const char* schema_name = "alhazen-study-1";

nlohmann::ordered_json to_json(const Study& study);

/// Reads a study.json of this schema, or that of a folder. Throws InputError.
nlohmann::json read_study_json(const std::string& path);

/// Takes the measurements of an earlier, unfinished run into the trials of `study`, which was planned anew. Throws
/// InputError where that run was of something else.
void resume_from(const nlohmann::json& earlier, const std::string& path, Study& study);

/// A number as JSON has it: null where it is not finite.
nlohmann::ordered_json number(double value);

}  // namespace alhazen::study
