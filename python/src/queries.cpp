// alhazen.RayQueries, alhazen.Hits, and the rays of a scene.

#include <memory>
#include <utility>

#include "alhazen/rays.h"
#include "bindings.h"
#include "convert.h"
#include "interruptible.h"
#include "progress.h"
#include "python_scene.h"
#include "python_warnings.h"
#include "ray_arrays.h"
#include "settings.h"

namespace alhazen::python {

namespace {

/// A BVH of a scene in one precision.
struct PythonQueries {
  RayQueries queries;
  std::string precision;
};

template <class Real>
Hits intersect(const PythonQueries& of, const RayArguments& arguments, const std::vector<std::string>& fields,
               int threads) {
  const RayInput<Real> input(arguments);
  HitArrays<Real> arrays;
  Hits hits = Hits::allocate(input.shape, fields, arrays);
  const Unlocked unlocked;
  of.queries.closest_hits(input.rays, arrays, threads);
  return hits;
}

template <class Real>
py::array occluded(const PythonQueries& of, const RayArguments& arguments, int threads) {
  const RayInput<Real> input(arguments);
  py::array_t<bool> blocked(input.shape);
  auto* const bytes = reinterpret_cast<uint8_t*>(blocked.mutable_data());  // 0 and 1, as NumPy has them
  const Unlocked unlocked;
  of.queries.occluded(input.rays, bytes, threads);
  return blocked;
}

int thread_count(const py::object& threads) { return static_cast<int>(integer("threads", threads, 0, 4096)); }

Hits intersect(const PythonQueries& of, const RayArguments& arguments, const py::object& fields,
               const py::object& threads) {
  const std::vector<std::string> names = Hits::fields_of(fields);
  return is_double(arguments, py::none()) ? intersect<double>(of, arguments, names, thread_count(threads))
                                          : intersect<float>(of, arguments, names, thread_count(threads));
}

py::array occluded(const PythonQueries& of, const RayArguments& arguments, const py::object& threads) {
  return is_double(arguments, py::none()) ? occluded<double>(of, arguments, thread_count(threads))
                                          : occluded<float>(of, arguments, thread_count(threads));
}

std::shared_ptr<const PythonQueries> build(const PythonScene& scene, const alhazen::Settings& settings) {
  const SceneReading reading(scene);
  std::shared_ptr<const PythonQueries> made;
  run_droppable([&](const ProgressFunction& progress) {
    made = std::make_shared<const PythonQueries>(
        PythonQueries{RayQueries(reading.scene(), settings, progress), settings.precision});
  });
  return made;
}

PythonQueries build(const py::object& scene, const alhazen::Settings& settings) {
  if (py::isinstance<PythonScene>(scene)) return *build(py::cast<const PythonScene&>(scene), settings);
  if (!is_file_name(scene)) refuse_given("scene", "an alhazen.Scene or the name of a file", scene);
  const std::string file = file_name("scene", scene);
  std::unique_ptr<PythonQueries> made;
  run_droppable([&](const ProgressFunction& progress) {
    made = std::make_unique<PythonQueries>(
        PythonQueries{RayQueries::from_file(file, settings, progress), settings.precision});
  });
  issue_warnings(made->queries.warnings());
  return *made;
}

/// What scenes keep for their own queries, until they change.
struct SceneQueries {
  uint64_t changes = 0;  ///< of the scene, when these were built
  std::shared_ptr<const PythonQueries> single, double_;
};

std::shared_ptr<const PythonQueries> queries_of(const PythonScene& scene, bool wants_double) {
  scene.read();
  auto kept = std::static_pointer_cast<SceneQueries>(scene.kept_queries());
  if (!kept || kept->changes != scene.changes()) {
    kept = std::make_shared<SceneQueries>(SceneQueries{scene.changes(), {}, {}});
    scene.keep_queries(kept);
  }
  std::shared_ptr<const PythonQueries>& queries = wants_double ? kept->double_ : kept->single;
  if (!queries) {
    alhazen::Settings settings;
    settings.precision = wants_double ? "double" : "float";
    queries = build(scene, settings);
  }
  return queries;
}

py::array bounds_of(const RayQueries& queries) {
  const Box& box = queries.bounds();
  py::array_t<double> array({2, 3});
  auto values = array.mutable_unchecked<2>();
  const Vec3 ends[] = {box.low, box.high};
  for (py::ssize_t i = 0; i < 2; ++i) {
    values(i, 0) = ends[i].x;
    values(i, 1) = ends[i].y;
    values(i, 2) = ends[i].z;
  }
  return array;
}

constexpr const char* rays_doc =
    "origins, directions: arrays of the shape (n, 3), (..., 3), or (3,) for all rays alike, in world space; "
    "directions\n"
    "have any length above 0. t_max: a number, or an array of the shape (n,); a hit counts if 0 < t < t_max. time: "
    "when\n"
    "the shutter opens (0) to when it closes (1). float32 and float64 arrays are read in place, if the components of "
    "a\n"
    "vector are adjacent. threads: at most so many; 0: all processors.\n\n";

void bind_hits(py::module_& m) {
  py::class_<Hits> hits(
      m, "Hits",
      "What rays hit: arrays of NumPy with a value for each ray. After a miss t is infinity, indices\n"
      "are alhazen.INVALID_ID, and all else is 0.");
  const std::pair<const char*, const char*> fields[] = {
      {"t", "array: (n,) in units of the direction's length: the hit is at origin + t * direction."},
      {"position", "array: (n, 3) in world space, on the surface: more accurate than origin + t * direction."},
      {"normal", "array: (n, 3) unit geometric normal on the front of the surface, whichever side is hit."},
      {"shading_normal", "array: (n, 3) unit interpolated vertex normal; the geometric one where there are none."},
      {"offset", "array: (n,) how far to move a position along its normal, or against it, to start another ray there."},
      {"uv", "array: (n, 2) texture coordinates of the first set."},
      {"barycentric", "array: (n, 2) weights of the second and third vertex of the triangle; 0 on other shapes."},
      {"primitive", "array: (n,) uint32, index of the triangle in its mesh; 0 on other shapes."},
      {"shape", "array: (n,) uint32, index of the shape, within its group if `instance` is valid."},
      {"instance", "array: (n,) uint32, index of the instance; alhazen.INVALID_ID if there is none."}};
  for (const auto& [name, doc] : fields)
    hits.def_property_readonly(
        name, [name = name](const Hits& h) { return h.field(name); }, doc);
  hits.def_property_readonly("hit", &Hits::hit, "array: (n,) bool, whether the ray hits anything.")
      .def_property_readonly(
          "fields",
          [](const Hits& h) {
            py::list names;
            for (const std::string& name : Hits::all_fields())
              if (h.arrays().contains(name)) names.append(name);
            return py::tuple(names);
          },
          "tuple[str, ...]: names of the arrays that are there.")
      .def("__len__",
           [](const Hits& h) {
             if (h.shape().empty()) throw py::type_error("the hit of a single ray has no length");
             return h.shape()[0];
           })
      .def("__repr__", [](const Hits& h) {
        const py::object count = h.hit().attr("sum")();
        return "<alhazen.Hits of " + py::cast<std::string>(py::str(h.field("t").attr("size"))) + " rays, " +
               py::cast<std::string>(py::str(count)) + " hit>";
      });
}

}  // namespace

void bind_queries(py::module_& m) {
  py::options options;
  options.disable_function_signatures();
  m.attr("INVALID_ID") = invalid_id;
  bind_hits(m);
  const std::string rays_text =
      "(self, origins: array, directions: array, t_max: array | None = None, *, "
      "time: array | None = None, ";
  const std::string fields_text = "fields: Sequence[str] | None = None, ", threads_text = "threads: int = 0",
                    precision_text = ", precision: str | None = None";
  const std::string intersect_doc =
      std::string("\n\nFinds the closest hit of every ray.\n\n") + rays_doc +
      "fields: names of the arrays that are wanted, each of which takes time; None: all. t is always there.\n\n"
      "Returns an alhazen.Hits, in double precision if an array of rays is float64, otherwise in float32. Raises\n"
      "InputError, which names the argument, for other shapes, NaN and infinite components.";
  const std::string occluded_doc = std::string("\n\nFinds whether anything is between 0 and t_max of every ray.\n\n") +
                                   rays_doc +
                                   "Returns an array of bool with the shape (n,). It is faster than `intersect`.";
  py::class_<PythonQueries>(
      m, "RayQueries",
      "Answers ray queries on a scene as it is now: the closest hits of arrays of rays, or whether anything occludes\n"
      "them. Queries see geometry alone: both sides of every surface, and no opacities.\n\n"
      "scene: alhazen.Scene, or the name of a file. Of the settings, which are those of alhazen.render, `precision`\n"
      "('float' or 'double', in which rays are traced), `threads` and those about reading matter.")
      .def(py::init([](const py::object& scene, const py::kwargs& settings) {
             return build(scene, settings_of("RayQueries", py::none(), settings));
           }),
           py::arg("scene"), "__init__(self, scene: Scene | path, **settings)")
      .def(
          "intersect",
          [](const PythonQueries& queries, const py::object& origins, const py::object& directions,
             const py::object& t_max, const py::object& time, const py::object& fields, const py::object& threads) {
            return intersect(queries, {origins, directions, t_max, time}, fields, threads);
          },
          py::arg("origins"), py::arg("directions"), py::arg("t_max") = py::none(), py::kw_only(),
          py::arg("time") = py::none(), py::arg("fields") = py::none(), py::arg("threads") = 0,
          ("intersect" + rays_text + fields_text + threads_text + ") -> Hits" + intersect_doc).c_str())
      .def(
          "occluded",
          [](const PythonQueries& queries, const py::object& origins, const py::object& directions,
             const py::object& t_max, const py::object& time, const py::object& threads) {
            return occluded(queries, {origins, directions, t_max, time}, threads);
          },
          py::arg("origins"), py::arg("directions"), py::arg("t_max") = py::none(), py::kw_only(),
          py::arg("time") = py::none(), py::arg("threads") = 0,
          ("occluded" + rays_text + threads_text + ") -> array" + occluded_doc).c_str())
      .def_property_readonly(
          "bounds", [](const PythonQueries& queries) { return bounds_of(queries.queries); },
          "array: (2, 3), the low and the high corner of a box that contains all surfaces at all times.")
      .def_readonly("precision", &PythonQueries::precision, "str: float or double.")
      .def_property_readonly(
          "warnings",
          [](const PythonQueries& queries) {
            py::list texts;
            for (const std::string& text : warning_texts(queries.queries.warnings())) texts.append(text);
            return texts;
          },
          "list[str]: of the scene reader and of building.")
      .def("__repr__",
           [](const PythonQueries& queries) { return "<alhazen.RayQueries in " + queries.precision + " precision>"; });

  // Methods of alhazen.Scene.
  const py::object scene = m.attr("Scene");
  const auto add = [&](const char* name, auto function, const std::string& doc, auto... named) {
    scene.attr(name) = py::cpp_function(function, py::name(name), py::is_method(scene), doc.c_str(), named...);
  };
  const std::string kept =
      "\n\nThe first call builds a BVH, which is kept until the scene changes. precision: float or double, in which "
      "it\n"
      "is built; None: that of the arrays. alhazen.RayQueries keeps one of a scene that changes.";
  add(
      "intersect",
      [](const PythonScene& of, const py::object& origins, const py::object& directions, const py::object& t_max,
         const py::object& time, const py::object& fields, const py::object& threads, const py::object& precision) {
        const RayArguments rays{origins, directions, t_max, time};
        return intersect(*queries_of(of, is_double(rays, precision)), rays, fields, threads);
      },
      "intersect" + rays_text + fields_text + threads_text + precision_text + ") -> Hits" + intersect_doc + kept,
      py::arg("origins"), py::arg("directions"), py::arg("t_max") = py::none(), py::kw_only(),
      py::arg("time") = py::none(), py::arg("fields") = py::none(), py::arg("threads") = 0,
      py::arg("precision") = py::none());
  add(
      "occluded",
      [](const PythonScene& of, const py::object& origins, const py::object& directions, const py::object& t_max,
         const py::object& time, const py::object& threads, const py::object& precision) {
        const RayArguments rays{origins, directions, t_max, time};
        return occluded(*queries_of(of, is_double(rays, precision)), rays, threads);
      },
      "occluded" + rays_text + threads_text + precision_text + ") -> array" + occluded_doc + kept, py::arg("origins"),
      py::arg("directions"), py::arg("t_max") = py::none(), py::kw_only(), py::arg("time") = py::none(),
      py::arg("threads") = 0, py::arg("precision") = py::none());
}

}  // namespace alhazen::python
