#include "modules/probe.h"

#include "render/sample_kernel.h"
#include "util/define_module.h"

int alhazen_probe_answer();  // of a library of its own, which can be missing

namespace alhazen::test {
namespace {

const ProbeModule table{alhazen_probe_answer(), [] { return static_cast<const void*>(&instruction_sets()); }};

}  // namespace
}  // namespace alhazen::test

ALHAZEN_MODULE("probe", alhazen::test::table)
