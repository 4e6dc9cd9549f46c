// Prints the cost of one stability verdict by TryStability and by peers on the same stances, and of
// the double description and the margins. One thread; medians of CPU time per query in
// microseconds.
#include <glpk.h>
#include <time.h>

#include <algorithm>
#include <cstdio>
#include <functional>
#include <vector>

#include "cguide/exact/cone_membership.h"
#include "cguide/numeric/double_description.h"
#include "cguide/numeric/friction.h"
#include "cguide/numeric/margins.h"
#include "tests/numeric/stability_cases.h"

namespace {

using cguide::Verdict;
using cguide::numeric::Pyramid;
using cguide::numeric::Rng;
using cguide::numeric::StabilityQuery;
using cguide::numeric::StabilityWorkspace;
using cguide::numeric::Vector6d;
using cguide::numeric::testing::RandomStance;
using cguide::numeric::testing::Stance;

double ThreadMicroseconds() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e6 * static_cast<double>(t.tv_sec) + 1e-3 * static_cast<double>(t.tv_nsec);
}

double Median(std::vector<double> x) {
  std::nth_element(x.begin(), x.begin() + x.size() / 2, x.end());
  return x[x.size() / 2];
}

// Median over `count` stances of the time of `work`, called `repeats` times on each.
double Time(const std::vector<Stance>& stances, std::size_t count, int repeats, int sides,
            const std::function<void(const StabilityQuery&)>& work) {
  std::vector<double> times;
  for (std::size_t i = 0; i < std::min(count, stances.size()); ++i) {
    StabilityQuery query = stances[i].Query();
    query.generators = sides;
    const double start = ThreadMicroseconds();
    for (int k = 0; k < repeats; ++k) work(query);
    times.push_back((ThreadMicroseconds() - start) / repeats);
  }
  return Median(times);
}

// Between two single shots everything that fits in the first two caches is pushed out.
void FlushCaches() {
  static std::vector<double> junk(1 << 19);
  for (std::size_t i = 0; i < junk.size(); i += 8) junk[i] += 1;
}

double TimeSingleShots(const std::vector<Stance>& stances) {
  StabilityWorkspace workspace;
  std::vector<double> times;
  timespec t0, t1;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t0);
  for (const Stance& stance : stances) {
    FlushCaches();
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t0);
    const auto answer = TryStability(stance.Query(), &workspace);
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t1);
    if (answer.pivots < 0) std::puts("");
    times.push_back(1e6 * double(t1.tv_sec - t0.tv_sec) + 1e-3 * double(t1.tv_nsec - t0.tv_nsec));
  }
  return Median(times);
}

// Phase-1 simplex of GLPK on the pyramids' wrenches, problem building included as a user has to.
bool SolveByGlpk(const StabilityQuery& query) {
  const std::vector<Vector6d> a = WrenchGenerators(query, Pyramid::kInscribed);
  const Vector6d v = RequiredWrench(query);
  glp_prob* lp = glp_create_prob();
  glp_add_rows(lp, 6);
  glp_add_cols(lp, static_cast<int>(a.size()));
  for (int i = 0; i < 6; ++i) glp_set_row_bnds(lp, i + 1, GLP_FX, v[i], v[i]);
  const int rows[7] = {0, 1, 2, 3, 4, 5, 6};
  for (int j = 0; j < static_cast<int>(a.size()); ++j) {
    double values[7] = {0, a[j][0], a[j][1], a[j][2], a[j][3], a[j][4], a[j][5]};
    glp_set_mat_col(lp, j + 1, 6, rows, values);
    glp_set_col_bnds(lp, j + 1, GLP_LO, 0, 0);
  }
  glp_smcp options;
  glp_init_smcp(&options);
  options.msg_lev = GLP_MSG_OFF;
  glp_simplex(lp, &options);
  const bool feasible = glp_get_status(lp) == GLP_OPT;
  glp_delete_prob(lp);
  return feasible;
}

void DecideByCgal(const StabilityQuery& query) {
  std::vector<cguide::VectorXq> generators;
  const auto lift = [](const Vector6d& a) {
    cguide::VectorXq lifted(6);
    for (int i = 0; i < 6; ++i) lifted[i] = cguide::Lift(a[i]);
    return lifted;
  };
  for (const Vector6d& a : WrenchGenerators(query, Pyramid::kInscribed))
    generators.push_back(lift(a));
  cguide::exact::DecideConeMembership(generators, lift(RequiredWrench(query)));
}

void Report(int patches) {
  Rng rng(5);
  std::vector<Stance> stances;
  for (int i = 0; i < 400; ++i) stances.push_back(RandomStance(patches, rng));
  StabilityWorkspace workspace;
  int undecided = 0, pivots = 0;
  for (const Stance& stance : stances) {
    const auto answer = TryStability(stance.Query(), &workspace);
    undecided += answer.verdict == Verdict::kUndecided;
    pivots += answer.pivots;
  }
  const double warm = Time(stances, 400, 20, 4,
                           [&](const StabilityQuery& query) { TryStability(query, &workspace); });
  const double margin = Time(stances, 200, 1, 4, [&](const StabilityQuery& query) {
    FindComMargin(query, {}, &workspace);
  });
  std::printf(
      "%2d patches: TryStability warm %.2f, single shot %.2f (%.1f pivots, %d of 400 undecided); "
      "com margin %.0f\n",
      patches, warm, TimeSingleShots(stances), pivots / 400.0, undecided, margin);
  for (const int sides : {4, 8}) {
    const double glpk =
        Time(stances, 200, 1, sides, [](const StabilityQuery& query) { SolveByGlpk(query); });
    const double cgal = Time(stances, 12, 1, sides, &DecideByCgal);
    const double dual = Time(stances, 15, 1, sides, [](const StabilityQuery& query) {
      cguide::numeric::DualDescription(WrenchGenerators(query, Pyramid::kInscribed));
    });
    std::printf(
        "   %d sides: GLPK %.0f (%.0fx), exact cone membership by CGAL's QP %.0f (%.0fx), "
        "double description %.0f\n",
        sides, glpk, glpk / warm, cgal, cgal / warm, dual);
  }
}

}  // namespace

int main() {
  for (const int patches : {1, 2, 3, 4, 8}) Report(patches);
}
