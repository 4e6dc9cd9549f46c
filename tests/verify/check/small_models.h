#pragma once

#include <string>
#include <vector>

#include "cguide/exact/contact.h"
#include "cguide/verify/check/check.h"
#include "cguide/verify/check/contact_flat_internal.h"
#include "cguide/verify/check/contact_patch_internal.h"
#include "cguide/verify/check/contact_point_internal.h"
#include "cguide/verify/check/interval_internal.h"
#include "tests/numeric/geometry_models.h"

// Models of one link that the checker's tests share.
namespace cguide::check::test {

using cguide::test::BoxMesh;
using cguide::test::OneObject;
using Eigen::Vector3d;

/** A link of the given shapes that must keep contact by sites given in its frame. */
inline Model ContactModelOf(std::vector<LinkShape> shapes, std::vector<Object> objects,
                            const std::vector<Vector3d>& sites) {
  Model model = cguide::test::OneBodyModel(std::move(shapes), std::move(objects));
  model.require = GuideRequirement::kContact;
  for (const Vector3d& x : sites) model.sites.push_back({0, x, 0});
  return model;
}

/** A site at the origin of a link without shapes. */
inline Model OneSite(std::vector<Object> objects, double radius = 0) {
  Model model = ContactModelOf({}, std::move(objects), {Vector3d::Zero()});
  model.sites[0].radius = radius;
  return model;
}

inline Edge Move(const Vector3d& from, const Vector3d& to) {
  return {cguide::test::At(from), cguide::test::At(to)};
}

inline Edge Still(const Vector3d& p) { return Move(p, p); }

inline ContactEvidence FlatOn(int piece, const FlatEvidence& flat = {}) {
  return {0, piece, flat, {}, {}};
}

inline ContactEvidence NearOn(int piece, const NearEvidence& near) {
  return {0, piece, {}, near, {}};
}

/** Planes for each shape and piece, one tree of a single node. */
inline EdgeProof ProofOf(const std::vector<ContactEvidence>& contacts,
                         const std::vector<Separation>& apart = {}) {
  EdgeProof proof{0, {}, {}};
  proof.root.balance = Balance{contacts, {}};
  proof.root.apart = apart;
  return proof;
}

/** Empty where the proof is accepted. */
inline std::string Refusal(const Model& model, const Edge& edge, const EdgeProof& proof,
                           int bits = 0) {
  return Checker(model, {bits}).CheckEdge(edge, proof);
}

/** Whether the evidence keeps a contact of the model's link over the whole edge. */
inline bool Keeps(const Model& model, const Edge& edge, const ContactEvidence& evidence) {
  return Refusal(model, edge, ProofOf({evidence})).empty();
}

/** The contact that the evidence keeps over the edge. */
inline std::optional<KeptContact<Interval>> Kept(const Model& model, const Edge& edge,
                                                 const ContactEvidence& evidence) {
  const Prepared<Interval> prepared(model);
  std::vector<MovingPose<Interval>> links;
  PlaceLinks(model.robot, prepared.joints, edge, {0.5, 0.5}, &links);
  BehindCache cache;
  return ContactChecker<Interval>(prepared, links, &cache).Keep(evidence);
}

/** The contacts that the exact reference finds at s. */
inline std::vector<exact::FoundContact> ContactsAt(const Model& model, const Edge& edge,
                                                   const Rational& s) {
  return exact::FindContacts(exact::ContactScene(model),
                             exact::PlaceRobot(model.robot, edge, s, 160));
}

}  // namespace cguide::check::test
