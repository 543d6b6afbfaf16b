#include "backends/optix/module.h"

#include "backends/optix/module/engine.h"
#include "backends/optix/module/library.h"
#include "util/define_module.h"

namespace alhazen::impl::optix {

namespace {

std::string problem() { return optix_library().problem; }

const OptixModule table{problem, make_optix_engine, denoise};

}  // namespace

}  // namespace alhazen::impl::optix

ALHAZEN_MODULE("optix", alhazen::impl::optix::table)
