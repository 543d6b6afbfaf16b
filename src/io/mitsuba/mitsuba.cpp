#include "io/mitsuba/mitsuba.h"

#include <algorithm>
#include <utility>

#include "io/mitsuba/bsdfs.h"
#include "io/mitsuba/emitters.h"
#include "io/mitsuba/sensors.h"
#include "io/mitsuba/shapes.h"
#include "scene/default_view.h"
#include "scene/limits.h"
#include "util/quoted.h"

namespace alhazen::impl {

namespace mitsuba {

namespace {

void warn_of_darkness(Build& build) {
  bool any_shape = false, any_emission = !build.scene.lights.empty();
  for (const ShapeGroup& group : build.scene.groups)
    for (const Shape& shape : group.shapes) {
      any_shape = true;
      any_emission = any_emission || shape.emission;
    }
  const SourceLocation where{build.scene.name, 0, 0};
  if (!any_shape && build.scene.lights.empty())
    build.diagnostics.warn(where, "the scene has no shapes and no lights; the image will be black");
  else if (!any_emission)
    build.diagnostics.warn(where, "the scene has no lights; the image will be black");
}

Scene build_scene(Document document, const std::string& name, const ReadOptions& options, Diagnostics& diagnostics) {
  Build build(std::move(document), diagnostics);
  build.scene.name = name;
  build.scene.max_depth = max_bounces;
  ObjectReader scene(build.document, 0);
  for (const Property* integrator : scene.objects("integrator")) set_integrator(build, *integrator);
  const std::vector<const Property*> sensors = scene.objects("sensor");
  if (!sensors.empty()) set_sensor(build, *sensors[0]);
  for (const Property* shape : scene.objects("shape")) add_shape(build, *shape);
  const std::vector<const Property*> emitters = scene.objects("emitter");
  std::vector<uint32_t> of_shapes;  // emitters of the scene that shapes refer to
  for (const Object& object : build.document.objects)
    if (object.tag == "shape")
      for (const Property& property : object.properties)
        if (property.kind == ValueKind::object) of_shapes.push_back(property.object);
  for (const Property* emitter : emitters)
    if (std::find(of_shapes.begin(), of_shapes.end(), emitter->object) == of_shapes.end()) add_emitter(build, *emitter);
  // BSDFs that no shape uses are read for their errors.
  for (const Property* bsdf : scene.objects("bsdf")) read_bsdf(build, *bsdf);
  for (const Property* medium : scene.objects("medium"))
    build.warn(medium->place, "participating media are not supported; they are omitted");
  for (const char* tag : {"texture", "spectrum", "volume", "phase", "sampler", "film", "rfilter"}) scene.objects(tag);
  scene.reject_unknown();
  tessellate_for_instances(build);
  warn_of_darkness(build);
  if (sensors.empty()) {
    diagnostics.warn({name}, "the scene has no sensor; one that sees all of it is used");
    fit_camera(build.scene, options.aspect);
  }
  return std::move(build.scene);
}

}  // namespace

}  // namespace mitsuba

Scene read_mitsuba(const InputPath& path, const ReadOptions& options, Diagnostics& diagnostics) {
  return mitsuba::build_scene(mitsuba::read_document(path, options.definitions, options.search), path.name, options,
                              diagnostics);
}

Scene parse_mitsuba(const std::string& text, const std::string& name, const std::string& folder,
                    const ReadOptions& options, Diagnostics& diagnostics) {
  return mitsuba::build_scene(mitsuba::parse_document(text, name, folder, options.definitions, options.search), name,
                              options, diagnostics);
}

}  // namespace alhazen::impl
