#include "cguide/numeric/stability_memory.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "cguide/numeric/fp_guard.h"
#include "cguide/numeric/stability_contacts_internal.h"

// Nothing in this file is trusted: what it remembers are proposals, and the certificates decide.
namespace cguide::numeric {
namespace {

using Eigen::Vector3d;

/** A force of a remembered base. */
struct KeptForce {
  int place = -1;  ///< of its contact in the list
  int site = -1, body = -1, object = -1;
  Vector3d point_W = Vector3d::Zero();
  Vector3d n_W = Vector3d::Zero();
  Vector3d t_W = Vector3d::Zero();  ///< unit, normal to n; zero where the force is along n
  double mu = 0;                    ///< with which u was made
  Vector3d u_W = Vector3d::Zero();
};

/** Six forces that span the wrenches and balanced a query. */
struct KeptBase {
  KeptForce force[6];
  Matrix6d inverse;  ///< of their wrenches about `com_W`, arms in units of `length`
  Vector3d com_W = Vector3d::Zero();
  double length = 1;  ///< m, a power of two
};

/** A wrench y that separated, of moments in metres. */
struct KeptCut {
  Vector6d y = Vector6d::Zero();
  Vector3d arm =
      Vector3d::Zero();  ///< of the mean of the force points, from the centre of mass (m)
};

/** The last few, last used first. */
template <typename T>
class Recent {
 public:
  static constexpr int kCapacity = 8;
  int size() const { return size_; }
  T& operator[](int i) { return kept_[static_cast<std::size_t>(i)]; }
  void Use(int i) { std::rotate(kept_.begin(), kept_.begin() + i, kept_.begin() + i + 1); }
  /** A place for a new one, in front. */
  T& Add() {
    size_ = std::min(size_ + 1, kCapacity);
    Use(size_ - 1);
    return kept_[0];
  }
  void Clear() { size_ = 0; }

 private:
  std::array<T, kCapacity> kept_;
  int size_ = 0;
};

Vector3d Cross(const Vector3d& a, const Vector3d& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

bool IsSame(const KeptForce& force, const Contact& contact) {
  return force.site == contact.site && force.body == contact.body && force.object == contact.object;
}

// The contact that is probably the force's: at its place, else the nearest of its site and object.
int FindContact(const KeptForce& force, std::span<const Contact> contacts) {
  const int n = static_cast<int>(contacts.size());
  if (force.place < n && IsSame(force, contacts[force.place])) return force.place;
  int best = -1;
  double nearest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < n; ++i) {
    if (!IsSame(force, contacts[i])) continue;
    const double squared = (contacts[i].force_point_W() - force.point_W).squaredNorm();
    if (squared < nearest) {
      nearest = squared;
      best = i;
    }
  }
  return best;
}

}  // namespace

struct StabilityMemory::Contents {
  Contents() { Resize(6, &some); }  // all the room that it will need
  Recent<KeptBase> bases;
  Recent<KeptCut> cuts;
  bool failed_last = false;
  long asked = 0, answered = 0;
  ScaledContacts some;  ///< of the base at hand
  Balance balance;
};

namespace {

using Contents = StabilityMemory::Contents;

/** Puts a remembered base on the contacts of a query. */
class BaseMover {
 public:
  BaseMover(const StabilityQuery& query, KeptBase* base, Contents* x)
      : query_(query), base_(*base), x_(*x) {}

  /** Whether the base provably carries the robot; the balance is left in the contents. */
  bool Carries() {
    if (!FindPoints() || !SeemsToCarry()) return false;
    if (!ScaleSome(query_, {which_, static_cast<std::size_t>(count_)}, base_.length, &x_.some)) {
      return false;
    }
    const bool changed = MakeColumns();
    MoveInverse();
    if (changed) RefineInverse();
    SetWeights();
    if (!ProveInterior(x_.some, &x_.balance)) return false;
    Keep();
    return true;
  }

 private:
  bool FindPoints() {
    Vector3d before = Vector3d::Zero(), now = Vector3d::Zero();
    for (int k = 0; k < 6; ++k) {
      const int i = FindContact(base_.force[k], query_.contacts);
      if (i < 0) return false;
      slot_[k] = static_cast<int>(std::find(which_, which_ + count_, i) - which_);
      if (slot_[k] == count_) which_[count_++] = i;
      point_[k] = query_.contacts[i].force_point_W();
      before += base_.force[k].point_W;
      now += point_[k];
    }
    shift_W_ = (query_.com_W - base_.com_W) - (now - before) / 6;
    shift_ = shift_W_ / base_.length;
    return true;
  }

  // The weights as they would be had all force points moved like their mean. With moments about a
  // centre of mass that is shifted by d against the contacts, (f, r x f) becomes (f, (r - d) x f):
  // weights of a wrench (f, m) are R_f f + R_m (m + d x f).
  bool SeemsToCarry() const {
    const Vector3d f = -query_.gravity_W;
    const Vector6d weight =
        base_.inverse.leftCols<3>() * f + base_.inverse.rightCols<3>() * Cross(shift_, f);
    return weight.minCoeff() > 0;
  }

  // Forces in the cones as they are now. @return whether anything but the centre of mass moved, by
  // more than a few roundings.
  bool MakeColumns() {
    constexpr double kRoundings = 1e-12;
    double moved = 0;
    for (int k = 0; k < 6; ++k) {
      const KeptForce& force = base_.force[k];
      Generator& column = x_.balance.base[k];
      column.contact = slot_[k];
      column.u = Direction(force, slot_[k]);
      const Vector3d r = x_.some.arm(slot_[k]);
      column.wrench << column.u, Cross(r, column.u);
      const Vector3d step = point_[k] - force.point_W - (query_.com_W - base_.com_W) + shift_W_;
      moved = std::max({moved, step.cwiseAbs().maxCoeff() / base_.length,
                        (column.u - force.u_W).cwiseAbs().maxCoeff()});
    }
    return !(moved < kRoundings);
  }

  Vector3d Direction(const KeptForce& force, int slot) const {
    const Vector3d n = x_.some.normal(slot);
    const double mu = x_.some.mu[slot];
    if (n == force.n_W && mu == force.mu) return force.u_W;
    if (mu == 0 || force.t_W.isZero(0)) return n;
    Vector3d t = force.t_W - force.t_W.dot(n) * n;
    t /= t.norm();
    return n + (mu / t.norm()) * (t - t.dot(n) * n);
  }

  void MoveInverse() {
    Matrix6d& R = x_.balance.base_inverse;
    R = base_.inverse;
    for (int k = 0; k < 6; ++k) {
      const Vector3d m = R.row(k).tail<3>();
      R.row(k).head<3>() += Cross(m, shift_);
    }
  }

  // Newton's step for an inverse: an error E = I - R B becomes E^2.
  void RefineInverse() {
    Matrix6d B;
    for (int k = 0; k < 6; ++k) B.col(k) = x_.balance.base[k].wrench;
    Matrix6d& R = x_.balance.base_inverse;
    const Matrix6d E = Matrix6d::Identity() - R.lazyProduct(B);
    R += E.lazyProduct(R).eval();
  }

  void SetWeights() {
    const Vector6d weight = x_.balance.base_inverse.leftCols<3>() * x_.some.v_f;
    std::copy(weight.data(), weight.data() + 6, x_.balance.weight);
    x_.balance.num_extra = 0;
  }

  void Keep() {
    base_.inverse = x_.balance.base_inverse;
    base_.com_W = query_.com_W;
    for (int k = 0; k < 6; ++k) {
      KeptForce& force = base_.force[k];
      force.place = which_[slot_[k]];
      force.point_W = point_[k];
      force.n_W = x_.some.normal(slot_[k]);
      force.mu = x_.some.mu[slot_[k]];
      force.u_W = x_.balance.base[k].u;
    }
  }

  const StabilityQuery& query_;
  KeptBase& base_;
  Contents& x_;
  int slot_[6];
  int which_[6], count_ = 0;
  Vector3d point_[6];
  Vector3d shift_W_ = Vector3d::Zero();  ///< of the centre of mass against the mean force point
  Vector3d shift_ = Vector3d::Zero();    ///< in units of the base's length
};

/** Six of the columns of a balance that carry the wrench alone [Caratheodory]: each extra one
 gives its weight to the base, or takes the place of the column of the base that this would make
 negative. */
void ReduceToBase(Balance* balance) {
  Matrix6d& R = balance->base_inverse;
  for (int j = 0; j < balance->num_extra; ++j) {
    const Vector6d alpha = R * balance->extra[j].wrench;
    double theta = balance->extra_weight[j];
    int leaving = -1;
    for (int k = 0; k < 6; ++k) {
      if (!(alpha[k] < 0) || !(balance->weight[k] < -theta * alpha[k])) continue;
      theta = balance->weight[k] / -alpha[k];
      leaving = k;
    }
    for (int k = 0; k < 6; ++k) balance->weight[k] += theta * alpha[k];
    if (leaving < 0) continue;
    const Eigen::Matrix<double, 1, 6> pivot_row = R.row(leaving) / alpha[leaving];
    for (int k = 0; k < 6; ++k) {
      if (k != leaving) R.row(k) -= alpha[k] * pivot_row;
    }
    R.row(leaving) = pivot_row;
    balance->base[leaving] = balance->extra[j];
    balance->weight[leaving] = balance->extra_weight[j] - theta;
  }
  balance->num_extra = 0;
}

void RememberBase(const StabilityQuery& query, const ScaledContacts& scaled, Balance balance,
                  KeptBase* base) {
  ReduceToBase(&balance);
  // Twice the length of the query: room for arms to grow. Moments are halved.
  base->length = 2 * scaled.length;
  base->inverse = balance.base_inverse;
  base->inverse.rightCols<3>() *= 2;
  base->com_W = query.com_W;
  for (int k = 0; k < 6; ++k) {
    const Generator& column = balance.base[k];
    KeptForce& force = base->force[k];
    const Contact& contact = query.contacts[scaled.index[column.contact]];
    force.place = scaled.index[column.contact];
    force.site = contact.site, force.body = contact.body, force.object = contact.object;
    force.point_W = contact.force_point_W();
    force.n_W = contact.n_W;
    force.mu = scaled.mu[column.contact];
    force.u_W = column.u;
    force.t_W = column.u - contact.n_W;
    const double length = force.t_W.norm();
    if (length > 0) force.t_W /= length;
  }
}

bool AnswerByBase(const StabilityQuery& query, Contents* x, StabilityAnswer* answer) {
  for (int i = 0; i < x->bases.size(); ++i) {
    if (!BaseMover(query, &x->bases[i], x).Carries()) continue;
    answer->verdict = Verdict::kHolds;
    ReportBalance(x->some, x->balance, &answer->forces);
    x->bases.Use(i);
    return true;
  }
  return false;
}

Vector3d MeanArm(const ScaledContacts& scaled) {
  Vector3d sum = Vector3d::Zero();
  for (int i = 0; i < scaled.count; ++i) sum += scaled.arm(i);
  return scaled.count == 0 ? sum : Vector3d(sum * (scaled.length / scaled.count));
}

// With moments about a point shifted by d, the field g(p) = y_f + y_m x (p - c) has y_f + y_m x d.
bool AnswerByCut(const ScaledContacts& scaled, Contents* x, StabilityAnswer* answer) {
  if (x->cuts.size() == 0) return false;
  const Vector3d arm = MeanArm(scaled);
  for (int i = 0; i < x->cuts.size(); ++i) {
    KeptCut& cut = x->cuts[i];
    Vector6d y = cut.y;
    y.head<3>() += Cross(Vector3d(y.tail<3>()), cut.arm - arm);
    if (!(y.head<3>().dot(scaled.v_f) > 0)) continue;
    Vector6d in_lengths = y;
    in_lengths.tail<3>() *= scaled.length;
    if (!ProveOutside(scaled, in_lengths)) continue;
    cut = {y, arm};
    answer->verdict = Verdict::kFails;
    answer->separator.y = y;
    x->cuts.Use(i);
    return true;
  }
  return false;
}

bool AnswerFromMemory(const StabilityQuery& query, Contents* x, StabilityWorkspace* workspace,
                      StabilityAnswer* answer) {
  if (!x->failed_last && AnswerByBase(query, x, answer)) return true;
  ScaledContacts& scaled = workspace->scratch->contacts;
  if (x->cuts.size() > 0 && ScaleContacts(query, &scaled) && AnswerByCut(scaled, x, answer)) {
    return true;
  }
  return x->failed_last && AnswerByBase(query, x, answer);
}

void Remember(const StabilityQuery& query, const StabilityWorkspace::Scratch& scratch,
              const StabilityAnswer& answer, Vector6d deep, Contents* x) {
  if (answer.verdict == Verdict::kHolds) {
    RememberBase(query, scratch.contacts, scratch.balance, &x->bases.Add());
  }
  if (answer.verdict == Verdict::kFails) {
    deep.tail<3>() /= scratch.contacts.length;
    x->cuts.Add() = {deep, MeanArm(scratch.contacts)};
  }
}

}  // namespace

StabilityMemory::StabilityMemory() : contents(std::make_unique<Contents>()) {}
StabilityMemory::~StabilityMemory() = default;
StabilityMemory::StabilityMemory(StabilityMemory&&) noexcept = default;
StabilityMemory& StabilityMemory::operator=(StabilityMemory&&) noexcept = default;

void StabilityMemory::Forget() {
  contents->bases.Clear();
  contents->cuts.Clear();
  contents->failed_last = false;
}

long StabilityMemory::asked() const { return contents->asked; }
long StabilityMemory::answered() const { return contents->answered; }

StabilityAnswer TryStability(const StabilityQuery& query, StabilityMemory* memory,
                             StabilityWorkspace* workspace) {
  RequireRoundToNearest();
  Contents& x = *memory->contents;
  ++x.asked;
  StabilityAnswer answer;
  if (AnswerFromMemory(query, &x, workspace, &answer)) {
    ++x.answered;
  } else {
    Vector6d deep;
    answer = AskSimplex(query, workspace, &deep);
    Remember(query, *workspace->scratch, answer, deep, &x);
  }
  if (answer.verdict != Verdict::kUndecided) x.failed_last = answer.verdict == Verdict::kFails;
  return answer;
}

}  // namespace cguide::numeric
