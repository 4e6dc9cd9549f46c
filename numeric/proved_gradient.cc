#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "cguide/exact/linear_algebra.h"
#include "cguide/numeric/proved_margins.h"
#include "cguide/numeric/region_proof_internal.h"

// Proposals alone: exact::CheckMarginGradient judges.
namespace cguide::numeric {
namespace {

using internal::BindingLine;
using internal::RegionProof;

// m. The boundary's bend over a step goes into the bounds, and the unknown part of com_m over the
// step, some 1e-12 m.
constexpr double kStep = 0x1p-19;
constexpr double kTolerance = 1e-12;
constexpr double kNegligible = 1e-6;
constexpr double kWide = 1e-3;  // m: no accident of rounding
constexpr double kShy = 1e-4;   // stays off the ends of an interval

/** The contacts where their forces act and with their normals, as stored and without error. */
std::vector<Contact> Stored(const StabilityQuery& query) {
  std::vector<Contact> contacts;
  for (const Contact& contact : query.contacts) {
    Contact& stored = contacts.emplace_back(contact);
    stored.x_W = contact.force_point_W();
    stored.radius = 0;
    stored.error = 0;
    stored.normal_error = 0;
  }
  return contacts;
}

double Largest(const exact::EnclosedVector& box) {
  double largest = 0;
  for (const exact::Enclosure& e : box) largest = std::max({largest, -e.lo, e.hi});
  return largest;
}

/** Scales y so that its line has a normal 1 long. */
bool Normalise(const Vector3q& w, Vector6q* y) {
  const Vector3q h = exact::Cross(w, y->tail(3));
  const double factor = 1 / std::sqrt(NearestDouble(exact::SquaredNorm(h)));
  if (!std::isfinite(factor) || !(factor > 0)) return false;
  for (Rational& x : *y) x *= Lift(factor);
  return true;
}

/** Proposes evidence for the gradient of one stance. */
class GradientProver {
 public:
  GradientProver(const StabilityQuery& query, const RegionOptions& options,
                 StabilityWorkspace* workspace)
      : query_(query), options_(options), workspace_(workspace) {}

  std::optional<ProvedMarginGradient> Prove();

 private:
  bool AddRegion();
  void AddMoved(int contact, const Eigen::Vector3d& step);
  void AddTurned(const exact::MovedSeparator& moved);
  std::optional<exact::MarginGradientBox> Check() const {
    return exact::CheckMarginGradient(result_.lifted.query, result_.evidence);
  }

  const StabilityQuery& query_;
  const RegionOptions& options_;
  StabilityWorkspace* const workspace_;
  ProvedMarginGradient result_;
  Vector3q w_;
  std::vector<double> moment_;  // what the twisted balances leave to y_m.w
  int pillar_ = -1;             // the contact with the largest force, as far as known
};

bool GradientProver::AddRegion() {
  RegionProof proof(query_, options_, workspace_);
  if (!proof.found()) return false;
  const ComMargin margin = ExploreMargin(options_.margins, &proof.explorer());
  if (!std::isfinite(margin.lo)) return false;
  proof.AddCornersForMargin(margin.lo);
  proof.AddBinding();
  const auto pole = proof.Pole();
  const std::vector<BindingLine> lines = BindingLines(proof.explorer());
  if (!pole || lines.empty()) return false;
  result_.evidence.pole = *pole;
  const BindingLine& line = lines.back();
  for (const double twist : {kStep, -kStep}) {
    auto balance = proof.Twisted(line, twist);
    if (!balance) return false;
    Eigen::Vector3d d;
    for (int k = 0; k < 3; ++k) d[k] = NearestDouble(balance->balance.displacement[k]);
    const double short_of = line.offset - d.dot(proof.explorer().InWorld(line.h));
    moment_.push_back(short_of / NearestDouble(balance->twist));
    result_.evidence.twisted.push_back(*std::move(balance));
  }
  result_.lifted = proof.lifted();
  result_.evidence.region = proof.evidence();
  w_ = exact::Scaled(-result_.lifted.query.mass, result_.lifted.query.gravity);
  return true;
}

/** The wrench of the line that binds once a contact is moved. */
void GradientProver::AddMoved(int contact, const Eigen::Vector3d& step) {
  std::vector<Contact> contacts(query_.contacts.begin(), query_.contacts.end());
  const int index = result_.lifted.contact[static_cast<std::size_t>(contact)];
  Eigen::Vector3d& point = contacts[static_cast<std::size_t>(index)].x_W;
  exact::MovedSeparator moved;
  moved.contact = contact;
  const Vector3q before = Lift(point);
  point += step;
  moved.shift = Lift(point) - before;
  StabilityQuery shifted = query_;
  shifted.contacts = contacts;
  RegionProof proof(shifted, options_, workspace_);
  if (!proof.found()) return;
  ExploreMargin(options_.margins, &proof.explorer());
  proof.AddBinding();
  if (proof.evidence().separators.empty()) return;
  moved.y = proof.evidence().separators.back();
  if (!Normalise(w_, &moved.y)) return;
  AddTurned(moved);
  result_.evidence.moved.push_back(std::move(moved));
}

/** Where one contact alone carries the robot, turning about the vertical through it costs nothing
 until others are driven: y_m.w is an interval, and wrenches near both ends are asked for. */
void GradientProver::AddTurned(const exact::MovedSeparator& moved) {
  if (std::abs(moment_[0] - moment_[1]) < kWide) return;
  exact::EquilibriumQuery shifted = result_.lifted.query;
  shifted.contacts[static_cast<std::size_t>(moved.contact)].p += moved.shift;
  const Vector3q arm = shifted.contacts[static_cast<std::size_t>(pillar_)].p - shifted.com;
  const double present = NearestDouble(exact::Dot(w_, moved.y.tail(3)));
  const double middle = (moment_[0] + moment_[1]) / 2;
  for (const double end : moment_) {
    const double wanted = middle + (end - middle) * (1 - kShy);
    const Rational turn = Lift(wanted - present) / exact::SquaredNorm(w_);
    const Vector3q turned_m = exact::Scaled(turn, w_);
    exact::MovedSeparator turned = moved;
    turned.y.tail(3) += turned_m;
    turned.y.head(3) -= exact::Cross(turned_m, arm);
    if (exact::ArePolar(shifted, {turned.y})) result_.evidence.moved.push_back(std::move(turned));
  }
}

std::optional<ProvedMarginGradient> GradientProver::Prove() {
  if (!AddRegion()) return std::nullopt;
  auto box = Check();
  if (!box) return std::nullopt;
  const auto less = [](const auto& a, const auto& b) { return Largest(a) < Largest(b); };
  pillar_ = static_cast<int>(std::max_element(box->contact.begin(), box->contact.end(), less) -
                             box->contact.begin());
  for (std::size_t k = 0; k < box->contact.size(); ++k) {
    if (Largest(box->contact[k]) < kNegligible) continue;
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(axis);
      AddMoved(static_cast<int>(k), step);
      AddMoved(static_cast<int>(k), -step);
    }
  }
  box = Check();
  if (!box) return std::nullopt;
  result_.com_m = box->com_m;
  result_.com_W = box->com;
  result_.contact_W.resize(query_.contacts.size());
  for (std::size_t k = 0; k < box->contact.size(); ++k) {
    result_.contact_W[static_cast<std::size_t>(result_.lifted.contact[k])] = box->contact[k];
  }
  return std::move(result_);
}

}  // namespace

std::optional<ProvedMarginGradient> ProveComMarginGradient(const StabilityQuery& query,
                                                           const MarginOptions& options,
                                                           StabilityWorkspace* workspace) {
  const std::vector<Contact> contacts = Stored(query);
  StabilityQuery stored = query;
  stored.contacts = contacts;
  stored.com_error = 0;
  RegionOptions fine;
  fine.margins = options;
  fine.margins.tolerance = std::min(options.tolerance, kTolerance);
  return GradientProver(stored, fine, workspace).Prove();
}

}  // namespace cguide::numeric
