#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>

#include "tests/fuzz/edge_cases.h"

namespace cguide::fuzz {

/** What became of edges of one kind. */
struct EdgeTally {
  long cases = 0;
  long unmade = 0;  ///< seeds whose making rounding spoilt
  long proved = 0, refuted = 0, undecided = 0;
  long kept = 0, violated = 0;  ///< truth from the making
  long wrong = 0;
  long precise = 0;  ///< proofs that were also checked at higher precision
  long samples = 0;  ///< instants of proved edges that were tested
  /** Of the undecided ones: how often, and the seed of the first. */
  std::map<std::string, std::pair<long, std::uint64_t>> reasons;
};

struct CampaignOptions {
  int samples = 50;  ///< of each proved edge
  int precise_bits = 128;
  /** Of proved edges whose truth is known one in so many gets the second check and the samples. */
  int share = 8;
};

/** Audits the case that a generator with this seed makes and judges the answer:
 - against the truth known from the making;
 - where proved: the checker accepts the proof in numbers of `precise_bits` as well, and no sampled
   instant is refuted by the ladder of verify/sample_ladder.h, or by exact twins at exactly that s;
 - where refuted and the truth is not known: the exact twins do not find the instant named to be
 good. Returns what is wrong, or an empty string. */
std::string JudgeEdge(const EdgeKind& kind, std::uint64_t seed, const CampaignOptions& options,
                      EdgeTally* tally);

}  // namespace cguide::fuzz
