#pragma once

// The folder of a study. study.json marks a folder as one: only then the other files of these names are the study's and
// may be replaced.

#include <string>
#include <vector>

#include "files/input_record.h"

namespace alhazen::impl::study {

/// The name of every file that a study may write, study.json first.
const std::vector<std::string>& study_file_names();

/// The path of a file in the folder.
std::string in_folder(const std::string& folder, const std::string& name);

/// Throws InputError unless a study may be written to `folder`: a new folder, one without files of these names, or, if
/// `resume` or `overwrite`, one that holds a study.
void check_folder(const std::string& folder, bool resume, bool overwrite);

/// Whether the folder holds a study that was interrupted.
bool holds_incomplete_study(const std::string& folder);

/// Throws InputError if one of the study's files, by any name, is one of `inputs`.
void refuse_inputs(const std::string& folder, const InputRecord& inputs);

/// Creates the folder and those above it. Returns whether it did not exist. Throws InputError.
bool create_folder(const std::string& folder);

/// Removes the files of a replaced study except study.json, so that none is shown beside the new one.
void remove_replaced_files(const std::string& folder);

}  // namespace alhazen::impl::study
