#include "cguide/numeric/stability.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "tests/numeric/stability_cases.h"
#include "tests/numeric/stability_exact.h"

namespace cguide::numeric {
namespace {

using testing::AddPatch;
using testing::AsStored;
using testing::Between;
using testing::IsProved;
using testing::PointContact;
using testing::RandomStance;
using testing::RealContact;
using testing::Stance;

struct Counts {
  int holds = 0;
  int fails = 0;
  int undecided = 0;
  int total() const { return holds + fails + undecided; }
};

Verdict DecideAndCheck(const Stance& stance, StabilityWorkspace* workspace, Counts* counts) {
  const StabilityQuery query = stance.Query();
  const StabilityAnswer answer = TryStability(query, workspace);
  REQUIRE(IsProved(query, answer));
  if (answer.verdict == Verdict::kHolds) ++counts->holds;
  if (answer.verdict == Verdict::kFails) ++counts->fails;
  if (answer.verdict == Verdict::kUndecided) ++counts->undecided;
  return answer.verdict;
}

Stance Foot() {
  Stance stance;
  AddPatch({0, 0, 0}, {0, 0, 1}, 0, 0.5, 0.125, 0.0625, &stance);
  stance.com = {0, 0, 0.75};
  return stance;
}

TEST_CASE("every verdict on random stances is proved by its witness over the rationals") {
  StabilityWorkspace workspace;
  Rng rng(101);
  Counts counts;
  for (const int patches : {1, 2, 3, 4, 8}) {
    for (int i = 0; i < 300; ++i) DecideAndCheck(RandomStance(patches, rng), &workspace, &counts);
  }
  CHECK(counts.holds > 500);
  CHECK(counts.fails > 400);
  CHECK(counts.undecided <= 1);
}

// Where on the segment from a stable to an unstable CoM the verdict changes: the last point found
// to hold and the first found to fail.
std::pair<double, double> FindTie(Stance stance, const Eigen::Vector3d& inside,
                                  const Eigen::Vector3d& outside, StabilityWorkspace* workspace) {
  const auto bisect = [&](Verdict left) {
    double lo = 0, hi = 1;
    for (int i = 0; i < 60; ++i) {
      const double mid = 0.5 * (lo + hi);
      stance.com = inside + mid * (outside - inside);
      const Verdict verdict = TryStability(stance.Query(), workspace).verdict;
      const bool is_left =
          verdict == left || (left == Verdict::kUndecided && verdict != Verdict::kFails);
      (is_left ? lo : hi) = mid;
    }
    return std::pair(lo, hi);
  };
  return {bisect(Verdict::kHolds).first, bisect(Verdict::kUndecided).second};
}

TEST_CASE("near-ties on both sides never get a wrong verdict, and few are declined") {
  StabilityWorkspace workspace;
  Rng rng(103);
  Counts at[16];
  int stances = 0, pivots = 0;
  while (stances < 150) {
    Stance stance = RandomStance(1 + stances % 4, rng);
    const Eigen::Vector3d outside = stance.com;
    const Eigen::Vector3d inside(stance.centroid[0], stance.centroid[1], outside[2]);
    const Verdict far = TryStability(stance.Query(), &workspace).verdict;
    stance.com = inside;
    const Verdict near = TryStability(stance.Query(), &workspace).verdict;
    if (far != Verdict::kFails || near != Verdict::kHolds) continue;
    ++stances;
    const auto [last, first] = FindTie(stance, inside, outside, &workspace);
    REQUIRE(last <= first);
    const double length = (outside - inside).norm();
    for (int digits = 3; digits <= 15; ++digits) {
      for (const double side : {-1.0, 1.0}) {
        const double step = side * std::pow(10.0, -digits) / length;
        const double at_s = (side < 0 ? last : first) + step;
        stance.com = inside + at_s * (outside - inside);
        const Verdict verdict = DecideAndCheck(stance, &workspace, &at[digits]);
        // The stable CoMs of a segment are an interval; rounding of the CoM moves it by 1e-16.
        if (digits <= 14 && verdict != Verdict::kUndecided && at_s > 0 && at_s < 1) {
          CHECK((verdict == Verdict::kHolds) == (side < 0));
        }
        pivots = std::max(pivots, TryStability(stance.Query(), &workspace).pivots);
      }
    }
  }
  for (int digits = 3; digits <= 15; ++digits) {
    const double declined = double(at[digits].undecided) / at[digits].total();
    WARN("1e-" << digits << ": " << at[digits].holds << " hold, " << at[digits].fails << " fail, "
               << at[digits].undecided << " declined");
    if (digits <= 11) CHECK(declined <= 0.01);
  }
  WARN("most pivots: " << pivots);
}

TEST_CASE("a flat foot holds inside its rectangle, fails outside, and declines its edges") {
  StabilityWorkspace workspace;
  Counts counts;
  Stance stance = Foot();
  for (const double height : {0.0, 0.5, 0.75, -0.5}) {
    for (const double x : {0.0, 0.0625, 0.125 - 0x1p-40, 0.125, 0.125 + 0x1p-40, 0.25}) {
      for (const double y : {0.0, 0.0625 - 0x1p-40, 0.0625, 0.0625 + 0x1p-40}) {
        CAPTURE(height, x, y);
        stance.com = {x, -y, height};
        const Verdict verdict = DecideAndCheck(stance, &workspace, &counts);
        const bool in = x < 0.125 && y<0.0625, out = x> 0.125 || y > 0.0625;
        CHECK(verdict == (in ? Verdict::kHolds : out ? Verdict::kFails : Verdict::kUndecided));
      }
    }
  }
}

TEST_CASE("walls: pushing two of them apart holds above the friction that carries it") {
  StabilityWorkspace workspace;
  Counts counts;
  for (const double mu : {0.1, 0.5, 0.9}) {
    Stance stance;
    AddPatch({-0.5, 0, 0.25}, {1, 0, 0}, 0, mu, 0.0625, 0.125, &stance);
    AddPatch({0.5, 0, 0.25}, {-1, 0, 0}, 0, mu, 0.0625, 0.125, &stance);
    // Squeezing needs no bound on forces: any friction carries any weight, anywhere.
    for (const Eigen::Vector3d& com :
         {Eigen::Vector3d(0, 0, 0.25), Eigen::Vector3d(0.25, 0.0625, 1)}) {
      stance.com = com;
      CHECK(DecideAndCheck(stance, &workspace, &counts) == Verdict::kHolds);
    }
  }
  Stance leaning;  // one wall: nothing balances the push
  AddPatch({-0.5, 0, 0.25}, {1, 0, 0}, 0, 0.9, 0.0625, 0.125, &leaning);
  CHECK(DecideAndCheck(leaning, &workspace, &counts) == Verdict::kFails);
  // Floor and wall: a ladder holds if the floor carries it and slips if the floor is ice.
  for (const double mu : {0.0, 0.9}) {
    Stance ladder;
    AddPatch({0, 0, 0}, {0, 0, 1}, 0, mu, 0.015625, 0.125, &ladder);
    AddPatch({-1, 0, 1}, {1, 0, 0}, 0, 0.25, 0.015625, 0.125, &ladder);
    ladder.com = {-0.5, 0, 0.5};
    CHECK(DecideAndCheck(ladder, &workspace, &counts) ==
          (mu > 0 ? Verdict::kHolds : Verdict::kFails));
  }
}

TEST_CASE("no contacts fail") {
  StabilityWorkspace workspace;
  Stance stance;
  Counts counts;
  CHECK(DecideAndCheck(stance, &workspace, &counts) == Verdict::kFails);
}

TEST_CASE("a wrench cone of rank below six never holds, and fails where the wrench is outside") {
  StabilityWorkspace workspace;
  Counts counts;
  Rng rng(107);
  for (int i = 0; i < 400; ++i) {
    Stance stance;
    const Eigen::Vector3d p(Normal(rng), Normal(rng), 0), q(Normal(rng), Normal(rng), 0);
    const int points = 1 + i % 3;
    stance.contacts.push_back(PointContact(p, {0, 0, 1}, 0.5));
    if (points > 1) stance.contacts.push_back(PointContact(q, {0, 0, 1}, 0.5));
    if (points > 2) stance.contacts.push_back(PointContact(0.5 * (p + q), {0, 0, 1}, 0.5));
    stance.com = points == 1 ? p : 0.5 * (p + q);
    stance.com[2] = 0.5;
    // Above the support: a tie, up to the rounding of the sums above, which may put it outside.
    CHECK(DecideAndCheck(stance, &workspace, &counts) != Verdict::kHolds);
    stance.com += Eigen::Vector3d(Normal(rng), Normal(rng), 0);
    CHECK(DecideAndCheck(stance, &workspace, &counts) == Verdict::kFails);
    stance.com = p + 2 * (p - q);  // on the line of the points, beyond them
    CHECK(DecideAndCheck(stance, &workspace, &counts) == Verdict::kFails);
  }
}

TEST_CASE("exact ties of rank-deficient sets are declined") {
  StabilityWorkspace workspace;
  Counts counts;
  Stance stance;
  stance.contacts = {PointContact({0.25, 0.5, 0}, {0, 0, 1}, 0.5)};
  stance.com = {0.25, 0.5, 1};
  CHECK(DecideAndCheck(stance, &workspace, &counts) == Verdict::kUndecided);
  stance.contacts.push_back(PointContact({0.75, 0.5, 0}, {0, 0, 1}, 0.5));
  stance.com = {0.5, 0.5, 1};
  CHECK(DecideAndCheck(stance, &workspace, &counts) == Verdict::kUndecided);
  // Two facing points squeeze anything, but cannot resist a turn about their line.
  stance.contacts = {PointContact({-0.5, 0, 0.5}, {1, 0, 0}, 0.5),
                     PointContact({0.5, 0, 0.5}, {-1, 0, 0}, 0.5)};
  stance.com = {0, 0, 0.5};
  CHECK(DecideAndCheck(stance, &workspace, &counts) == Verdict::kUndecided);
  stance.com = {0, 0.25, 0.5};
  CHECK(DecideAndCheck(stance, &workspace, &counts) != Verdict::kHolds);
}

TEST_CASE("frictionless contacts: a tray of them holds only where it is form closed") {
  StabilityWorkspace workspace;
  Counts counts;
  Stance stance;
  AddPatch({0, 0, 0}, {0, 0, 1}, 0, 0, 0.125, 0.0625, &stance);
  stance.com = {0, 0, 0.5};
  CHECK(DecideAndCheck(stance, &workspace, &counts) != Verdict::kHolds);  // rank 3
  // Fences on all four sides, two points each, complete the rank.
  for (const double y : {-0.03125, 0.046875}) {
    stance.contacts.push_back(PointContact({-0.25, y, 0.25}, {1, 0, 0}, 0));
    stance.contacts.push_back(PointContact({0.25, y, 0.25}, {-1, 0, 0}, 0));
    stance.contacts.push_back(PointContact({y, -0.25, 0.25}, {0, 1, 0}, 0));
    stance.contacts.push_back(PointContact({y, 0.25, 0.25}, {0, -1, 0}, 0));
  }
  CHECK(DecideAndCheck(stance, &workspace, &counts) == Verdict::kHolds);
  for (Contact& contact : stance.contacts) contact.error = 1e-9, contact.normal_error = 1e-8;
  CHECK(TryStability(stance.Query(), &workspace).verdict == Verdict::kHolds);
}

TEST_CASE("order, repetition, scale and strength of gravity change no verdict") {
  StabilityWorkspace workspace;
  Rng rng(109);
  int compared = 0;
  for (int i = 0; i < 300; ++i) {
    const Stance stance = RandomStance(1 + i % 4, rng);
    Counts counts;
    const Verdict verdict = DecideAndCheck(stance, &workspace, &counts);
    if (verdict == Verdict::kUndecided) continue;
    ++compared;
    Stance other = stance;
    std::reverse(other.contacts.begin(), other.contacts.end());
    std::swap(other.contacts.front(), other.contacts[1]);
    CHECK(DecideAndCheck(other, &workspace, &counts) == verdict);
    other.contacts.insert(other.contacts.end(), stance.contacts.begin(), stance.contacts.end());
    CHECK(DecideAndCheck(other, &workspace, &counts) == verdict);
    for (const double scale : {1e-6, 1e5}) {
      other = stance;
      other.com *= scale;
      for (Contact& c : other.contacts) c.x_W *= scale, c.y_W *= scale, c.distance *= scale;
      CHECK(DecideAndCheck(other, &workspace, &counts) == verdict);
    }
    StabilityQuery query = stance.Query();
    for (const double factor : {1e-200, 1e-3, 1e250}) {
      query.gravity_W = Eigen::Vector3d(0, 0, -9.81) * factor;
      query.mass = 1 / factor;
      const StabilityAnswer answer = TryStability(query, &workspace);
      CHECK(answer.verdict == verdict);
      CHECK(IsProved(query, answer));
    }
  }
  CHECK(compared > 295);
}

TEST_CASE("a change of frame changes no verdict") {
  StabilityWorkspace workspace;
  Rng rng(113);
  for (int i = 0; i < 300; ++i) {
    const Stance stance = RandomStance(1 + i % 4, rng);
    const Quaternion q = SampleVonMisesFisher({0, 0, 0, 1}, 0, rng);
    const Eigen::Matrix3d R = Eigen::Quaterniond(q.w, q.x, q.y, q.z).toRotationMatrix();
    const Eigen::Vector3d p(Normal(rng), Normal(rng), Normal(rng));
    Stance moved = stance;
    moved.com = R * stance.com + p;
    for (Contact& c : moved.contacts) {
      c.x_W = R * c.x_W + p;
      c.n_W = (R * c.n_W).normalized();
    }
    StabilityQuery query = moved.Query();
    query.gravity_W = R * query.gravity_W;
    const StabilityAnswer answer = TryStability(query, &workspace);
    CHECK(IsProved(query, answer));
    CHECK(answer.verdict == TryStability(stance.Query(), &workspace).verdict);
  }
}

// A rational vector within `radius` of the origin, on its sphere as often as not.
Vector3q RandomOffset(double radius, Rng& rng) {
  Eigen::Vector3d d(Normal(rng), Normal(rng), Normal(rng));
  d *= radius * (1 - 1e-12) / d.norm() * (Uniform(rng) < 0.5 ? 1 : Uniform(rng));
  return Lift(d);
}

Vector3q Plus(Vector3q a, const Vector3q& b) {
  for (int i = 0; i < 3; ++i) a[i] += b[i];
  return a;
}

TEST_CASE("verdicts hold for every configuration within the stated errors") {
  StabilityWorkspace workspace;
  Rng rng(127);
  Counts at_error[3];
  const double errors[3] = {1e-12, 1e-6, 1e-3};
  for (int i = 0; i < 600; ++i) {
    const double error = errors[i % 3];
    Stance stance = RandomStance(1 + i % 4, rng);
    for (Contact& c : stance.contacts) {
      c.error = error;
      c.normal_error = -1;  // to be derived from x and y
      c.radius = i % 2 ? 0.0625 : 0;
      c.distance = c.radius + 0.02;
      c.y_W = c.x_W - c.distance * c.n_W;
      c.error += 1e-15;  // of y, rounded here
    }
    StabilityQuery query = stance.Query();
    query.com_error = error;
    const StabilityAnswer answer = TryStability(query, &workspace);
    Counts& counts = at_error[i % 3];
    ++(answer.verdict == Verdict::kHolds   ? counts.holds
       : answer.verdict == Verdict::kFails ? counts.fails
                                           : counts.undecided);
    if (answer.verdict == Verdict::kUndecided) continue;
    for (int trial = 0; trial < 5; ++trial) {
      std::vector<RealContact> real;
      for (const Contact& c : stance.contacts) {
        const Vector3q x = Plus(Lift(c.x_W), RandomOffset(error, rng));
        const Vector3q y = Plus(Lift(c.y_W), RandomOffset(error, rng));
        RealContact contact{testing::Minus(x, y), x, Lift(c.friction)};
        // |w| to 50 digits is beyond every margin here.
        const mpf_class squared(testing::Dot(contact.w, contact.w), 256);
        const Rational norm(sqrt(squared));
        for (int j = 0; j < 3; ++j) contact.p[j] -= Lift(c.radius) * contact.w[j] / norm;
        real.push_back(contact);
      }
      const Vector3q com = Plus(Lift(query.com_W), RandomOffset(error, rng));
      if (answer.verdict == Verdict::kHolds) {
        REQUIRE(testing::ProvesInterior(real, com, query, answer.forces));
      } else {
        REQUIRE(testing::ProvesOutside(real, com, query, answer.separator));
      }
    }
  }
  CHECK(at_error[0].undecided == 0);
  CHECK(at_error[1].undecided <= 10);
  CHECK(at_error[2].undecided < 200);
  for (const Counts& counts : at_error) CHECK(counts.holds + counts.fails > 20);
}

TEST_CASE("contacts that only may be active carry nothing but forbid a refutation") {
  StabilityWorkspace workspace;
  Stance stance = Foot();
  StabilityAnswer answer = TryStability(stance.Query(), &workspace);
  CHECK(answer.verdict == Verdict::kHolds);
  for (Contact& c : stance.contacts) c.certain = false;
  CHECK(TryStability(stance.Query(), &workspace).verdict == Verdict::kUndecided);
  stance.com = {1, 0, 0.75};
  CHECK(TryStability(stance.Query(), &workspace).verdict == Verdict::kFails);
  // Certain foot, CoM beyond it, above a second one that may or may not touch.
  stance = Foot();
  AddPatch({1, 0, 0}, {0, 0, 1}, 0, 0.5, 0.125, 0.0625, &stance);
  for (int i = 4; i < 8; ++i) stance.contacts[i].certain = false;
  stance.com = {0.5, 0, 0.75};
  CHECK(TryStability(stance.Query(), &workspace).verdict == Verdict::kUndecided);
  stance.com = {0, 0, 0.75};
  answer = TryStability(stance.Query(), &workspace);
  REQUIRE(answer.verdict == Verdict::kHolds);
  for (const WitnessForce& force : answer.forces) CHECK(force.contact < 4);
  stance.com = {2, 0, 0.75};
  CHECK(TryStability(stance.Query(), &workspace).verdict == Verdict::kFails);
}

TEST_CASE("a contact whose normal is not known carries nothing and forbids a refutation") {
  StabilityWorkspace workspace;
  Stance stance = Foot();
  for (Contact& c : stance.contacts) c.distance = 1e-13, c.error = 1e-13, c.normal_error = -1;
  CHECK(std::isinf(NormalError(stance.contacts[0])));
  CHECK(TryStability(stance.Query(), &workspace).verdict == Verdict::kUndecided);
  stance.com = {1, 0, 0.75};
  CHECK(TryStability(stance.Query(), &workspace).verdict == Verdict::kUndecided);
  for (Contact& c : stance.contacts) c.normal_error = 1e-15;  // known from the face it touches
  CHECK(TryStability(stance.Query(), &workspace).verdict == Verdict::kFails);
}

TEST_CASE("the derived normal error bounds the change of direction") {
  Rng rng(131);
  double tightest = 0;
  for (int i = 0; i < 20'000; ++i) {
    Contact c;
    c.distance = std::pow(10, Between(rng, -6, 0));
    c.error = c.distance * std::pow(10, Between(rng, -6, -0.5));
    const Eigen::Vector3d w =
        Eigen::Vector3d(Normal(rng), Normal(rng), Normal(rng)).normalized() * c.distance;
    c.n_W = w / c.distance;
    const double bound = NormalError(c);
    Eigen::Vector3d offset(Normal(rng), Normal(rng), Normal(rng));
    offset -= Uniform(rng) * offset.dot(c.n_W) * c.n_W;
    offset *= 2 * c.error / offset.norm();
    const double moved = ((w + offset).normalized() - c.n_W).norm();
    REQUIRE(moved <= bound);
    tightest = std::max(tightest, moved / bound);
  }
  CHECK(tightest > 0.9);
}

TEST_CASE("numbers that are not numbers, no mass and no gravity are declined") {
  StabilityWorkspace workspace;
  const Stance stance = Foot();
  const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
  for (const double bad : {nan, infinity, -infinity}) {
    for (int field = 0; field < 6; ++field) {
      Stance broken = stance;
      if (field == 0) broken.contacts[2].x_W[1] = bad;
      if (field == 1) broken.contacts[2].n_W[1] = bad;
      if (field == 2) broken.contacts[2].friction = bad;
      if (field == 3) broken.com[0] = bad;
      if (field == 4) broken.contacts[2].radius = bad;
      if (field == 5) broken.contacts[2].error = bad;
      CAPTURE(bad, field);
      CHECK(TryStability(broken.Query(), &workspace).verdict == Verdict::kUndecided);
    }
  }
  StabilityQuery query = stance.Query();
  query.mass = 0;
  CHECK(TryStability(query, &workspace).verdict == Verdict::kUndecided);
  query.mass = 58;
  query.gravity_W.setZero();
  CHECK(TryStability(query, &workspace).verdict == Verdict::kUndecided);
}

TEST_CASE("the forces reported balance gravity") {
  StabilityWorkspace workspace;
  Rng rng(137);
  int balanced = 0;
  for (int i = 0; i < 300; ++i) {
    const Stance stance = RandomStance(2 + i % 4, rng);
    const StabilityAnswer answer = TryStability(stance.Query(), &workspace);
    if (answer.verdict != Verdict::kHolds) continue;
    ++balanced;
    Eigen::Vector3d force = 58 * Eigen::Vector3d(0, 0, -9.81), moment(0, 0, 0);
    double scale = 0;
    for (const WitnessForce& f : answer.forces) {
      const Contact& c = stance.contacts[f.contact];
      CHECK(f.u_W.dot(c.n_W) == Approx(1).epsilon(1e-12));
      force += f.weight * f.u_W;
      moment += f.weight * (c.force_point_W() - stance.com).cross(f.u_W);
      scale += f.weight;
    }
    CHECK(force.norm() <= 1e-12 * scale);
    CHECK(moment.norm() <= 1e-12 * scale);
  }
  CHECK(balanced > 100);
}

TEST_CASE("an answer depends on its query alone") {
  Rng rng(139);
  StabilityWorkspace used;
  for (int i = 0; i < 200; ++i) {
    const Stance stance = RandomStance(1 + i % 5, rng);
    StabilityWorkspace fresh;
    const StabilityAnswer a = TryStability(stance.Query(), &used);
    const StabilityAnswer b = TryStability(stance.Query(), &fresh);
    CHECK(a.verdict == b.verdict);
    CHECK(a.pivots == b.pivots);
    CHECK(a.separator.y == b.separator.y);
    REQUIRE(a.forces.size == b.forces.size);
    for (int k = 0; k < a.forces.size; ++k)
      CHECK(a.forces.force[k].weight == b.forces.force[k].weight);
  }
}

}  // namespace
}  // namespace cguide::numeric
