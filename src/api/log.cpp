#include "alhazen/log.h"

#include <string>
#include <utility>

#include "api/option_names.h"
#include "util/log.h"

namespace ALHAZEN_NAMESPACE {

void set_log(LogFunction log) {
  if (!log) return impl::set_log_function({});
  impl::set_log_function(
      [log = std::move(log)](LogLevel level, const std::string& line) { log(level, impl::with_field_names(line)); });
}

}  // namespace ALHAZEN_NAMESPACE
