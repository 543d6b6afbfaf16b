#include "modules/probe.h"

#include "render/sample_kernel.h"
#include "util/define_module.h"

namespace alhazen::test {
namespace {

const ProbeModule table{42, [] { return static_cast<const void*>(&instruction_sets()); }};

}  // namespace
}  // namespace alhazen::test

ALHAZEN_MODULE("probe", alhazen::test::table)
