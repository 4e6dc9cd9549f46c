// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>

namespace cguide {

/** A broken precondition or a malformed file: never the outcome of a question about a
 configuration.

 what() is one message for the user: what is wrong, where (file and line, or key path), why, and
 what to do about it. */
class Error : public std::runtime_error {
 public:
  enum class Code {
    kInvalidArgument,  ///< a caller broke a documented precondition
    kBadInput,         ///< a file or value given by the user is unusable
    kIo,               ///< a file cannot be read or written
    kInternal          ///< a library failed in a way we did not foresee
  };

  Error(Code code, const std::string& what) : std::runtime_error(what), code_(code) {}
  Code code() const noexcept { return code_; }

 private:
  Code code_;
};

/** Throws Error::kInvalidArgument naming the calling function unless `ok`. Always armed.
 `caller` is filled in by the compiler; the builtin is used because clang 14 has no
 std::source_location. */
void Require(bool ok, const char* what, const char* caller = __builtin_FUNCTION());

}  // namespace cguide
