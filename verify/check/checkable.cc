// SPDX-License-Identifier: Apache-2.0
#include "cguide/verify/check/checkable.h"

#include <algorithm>
#include <map>
#include <variant>

#include "cguide/exact/core/error.h"

namespace cguide::check {
namespace {

/** Halving of smaller lengths would not be exact. */
constexpr double kLeastLength = 1e-300;
/** About 1 GB of scratch; the largest known model asks for a fiftieth of it. */
constexpr double kMostPairs = 2e7;

[[noreturn]] void Refuse(const std::string& why) {
  throw Error(Error::Code::kBadInput, "the model: " + why);
}

void RequireLength(double x) {
  if (!(x >= kLeastLength)) Refuse("a length below 1e-300 m; such shapes are refused");
}

void RequireShape(const PieceShape& shape) {
  if (const auto* box = std::get_if<Box>(&shape)) RequireLength(box->size.minCoeff());
  if (const auto* capsule = std::get_if<Capsule>(&shape)) RequireLength(capsule->length);
  if (const auto* cylinder = std::get_if<Cylinder>(&shape)) {
    RequireLength(std::min(cylinder->radius, cylinder->length));
  }
  const auto* solid = std::get_if<Solid>(&shape);
  if (solid && !IsClosed(*solid)) {
    Refuse(
        "a solid that is not closed and consistently oriented has no inside; make it a surface or "
        "a hull");
  }
}

/** Counted in doubles, which do not wrap. */
double CountPairs(const Model& model) {
  std::vector<double> shapes(model.robot.bodies.size());
  double all = 0, pieces = 0, pairs = 0;
  for (const Link& link : model.robot.links) {
    shapes[link.body] += static_cast<double>(link.shapes.size());
    all += static_cast<double>(link.shapes.size());
  }
  for (const Object& object : model.objects) pieces += static_cast<double>(object.pieces.size());
  for (const auto& [i, j] : model.self_pairs) pairs += shapes[i] * shapes[j];
  return pairs + all * pieces;
}

}  // namespace

bool IsClosed(const Solid& solid) {
  using Position = std::array<double, 3>;
  const auto at = [&](int vertex) {
    const Eigen::Vector3d& v = solid.vertices[vertex];
    return Position{v[0], v[1], v[2]};
  };
  std::map<std::pair<Position, Position>, long> balance;
  for (const std::array<int, 3>& t : solid.triangles) {
    for (int k = 0; k < 3; ++k) {
      const Position a = at(t[k]), b = at(t[(k + 1) % 3]);
      if (a < b) ++balance[{a, b}];
      if (b < a) --balance[{b, a}];
    }
  }
  return std::all_of(balance.begin(), balance.end(),
                     [](const auto& edge) { return edge.second == 0; });
}

void RequireCheckable(const Model& model) {
  CheckModel(model);
  if (model.contact.model == ContactModel::kNearest) {
    Refuse("contact model \"nearest\" has no continuous proofs; use \"sites\"");
  }
  for (const Link& link : model.robot.links) {
    for (const LinkShape& shape : link.shapes) {
      RequireShape(std::visit([](const auto& g) { return PieceShape(g); }, shape.geometry));
    }
  }
  for (const Object& object : model.objects) {
    for (const Piece& piece : object.pieces) RequireShape(piece.geometry);
  }
  if (CountPairs(model) > kMostPairs) {
    Refuse("more than 2e7 pairs of shapes and pieces; split the scene");
  }
}

}  // namespace cguide::check
