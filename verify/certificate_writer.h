#pragma once

#include <string>
#include <vector>

#include "cguide/verify/check/certificate.h"

namespace cguide::verify {

/** The text of a certificate (verify/FORMAT.md); proofs by edge, for every model in `robust`. Same
 arguments, same bytes.
 @throws Error where a name is not UTF-8. */
std::string WriteCertificate(const Model& model, const Path& path, const std::string& tool,
                             const std::vector<const check::EdgeProof*>& proofs,
                             const check::Robustness& robust = {});

/** One element of the list "proofs". */
std::string WriteProof(const check::EdgeProof& proof);

}  // namespace cguide::verify
