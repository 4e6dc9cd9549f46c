#include "cguide/exact/contact.h"

#include <algorithm>

#include "cguide/exact/contact_internal.h"
#include "cguide/exact/core/error.h"
#include "cguide/exact/linear_algebra.h"

namespace cguide::exact {
namespace internal {
namespace {

/** Where a candidate stands. */
struct Standing {
  Verdict survives = Verdict::kHolds;  ///< against every set outside its cluster
  int band = 0;                        ///< 1 in it for every truth, 0 for none, -1 else
  std::vector<int> rivals;             ///< sets that may have a nearer point
  int cluster = -1;
};

/** A unit vector along w, within `error` of the truth's. */
struct Direction {
  Vector3q u;
  Rational error;
};

Direction UnitOf(const Candidate& c, int bits) {
  const Root root = RootOf(SquaredNorm(c.w), bits);
  return {Scaled(1 / root.hi, c.w), DirectionError(c.w, c.error_w) + (root.hi - root.lo) / root.hi};
}

/** The question about one site: its candidates, which survive, and what becomes of them. */
class SiteQuery {
 public:
  SiteQuery(const ContactSets& sets, const RobotPlacement& placement, const PlacedSite& site,
            int bits)
      : sets_(sets), site_(site), rules_{Lift(sets.model.contact.seam), bits} {
    Collect();
    candidates_ = near_;
    if (sets.model.contact.skin > 0) ApplySkin(sets, site, placement, rules_, &candidates_);
  }

  void Find(std::vector<FoundContact>* contacts) {
    const int n = static_cast<int>(candidates_.size());
    standing_.resize(n);
    for (int i = 0; i < n; ++i) standing_[i] = Judge(candidates_[i]);
    Cluster();
    for (int i = 0; i < n; ++i) {
      if (standing_[i].cluster == i) EmitCluster(i, contacts);
    }
  }

 private:
  /** Sets within reach of the site, with the candidate of each. */
  void Collect() {
    const ContactRules& rules = sets_.model.contact;
    const Rational reach = std::max(Rational(site_.radius + Lift(rules.epsilon)),
                                    Rational(Lift(rules.skin) + rules_.seam));
    const BoundingBox box = BoundsOf(std::span(&site_.x, 1), site_.error + reach);
    for (const ConvexSet& set : sets_.sets) {
      if (set.kind != SetKind::kHalfspace && GapBelow(box, set.bounds) > 0) continue;
      bool inside = false;
      Candidate c = Approach(set, site_, rules_.bits, &inside);
      if (c.SurelyNotBelow(reach)) continue;
      near_.push_back(std::move(c));
      inside_.push_back(inside);
    }
    if (IsSunk()) near_.clear();
  }

  /** Whether a solid holds the whole ball of that reach about the site: nothing in it is in front
   of the obstacles. The ball is free of the solid's triangles, so that it has one winding number.
 */
  bool IsSunk() const {
    for (std::size_t k = 0; k < sets_.solids.size(); ++k) {
      const bool is_near = std::any_of(near_.begin(), near_.end(), [&](const Candidate& c) {
        return c.set->solid == static_cast<int>(k);
      });
      if (!is_near && WindingNumber(sets_.solids[k], site_.x).value_or(0) != 0) return true;
    }
    return false;
  }

  int BandOf(const Candidate& c) const {
    const Rational upper = site_.radius + Lift(sets_.model.contact.epsilon);
    const Rational lower = site_.radius - sets_.Skin(site_.body, c.set->object);
    if (c.SurelyNotBelow(upper) || c.SurelyNotAbove(lower)) return 0;
    return c.SurelyBelow(upper) && c.SurelyAbove(lower) ? 1 : -1;
  }

  Viewed View(const Candidate& c) const {
    return {site_.x, c.y, site_.error, c.error_y, std::max(c.error_d, c.error_y)};
  }

  /** The inside of every solid near the site, whatever its triangles say. */
  Verdict OutsideSolids(const Candidate& c) const {
    const Viewed view = c.flat ? ViewFromAbove(c) : View(c);
    Verdict verdict = Verdict::kHolds;
    int last = -1;
    for (const Candidate& other : near_) {
      if (other.set->solid < 0 || other.set->solid == last) continue;
      last = other.set->solid;
      const Verdict one = StaysOutside(sets_.solids[last], view, rules_);
      if (one == Verdict::kFails) return one;
      if (one == Verdict::kUndecided) verdict = one;
    }
    return verdict;
  }

  bool Inside(const Candidate& c) const {
    if (sets_.Skin(site_.body, c.set->object) > 0) return false;
    for (std::size_t k = 0; k < near_.size(); ++k) {
      if (near_[k].set == c.set) return inside_[k];
    }
    return false;
  }

  Standing Judge(const Candidate& c) const {
    Standing result;
    result.band = Inside(c) ? 0 : BandOf(c);
    for (std::size_t k = 0; k < near_.size(); ++k) {
      const ConvexSet& other = *near_[k].set;
      if (&other == c.set) continue;
      const Verdict one =
          c.flat ? StaysFlat(other, c, rules_) : StaysClosest(other, View(c), rules_);
      if (one == Verdict::kFails) {
        result.survives = one;
        return result;
      }
      if (one == Verdict::kUndecided) result.rivals.push_back(static_cast<int>(k));
    }
    if (result.band != 0) result.survives = OutsideSolids(c);
    return result;
  }

  bool Rival(int i, int j) const {
    const std::vector<int>& rivals = standing_[i].rivals;
    return std::any_of(rivals.begin(), rivals.end(),
                       [&](int k) { return near_[k].set == candidates_[j].set; });
  }

  /** Whether the errors allow y_i = y_j. */
  bool MayCoincide(int i, int j) const {
    const Candidate &a = candidates_[i], &b = candidates_[j];
    const Rational reach = a.error_y + b.error_y;
    return SquaredNorm(a.y - b.y) <= reach * reach;
  }

  /** Joins surviving candidates that may coincide, or of which one may be nearer than the other. */
  void Cluster() {
    const int n = static_cast<int>(candidates_.size());
    for (int i = 0; i < n; ++i) standing_[i].cluster = Alive(i) ? i : -1;
    for (int i = 0; i < n; ++i) {
      for (int j = i + 1; j < n; ++j) {
        if (!Alive(i) || !Alive(j)) continue;
        if (Rival(i, j) || Rival(j, i) || MayCoincide(i, j)) Join(i, j);
      }
    }
  }

  bool Alive(int i) const { return standing_[i].survives != Verdict::kFails; }

  void Join(int i, int j) {
    const int keep = std::min(standing_[i].cluster, standing_[j].cluster);
    const int drop = std::max(standing_[i].cluster, standing_[j].cluster);
    for (Standing& s : standing_) {
      if (s.cluster == drop) s.cluster = keep;
    }
  }

  std::vector<int> Members(int cluster) const {
    std::vector<int> members;
    for (std::size_t i = 0; i < standing_.size(); ++i) {
      if (standing_[i].cluster == cluster) members.push_back(static_cast<int>(i));
    }
    return members;
  }

  /** Every member is in the band, none has a rival outside the cluster: the member nearest to the
   true x, whichever that is, has no nearer point of any member's set, nor of any other. */
  bool IsCertain(const std::vector<int>& members) const {
    for (int i : members) {
      const Standing& s = standing_[i];
      if (s.band != 1 || candidates_[i].doubtful || s.survives != Verdict::kHolds) return false;
      for (int k : s.rivals) {
        const bool known = std::any_of(members.begin(), members.end(),
                                       [&](int j) { return candidates_[j].set == near_[k].set; });
        if (!known) return false;
      }
    }
    return true;
  }

  Rational Friction(int i) const {
    return Lift(sets_.model.objects[candidates_[i].set->object].friction);
  }

  /** All members stand at the same exact point, so that its owners are known. */
  bool IsOnePoint(const std::vector<int>& members) const {
    return std::all_of(members.begin(), members.end(), [&](int i) {
      return candidates_[i].error_y == 0 && candidates_[i].y == candidates_[members[0]].y;
    });
  }

  void EmitCluster(int cluster, std::vector<FoundContact>* contacts) const {
    const std::vector<int> members = Members(cluster);
    if (!IsCertain(members)) {
      for (int i : members) {
        if (standing_[i].band != 0) contacts->push_back(Emit({i}, i, false));
      }
      return;
    }
    int least = members[0], most = members[0];
    for (int i : members) {
      if (Friction(i) < Friction(least)) least = i;
      if (Friction(i) > Friction(most)) most = i;
    }
    contacts->push_back(Emit(members, least, true));
    if (Friction(most) == Friction(least) || IsOnePoint(members)) return;
    contacts->push_back(Emit(members, most, false));
  }

  /** The contact that stands for all members, with the friction of one. */
  FoundContact Emit(const std::vector<int>& members, int owner, bool certain) const {
    const Candidate& c = candidates_[members[0]];
    FoundContact found;
    found.site = site_.site;
    found.body = site_.body;
    found.object = candidates_[owner].set->object;
    found.x = site_.x;
    found.y = c.y;
    found.error_x = site_.error;
    SetDistance(members, &found);
    ExactContact& contact = found.contact;
    contact.certain = certain;
    contact.cone.mu = Friction(owner);
    const Direction n = SetNormal(members, &contact);
    contact.p = site_.x;
    contact.error_p = site_.error;
    if (site_.radius > 0) {
      contact.p -= Scaled(site_.radius, n.u);
      contact.error_p += site_.radius * n.error;
    }
    return found;
  }

  void SetDistance(const std::vector<int>& members, FoundContact* found) const {
    const auto distance = [&](const Candidate& c, Rational* width) {
      const Root root = RootOf(c.squared, rules_.bits);
      *width = root.hi - root.lo;
      return Rational((c.sign > 0 ? root.lo : -root.lo) - c.inset);
    };
    Rational width;
    const Candidate& first = candidates_[members[0]];
    found->distance = distance(first, &width);
    for (int i : members) {
      const Candidate& c = candidates_[i];
      const Rational off = abs(distance(c, &width) - found->distance);
      const Rational error_d = off + width + c.error_d;
      found->error_distance = std::max(found->error_distance, error_d);
      const Rational error_y = SqrtUp(SquaredNorm(c.y - first.y)) + c.error_y;
      found->error_y = std::max(found->error_y, error_y);
    }
  }

  /** The cone's axis, with an error that covers those of all members, and its unit vector. */
  Direction SetNormal(const std::vector<int>& members, ExactContact* contact) const {
    const Candidate& first = candidates_[members[0]];
    Direction n = UnitOf(first, rules_.bits);
    contact->cone.w = first.w;
    contact->error_w = first.error_w;
    const bool same = std::all_of(members.begin(), members.end(), [&](int i) {
      const Candidate& c = candidates_[i];
      return c.error_w == 0 && first.error_w == 0 && IsZero(Cross(c.w, first.w)) &&
             Dot(c.w, first.w) > 0;
    });
    if (members.size() == 1 || same) return n;
    Rational error = n.error;
    for (int i : members) {
      const Direction other = UnitOf(candidates_[i], rules_.bits);
      error = std::max(error, Rational(other.error + SqrtUp(SquaredNorm(other.u - n.u))));
    }
    n.error = error;
    contact->cone.w = n.u;
    contact->error_w = error;
    return n;
  }

  const ContactSets& sets_;
  const PlacedSite& site_;
  SeamRules rules_;
  std::vector<Candidate> near_;
  std::vector<char> inside_;  ///< per near_: x is in the set for certain
  std::vector<Candidate> candidates_;
  std::vector<Standing> standing_;
};

}  // namespace
}  // namespace internal

std::vector<FoundContact> FindContacts(const ContactScene& scene, const RobotPlacement& placement,
                                       const ContactOptions& options) {
  const internal::ContactSets& sets = scene.sets();
  const Model& model = sets.model;
  Require(placement.links.size() == model.robot.links.size(),
          "the placement is not one of this model's robot");
  Require(options.root_bits >= 50 && options.root_bits <= 1 << 16,
          "the precision of roots must be between 50 and 2^16 bits");
  std::vector<FoundContact> contacts;
  for (std::size_t i = 0; i < model.sites.size(); ++i) {
    const Site& site = model.sites[i];
    const int body = model.robot.links[site.link].body;
    const std::vector<int>& bodies = model.contact.bodies;
    if (!std::binary_search(bodies.begin(), bodies.end(), body)) continue;
    const LinkPlacement& X = placement.links[site.link];
    const Vector3q x_L = Lift(site.x_L);
    internal::PlacedSite placed{static_cast<int>(i), body, Transformed(X.R, x_L) + X.p};
    placed.error = X.error_p;
    if (X.error_R != 0) placed.error += X.error_R * SqrtUp(SquaredNorm(x_L));
    placed.radius = Lift(site.radius);
    internal::SiteQuery(sets, placement, placed, options.root_bits).Find(&contacts);
  }
  return contacts;
}

EquilibriumQuery ContactEquilibrium(const ContactScene& scene, const RobotPlacement& placement,
                                    const std::vector<FoundContact>& contacts) {
  const Model& model = scene.sets().model;
  EquilibriumQuery query;
  for (const FoundContact& found : contacts) query.contacts.push_back(found.contact);
  query.com = placement.com;
  query.com_error = placement.com_error;
  query.mass = 0;
  for (const Link& link : model.robot.links) query.mass += Lift(link.mass);
  query.gravity = Lift(model.gravity);
  return query;
}

}  // namespace cguide::exact
