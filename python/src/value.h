#pragma once

// Values: what describes a part of a scene before it is added, and what the scene gives back. Each class is a table of
// fields over a struct of the library; constructor, properties, repr, == and copies follow from the table.

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "bindings.h"
#include "python_scene.h"

namespace alhazen::python {

class Value;

/// One attribute. Functions get the struct as a pointer, whose type the table knows.
struct Field {
  std::string name;
  std::string type;  ///< for signatures
  std::string doc;
  std::function<void(const std::string& name, py::handle given, void* data)> assign;
  std::function<py::object(const void* data)> show;
  /// The rest is for fields that can refer to parts of a scene, such as textures; empty for others. What is given for
  /// such a part (a value, a part of a scene, the name of a file) as it is kept; null if it is none.
  std::function<py::object(const std::string& name, py::handle given, void* data)> keep{};
  /// Finds or adds what was kept in the scene, and puts its handle into the struct.
  std::function<void(const std::string& name, py::handle kept, alhazen::Scene& scene, void* data)> resolve{};
  /// The reverse: what the struct refers to; null if it refers to nothing.
  std::function<py::object(const std::shared_ptr<PythonScene>& scene, void* data)> lift{};
};

struct ValueClass {
  std::string name;
  std::vector<Field> fields;
  size_t positional = 0;  ///< how many of the fields may be given by position
  /// Throws InputError for values that the library refuses.
  std::function<void(const void* data)> check;
  std::function<std::shared_ptr<Value>()> make;  ///< one with the defaults

  const Field* find(const std::string& name) const;
  const Field& field(const std::string& name) const;
};

class Value : public std::enable_shared_from_this<Value> {
 public:
  explicit Value(const ValueClass& of_class) : class_(&of_class) {}
  virtual ~Value() = default;

  virtual void* data() = 0;
  const void* data() const { return const_cast<Value*>(this)->data(); }
  /// Not frozen.
  virtual std::shared_ptr<Value> copy() const = 0;

  const ValueClass& value_class() const { return *class_; }
  py::object get(const Field& field) const;
  /// Throws for what does not fit, and then changes nothing.
  void set(const Field& field, py::handle given);
  /// Several at once, which are checked together.
  void set_all(const py::args& args, const py::kwargs& kwargs);
  /// Fills in what a scene's struct refers to.
  void lift(const std::shared_ptr<PythonScene>& scene);
  /// A copy whose struct has handles of the scene, to which what it refers to is added.
  std::shared_ptr<Value> resolved(alhazen::Scene& scene) const;
  /// Itself if it is frozen, else a copy that is: assigning to one would be lost.
  std::shared_ptr<Value> frozen() const;
  bool equals(const Value& other) const;
  std::string repr() const;

 protected:
  Value(const Value& other) : std::enable_shared_from_this<Value>(), class_(other.class_), kept_(other.kept_) {}

 private:
  void assign(const Field& field, py::handle given);

  const ValueClass* class_;
  std::map<const Field*, py::object> kept_;
  bool is_frozen_ = false;
};

/// "base_colour" as "base_color": both spellings are taken.
std::string american(const std::string& name);

/// What every class of values has: repr, ==, copies, replace. `doc` of a base class says what its classes share.
void bind_value_base(py::module_& m);
/// "name(a: float = 1, *, b: ...)", from the values that a new one has.
std::string signature(const ValueClass& of_class);
void bind_properties(py::object python_class, const ValueClass& of_class);

}  // namespace alhazen::python
