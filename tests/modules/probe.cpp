#include "modules/probe.h"

#include "render/sample_kernel.h"
#include "util/define_module.h"

namespace alhazen::impl::test {
namespace {

const ProbeModule table{42, [] { return static_cast<const void*>(&instruction_sets()); }};

}  // namespace
}  // namespace alhazen::impl::test

ALHAZEN_MODULE("probe", alhazen::impl::test::table)
