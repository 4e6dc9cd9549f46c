// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <map>
#include <span>
#include <string>

#include "cguide/exact/core/error.h"
#include "cguide/verify/check/balance_internal.h"

// One edge against its proof: what is asked for is derived from the model alone, and whatever the
// proof leaves open somewhere in [0, 1] refuses it (FORMAT.md part 3).
namespace cguide::check {

template <typename I>
class EdgeChecker {
 public:
  EdgeChecker(const Model& model, const Robustness& robust) : prepared_(model, robust) {}

  /** Empty where the proof holds, else what does not and where. */
  std::string Check(const Edge& edge, const EdgeProof& proof) {
    if (DotOf(edge.from.X_WB.q, edge.to.X_WB.q) == 0) return "the shorter arc is not defined";
    edge_ = &edge;
    refusal_.clear();
    if (!CheckOutside(proof)) return refusal_;
    const Span whole{0.5, 0.5};
    PlaceAt(whole);
    std::vector<Obligation> open = OpenObligations();
    CheckNode(proof.root, whole, open, true);
    return refusal_;
  }

 private:
  /** A shape and a piece, or (self) two shapes, to be kept apart. */
  struct Obligation {
    int shape = -1;
    int other = -1;
    bool self = false;
  };

  /** All obligations but those of shapes and pieces whose boxes over the span at hand are apart.
   */
  std::vector<Obligation> OpenObligations() {
    std::vector<Obligation> all;
    const int shapes = static_cast<int>(prepared_.shapes.size());
    std::vector<std::vector<int>> of_body(prepared_.model->robot.bodies.size());
    for (int s = 0; s < shapes; ++s) of_body[prepared_.shapes[s].body].push_back(s);
    for (int s = 0; s < shapes; ++s) {
      for (const int p : prepared_.tree.Near(Shape(s).box)) all.push_back({s, p, false});
    }
    for (const auto& [i, j] : prepared_.model->self_pairs) {
      for (const int s : of_body[i]) {
        for (const int t : of_body[j]) all.push_back({s, t, true});
      }
    }
    return all;
  }

  bool Refuse(const Span& span, const std::string& why) {
    refusal_ = why + " is not shown for s in [" + std::to_string(span.middle - span.half) + ", " +
               std::to_string(span.middle + span.half) + "]";
    return false;
  }

  /** Names may be of any length, and there may be a refusal for each edge. */
  static std::string Shortened(const std::string& name) {
    return name.size() <= 80 ? name : name.substr(0, 80) + " ...";
  }

  std::string Describe(const Obligation& o) const {
    const Robot& robot = prepared_.model->robot;
    const std::string first = Shortened(robot.links[prepared_.shapes[o.shape].link].name);
    const std::string second =
        Shortened(o.self ? robot.links[prepared_.shapes[o.other].link].name
                         : prepared_.model->objects[prepared_.obstacles[o.other].object].name);
    return "that \"" + first + "\" (shape " + std::to_string(o.shape) + ") and \"" + second +
           "\" (" + (o.self ? "shape " : "piece ") + std::to_string(o.other) + ") keep apart";
  }

  void PlaceAt(const Span& span) {
    PlaceLinks(prepared_.model->robot, prepared_.joints, *edge_, span, &links_);
    moved_.assign(prepared_.shapes.size(), std::nullopt);
  }

  const MovingSet<I>& Shape(int index) {
    std::optional<MovingSet<I>>& moved = moved_[index];
    if (!moved) {
      const RobotShape<I>& shape = prepared_.shapes[index];
      moved = Move(shape.set, shape.X_LS, links_[shape.link]);
    }
    return *moved;
  }

  /** The planes that a node gives, by shape and other. */
  using PlanesOf = std::map<std::pair<int, int>, const std::vector<Plane>*>;
  static PlanesOf Index(const std::vector<Separation>& separations) {
    PlanesOf planes;
    for (const Separation& s : separations) planes[{s.shape, s.other}] = &s.planes;
    return planes;
  }

  /** The planes that a node gives for all pieces behind them, by shape. */
  using SharedOf = std::map<int, std::vector<PlaneBelow<I>>>;
  SharedOf SharedPlanes(const std::vector<SharedPlane>& above) {
    SharedOf shared;
    for (const SharedPlane& given : above) {
      const IntervalVector<I> n = Lifted<I>(given.plane.n);
      const I m0(given.plane.m0);
      for (const int s : given.shapes) {
        if (s < 0 || s >= static_cast<int>(prepared_.shapes.size())) continue;
        shared[s].push_back({n, m0, LowestOver(Shape(s), n, Polynomial<I>(m0))});
      }
    }
    return shared;
  }

  bool CheckOutside(const EdgeProof& proof);
  /** `open`: what has to be shown over the span; its order is changed. */
  bool CheckNode(const Node& node, const Span& span, std::span<Obligation> open, bool balance_open);
  bool Holds(const Obligation& o, const PlanesOf& apart, const PlanesOf& self_apart,
             const SharedOf& shared);
  bool CheckBalance(const Balance& balance, const Span& span);
  /** Whether the forces sum up to (v_f, v_tau) about the centre of mass, inside of the cone. */
  bool CheckForces(const std::vector<ForceEvidence>& forces,
                   const std::vector<KeptContact<I>>& kept, const PolynomialVector<I>& com,
                   const IntervalVector<I>& v_f, const IntervalVector<I>& v_tau, const Span& span);

  Prepared<I> prepared_;
  const Edge* edge_ = nullptr;
  std::string refusal_;
  std::vector<MovingPose<I>> links_;
  std::vector<std::optional<MovingSet<I>>> moved_;
  BehindCache behind_;
};

/** A point of the shape's core, in its frame; the middle of a hull's box may not be one. */
template <typename I>
IntervalVector<I> PointOfCore(const ConvexSet<I>& set) {
  return set.corners.empty() ? IntervalVector<I>{I(0.0), I(0.0), I(0.0)} : set.corners.front();
}

// A solid's surface is kept apart from the shape for all s, so that its side is the one at s = 0.
template <typename I>
bool EdgeChecker<I>::CheckOutside(const EdgeProof& proof) {
  const Span start{0, 0};
  bool placed = false;
  for (int p = 0; p < static_cast<int>(prepared_.obstacles.size()); ++p) {
    const Obstacle<I>& obstacle = prepared_.obstacles[p];
    if (!obstacle.mesh || !obstacle.mesh->solid || obstacle.mesh->triangles.empty()) continue;
    if (!placed) PlaceAt(start);
    placed = true;
    for (int s = 0; s < static_cast<int>(prepared_.shapes.size()); ++s) {
      const MovingSet<I>& shape = Shape(s);
      if (Apart(shape.box, obstacle.mesh->box)) continue;
      const PolynomialVector<I> c = Apply(shape.X, PointOfCore(*shape.set));
      const IntervalVector<I> x{c[0].c[0], c[1].c[0], c[2].c[0]};
      const bool outside =
          std::any_of(proof.outside.begin(), proof.outside.end(), [&](const OutsideRay& ray) {
            return ray.shape == s && ray.piece == p &&
                   IsOutside(x, *obstacle.mesh, Lifted<I>(ray.direction));
          });
      if (!outside) return Refuse(start, Describe({s, p, false}) + " (outside the solid)");
    }
  }
  return true;
}

template <typename I>
bool EdgeChecker<I>::Holds(const Obligation& o, const PlanesOf& apart, const PlanesOf& self_apart,
                           const SharedOf& shared) {
  static const std::vector<Plane> kNone;
  const PlanesOf& given = o.self ? self_apart : apart;
  const auto found = given.find({o.shape, o.other});
  const std::vector<Plane>& planes = found == given.end() ? kNone : *found->second;
  if (o.self) return AreApart(Shape(o.shape), Shape(o.other), planes);
  const Obstacle<I>& obstacle = prepared_.obstacles[o.other];
  const double skin = prepared_.Skin(prepared_.shapes[o.shape].body, obstacle.object);
  const Slack slack{skin, prepared_.robust.pose};
  if (IsFree(Shape(o.shape), obstacle, planes, slack)) return true;
  const auto below = shared.find(o.shape);
  return obstacle.convex && below != shared.end() &&
         IsBehindOne(*obstacle.convex, below->second, slack);
}

template <typename I>
bool EdgeChecker<I>::CheckBalance(const Balance& balance, const Span& span) {
  const Model& model = *prepared_.model;
  ContactChecker<I> contacts(prepared_, links_, &behind_);
  std::vector<KeptContact<I>> kept;
  for (const ContactEvidence& evidence : balance.contacts) {
    auto contact = contacts.Keep(evidence);
    if (!contact) {
      return Refuse(span, contacts.reason() + ": that site " + std::to_string(evidence.site) +
                              " keeps contact with piece " + std::to_string(evidence.piece));
    }
    kept.push_back(std::move(*contact));
  }
  if (model.require == GuideRequirement::kContact) {
    return !kept.empty() || Refuse(span, "contact");
  }
  I mass;
  const PolynomialVector<I> com = CenterOfMass(model.robot, links_, &mass);
  IntervalVector<I> v_f, v_tau{I(0.0), I(0.0), I(0.0)};
  for (int i = 0; i < 3; ++i) v_f[i] = -(mass * I(model.gravity[i]));
  if (!(prepared_.robust.com > 0)) {
    return CheckForces(balance.forces, kept, com, v_f, v_tau, span);
  }
  const auto moments = DisplacedMoments(model.gravity, Norm(v_f), prepared_.robust.com);
  if (balance.displaced.size() != moments.size()) {
    return Refuse(span, "balance with the centre of mass elsewhere (" +
                            std::to_string(moments.size()) + " lists of forces)");
  }
  for (std::size_t k = 0; k < moments.size(); ++k) {
    if (!CheckForces(balance.displaced[k], kept, com, v_f, moments[k], span)) return false;
  }
  return true;
}

template <typename I>
bool EdgeChecker<I>::CheckForces(const std::vector<ForceEvidence>& forces,
                                 const std::vector<KeptContact<I>>& kept,
                                 const PolynomialVector<I>& com, const IntervalVector<I>& v_f,
                                 const IntervalVector<I>& v_tau, const Span& span) {
  if (forces.size() < 6) return Refuse(span, "balance (fewer than six forces)");
  std::vector<MovingWrench<I>> wrenches;
  std::vector<Polynomial<I>> weights;
  for (const ForceEvidence& force : forces) {
    if (force.contact < 0 || force.contact >= static_cast<int>(kept.size())) {
      return Refuse(span, "the contact of a force");
    }
    const KeptContact<I>& contact = kept[force.contact];
    if (!IsAdmissible(contact, force.u_W, prepared_.robust.friction)) {
      return Refuse(span, "that a force stays in the friction cone of contact " +
                              std::to_string(force.contact));
    }
    wrenches.push_back(WrenchOf(contact.point - com, force.u_W));
    weights.emplace_back(I(force.w0), I(force.w1), I(0.0));
  }
  return IsInterior(wrenches, weights, v_f, v_tau) ||
         Refuse(span, "that the forces carry the robot");
}

template <typename I>
bool EdgeChecker<I>::CheckNode(const Node& node, const Span& span, std::span<Obligation> open,
                               bool balance_open) {
  if (!open.empty() || (balance_open && node.balance)) PlaceAt(span);
  const SharedOf shared = open.empty() ? SharedOf{} : SharedPlanes(node.above);
  const PlanesOf apart = Index(node.apart), self_apart = Index(node.self_apart);
  const auto rest = std::partition(open.begin(), open.end(), [&](const Obligation& o) {
    return !Holds(o, apart, self_apart, shared);
  });
  open = open.first(static_cast<std::size_t>(rest - open.begin()));
  if (balance_open && node.balance) {
    if (!CheckBalance(*node.balance, span)) return false;
    balance_open = false;
  }
  if (open.empty() && !balance_open) return true;
  // Shorter spans could not be halved exactly.
  if (node.halves.size() != 2 || span.half < 0x1p-40) {
    return Refuse(span, open.empty() ? std::string("balance") : Describe(open.front()));
  }
  const double half = 0.5 * span.half;
  return CheckNode(node.halves[0], {span.middle - half, half}, open, balance_open) &&
         CheckNode(node.halves[1], {span.middle + half, half}, open, balance_open);
}

}  // namespace cguide::check
