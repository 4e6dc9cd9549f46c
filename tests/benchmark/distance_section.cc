#include "tests/benchmark/distance_section.h"

#include <cmath>
#include <random>

#include "cguide/exact/linear_algebra.h"
#include "cguide/numeric/convex_distance.h"
#include "tests/benchmark/timing.h"
#include "tests/cases/placed_convex.h"
#include "tests/peers/bullet_peer.h"
#include "tests/peers/cgal_peer.h"
#include "tests/peers/fcl_peer.h"

namespace cguide::benchmark_tools {
namespace {

using Eigen::Vector3d;
using Points = std::vector<Vector3d>;
using test::ConvexPair;

volatile double sink = 0;  // Keeps results alive.

std::vector<Vector3q> Lifted(const Points& points) {
  std::vector<Vector3q> result;
  for (const Vector3d& p : points) result.push_back(Lift(p));
  return result;
}

Rational SquaredTruth(const ConvexPair& pair) {
  return exact::SquaredConvexDistance(Lifted(pair.a), Lifted(pair.b)).squared;
}

// Random hulls on ellipsoids; `how`: 0 apart by 0.1 to 0.6 m, 1 near touch, 2 overlapping.
ConvexPair TimedPair(std::mt19937_64& rng, int vertices, int how) {
  using namespace test::cases;
  if (how == 0) return AtDistance(rng, vertices, vertices, Uniform(rng, 0.1, 0.6));
  if (how == 1) return AtDistance(rng, vertices, vertices, Tiny(rng, 12, 3));
  ConvexPair pair{Ellipsoid(rng, vertices, 0.3), Ellipsoid(rng, vertices, 0.3), {}};
  Move(&pair.b, 0.1 * Direction(rng));
  return pair;
}

long ExactRow(std::FILE* out, const char* name, const std::vector<ConvexPair>& pairs) {
  std::vector<double> ours, cgal, ratio;
  long wrong = 0, signs = 0, rounds = 0;
  for (const ConvexPair& pair : pairs) {
    const peers::CgalPoints a(pair.a), b(pair.b);
    Rational theirs;
    numeric::HullDistance distance;
    cgal.push_back(MicrosecondsOf(1, [&] { theirs = peers::CgalSquaredDistance(a, b); }));
    ours.push_back(MicrosecondsOf(20, [&] {
      distance = numeric::SquaredConvexDistance(std::span(pair.a), std::span(pair.b));
    }));
    ratio.push_back(cgal.back() / ours.back());
    wrong += distance.squared != theirs;
    signs += distance.exact_signs;
    rounds += distance.rounds;
  }
  const double n = static_cast<double>(pairs.size());
  std::fprintf(out, "%-24s %9.1f %9.2f %8.0fx   %6.2f %6.2f %6ld\n", name, Median(cgal),
               Median(ours), Median(ratio), static_cast<double>(signs) / n,
               static_cast<double>(rounds) / n, wrong);
  return wrong;
}

// Turned by a rational rotation that no double holds; CGAL over integers, as our reference calls
// it.
long RationalRow(std::FILE* out, const char* name, const std::vector<ConvexPair>& pairs) {
  std::vector<double> ours, cgal, ratio;
  long wrong = 0;
  const Matrix3q R = exact::RotationOf({0.3, -0.1, 0.7, 0.5});
  for (const ConvexPair& pair : pairs) {
    std::vector<Vector3q> a = Lifted(pair.a), b = Lifted(pair.b);
    for (auto* points : {&a, &b}) {
      for (Vector3q& p : *points) p = exact::Transformed(R, p);
    }
    numeric::HullDistance distance;
    Rational squared;
    cgal.push_back(
        MicrosecondsOf(1, [&] { squared = exact::SquaredConvexDistanceByQp(a, b).squared; }));
    ours.push_back(MicrosecondsOf(
        5, [&] { distance = numeric::SquaredConvexDistance(std::span(a), std::span(b)); }));
    ratio.push_back(cgal.back() / ours.back());
    wrong += distance.squared != squared;
  }
  std::fprintf(out, "%-24s %9.1f %9.2f %8.0fx   %6s %6s %6ld\n", name, Median(cgal), Median(ours),
               Median(ratio), "", "", wrong);
  return wrong;
}

long ReportExact(std::FILE* out, int count) {
  std::fprintf(out, "\nExact squared distance of convex hulls (us, medians; ratio of each pair)\n");
  std::fprintf(out, "%-24s %9s %9s %9s   %6s %6s %6s\n", "vertices, pairs", "CGAL", "ours", "ratio",
               "signs", "rounds", "differ");
  long wrong = 0;
  std::mt19937_64 rng(20261126);
  static constexpr const char* kHow[] = {"apart", "near touch", "overlapping"};
  for (int how = 0; how < 3; ++how) {
    for (const int vertices : {8, 20, 60, 200}) {
      std::vector<ConvexPair> pairs;
      for (int i = 0; i < count; ++i) pairs.push_back(TimedPair(rng, vertices, how));
      char name[40];
      std::snprintf(name, sizeof name, "%d %s", vertices, kHow[how]);
      wrong += ExactRow(out, name, pairs);
    }
  }
  for (const auto category : {test::PairCategory::kGridBoxes, test::PairCategory::kParallelFaces,
                              test::PairCategory::kTouching}) {
    std::vector<ConvexPair> pairs;
    for (int i = 0; i < count; ++i) pairs.push_back(MakeConvexPair(category, rng));
    wrong += ExactRow(out, NameOf(category), pairs);
  }
  for (const int vertices : {8, 20, 60}) {
    std::vector<ConvexPair> pairs;
    for (int i = 0; i < count / 2; ++i) pairs.push_back(TimedPair(rng, vertices, 0));
    wrong += RationalRow(out, (std::to_string(vertices) + " apart, over Q").c_str(), pairs);
  }
  return wrong;
}

// A pair in the form each solver wants.
struct EnclosurePair {
  explicit EnclosurePair(const ConvexPair& pair)
      : points{numeric::ConvexPoints(pair.a), numeric::ConvexPoints(pair.b)} {
    for (int side = 0; side < 2; ++side) {
      const Points& vertices = side == 0 ? pair.a : pair.b;
      if (pair.boxes) {
        const test::BoxCase& box = (*pair.boxes)[side];
        shape[side].SetBox(box);
        fcl[side] = peers::FclObject::Box(box.center, box.half);
        bullet[side] = peers::BulletShape::Box(box.center, box.half);
      } else {
        shape[side].SetHull(vertices);
        fcl[side] = peers::FclObject::Hull(vertices);
        bullet[side] = peers::BulletShape::Hull(vertices);
      }
    }
  }

  numeric::ConvexPoints points[2];
  test::PlacedConvex shape[2];
  peers::FclObject fcl[2];
  peers::BulletShape bullet[2];
};

long EnclosureRow(std::FILE* out, const char* name, const std::vector<ConvexPair>& pairs) {
  std::vector<double> times[5], ratios[4];
  double width = 0;
  long wrong = 0;
  for (const ConvexPair& pair : pairs) {
    const EnclosurePair e(pair);
    const Rational truth = SquaredTruth(pair);
    numeric::DirectedClearance placed;
    numeric::DistanceBounds bounds;
    constexpr int kRepeats = 50;
    const double us[5] = {
        MicrosecondsOf(
            kRepeats,
            [&] { placed = numeric::ConvexClearance(e.shape[0].set, e.shape[1].set, INFINITY); }),
        MicrosecondsOf(kRepeats,
                       [&] { bounds = numeric::BoundConvexDistance(e.points[0], e.points[1]); }),
        MicrosecondsOf(kRepeats, [&] { sink = peers::FclDistance(e.fcl[0], e.fcl[1], 1e-12); }),
        MicrosecondsOf(kRepeats, [&] { sink = peers::FclDistance(e.fcl[0], e.fcl[1], 1e-6); }),
        MicrosecondsOf(kRepeats, [&] { sink = peers::BulletDistance(e.bullet[0], e.bullet[1]); })};
    for (int k = 0; k < 5; ++k) times[k].push_back(us[k]);
    for (int k = 0; k < 4; ++k) ratios[k].push_back(us[k % 2] / us[2 + k / 2]);
    for (const auto& [lo, hi] :
         {std::pair{placed.lo, placed.hi}, std::pair{bounds.lo, bounds.hi}}) {
      wrong += Lift(lo) * Lift(lo) > truth || Lift(hi) * Lift(hi) < truth;
      width = std::max(width, hi - lo);
    }
  }
  std::fprintf(out, "%-14s %8.2f %8.2f %8.2f %8.2f %8.2f   %6.2f %6.2f %6.2f %6.2f   %8.1e %5ld\n",
               name, Median(times[0]), Median(times[1]), Median(times[2]), Median(times[3]),
               Median(times[4]), Median(ratios[0]), Median(ratios[1]), Median(ratios[2]),
               Median(ratios[3]), width, wrong);
  return wrong;
}

long ReportEnclosures(std::FILE* out, int count) {
  std::fprintf(out,
               "\nEnclosures of distances (us, medians), ratios to FCL 1e-12 and FCL 1e-6\n"
               "(placed: hull or box with pose and error, points: prepared sets of doubles)\n");
  std::fprintf(out, "%-14s %8s %8s %8s %8s %8s   %13s %13s   %8s %5s\n", "pairs", "placed",
               "points", "FCL e-12", "FCL e-6", "Bullet", "placed,points", "placed,points", "width",
               "wrong");
  std::mt19937_64 rng(77);
  long wrong = 0;
  for (const int vertices : {8, 20, 60, 200}) {
    std::vector<ConvexPair> pairs;
    for (int i = 0; i < count; ++i) pairs.push_back(TimedPair(rng, vertices, 0));
    wrong += EnclosureRow(out, std::to_string(vertices).c_str(), pairs);
  }
  std::vector<ConvexPair> boxes;
  while (static_cast<int>(boxes.size()) < count) {
    ConvexPair pair = MakeConvexPair(test::PairCategory::kGridBoxes, rng);
    if (SquaredTruth(pair) > 0) boxes.push_back(pair);
  }
  return wrong + EnclosureRow(out, "boxes", boxes);
}

long DecisionRow(std::FILE* out, test::PairCategory category, double threshold, int count) {
  std::mt19937_64 rng(static_cast<unsigned>(category) + 100);
  std::vector<double> ours, textbook;
  long wrong = 0, tried = 0;
  for (int i = 0; i < count; ++i) {
    const ConvexPair pair = MakeConvexPair(category, rng);
    const numeric::RoundedPoints a{pair.a, 0}, b{pair.b, 0};
    const exact::RoundedHull p{Lifted(pair.a), 0}, q{Lifted(pair.b), 0};
    Sign sign = Sign::kZero, truth = Sign::kZero;
    ours.push_back(MicrosecondsOf(20, [&] { sign = numeric::CompareDistance(a, b, threshold); }));
    textbook.push_back(
        MicrosecondsOf(1, [&] { truth = exact::CompareDistance(p, q, Lift(threshold)); }));
    tried += numeric::TryCompareDistance(a, b, threshold).has_value();
    wrong += sign != truth;
  }
  std::fprintf(out, "%-20s %6.2f %10.1f %8.2f %9.0f%% %6ld\n", NameOf(category), threshold,
               Median(textbook), Median(ours), 100.0 * static_cast<double>(tried) / count, wrong);
  return wrong;
}

long ReportDecisions(std::FILE* out, int count) {
  std::fprintf(out, "\nSign of d - t of sets of doubles (us, medians), decided in doubles alone\n");
  std::fprintf(out, "%-20s %6s %10s %8s %10s %6s\n", "pairs", "t", "textbook", "ours", "doubles",
               "differ");
  long wrong = 0;
  for (const auto category : {test::PairCategory::kRandom, test::PairCategory::kGridBoxes,
                              test::PairCategory::kNearTouch, test::PairCategory::kThreshold}) {
    for (const double threshold : {0.0, 0.01}) {
      wrong += DecisionRow(out, category, threshold, 3 * count);
    }
  }
  return wrong;
}

// What a solver got wrong, per category.
struct Faults {
  long far = 0;            // both see a gap, off by more than 1 mm
  long false_contact = 0;  // a collision where the sets are farther than 1e-9 apart
  long false_free = 0;     // more than 1e-9 where the sets meet
  long threshold = 0;      // the wrong side of 0.01 m, exactly
  long failed = 0;
  double error = 0;

  void Count(double answer, const Rational& squared) {
    const double truth = std::sqrt(NearestDouble(squared));
    if (std::isnan(answer)) {
      ++failed;
      return;
    }
    const double distance = std::max(answer, 0.0);
    far += answer > 0 && squared > 0 && std::abs(distance - truth) > 1e-3;
    false_contact += answer <= 0 && truth > 1e-9;
    false_free += answer > 1e-9 && squared == 0;
    const Rational at = Lift(0.01) * Lift(0.01);
    threshold += (Lift(distance) * Lift(distance) > at) != (squared > at);
    error = std::max(error, std::abs(distance - truth));
  }
};

void VerdictRow(std::FILE* out, const char* category, const char* name, const Faults& f) {
  std::fprintf(out, "%-20s %-10s %6ld %6ld %6ld %6ld %6ld   %8.1e\n", category, name, f.far,
               f.false_contact, f.false_free, f.threshold, f.failed, f.error);
}

long ReportVerdicts(std::FILE* out, int count) {
  std::fprintf(
      out,
      "\nWrong answers in %d pairs: off by more than 1 mm, false contact, false free, wrong\n"
      "side of 0.01 m, exception; largest error (m). Ours: bounds that exclude the truth or\n"
      "a wrong sign count as `far` and `side`, undecided signs of the fast stage as `failed`\n",
      count);
  std::fprintf(out, "%-20s %-10s %6s %6s %6s %6s %6s   %8s\n", "category", "solver", "far",
               "contact", "free", "side", "failed", "error");
  long wrong = 0;
  for (const auto category : test::kPairCategories) {
    std::mt19937_64 rng(static_cast<unsigned>(category) + 1);
    Faults loose, tight, bullet, ours;
    for (int i = 0; i < count; ++i) {
      const ConvexPair pair = MakeConvexPair(category, rng);
      const EnclosurePair e(pair);
      const Rational truth = SquaredTruth(pair);
      loose.Count(peers::FclDistance(e.fcl[0], e.fcl[1], 1e-6), truth);
      tight.Count(peers::FclDistance(e.fcl[0], e.fcl[1], 1e-12), truth);
      bullet.Count(peers::BulletDistance(e.bullet[0], e.bullet[1]), truth);
      const numeric::DistanceBounds bounds = numeric::BoundConvexDistance(e.points[0], e.points[1]);
      ours.far += Lift(bounds.lo) * Lift(bounds.lo) > truth;
      ours.far += Lift(bounds.hi) * Lift(bounds.hi) < truth;
      ours.error = std::max(ours.error, bounds.hi - bounds.lo);
      const numeric::RoundedPoints a{pair.a, 0}, b{pair.b, 0};
      const Sign sign = SignOf(Rational(truth - Lift(0.01) * Lift(0.01)));
      ours.threshold += numeric::CompareDistance(a, b, 0.01) != sign;
      ours.failed += !numeric::TryCompareDistance(a, b, 0.01);
      ours.threshold +=
          numeric::SquaredConvexDistance(std::span(pair.a), std::span(pair.b)).squared != truth;
    }
    VerdictRow(out, NameOf(category), "FCL 1e-6", loose);
    VerdictRow(out, "", "FCL 1e-12", tight);
    VerdictRow(out, "", "Bullet", bullet);
    VerdictRow(out, "", "ours", ours);
    wrong += ours.far + ours.threshold;
  }
  return wrong;
}

long CompareTwins(std::FILE* out, int count) {
  std::mt19937_64 rng(99);
  long wrong = 0, filtered = 0, settled = 0, refined = 0;
  for (int i = 0; i < count; ++i) {
    const ConvexPair pair = MakeConvexPair(test::kPairCategories[i % 9], rng);
    const auto distance = numeric::SquaredConvexDistance(std::span(pair.a), std::span(pair.b));
    const Rational truth = SquaredTruth(pair);
    wrong += distance.squared != truth;
    const numeric::DistanceBounds bounds = numeric::BoundConvexDistance(pair.a, pair.b);
    wrong += Lift(bounds.lo) * Lift(bounds.lo) > truth || Lift(bounds.hi) * Lift(bounds.hi) < truth;
    const numeric::RoundedPoints a{pair.a, 0}, b{pair.b, 0};
    const double near = std::sqrt(NearestDouble(truth));  // the hardest threshold
    const Sign sign = SignOf(Rational(truth - Lift(near) * Lift(near)));
    const auto tried = numeric::TryCompareDistance(a, b, near);
    wrong += (tried && *tried != sign) || numeric::CompareDistance(a, b, near) != sign;
    filtered += distance.rounds == 0 && distance.exact_signs == 0;
    settled += distance.rounds == 0 && distance.exact_signs > 0;
    refined += distance.rounds > 0;
  }
  std::fprintf(out,
               "\nTwins on %d adversarial pairs: wrong %ld; doubles alone %ld, integers for signs "
               "%ld, refined %ld\n",
               count, wrong, filtered, settled, refined);
  return wrong;
}

}  // namespace

long ReportDistances(std::FILE* out, const DistanceReportOptions& options) {
  long wrong = ReportExact(out, options.timing_pairs);
  wrong += ReportEnclosures(out, options.timing_pairs);
  wrong += ReportDecisions(out, options.timing_pairs);
  wrong += ReportTriangleDistances(out, options.timing_pairs);
  wrong += ReportVerdicts(out, options.verdict_pairs);
  if (options.twin_pairs > 0) wrong += CompareTwins(out, options.twin_pairs);
  return wrong;
}

}  // namespace cguide::benchmark_tools
