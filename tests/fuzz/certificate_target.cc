// A libFuzzer target for certificates: whatever the bytes, they are refused with a cguide::Error or
// checked, in doubles and, where a proof holds, in MPFR numbers of 120 bits too.
#include <cstdint>
#include <string>

#include "cguide/exact/core/error.h"
#include "cguide/verify/check/check.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const cguide::check::Certificate certificate =
        cguide::check::ParseCertificate(std::string(reinterpret_cast<const char*>(data), size));
    const cguide::check::CheckReport report = cguide::check::CheckCertificate(certificate);
    if (report.proved > 0) cguide::check::CheckCertificate(certificate, {120});
  } catch (const cguide::Error&) {
  }
  return 0;
}
