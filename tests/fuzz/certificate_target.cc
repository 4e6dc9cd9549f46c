// A libFuzzer target for certificates: whatever the bytes, they are refused with a cguide::Error or
// checked. What is accepted in doubles is accepted in MPFR numbers of 120 bits, whose intervals are
// narrower.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "cguide/exact/core/error.h"
#include "cguide/verify/check/check.h"

namespace {

using cguide::check::CheckCertificate;
using cguide::check::CheckReport;

void Check(const std::string& text) {
  const cguide::check::Certificate certificate = cguide::check::ParseCertificate(text);
  const CheckReport report = CheckCertificate(certificate);
  if (report.proved == 0) return;
  if (CheckCertificate(certificate, {120}).proved < report.proved) {
    std::fprintf(stderr, "a proof holds in doubles but not in 120 bits\n");
    std::abort();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    Check(std::string(reinterpret_cast<const char*>(data), size));
  } catch (const cguide::Error&) {
  }
  return 0;
}
