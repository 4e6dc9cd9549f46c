// SPDX-License-Identifier: Apache-2.0
#include "cguide/exact/core/error.h"

namespace cguide {

void Require(bool ok, const char* what, std::source_location where) {
  if (ok) return;
  throw Error(Error::Code::kInvalidArgument, std::string(where.function_name()) + ": " + what);
}

}  // namespace cguide
