#include "cguide/exact/com_region_search.h"

#include <Eigen/LU>
#include <algorithm>

#include "cguide/exact/cone_membership.h"
#include "cguide/exact/core/error.h"
#include "cguide/exact/linear_algebra.h"
#include "cguide/exact/linear_program.h"
#include "cguide/exact/pyramids_internal.h"

namespace cguide::exact {
namespace {

using internal::Generators;

const Rational kFar = 128;  // m

/** max d.delta over delta = (x_N - x_N+1) e1 + (x_N+2 - x_N+3) e2 with sum x_j a_j - (0, delta x w)
 = (w, 0). */
class DisplacementProgram {
 public:
  DisplacementProgram(const std::vector<VectorXq>& wrenches, const Vector3q& w,
                      const std::array<Vector3q, 2>& axes)
      : count_(wrenches.size()), axes_(axes) {
    program_.columns = wrenches;
    for (const Vector3q& e : axes) {
      VectorXq column = VectorXq::Zero(6);
      column.tail(3) = Cross(w, e);  // -(e x w)
      program_.columns.push_back(column);
      program_.columns.push_back(-column);
    }
    program_.b = VectorXq::Zero(6);
    program_.b.head(3) = w;
  }

  const ProgramSolution& Solve(const Vector3q& d) {
    program_.c.assign(count_, 0);
    for (const Vector3q& e : axes_) {
      program_.c.push_back(Dot(d, e));
      program_.c.push_back(-program_.c.back());
    }
    const std::vector<int> last = std::move(solution_.basis);
    solution_ = SolveLinearProgram(program_, last);
    return solution_;
  }

  Vector3q Displacement(const std::vector<Rational>& x) const {
    return Scaled(x[count_] - x[count_ + 1], axes_[0]) +
           Scaled(x[count_ + 2] - x[count_ + 3], axes_[1]);
  }

 private:
  LinearProgram program_;
  std::size_t count_;
  std::array<Vector3q, 2> axes_;
  ProgramSolution solution_;
};

class Search {
 public:
  Search(const EquilibriumQuery& query, const Vector3q& up, const RegionSearchOptions& options)
      : up_(up), axes_(PlaneAxes(up)), max_shots_(options.max_shots) {
    const Vector3q w = Scaled(-query.mass, query.gravity);
    if (internal::IsExact(query)) {
      generators_ = internal::InnerGenerators(query, options.sides);
      inner_.emplace(generators_.wrenches, w, axes_);
    }
    if (const auto outer = internal::OuterGenerators(query, options.sides)) {
      outer_.emplace(*outer, w, axes_);
    }
  }

  ComRegionEvidence Run();

 private:
  struct Shot {
    Vector3q d;
    std::optional<DisplacedBalance> corner;
    std::optional<Vector6q> separator;
  };

  Shot Shoot(const Vector3q& d);
  bool Refine(std::size_t i);
  void ShootAtOrigin();

  Vector3q up_;
  std::array<Vector3q, 2> axes_;
  int max_shots_;
  Generators generators_;
  std::optional<DisplacementProgram> inner_, outer_;
  bool is_empty_ = false;
  std::vector<Shot> shots_;  // counter-clockwise by direction
};

Search::Shot Search::Shoot(const Vector3q& d) {
  Shot shot;
  shot.d = d;
  if (inner_) {
    ProgramSolution solution = inner_->Solve(d);
    if (solution.status == ProgramStatus::kUnbounded) {
      const Rational length = SqrtUp(SquaredNorm(inner_->Displacement(solution.ray)));
      for (std::size_t j = 0; j < solution.x.size(); ++j) {
        solution.x[j] += kFar / length * solution.ray[j];
      }
    }
    if (solution.status != ProgramStatus::kInfeasible) {
      shot.corner.emplace();
      shot.corner->displacement = inner_->Displacement(solution.x);
      for (std::size_t j = 0; j < generators_.forces.size(); ++j) {
        if (solution.x[j] == 0) continue;
        ContactForce force = generators_.forces[j];
        force.f = Scaled(solution.x[j], force.f);
        shot.corner->forces.push_back(std::move(force));
      }
    }
  }
  if (outer_) {
    const ProgramSolution& solution = outer_->Solve(d);
    if (solution.status == ProgramStatus::kOptimal) shot.separator = -solution.y;
    if (solution.status == ProgramStatus::kInfeasible) {
      shot.separator = solution.y;
      is_empty_ = true;
    }
  }
  return shot;
}

Vector3q Rounded(const Vector3q& d) {
  const Rational scale = SqrtUp(SquaredNorm(d));
  Vector3q result;
  for (int k = 0; k < 3; ++k) result[k] = Lift(NearestDouble(Rational(d[k] / scale)));
  return result;
}

/** Asks the outward normal of the side from shot i to the next; false where there is no side. */
bool Search::Refine(std::size_t i) {
  const Shot &a = shots_[i], &b = shots_[(i + 1) % shots_.size()];
  if (!a.corner || !b.corner) return false;
  const Vector3q normal = Cross(b.corner->displacement - a.corner->displacement, up_);
  if (IsZero(normal)) return false;
  const Vector3q d = Rounded(normal);
  // Only between the two: the polygon turns by less than half a turn from one shot to the next.
  if (Dot(up_, Cross(a.d, d)) <= 0 || Dot(up_, Cross(d, b.d)) <= 0) return false;
  shots_.insert(shots_.begin() + static_cast<std::ptrdiff_t>(i) + 1, Shoot(d));
  return true;
}

/** From the nearest corner; a polygon that holds 0 needs no such line. */
void Search::ShootAtOrigin() {
  const Shot* nearest = nullptr;
  for (const Shot& shot : shots_) {
    if (!shot.corner) continue;
    if (!nearest ||
        SquaredNorm(shot.corner->displacement) < SquaredNorm(nearest->corner->displacement)) {
      nearest = &shot;
    }
  }
  if (!nearest || IsZero(nearest->corner->displacement)) return;
  Shot shot = Shoot(Rounded(-nearest->corner->displacement));
  shot.corner.reset();
  shots_.push_back(std::move(shot));
}

ComRegionEvidence Search::Run() {
  for (const Vector3q& d : {axes_[0], axes_[1], Vector3q(-axes_[0]), Vector3q(-axes_[1])}) {
    if (!is_empty_) shots_.push_back(Shoot(d));
  }
  for (std::size_t i = 0; !is_empty_ && i < shots_.size();) {
    if (static_cast<int>(shots_.size()) >= max_shots_) break;
    if (!Refine(i)) ++i;
  }
  if (!is_empty_) ShootAtOrigin();
  ComRegionEvidence evidence;
  for (Shot& shot : shots_) {
    if (shot.separator) evidence.separators.push_back(*shot.separator);
    if (!shot.corner) continue;
    const auto same = [&](const DisplacedBalance& other) {
      return other.displacement == shot.corner->displacement;
    };
    if (std::none_of(evidence.corners.begin(), evidence.corners.end(), same)) {
      evidence.corners.push_back(std::move(*shot.corner));
    }
  }
  return evidence;
}

}  // namespace

ComRegionEvidence SearchComRegion(const EquilibriumQuery& query, const Vector3q& up,
                                  const RegionSearchOptions& options) {
  Require(options.sides >= 3, "a pyramid needs at least three sides");
  if (!CheckComRegion(query, up, {})) {  // the preconditions are its own
    throw Error(Error::Code::kInternal, "no evidence was refused");
  }
  if (auto closure = SearchClosure(query)) return *closure;
  ComRegionEvidence evidence = Search(query, up, options).Run();
  if (!CheckComRegion(query, up, evidence)) {
    throw Error(Error::Code::kInternal, "the search for a region of balance found no valid proof");
  }
  return evidence;
}

std::optional<ComRegionEvidence> SearchClosure(const EquilibriumQuery& query, int sides) {
  const Generators generators = internal::InnerGenerators(query, sides);
  if (generators.wrenches.empty()) return std::nullopt;
  const ConeMembership nothing = DecideConeMembership(generators.wrenches, VectorXq::Zero(6));
  if (nothing.where != Membership::kInterior) return std::nullopt;
  std::vector<VectorXq> wrenches;
  for (const int j : nothing.index) wrenches.push_back(generators.wrenches[j]);
  const std::vector<int> basis = internal::ProposeBasis(wrenches);
  Eigen::Matrix<double, 6, 6> B;
  ComRegionEvidence evidence;
  DisplacedBalance& closure = evidence.closure.emplace();
  for (int k = 0; k < 6; ++k) {
    for (int i = 0; i < 6; ++i) B(i, k) = NearestDouble(wrenches[basis[k]][i]);
    evidence.basis.columns.push_back(generators.forces[nothing.index[basis[k]]]);
    closure.base_weight.push_back(nothing.weight[basis[k]]);
  }
  for (std::size_t j = 0; j < wrenches.size(); ++j) {
    if (std::find(basis.begin(), basis.end(), static_cast<int>(j)) != basis.end()) continue;
    ContactForce force = generators.forces[nothing.index[j]];
    force.f = Scaled(nothing.weight[j], force.f);
    closure.forces.push_back(std::move(force));
  }
  const Eigen::Matrix<double, 6, 6> inverse = B.inverse();
  if (!inverse.allFinite()) return std::nullopt;
  evidence.basis.inverse.resize(6, 6);
  for (int i = 0; i < 6; ++i) {
    for (int k = 0; k < 6; ++k) evidence.basis.inverse(i, k) = Lift(inverse(i, k));
  }
  Vector3q up = Scaled(-1, query.gravity);
  if (!CheckComRegion(query, up, evidence)) return std::nullopt;
  return evidence;
}

}  // namespace cguide::exact
