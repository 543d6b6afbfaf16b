#include "view/save_picture.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <new>
#include <optional>
#include <utility>

#include "alhazen/save.h"
#include "util/diagnostics.h"
#include "util/parse_numbers.h"
#include "util/quoted.h"

namespace alhazen::impl {

namespace {

namespace fs = std::filesystem;

struct Format {
  const char* extension;
  const char* content_type;
};
constexpr Format formats[] = {{"png", "image/png"},
                              {"exr", "image/x-exr"},
                              {"jpg", "image/jpeg"},
                              {"hdr", "image/vnd.radiance"},
                              {"pfm", "application/octet-stream"}};

PageResponse refusal(int status, const std::string& reason) {
  PageResponse response;
  response.status = status;
  response.body = reason + "\n";
  return response;
}

/// A folder that is removed with what is in it.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string pattern = (fs::temp_directory_path() / "alhazen-XXXXXX").string();
    if (!::mkdtemp(pattern.data())) throw Error("no folder can be made in " + fs::temp_directory_path().string());
    path_ = pattern;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

ToneMapping tone_mapping_of(const std::string& name) {
  constexpr std::pair<const char*, ToneMapping> names[] = {{"none", ToneMapping::none},
                                                           {"reinhard", ToneMapping::reinhard},
                                                           {"filmic", ToneMapping::filmic},
                                                           {"aces", ToneMapping::aces},
                                                           {"agx", ToneMapping::agx}};
  for (const auto& [known, mapping] : names)
    if (name == known) return mapping;
  throw InputError("tone_map may be none, reinhard, filmic, aces or agx, not " + quoted(name));
}

SaveOptions options_of(const std::string& query) {
  SaveOptions options;
  for (size_t begin = 0; begin < query.size();) {
    const size_t end = std::min(query.find('&', begin), query.size());
    const std::string entry = query.substr(begin, end - begin);
    const size_t equals = std::min(entry.find('='), entry.size());
    const std::string name = entry.substr(0, equals), value = entry.substr(std::min(equals + 1, entry.size()));
    if (name == "exposure") {
      if (!parse_number(value, options.exposure) || !(options.exposure >= -126 && options.exposure <= 127))
        throw InputError("exposure must be a number of stops from -126 to 127, not " + quoted(value));
    } else if (name == "tone_map") {
      options.tone_mapping = tone_mapping_of(value);
    } else {
      throw InputError("images are saved with 'exposure' and 'tone_map', not with " + quoted(name));
    }
    begin = end + 1;
  }
  return options;
}

RenderedImage whole_image(const ViewImage& image) {
  RenderedImage whole = image.description;
  for (const PictureLayer& layer : image.picture->layers) {
    whole.channels.insert(whole.channels.end(), layer.channels.begin(), layer.channels.end());
    whole.planes.insert(whole.planes.end(), layer.planes.begin(), layer.planes.end());
  }
  return whole;
}

std::string file_bytes(const RenderedImage& image, const std::string& extension, const SaveOptions& options) {
  if (extension == "png") {
    const std::vector<uint8_t> bytes = encode_png(image, options);
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  }
  const TemporaryFolder folder;
  const fs::path file = folder.path() / ("image." + extension);
  save(image, file.string(), options);
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace

PageResponse save_picture(const std::string& scene_file, const ViewImage* image, const std::string& path,
                          const std::string& query) {
  for (const Format& format : formats) {
    if (path != std::string("save.") + format.extension) continue;
    try {
      const SaveOptions options = options_of(query);
      if (!image) return refusal(503, "there is no picture at full resolution yet: try again in a moment");
      PageResponse response;
      response.content_type = format.content_type;
      response.file_name = fs::path(scene_file).stem().string() + "." + format.extension;
      response.body = file_bytes(whole_image(*image), format.extension, options);
      return response;
    } catch (const InputError& error) {
      return refusal(400, error.what());
    } catch (const std::bad_alloc&) {
      return refusal(500, "there is not enough memory to save the image");
    } catch (const std::exception& error) {
      return refusal(500, error.what());
    }
  }
  return refusal(404, "there is nothing of this name");
}

}  // namespace alhazen::impl
