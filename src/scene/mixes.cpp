#include "scene/mixes.h"

#include "util/diagnostics.h"

namespace alhazen::impl {

std::vector<uint32_t> order_of_mixes(const std::vector<Material>& materials, uint32_t& of_itself) {
  enum class State : uint8_t { unknown, open, done };
  std::vector<State> states(materials.size());
  std::vector<uint32_t> order, path;
  of_itself = no_index;
  for (uint32_t i = 0; i < materials.size(); ++i) {
    path.push_back(i);
    while (!path.empty()) {
      const uint32_t index = path.back();
      const bool is_mix = materials[index].kind == MaterialKind::mix;
      // A mix is visited twice: before its materials, and when they are done.
      if (states[index] != State::unknown || !is_mix) {
        if (states[index] == State::open) order.push_back(index);
        states[index] = State::done;
        path.pop_back();
        continue;
      }
      states[index] = State::open;
      for (const uint32_t part : materials[index].mixed) {
        if (part >= materials.size()) continue;
        if (states[part] == State::open) of_itself = part;
        if (states[part] == State::unknown) path.push_back(part);
      }
      if (of_itself != no_index) return order;
    }
  }
  return order;
}

void check_mixes(const Scene& scene) {
  uint32_t of_itself = no_index;
  order_of_mixes(scene.materials, of_itself);
  if (of_itself != no_index)
    throw InputError({scene.name}, "the mix '" + scene.materials[of_itself].name + "' contains itself");
}

}  // namespace alhazen::impl
