// SPDX-License-Identifier: Apache-2.0
#include "cguide/exact/core/error.h"

namespace cguide {

void Require(bool ok, const char* what, const char* caller) {
  if (ok) return;
  throw Error(Error::Code::kInvalidArgument, std::string(caller) + ": " + what);
}

}  // namespace cguide
