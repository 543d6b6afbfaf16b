#pragma once

// The classes of values that stand for one struct each, and their binding.

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "alhazen/lights.h"
#include "alhazen/materials.h"
#include "alhazen/textures.h"
#include "field_types.h"

namespace alhazen::python {

/// What a scene takes of a kind: a material of it, a texture, a light, or the struct itself.
template <class Kind>
struct WholeOf {
  using type = Kind;
};
template <AlternativeOf<Bsdf> Kind>
struct WholeOf<Kind> {
  using type = Material;
};
template <AlternativeOf<TextureNode> Kind>
struct WholeOf<Kind> {
  using type = Texture;
};
template <AlternativeOf<LightKind> Kind>
struct WholeOf<Kind> {
  using type = Light;
};

/// Bases of classes in Python, which hold nothing of their own.
template <class Whole>
struct Family : Value {
  using Value::Value;
};
template <class Whole>
inline constexpr bool is_family = false;
template <>
inline constexpr bool is_family<Material> = true;
template <>
inline constexpr bool is_family<Texture> = true;
template <>
inline constexpr bool is_family<Light> = true;

template <class Kind>
using BaseOf = std::conditional_t<is_family<typename WholeOf<Kind>::type>, Family<typename WholeOf<Kind>::type>, Value>;

template <class Kind>
class Described : public BaseOf<Kind> {
 public:
  using Whole = typename WholeOf<Kind>::type;

  Described() : BaseOf<Kind>(the_class()) {}
  explicit Described(Whole whole) : BaseOf<Kind>(the_class()), whole_(std::move(whole)) {}

  void* data() override { return &whole_; }
  std::shared_ptr<Value> copy() const override { return std::make_shared<Described>(*this); }
  const Whole& whole() const { return whole_; }

  /// Filled when it is bound.
  static ValueClass& the_class() {
    static ValueClass one;
    return one;
  }

 private:
  Whole whole_{Kind{}};
};

/// The struct that has the member, in what a value holds.
template <class Part>
Part& part_of(void* data) {
  if constexpr (AlternativeOf<Part, Bsdf>)
    return std::get<Part>(static_cast<Material*>(data)->bsdf);
  else if constexpr (AlternativeOf<Part, TextureNode>)
    return std::get<Part>(static_cast<Texture*>(data)->node);
  else if constexpr (AlternativeOf<Part, LightKind>)
    return std::get<Part>(static_cast<Light*>(data)->kind);
  else
    return *static_cast<Part*>(data);
}

template <class Part, class T>
Field field(const char* name, T Part::*member, const char* doc) {
  using Type = FieldType<T>;
  const auto at = [member](const void* data) -> T& { return part_of<Part>(const_cast<void*>(data)).*member; };
  Field result{.name = name,
               .type = Type::type(),
               .doc = doc,
               .assign = [at](const std::string& its_name, py::handle given,
                              void* data) { at(data) = Type::read(its_name, given); },
               .show = [at](const void* data) { return Type::show(at(data)); }};
  if constexpr (RefersToParts<T>) {
    result.keep = [at](const std::string& its_name, py::handle given, void* data) {
      py::object kept = Type::keep(its_name, given);
      if (kept) at(data) = Type::placeholder();
      return kept;
    };
    result.resolve = [at](const std::string& its_name, py::handle kept, alhazen::Scene& scene, void* data) {
      at(data) = Type::resolve(its_name, kept, scene);
    };
    result.lift = [at](const std::shared_ptr<PythonScene>& scene, void* data) {
      py::object part = Type::lift(scene, at(data));
      if (part) at(data) = Type::placeholder();
      return part;
    };
  }
  return result;
}

/// How a class is described besides its fields.
struct ClassTexts {
  const char* name;
  const char* doc;
  size_t positional = 0;
};

template <class Kind>
py::class_<Described<Kind>, BaseOf<Kind>, std::shared_ptr<Described<Kind>>> bind_value(
    py::module_& m, const ClassTexts& texts, std::vector<Field> fields, std::function<void(const void*)> check) {
  ValueClass& of_class = Described<Kind>::the_class();
  of_class = {texts.name, std::move(fields), texts.positional, std::move(check),
              [] { return std::make_shared<Described<Kind>>(); }};
  const std::string doc = signature(of_class) + "\n\n" + texts.doc;
  py::class_<Described<Kind>, BaseOf<Kind>, std::shared_ptr<Described<Kind>>> bound(m, texts.name, doc.c_str());
  py::options options;
  options.disable_function_signatures();
  bound.def(py::init([](const py::args& args, const py::kwargs& kwargs) {
              auto made = std::make_shared<Described<Kind>>();
              made->set_all(args, kwargs);
              return made;
            }),
            ("__init__(self, " + signature(of_class).substr(std::string(texts.name).size() + 1)).c_str());
  bind_properties(bound, of_class);
  return bound;
}

/// The value of a struct of the scene.
template <class Kind>
std::shared_ptr<Value> value_of(const std::shared_ptr<PythonScene>& scene, typename Described<Kind>::Whole whole) {
  auto made = std::make_shared<Described<Kind>>(std::move(whole));
  made->lift(scene);
  return made;
}

}  // namespace alhazen::python
