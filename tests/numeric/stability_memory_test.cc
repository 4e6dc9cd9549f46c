#include "cguide/numeric/stability_memory.h"

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

Eigen::Vector3d RandomVector(double size, Rng& rng) {
  return size * Eigen::Vector3d(Normal(rng), Normal(rng), Normal(rng));
}

/** A stance that moves: patches slide and tilt, the CoM moves, all by up to about `step` a turn. */
class Mover {
 public:
  Mover(Stance stance, double step, Rng& rng)
      : stance_(std::move(stance)), step_(step), rng_(rng) {}
  const Stance& stance() const { return stance_; }

  void Move() {
    stance_.com += RandomVector(step_, rng_);
    Eigen::Vector3d slide = Eigen::Vector3d::Zero(), turn = slide;
    for (std::size_t j = 0; j < stance_.contacts.size(); ++j) {
      Contact& c = stance_.contacts[j];
      if (j % 4 == 0) slide = RandomVector(step_ / 4, rng_), turn = RandomVector(step_ / 4, rng_);
      c.x_W += slide;
      c.n_W = (c.n_W + turn.cross(c.n_W)).normalized();
      c.y_W = c.x_W - c.distance * c.n_W;
    }
  }

 private:
  Stance stance_;
  double step_;
  Rng& rng_;
};

/** Asks with memory, and checks the proof and the plain call's verdict. */
Verdict AskAndCheck(const StabilityQuery& query, StabilityMemory* memory,
                    StabilityWorkspace* workspace) {
  const StabilityAnswer answer = TryStability(query, memory, workspace);
  REQUIRE(IsProved(query, answer));
  const Verdict plain = TryStability(query, workspace).verdict;
  if (plain != Verdict::kUndecided && answer.verdict != Verdict::kUndecided) {
    REQUIRE(answer.verdict == plain);
  }
  return answer.verdict;
}

TEST_CASE("verdicts from memory on stances that move are proved, and most come from there") {
  StabilityWorkspace workspace;
  Rng rng(307);
  for (const double step : {1e-6, 1e-3, 1e-2}) {
    StabilityMemory memory;
    int undecided = 0;
    for (int i = 0; i < 24; ++i) {
      Mover mover(RandomStance(1 + i % 4, rng), step, rng);
      for (int k = 0; k < 25; ++k, mover.Move()) {
        undecided +=
            AskAndCheck(mover.stance().Query(), &memory, &workspace) == Verdict::kUndecided;
      }
    }
    CHECK(undecided == 0);
    CHECK(memory.asked() == 600);
    const double share = double(memory.answered()) / double(memory.asked());
    CAPTURE(step, share);
    CHECK(share > (step < 5e-3 ? 0.8 : 0.6));
  }
}

TEST_CASE("centres of mass on a grid over one stance are answered from memory, with proofs") {
  StabilityWorkspace workspace;
  Rng rng(311);
  long holds = 0, fails = 0;
  for (int i = 0; i < 8; ++i) {
    Stance stance = RandomStance(1 + i % 4, rng);
    const Eigen::Vector3d centre = stance.centroid;
    StabilityMemory memory;
    for (int k = 0; k < 200; ++k) {
      stance.com =
          centre + Eigen::Vector3d(0.4 * (k % 20) / 20 - 0.2, 0.4 * (k / 20) / 10 - 0.2, 0.5);
      const Verdict verdict = AskAndCheck(stance.Query(), &memory, &workspace);
      holds += verdict == Verdict::kHolds;
      fails += verdict == Verdict::kFails;
    }
    CHECK(memory.answered() > 160);
  }
  CHECK(holds > 200);
  CHECK(fails > 200);
  CHECK(holds + fails >= 1599);
}

TEST_CASE("beside a tie memory proves no more than is true") {
  StabilityWorkspace workspace;
  StabilityMemory memory;
  Stance stance = testing::Foot();
  for (int round = 0; round < 2; ++round) {
    for (int digits = 2; digits <= 50; ++digits) {
      const double step = std::ldexp(1.0, -digits);
      for (const double x : {0.125 - step, 0.125 + step, 0.125}) {
        stance.com = {x, 0.03125, 0.75};
        const Verdict verdict = AskAndCheck(stance.Query(), &memory, &workspace);
        if (x == 0.125) CHECK(verdict == Verdict::kUndecided);
      }
    }
  }
  CHECK(memory.answered() > 60);
}

TEST_CASE("an answer is a function of the questions since the memory was new or forgot") {
  StabilityWorkspace workspace;
  Rng rng(313);
  std::vector<Stance> stances;
  Mover mover(RandomStance(3, rng), 3e-3, rng);
  for (int k = 0; k < 60; ++k, mover.Move()) stances.push_back(mover.stance());
  StabilityMemory fresh, used;
  for (int i = 0; i < 20; ++i) TryStability(RandomStance(2, rng).Query(), &used, &workspace);
  used.Forget();
  for (const Stance& stance : stances) {
    StabilityWorkspace other;
    const StabilityAnswer a = TryStability(stance.Query(), &fresh, &workspace);
    const StabilityAnswer b = TryStability(stance.Query(), &used, &other);
    REQUIRE(a.verdict == b.verdict);
    REQUIRE(a.pivots == b.pivots);
    REQUIRE(a.separator.y == b.separator.y);
    REQUIRE(a.forces.size == b.forces.size);
    for (int k = 0; k < a.forces.size; ++k) {
      REQUIRE(a.forces.force[k].weight == b.forces.force[k].weight);
    }
  }
}

TEST_CASE("memory leaves the plain call as it was") {
  Rng rng(317);
  StabilityWorkspace used;
  StabilityMemory memory;
  Mover mover(RandomStance(2, rng), 1e-2, rng);
  for (int k = 0; k < 100; ++k, mover.Move()) {
    const StabilityQuery query = mover.stance().Query();
    TryStability(query, &memory, &used);
    StabilityWorkspace fresh;
    const StabilityAnswer a = TryStability(query, &used), b = TryStability(query, &fresh);
    REQUIRE(a.verdict == b.verdict);
    REQUIRE(a.pivots == b.pivots);
    REQUIRE(a.separator.y == b.separator.y);
  }
}

// Whatever a planner, or somebody who takes one memory for two robots, may do to the next question.
void Disturb(int kind, Stance* stance, Rng& rng) {
  auto& contacts = stance->contacts;
  const auto any = [&] {
    return static_cast<std::size_t>(Between(rng, 0, 0.999) * double(contacts.size()));
  };
  switch (kind) {
    case 0:
      std::shuffle(contacts.begin(), contacts.end(), rng);
      break;
    case 1:
      if (!contacts.empty()) contacts.erase(contacts.begin() + static_cast<long>(any()));
      break;
    case 2:
      if (!contacts.empty()) contacts.insert(contacts.begin(), contacts[any()]);
      break;
    case 3:
      for (Contact& c : contacts) c.certain = Uniform(rng) < 0.7;
      break;
    case 4:
      for (Contact& c : contacts) c.friction *= Uniform(rng) < 0.3 ? 0 : Between(rng, 0.5, 1.2);
      break;
    case 5:
      if (!contacts.empty()) contacts[any()].n_W *= -1;
      break;
    case 6:
      for (Contact& c : contacts) c.x_W *= 1e6, c.y_W *= 1e6;
      stance->com *= 1e6;
      break;
    case 7:
      for (Contact& c : contacts)
        c.error = 1e-3 * Uniform(rng), c.normal_error = 1e-2 * Uniform(rng);
      break;
    case 8:
      if (!contacts.empty()) contacts[any()] = contacts[any()];
      break;
    case 9:
      contacts.clear();
      break;
    default:
      break;
  }
}

TEST_CASE("contacts that come, go, trade places, slip or lie leave no wrong verdict") {
  StabilityWorkspace workspace;
  StabilityMemory memory;
  Rng rng(331);
  long decided = 0;
  for (int i = 0; i < 60; ++i) {
    Stance stance = RandomStance(1 + i % 4, rng);
    for (std::size_t j = 0; j < stance.contacts.size(); ++j) {
      Contact& c = stance.contacts[j];
      if (i % 3 > 0) c.site = static_cast<int>(j) / i % 3, c.object = static_cast<int>(j) / 4;
    }
    Mover mover(stance, 1e-3, rng);
    for (int k = 0; k < 20; ++k, mover.Move()) {
      Stance changed = mover.stance();
      if (k % 2 == 1) Disturb(i % 11, &changed, rng);
      StabilityQuery query = changed.Query();
      if (k % 5 == 3) query.gravity_W += RandomVector(1, rng);
      query.com_error = k % 7 == 0 ? 1e-4 : 0;
      // Errors are for the next case: here the stored numbers are the real ones.
      decided += AskAndCheck(query, &memory, &workspace) != Verdict::kUndecided;
    }
  }
  CHECK(decided > 800);
  CHECK(memory.answered() > 300);
}

TEST_CASE("numbers that are not finite, in forces or in what they hang on, prove nothing") {
  StabilityWorkspace workspace;
  Rng rng(337);
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e308}) {
    for (int field = 0; field < 8; ++field) {
      Stance stance = RandomStance(2, rng);
      stance.com = {stance.centroid[0], stance.centroid[1], 0.6};
      StabilityMemory memory;
      TryStability(stance.Query(), &memory, &workspace);
      for (Contact& c : stance.contacts) {
        if (field == 0) c.x_W[0] = bad;
        if (field == 1) c.n_W[1] = bad;
        if (field == 2) c.error = bad;
        if (field == 3) c.normal_error = bad;
        if (field == 4) c.radius = bad;
      }
      StabilityQuery query = stance.Query();
      if (field == 5) query.com_W[2] = bad;
      if (field == 6) query.com_error = bad;
      if (field == 7) query.gravity_W[0] = bad;
      CAPTURE(bad, field);
      const Verdict plain = TryStability(query, &workspace).verdict;
      CHECK(TryStability(query, &memory, &workspace).verdict == plain);
      if (std::isinf(bad)) CHECK(plain == Verdict::kUndecided);
    }
  }
}

TEST_CASE("verdicts from memory hold for every configuration within the stated errors") {
  StabilityWorkspace workspace;
  Rng rng(347);
  int remembered = 0;
  for (int i = 0; i < 40; ++i) {
    const double error = i % 2 ? 1e-6 : 1e-3;
    Mover mover(RandomStance(1 + i % 4, rng), 1e-3, rng);
    StabilityMemory memory;
    for (int k = 0; k < 6; ++k, mover.Move()) {
      Stance stance = mover.stance();
      for (Contact& c : stance.contacts) c.error = error, c.normal_error = error;
      StabilityQuery query = stance.Query();
      query.com_error = error;
      const long before = memory.answered();
      const StabilityAnswer answer = TryStability(query, &memory, &workspace);
      if (answer.verdict == Verdict::kUndecided || memory.answered() == before) continue;
      ++remembered;
      for (int trial = 0; trial < 3; ++trial) {
        const auto offset = [&]() -> Eigen::Vector3d {
          return 0.999 * error * RandomVector(1, rng).normalized();
        };
        std::vector<RealContact> real;
        for (const Contact& c : stance.contacts) {
          Contact moved = c;
          moved.x_W += offset();
          moved.n_W = (c.n_W + 0.7 * offset()).normalized();
          real.push_back(AsStored(moved));
        }
        const Vector3q com = Lift(Eigen::Vector3d(query.com_W + offset()));
        REQUIRE((answer.verdict == Verdict::kHolds
                     ? testing::ProvesInterior(real, com, query, answer.forces)
                     : testing::ProvesOutside(real, com, query, answer.separator)));
      }
    }
  }
  CHECK(remembered > 100);
}

}  // namespace
}  // namespace cguide::numeric
