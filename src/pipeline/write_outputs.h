#pragma once

// Writes the images of a render.

#include <map>
#include <string>
#include <vector>

#include "files/file_identity.h"
#include "files/input_record.h"
#include "images/image.h"
#include "pipeline/display_choice.h"
#include "render/renderer.h"

namespace alhazen::impl {

/// This name stands for standard output.
inline constexpr const char* standard_output_name = "-";

struct OutputOptions {
  std::vector<std::string> paths;
  WriteOptions how;
  std::string standard_output_format = "png";  ///< an extension of written_extensions(), without the dot
  DisplayChoice display;                       ///< what of `how` is left to the image

  /// Names whose extensions say how each output is written, in the order of `paths`.
  std::vector<std::string> format_names() const;
};

/// Returns the requested paths, else the scene's own file name in the current folder, else, with a warning if the scene
/// names a file of a kind that is not written, the scene's name with .exr. Throws InputError before rendering if a path
/// cannot be written: an unknown extension, a folder that does not exist or is not writable, cyclic links.
std::vector<std::string> choose_outputs(const std::vector<std::string>& asked, const std::string& film_filename,
                                        const std::string& scene_path, Diagnostics& diagnostics);

/// Throws InputError if a format cannot hold as many pixels.
void check_sizes(const std::vector<std::string>& outputs, const PixelWindow& window);

/// Throws InputError if two of these files are the same, by any names: written twice, or overwriting an input, which is
/// one of `inputs` or of those in `record`. `checkpoint` may be empty.
void check_files(const std::vector<std::string>& outputs, const std::string& checkpoint,
                 const std::vector<NamedFile>& inputs, const InputRecord& record);

/// What headers of images say: about the render, and if `has_layers` about its layers (EXR alone).
std::map<std::string, std::string> image_metadata(const Rendering& rendering, bool has_layers);

/// What headers say of how an image is displayed, as options of the command line.
std::string display_text(const WriteOptions& how);

struct OutputReport {
  std::vector<std::string> written;   ///< paths
  std::vector<std::string> failures;  ///< sentences
};

/// Writes every image, even if others fail.
OutputReport write_outputs(const OutputOptions& options, const Rendering& rendering);

}  // namespace alhazen::impl
