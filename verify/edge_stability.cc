#include "cguide/verify/edge_stability.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <deque>
#include <optional>
#include <vector>

#include "cguide/exact/contact.h"
#include "cguide/exact/core/error.h"
#include "cguide/numeric/membership.h"
#include "cguide/verify/leaf_balance_internal.h"

namespace cguide::verify {

using Eigen::Vector3d;
using numeric::World;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

struct StabilityEdgeWorkspace::Scratch {
  explicit Scratch(const World& world) : guide(world), keeper(world) {}
  numeric::GuideWorkspace guide;
  ContactKeeper keeper;
  TaylorState<kDegree> state;
  std::vector<KeptContact> kept;
  std::vector<Arm> arms;  ///< of the kept contacts
  BalanceProposer proposer;
  std::deque<Leaf> leaves;
  std::optional<exact::ContactScene> scene;  ///< made when first asked for
};

StabilityEdgeWorkspace::StabilityEdgeWorkspace(const World& world)
    : scratch(std::make_unique<Scratch>(world)) {}
StabilityEdgeWorkspace::~StabilityEdgeWorkspace() = default;
StabilityEdgeWorkspace::StabilityEdgeWorkspace(StabilityEdgeWorkspace&&) noexcept = default;
StabilityEdgeWorkspace& StabilityEdgeWorkspace::operator=(StabilityEdgeWorkspace&&) noexcept =
    default;

namespace {

/** (u, r(t) x u) of a constant force direction at a moving arm. */
struct MovingWrench {
  Model2 row[6];
};

MovingWrench WrenchOf(const Vector2& arm, const Vector3d& u) {
  MovingWrench wrench;
  for (int i = 0; i < 3; ++i) {
    wrench.row[i] = Constant<kDegree>(u[i]);
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    wrench.row[3 + i] = u[k] * Coordinate<kDegree>(arm, j) - u[j] * Coordinate<kDegree>(arm, k);
  }
  return wrench;
}

double Size(const Model2& a) { return std::max(-LowerBound(a), UpperBound(a)); }

/** u.n* >= |u| C for every real normal n* within `error` of n, C = 1/sqrt(1 + mu^2): rounding as
 derived at BoundError of numeric/stability_certificates.cc. */
bool IsAdmissible(const KeptContact& contact, const Vector3d& u) {
  const double cosine = 1 / std::sqrt(1 + contact.friction * contact.friction);
  return u.dot(contact.n_W) >= u.norm() * (cosine + contact.normal_error + 16 * kUnit);
}

/** A balance over a leaf: directions, weights and arms; the first six are the basis. */
struct LeafBalance {
  static constexpr int kCapacity = 18;  ///< two bases beside the first
  int size = 0;
  MovingWrench wrench[kCapacity];
  Model2 weight[kCapacity];
};

/** v - A(t) lambda(t). */
void Residual(const LeafBalance& balance, const Vector6d& v, Model2 (&residual)[6]) {
  for (int i = 0; i < 6; ++i) {
    residual[i] = Constant<kDegree>(v[i]);
    for (int j = 0; j < balance.size; ++j) {
      residual[i] = residual[i] - balance.weight[j] * balance.wrench[j].row[i];
    }
  }
}

/** R(a, .) times a moving vector. */
Model2 RowTimes(const Matrix6d& R, int a, const Model2 (&x)[6]) {
  Model2 sum = R(a, 0) * x[0];
  for (int i = 1; i < 6; ++i) sum = sum + R(a, i) * x[i];
  return sum;
}

/** Places of weights in certificates: shares of the load of about 1e-7, or all. */
int PlacesOf(const Vector6d& v, Care care) {
  const int digits = care == Care::kQuick ? 7 : 17;
  return std::clamp(digits - static_cast<int>(std::ceil(std::log10(v.head<3>().norm()))), 0, 17);
}

/** Puts the constant and the linear part of the residual on the basis; a proposal like all weights.
 */
void CorrectWeights(const Matrix6d& R, const Vector6d& v, int places, LeafBalance* balance) {
  Model2 residual[6];
  Residual(*balance, v, residual);
  for (int part = 0; part <= 1; ++part) {
    Vector6d c;
    for (int i = 0; i < 6; ++i) c[i] = residual[i].c[part];
    const Vector6d step = R * c;
    for (int j = 0; j < 6; ++j) balance->weight[j].c[part] += step[j];
  }
  for (int j = 0; j < 6; ++j) {
    for (int part = 0; part <= 1; ++part) {
      balance->weight[j].c[part] = ShortNumber(balance->weight[j].c[part], places);
    }
  }
}

/** The greater of two bounds; NaN, which bounds nothing, stays. */
double Greater(double a, double b) { return a > b ? a : (b >= a ? b : NAN); }

/** The two inequalities of DecideEdgeStability. NaN fails every comparison. */
bool ProveBalance(const Matrix6d& R, const Vector6d& v, const LeafBalance& balance) {
  double least = INFINITY;
  for (int j = 0; j < balance.size; ++j) {
    const double lowest = LowerBound(balance.weight[j]);
    if (!(lowest >= 0)) return false;
    if (j < 6 && !(lowest >= least)) least = lowest;
  }
  Model2 residual[6];
  Residual(balance, v, residual);
  double kappa = 0, moved = 0;
  for (int a = 0; a < 6; ++a) {
    double row = 0;
    for (int j = 0; j < 6; ++j) {
      Model2 entry = -RowTimes(R, a, balance.wrench[j].row);
      if (j == a) entry = Constant<kDegree>(1.0) + entry;
      row += Size(entry);
    }
    kappa = Greater(kappa, row);
    moved = Greater(moved, Size(RowTimes(R, a, residual)));
  }
  kappa *= kUp;
  return kappa < 1 && moved * kUp < (1 - kappa) * least * (1 - 0x1p-45);
}

class Decider {
 public:
  Decider(const World& world, const Edge& edge, const EdgeStabilityOptions& options,
          StabilityEdgeWorkspace::Scratch* scratch)
      : world_(world), edge_(edge), options_(options), x_(*scratch) {}

  EdgeStability Run();

 private:
  void PlaceAt(double s);
  void CopyMiddle();
  void ProposeContacts(const Leaf& leaf);
  bool SeemsToHold();
  Verdict TestMiddle(const Leaf& leaf);
  bool FailsExactly(const Leaf& leaf);
  void KeepContacts();
  bool HoldsOver(const Leaf& leaf);
  bool Balances();
  bool Balances(const Vector6d& v, std::vector<check::ForceEvidence>* noted);
  bool Carries(const std::vector<ProposedForce>& forces, const Vector6d& v, int places,
               std::vector<check::ForceEvidence>* noted);
  void Split(const Leaf& leaf);
  void Note(check::Balance balance);

  const World& world_;
  const Edge& edge_;
  const EdgeStabilityOptions& options_;
  StabilityEdgeWorkspace::Scratch& x_;
  EdgeStability result_;
  Leaf leaf_;                ///< at hand
  int exact_questions_ = 0;  ///< that were asked
};

// The real placement at s, which in general is that of no double configuration: the middle of
// Taylor models of a single point, whose remainders hold rounding alone and become error bounds.
void Decider::PlaceAt(double s) {
  EvaluateEdge<kDegree>(world_.tree(), edge_, {s, 0}, &x_.state);
  CopyMiddle();
  PlaceFromState(world_, &x_.guide.geometry);
}

// Where the bodies of x_.state are at t = 0, with its remainders. A point at |p_B| <= L is within
// sum_ij r(R_ij) L + sum_i r(p_i) of R p_B + p.
void Decider::CopyMiddle() {
  numeric::KinematicState& state = x_.guide.geometry.state;
  const std::size_t n = x_.state.X_WB.size();
  state.X_WB.resize(n);
  state.axis_W.resize(n);
  state.error_R.resize(n);
  state.error_p.resize(n);
  for (std::size_t b = 0; b < n; ++b) {
    const TaylorPose<kDegree>& X = x_.state.X_WB[b];
    double error_R = X.error_R;
    for (int j = 0; j < 3; ++j) {
      state.X_WB[b].R.col(j) = X.R[j].c[0].head<3>();
      error_R += X.R[j].r.sum();
    }
    state.X_WB[b].p = X.p.c[0].head<3>();
    state.error_R[b] = error_R * kUp;
    state.error_p[b] = (X.error_p + X.p.r.sum()) * kUp;
  }
  state.com_W = x_.state.com_W.c[0].head<3>();
  state.com_error = x_.state.com_W.r.sum() * kUp;
}

// Contacts at the middle of a leaf, for its proof: what they are worth is decided over the leaf.
// The remainders of a whole leaf would make them all uncertain, so they are left out here.
void Decider::ProposeContacts(const Leaf& leaf) {
  EvaluateEdge<kDegree>(world_.tree(), edge_, leaf, &x_.state);
  CopyMiddle();
  numeric::KinematicState& state = x_.guide.geometry.state;
  std::fill(state.error_R.begin(), state.error_R.end(), 64 * kUnit);
  std::fill(state.error_p.begin(), state.error_p.end(), 64 * kUnit);
  state.com_error = 64 * kUnit;
  PlaceFromState(world_, &x_.guide.geometry);
  FindContacts(world_, &x_.guide.geometry, &x_.guide.contacts);
}

// Whether it is worth while to ask for a refutation at the middle: not where the proposed contacts
// seem to carry the robot there. Proves nothing.
bool Decider::SeemsToHold() {
  if (world_.model().require == GuideRequirement::kStability) {
    return TryStability(PlacedQuery(world_, x_.guide), &x_.guide.stability).verdict ==
           Verdict::kHolds;
  }
  const auto& contacts = x_.guide.contacts;
  return std::any_of(contacts.begin(), contacts.end(), [](const auto& c) { return c.certain; });
}

// Fills x_.guide.contacts.
Verdict Decider::TestMiddle(const Leaf& leaf) {
  PlaceAt(leaf.middle);
  if (world_.model().require == GuideRequirement::kStability) {
    return TestPlacedStability(world_, &x_.guide).verdict;
  }
  FindContacts(world_, &x_.guide.geometry, &x_.guide.contacts);
  for (const numeric::Contact& contact : x_.guide.contacts) {
    if (contact.certain) return Verdict::kHolds;
  }
  return x_.guide.contacts.empty() ? Verdict::kFails : Verdict::kUndecided;
}

// Doubles know the closest points of meshes and hulls to about 1e-7 m. What they leave open on
// narrow leaves is asked of the exact twins, which take milliseconds, a few times an edge; pyramids
// of 8 sides tell what is a matter of geometry alone.
bool Decider::FailsExactly(const Leaf& leaf) {
  constexpr double kNarrow = 0x1p-12;
  constexpr int kBits = 106, kSides = 8;
  if (leaf.half > kNarrow || exact_questions_ >= options_.exact_questions) return false;
  ++exact_questions_;
  const Model& model = world_.model();
  if (!x_.scene) x_.scene.emplace(model);
  const exact::RobotPlacement placement =
      exact::PlaceRobot(model.robot, edge_, Lift(leaf.middle), kBits);
  const auto contacts = exact::FindContacts(*x_.scene, placement);
  if (model.require == GuideRequirement::kContact) return contacts.empty();
  const exact::EquilibriumQuery query = ContactEquilibrium(*x_.scene, placement, contacts);
  return DecideStability(query, {.max_sides = kSides}).verdict == Verdict::kFails;
}

void Decider::KeepContacts() {
  x_.kept.clear();
  for (const numeric::Contact& contact : x_.guide.contacts) {
    KeptContact kept;
    if (!contact.certain || !x_.keeper.Keep(x_.state, contact, options_.robust.pose, &kept))
      continue;
    if (options_.robust.friction > 0) {
      kept.friction = std::max(0.0, std::nextafter(kept.friction - options_.robust.friction, 0.0));
    }
    x_.kept.push_back(std::move(kept));
  }
}

// For a centre of mass that may be elsewhere, each corner of what the moment may be in its place.
bool Decider::Balances() {
  x_.arms.clear();
  for (const KeptContact& contact : x_.kept) {
    const Vector2 arm = contact.force_point - x_.state.com_W;
    x_.arms.push_back({arm.c[0].head<3>(), arm.c[1].head<3>(), arm.c[2].head<3>()});
  }
  Vector6d v = Vector6d::Zero();
  v.head<3>() = -world_.tree().mass * world_.model().gravity;
  check::Balance balance;
  if (!(options_.robust.com > 0)) {
    if (!Balances(v, &balance.forces)) return false;
  } else {
    for (const Vector3d& moment : DisplacedMoments(v.head<3>(), options_.robust.com)) {
      v.tail<3>() = moment;
      if (!Balances(v, &balance.displaced.emplace_back())) return false;
    }
  }
  if (options_.evidence) Note(std::move(balance));
  return true;
}

bool Decider::Balances(const Vector6d& v, std::vector<check::ForceEvidence>* noted) {
  constexpr double kNarrow = 0x1p-5;
  for (const Care care : {Care::kQuick, Care::kThorough}) {
    if (care == Care::kThorough && leaf_.half > kNarrow) return false;
    for (const WeightKind kind : {WeightKind::kConstant, WeightKind::kAffine}) {
      const auto& forces = x_.proposer.Propose(x_.kept, x_.arms, v, kind, care);
      if (forces.empty()) break;
      if (Carries(forces, v, PlacesOf(v, care), noted)) return true;
    }
  }
  return false;
}

// Contacts are numbered as in x_.kept.
bool Decider::Carries(const std::vector<ProposedForce>& forces, const Vector6d& v, int places,
                      std::vector<check::ForceEvidence>* noted) {
  LeafBalance balance;
  balance.size = static_cast<int>(forces.size());
  Matrix6d B;
  for (int j = 0; j < balance.size; ++j) {
    const ProposedForce& force = forces[j];
    const KeptContact& contact = x_.kept[force.contact];
    if (!IsAdmissible(contact, force.u_W)) return false;
    const Vector2 arm = contact.force_point - x_.state.com_W;
    balance.wrench[j] = WrenchOf(arm, force.u_W);
    balance.weight[j] = Constant<kDegree>(ShortNumber(force.w0, places));
    balance.weight[j].c[1] = ShortNumber(force.w1, places);
    if (j >= 6) continue;
    for (int i = 0; i < 6; ++i) B(i, j) = balance.wrench[j].row[i].c[0];
  }
  const Matrix6d R = B.partialPivLu().inverse();
  if (!R.allFinite()) return false;
  // The real mass is that of the model; its rounding in `tree` scales all weights alike, and being
  // interior does not depend on the scale of v.
  CorrectWeights(R, v, places, &balance);
  if (!ProveBalance(R, v, balance)) return false;
  for (int j = 0; j < balance.size; ++j) {
    const double w0 = balance.weight[j].c[0], w1 = balance.weight[j].c[1];
    // What was rounded to nothing bears nothing; the checker's bound on it would be below zero.
    if (w0 != 0 || w1 != 0) noted->push_back({forces[j].contact, forces[j].u_W, w0, w1});
  }
  return true;
}

// Only contacts that bear a force are written, numbered in the order of their first.
void Decider::Note(check::Balance balance) {
  std::vector<int> number(x_.kept.size(), -1);
  const auto renumber = [&](std::vector<check::ForceEvidence>& forces) {
    for (check::ForceEvidence& force : forces) {
      int& known = number[force.contact];
      if (known < 0) {
        known = static_cast<int>(balance.contacts.size());
        balance.contacts.push_back(x_.kept[force.contact].evidence);
      }
      force.contact = known;
    }
  };
  renumber(balance.forces);
  for (auto& forces : balance.displaced) renumber(forces);
  options_.evidence->nodes[leaf_].balance = std::move(balance);
}

bool Decider::HoldsOver(const Leaf& leaf) {
  ProposeContacts(leaf);
  KeepContacts();
  if (x_.kept.empty()) return false;
  if (world_.model().require == GuideRequirement::kContact) {
    if (options_.evidence) {
      options_.evidence->nodes[leaf_].balance = check::Balance{{x_.kept.front().evidence}, {}, {}};
    }
    return true;
  }
  return Balances();
}

void Decider::Split(const Leaf& leaf) {
  if (options_.evidence) options_.evidence->splits.insert(leaf);
  const double half = 0.5 * leaf.half;
  x_.leaves.push_back({leaf.middle - half, half});
  x_.leaves.push_back({leaf.middle + half, half});
}

EdgeStability Decider::Run() {
  if (world_.model().contact.model == ContactModel::kNearest) {
    result_.verdict = Verdict::kUndecided;
    result_.reason = "contact model \"nearest\": its contacts are not continuous";
    return result_;
  }
  x_.leaves.assign(1, Leaf{0.5, 0.5});
  while (!x_.leaves.empty()) {
    const Leaf leaf = x_.leaves.front();
    x_.leaves.pop_front();
    leaf_ = leaf;
    if (leaf.half > options_.widest) {
      Split(leaf);
      continue;
    }
    ++result_.leaves;
    if (HoldsOver(leaf)) {
      ++result_.proved;
      continue;
    }
    const Verdict middle = SeemsToHold() ? Verdict::kHolds : TestMiddle(leaf);
    if (middle == Verdict::kFails || (middle == Verdict::kUndecided && FailsExactly(leaf))) {
      result_.verdict = Verdict::kFails;
      result_.s = leaf.middle;
      return result_;
    }
    if (leaf.half <= options_.shortest || result_.leaves >= options_.max_leaves) {
      result_.verdict = Verdict::kUndecided;
      result_.s = leaf.middle;
      result_.reason = middle == Verdict::kHolds ? "no set of contacts is known to stay"
                                                 : "the middle of the leaf is not decided";
      return result_;
    }
    Split(leaf);
  }
  return result_;
}

}  // namespace

EdgeStability DecideEdgeStability(const World& world, const Edge& edge,
                                  const EdgeStabilityOptions& options,
                                  StabilityEdgeWorkspace* workspace) {
  Require(options.shortest >= 0x1p-40, "leaves must not be shorter than 2^-40");
  return Decider(world, edge, options, workspace->scratch.get()).Run();
}

}  // namespace cguide::verify
