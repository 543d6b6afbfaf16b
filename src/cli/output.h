#pragma once

// Where a render's pictures go.

#include <string>
#include <vector>

#include "files/file_identity.h"
#include "files/input_record.h"
#include "images/image.h"
#include "render/renderer.h"

namespace alhazen {

struct OutputOptions {
  std::vector<std::string> paths;
  ExrPixelType exr_type = ExrPixelType::half;
  PngOptions png;
};

/// The paths that were asked for, else the scene's own file name in the current folder, else the scene's name with
/// .exr. Throws InputError for what cannot be written: an unknown extension, a folder that is not there or not
/// writable, links that lead in a circle - before anything is rendered.
std::vector<std::string> choose_outputs(const std::vector<std::string>& asked, const std::string& film_filename,
                                        const std::string& scene_path);

/// Throws InputError where two of these files are one, by whatever names: written twice, or written over what is read,
/// `inputs` and those of `record`. `checkpoint` may be empty.
void check_files(const std::vector<std::string>& outputs, const std::string& checkpoint,
                 const std::vector<NamedFile>& inputs, const InputRecord& record);

struct OutputReport {
  std::vector<std::string> written;   ///< paths
  std::vector<std::string> failures;  ///< sentences
};

/// Writes every picture, whichever of the others fail.
OutputReport write_outputs(const OutputOptions& options, const Rendering& rendering);

/// The exposure in stops, 0 or less, that makes a picture of which most would be white a good one: in about half of
/// what is not black the strongest channel comes to less than 0.6.
double fitting_exposure(const ImageSource& source);

}  // namespace alhazen
