#include "cguide/numeric/proved_margins.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "cguide/exact/com_region_search.h"
#include "cguide/exact/core/error.h"
#include "cguide/exact/linear_algebra.h"
#include "cguide/exact/wrench_polyhedra.h"
#include "cguide/numeric/certified_facets.h"
#include "cguide/numeric/demand_limit.h"
#include "cguide/numeric/region_prover_internal.h"

namespace cguide::numeric {
namespace {

using internal::BoundaryPoint;
using internal::RegionExplorer;
using internal::RegionProver;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/** The query under the acceleration, with its finite numbers checked. */
StabilityQuery Accelerated(const StabilityQuery& query, const RegionOptions& options,
                           StabilityWorkspace* workspace) {
  StabilityQuery result = query;
  result.gravity_W -= options.acceleration_W;
  Require(!query.gravity_W.isZero(0), "gravity must not vanish");
  Require(ScaleContacts(result, &workspace->scratch->contacts),
          "numbers must be finite, mass positive, gravity different from the acceleration");
  for (const Contact& contact : query.contacts) {
    Require(!contact.n_W.isZero(0), "a contact normal must not vanish");
  }
  return result;
}

// Points that coincide up to rounding would make the polygon turn either way.
std::vector<std::size_t> DistinctPoints(const std::vector<BoundaryPoint>& points) {
  double size = 0;
  for (const BoundaryPoint& point : points) size = std::max(size, (point.p - points[0].p).norm());
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto near = [&](std::size_t j) {
      return (points[i].p - points[j].p).norm() <= 1e-10 * size;
    };
    if (kept.empty() || (!near(kept.back()) && !near(kept.front()))) kept.push_back(i);
  }
  return kept;
}

/** Of a polygon's corners those that its least distance from 0 needs: where 0 is inside, corners
 are left out while the chords keep that distance; else the ends of the nearest side. */
void KeepForMargin(const std::vector<BoundaryPoint>& points, double lo,
                   std::vector<std::size_t>* kept) {
  const auto distance = [&](std::size_t i, std::size_t j) {
    const Eigen::Vector2d &a = points[i].p, &b = points[j].p;
    return internal::Cross2(a, b) / (b - a).norm();
  };
  if (lo > 0) {
    for (std::size_t k = 0; k < kept->size() && kept->size() > 3;) {
      const std::size_t n = kept->size();
      const std::size_t before = (*kept)[(k + n - 1) % n], after = (*kept)[(k + 1) % n];
      if (distance(before, after) > lo) {
        kept->erase(kept->begin() + static_cast<std::ptrdiff_t>(k));
      } else {
        ++k;
      }
    }
    return;
  }
  std::array<std::size_t, 2> best{};
  double nearest = kInfinity;
  for (std::size_t k = 0; k < kept->size(); ++k) {
    const std::size_t i = (*kept)[k], j = (*kept)[(k + 1) % kept->size()];
    const double d = internal::DistanceFromSegment(points[i].p, points[j].p);
    if (d >= nearest) continue;
    nearest = d;
    best = {i, j};
  }
  *kept = {best[0]};
  if (best[1] != best[0]) kept->push_back(best[1]);
}

/** What the explorer found, as evidence that checks, in the two halves of a region. */
class Proof {
 public:
  Proof(const StabilityQuery& query, const RegionOptions& options, StabilityWorkspace* workspace)
      : query_(Accelerated(query, options, workspace)),
        up_(-query.gravity_W),
        lifted_(LiftCertain(query_)),
        explorer_(query_, workspace, {up_, true}),
        prover_(query_, up_, lifted_, workspace) {
    lifted_.query.gravity = Lift(query.gravity_W) - Lift(options.acceleration_W);
    region_.up = Lift(up_);
    has_base_ = explorer_.found() && prover_.SetBase(explorer_);
  }

  bool found() const { return has_base_; }
  RegionExplorer& explorer() { return explorer_; }

  /** The exact twin's evidence instead. */
  void Search();
  /** Whether force closure was proved. */
  bool AddClosure();
  /** All proper corners, or those that a com margin needs. */
  void AddCorners(std::optional<double> com_margin);
  /** Made safe and checked; else, those of the exact twin. */
  void AddSeparators(const std::vector<Vector6d>& wrenches);
  ProvedRegion Take() { return {std::move(lifted_), std::move(evidence_), std::move(region_)}; }

 private:
  std::optional<exact::ComRegion> Check(const exact::ComRegionEvidence& evidence) const {
    return exact::CheckComRegion(lifted_.query, region_.up, evidence);
  }
  bool TryCorners(const std::vector<std::size_t>& kept, double reach);
  bool TrySeparators(const std::vector<Vector6d>& wrenches, double reach);

  StabilityQuery query_;
  Eigen::Vector3d up_;
  LiftedQuery lifted_;
  RegionExplorer explorer_;
  RegionProver prover_;
  bool has_base_ = false;
  exact::ComRegionEvidence evidence_;
  exact::ComRegion region_;
};

void Proof::Search() {
  evidence_ = exact::SearchComRegion(lifted_.query, region_.up);
  region_ = *Check(evidence_);
}

// Where the negative of the base's sum is in the cone too, every wrench is. The exact twin's search
// (SearchClosure) would do, but takes several times longer.
bool Proof::AddClosure() {
  exact::ComRegionEvidence evidence;
  evidence.basis = prover_.basis();
  exact::DemandFamily family;
  family.v = Vector6q::Zero();
  for (const exact::ContactForce& column : evidence.basis.columns) {
    const Vector3q arm = lifted_.query.contacts[column.contact].p - lifted_.query.com;
    const Vector3q moment = exact::Cross(arm, column.f);
    for (int k = 0; k < 3; ++k) {
      family.v[k] -= column.f[k];
      family.v[3 + k] -= moment[k];
    }
  }
  for (const int sides : {8, 32}) {
    const exact::PyramidCone cone = exact::InscribedCone(lifted_.query, sides);
    const exact::DemandLimit limit = numeric::FindDemandLimit(cone, family);
    if (limit.status == exact::ProgramStatus::kInfeasible) continue;
    exact::DisplacedBalance& closure = evidence.closure.emplace();
    closure.base_weight.assign(6, 1);
    for (const exact::WeightedForce& force : limit.forces) {
      exact::ContactForce scaled = cone.forces[force.generator];
      scaled.f = exact::Scaled(force.weight, scaled.f);
      closure.forces.push_back(std::move(scaled));
    }
    auto region = Check(evidence);
    if (!region) continue;
    region_ = std::move(*region);
    evidence_ = std::move(evidence);
    return true;
  }
  return false;
}

bool Proof::TryCorners(const std::vector<std::size_t>& kept, double reach) {
  exact::ComRegionEvidence evidence;
  evidence.basis = prover_.basis();
  for (const std::size_t i : kept) {
    const BoundaryPoint& point = explorer_.points()[i];
    auto corner = prover_.Corner(explorer_.balances()[point.balance], reach);
    if (corner) evidence.corners.push_back(std::move(*corner));
  }
  auto region = Check(evidence);
  if (!region) return false;
  region_.inner = std::move(region->inner);
  evidence_.basis = std::move(evidence.basis);
  evidence_.corners = std::move(evidence.corners);
  return true;
}

void Proof::AddCorners(std::optional<double> com_margin) {
  const std::vector<BoundaryPoint>& points = explorer_.points();
  std::vector<std::size_t> kept = DistinctPoints(points);
  if (com_margin) {
    KeepForMargin(points, *com_margin, &kept);
  } else {
    const std::vector<std::size_t> proper = internal::ProperCorners(points);
    std::erase_if(
        kept, [&](std::size_t i) { return !std::binary_search(proper.begin(), proper.end(), i); });
  }
  for (double reach = 1; reach < 1e6; reach *= 32) {
    if (TryCorners(kept, reach)) return;
  }
}

bool Proof::TrySeparators(const std::vector<Vector6d>& wrenches, double reach) {
  exact::ComRegionEvidence evidence;
  for (const Vector6d& y : wrenches) {
    const auto safe = prover_.Separator(y, reach);
    if (!safe) return false;
    evidence.separators.push_back(*safe);
  }
  auto region = Check(evidence);
  if (!region) return false;
  region_.outer = std::move(region->outer);
  evidence_.separators = std::move(evidence.separators);
  return true;
}

void Proof::AddSeparators(const std::vector<Vector6d>& wrenches) {
  for (double reach = 1; reach < 1e6; reach *= 32) {
    if (TrySeparators(wrenches, reach)) return;
  }
  exact::ComRegionEvidence evidence;
  evidence.separators = exact::SearchComRegion(lifted_.query, region_.up).separators;
  if (auto region = Check(evidence)) {
    region_.outer = std::move(region->outer);
    evidence_.separators = std::move(evidence.separators);
  }
}

}  // namespace

ProvedComMargin ProveComMargin(const StabilityQuery& query, const RegionOptions& options,
                               StabilityWorkspace* workspace) {
  Proof proof(query, options, workspace);
  ProvedComMargin result;
  if (!proof.found()) {
    proof.Search();
  } else {
    const ComMargin margin = internal::ExploreMargin(options.margins, &proof.explorer());
    result.direction_W = margin.direction_W;
    if (std::isfinite(margin.lo) || !proof.AddClosure()) {
      proof.AddCorners(margin.lo);
      std::vector<Vector6d> wrenches;
      for (const auto& line : internal::BindingLines(proof.explorer())) wrenches.push_back(line.y);
      proof.AddSeparators(wrenches);
    }
  }
  result.proof = proof.Take();
  result.com_m = exact::MarginBounds(result.proof.region);
  return result;
}

ProvedSupportRegion ProveSupportRegion(const StabilityQuery& query, const RegionOptions& options,
                                       StabilityWorkspace* workspace) {
  Proof proof(query, options, workspace);
  if (!proof.found()) {
    proof.Search();
  } else {
    internal::ExploreRegion(options.margins, &proof.explorer());
    std::vector<Vector6d> wrenches;
    for (const BoundaryPoint& point : proof.explorer().points()) {
      if (!point.y.isZero(0)) wrenches.push_back(point.y);
    }
    if (!wrenches.empty() || !proof.AddClosure()) {
      proof.AddCorners(std::nullopt);
      proof.AddSeparators(wrenches);
    }
  }
  ProvedSupportRegion result;
  result.proof = proof.Take();
  const exact::ComRegion& region = result.proof.region;
  result.gap = exact::RegionGap(region);
  result.whole_plane = region.whole_plane;
  result.is_empty = exact::MarginBounds(region).hi == -kInfinity;
  for (const Vector3q& d : region.inner) {
    Vector3q p = Lift(query.com_W);
    p += d;
    result.inner_W.emplace_back(NearestDouble(p[0]), NearestDouble(p[1]), NearestDouble(p[2]));
  }
  return result;
}

namespace {

/** The generators as forces in doubles, where doubles hold them exactly. */
std::optional<std::vector<AppliedForce>> AsDoubles(const exact::EquilibriumQuery& query,
                                                   const exact::PyramidCone& cone) {
  const auto to_double = [](const Vector3q& v, Eigen::Vector3d* out) {
    for (int k = 0; k < 3; ++k) {
      (*out)[k] = NearestDouble(v[k]);
      if (!std::isfinite((*out)[k]) || Lift((*out)[k]) != v[k]) return false;
    }
    return true;
  };
  std::vector<AppliedForce> result;
  for (const exact::ContactForce& force : cone.forces) {
    AppliedForce a;
    if (!to_double(query.contacts[force.contact].p, &a.p) || !to_double(force.f, &a.u)) {
      return std::nullopt;
    }
    result.push_back(a);
  }
  return result;
}

/** The facets about the centre of mass c from those about the origin: with m_o = m_c + c x f a
 facet (h_f, h_m) becomes (h_f + h_m x c, h_m), because h_m.(c x f) = (h_m x c).f. */
VectorXq MovedTo(const Vector3q& c, const VectorXq& h) {
  VectorXq moved = h;
  moved.head(3) += exact::Cross(Vector3q(h.tail(3)), c);
  return moved;
}

/** All facets of the cone about the centre of mass: by CertifiedFacets where the generators are
 doubles, as axis-aligned contacts' are, else by the textbook. */
exact::HalfspaceCone FacetsAboutCom(const exact::EquilibriumQuery& query,
                                    const exact::PyramidCone& cone) {
  const auto forces = AsDoubles(query, cone);
  if (!forces) return exact::WrenchFacets(cone);
  exact::HalfspaceCone facets = ExactFacets(*forces, CertifiedFacets(*forces));
  for (VectorXq& h : facets.facets) h = MovedTo(query.com, h);
  for (VectorXq& e : facets.equations) e = MovedTo(query.com, e);
  return facets;
}

}  // namespace

std::optional<exact::Enclosure> ProveForceMargin(const StabilityQuery& query, int max_generators) {
  for (const Contact& contact : query.contacts) {
    if (contact.n_W.isZero(0)) return std::nullopt;
  }
  const LiftedQuery lifted = LiftCertain(query);
  const auto cone = exact::InscribedCone(lifted.query, query.generators);
  if (static_cast<int>(cone.wrenches.size()) > max_generators) return std::nullopt;
  return exact::ForceMargin(lifted.query, FacetsAboutCom(lifted.query, cone));
}

}  // namespace cguide::numeric
