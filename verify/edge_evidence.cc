#include "cguide/verify/edge_evidence.h"

namespace cguide::verify {
namespace {

check::Node Assemble(const EdgeEvidence& evidence, const Leaf& leaf) {
  check::Node node;
  if (const auto found = evidence.nodes.find(leaf); found != evidence.nodes.end()) {
    node = found->second;
  }
  if (evidence.splits.count(leaf) == 0) return node;
  const double half = 0.5 * leaf.half;
  node.halves.push_back(Assemble(evidence, {leaf.middle - half, half}));
  node.halves.push_back(Assemble(evidence, {leaf.middle + half, half}));
  return node;
}

}  // namespace

check::EdgeProof AssembleProof(int edge, const EdgeEvidence& evidence) {
  return {edge, evidence.outside, Assemble(evidence, {0.5, 0.5})};
}

std::vector<int> CertificateShapes(const numeric::World& world) {
  const Robot& robot = world.model().robot;
  std::vector<int> first;  // by link
  int count = 0;
  for (const Link& link : robot.links) {
    first.push_back(count);
    count += static_cast<int>(link.shapes.size());
  }
  std::vector<int> numbers;
  for (const Body& body : robot.bodies) {
    for (const int link : body.links) {
      for (std::size_t i = 0; i < robot.links[link].shapes.size(); ++i) {
        numbers.push_back(first[link] + static_cast<int>(i));
      }
    }
  }
  return numbers;
}

std::vector<check::OutsideRay> OutsideRays(int shape, int piece) {
  return {{shape, piece, {0.137, 0.291, 0.947}},
          {shape, piece, {0.881, -0.437, 0.179}},
          {shape, piece, {-0.533, 0.761, -0.371}}};
}

}  // namespace cguide::verify
