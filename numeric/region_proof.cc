#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "cguide/exact/com_region_search.h"
#include "cguide/exact/core/error.h"
#include "cguide/exact/linear_algebra.h"
#include "cguide/numeric/demand_limit.h"
#include "cguide/numeric/region_proof_internal.h"

namespace cguide::numeric::internal {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/** The query under the acceleration, with its finite numbers checked. */
StabilityQuery Accelerated(const StabilityQuery& query, const RegionOptions& options,
                           StabilityWorkspace* workspace) {
  StabilityQuery result = query;
  if (options.acceleration_W) result.gravity_W -= *options.acceleration_W;
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
    return Cross2(a, b) / (b - a).norm();
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
    const double d = DistanceFromSegment(points[i].p, points[j].p);
    if (d >= nearest) continue;
    nearest = d;
    best = {i, j};
  }
  *kept = {best[0]};
  if (best[1] != best[0]) kept->push_back(best[1]);
}

/** Adds, to either side of the line's normal, the point p that bounds best how far a line h.p <=
 offset through the region may turn there. */
void AddTelling(const std::vector<BoundaryPoint>& points, const std::vector<std::size_t>& distinct,
                const BindingLine& line, std::vector<std::size_t>* kept) {
  for (const double side : {1.0, -1.0}) {
    const Eigen::Vector2d t(-side * line.h[1], side * line.h[0]);
    std::optional<std::size_t> best;
    double least = kInfinity;
    for (const std::size_t i : distinct) {
      const double across = points[i].p.dot(t);
      if (!(across > 1e-9)) continue;
      const double turn = (line.offset + 1e-10 - points[i].p.dot(line.h)) / across;
      if (turn >= least) continue;
      least = turn;
      best = i;
    }
    if (!best || std::find(kept->begin(), kept->end(), *best) != kept->end()) continue;
    kept->push_back(*best);
  }
  std::sort(kept->begin(), kept->end());
}

}  // namespace

RegionProof::RegionProof(const StabilityQuery& query, const RegionOptions& options,
                         StabilityWorkspace* workspace)
    : query_(Accelerated(query, options, workspace)),
      up_(-query.gravity_W),
      lifted_(LiftCertain(query_)),
      explorer_(query_, workspace, {up_, true}),
      prover_(query_, up_, lifted_, workspace) {
  lifted_.query.gravity = Lift(query.gravity_W);
  if (options.acceleration_W) lifted_.query.gravity -= Lift(*options.acceleration_W);
  region_.up = Lift(up_);
  has_base_ = explorer_.found() && prover_.SetBase(explorer_);
}
void RegionProof::Search() {
  evidence_ = exact::SearchComRegion(lifted_.query, region_.up);
  region_ = *Check(evidence_);
}

// Where the negative of the base's sum is in the cone too, every wrench is. The exact twin's search
// (SearchClosure) would do, but takes several times longer.
bool RegionProof::AddClosure() {
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

bool RegionProof::TryCorners(const std::vector<std::size_t>& kept, double reach) {
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

void RegionProof::AddCorners() {
  std::vector<std::size_t> kept = DistinctPoints(explorer_.points());
  const std::vector<std::size_t> proper = ProperCorners(explorer_.points());
  std::erase_if(
      kept, [&](std::size_t i) { return !std::binary_search(proper.begin(), proper.end(), i); });
  AddCorners(kept);
}

void RegionProof::AddCornersForMargin(double com_margin) {
  const std::vector<BoundaryPoint>& points = explorer_.points();
  const std::vector<std::size_t> distinct = DistinctPoints(points);
  std::vector<std::size_t> kept = distinct;
  KeepForMargin(points, com_margin, &kept);
  const std::vector<BindingLine> lines = BindingLines(explorer_);
  if (!lines.empty()) AddTelling(points, distinct, lines.back(), &kept);
  AddCorners(kept);
}

void RegionProof::AddBinding() {
  std::vector<Vector6d> wrenches;
  for (const BindingLine& line : BindingLines(explorer_)) wrenches.push_back(line.y);
  AddSeparators(wrenches);
}

std::optional<exact::TwistedBalance> RegionProof::Twisted(const BindingLine& line, double twist) {
  const FloatBalance shot = explorer_.ShootTwisted(line.offset * line.h, line.h, twist);
  for (double reach = 1; reach < 1e6; reach *= 32) {
    exact::TwistedBalance result;
    auto balance = prover_.Corner(shot, reach, &result.twist);
    if (!balance) continue;
    result.balance = *std::move(balance);
    return result;
  }
  return std::nullopt;
}

std::optional<Vector6q> RegionProof::Pole() {
  const Vector6d* pole = prover_.pole();
  if (pole == nullptr) return std::nullopt;
  Vector6q z;
  for (int k = 0; k < 6; ++k) z[k] = Lift((*pole)[k]);
  return z;
}

void RegionProof::AddCorners(const std::vector<std::size_t>& kept) {
  for (double reach = 1; reach < 1e6; reach *= 32) {
    if (TryCorners(kept, reach)) return;
  }
}

bool RegionProof::TrySeparators(const std::vector<Vector6d>& wrenches, double reach) {
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

void RegionProof::AddSeparators(const std::vector<Vector6d>& wrenches) {
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

}  // namespace cguide::numeric::internal
