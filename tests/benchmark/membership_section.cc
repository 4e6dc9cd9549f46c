#include "tests/benchmark/membership_section.h"

#include <cmath>
#include <vector>

#include "cguide/numeric/cone_membership.h"
#include "cguide/numeric/cone_simplex_internal.h"
#include "tests/benchmark/timing.h"
#include "tests/cases/wrench_sets.h"
#include "tests/peers/cgal_qp_peer.h"
#include "tests/peers/glpk_peer.h"

namespace cguide::benchmark_tools {
namespace {

using numeric::ConeAnswer;
using numeric::ConeStage;
using numeric::ConeWorkspace;
using numeric::Rng;
using numeric::WrenchCone;
using testing::Storage;
using testing::WrenchSet;
using Vector6d = WrenchCone::Vector6d;

constexpr int kSets = 40, kDemands = 12;

Vector6d RoundedWrench(const AppliedForce& a) {
  Vector6d wrench;
  wrench << a.u, a.p[1] * a.u[2] - a.p[2] * a.u[1], a.p[2] * a.u[0] - a.p[0] * a.u[2],
      a.p[0] * a.u[1] - a.p[1] * a.u[0];
  return wrench;
}

/** One stance with its questions, as forces and as the wrenches that peers take. */
struct Stance {
  WrenchSet set;
  std::vector<AppliedForce> demands;
  std::vector<Vector6d> wrenches, demanded;
};

std::vector<Stance> MakeStances(int patches, int sides, Storage storage) {
  Rng rng(static_cast<std::uint64_t>(1000 * patches + 10 * sides) +
          (storage == Storage::kSnapped ? 1 : 0));
  std::vector<Stance> stances(kSets);
  for (Stance& s : stances) {
    s.set = testing::RandomStanceSet(patches, sides, storage, rng);
    for (const AppliedForce& a : s.set.generators) s.wrenches.push_back(RoundedWrench(a));
    for (int k = 0; k < kDemands; ++k) {
      s.demands.push_back(testing::RandomDemand(s.set, storage, rng));
      s.demanded.push_back(RoundedWrench(s.demands.back()));
    }
  }
  return stances;
}

struct Cell {
  double ours, floats, batch, glpk, cgal;
};

struct Totals {
  std::vector<double> over_cgal, over_glpk, batch_over_cgal, overhead;
  long asked = 0, fast = 0, disagreed = 0;
};

/** The proposal alone: what a float solver would stop at. */
void FloatOnly(const Stance& s, int k, WrenchCone* cone, ConeWorkspace* workspace) {
  cone->AssignForces(s.set.generators);
  SolvePhaseOne(*cone, s.demands[k], workspace->scratch.get());
  Keep(workspace->scratch->proposal.feasible);
}

Cell MeasureStance(const Stance& s, WrenchCone* cone, ConeWorkspace* workspace, Totals* totals) {
  Cell cell{};
  const auto each = [&](const auto& question) {
    return MicrosecondsOf(1,
                          [&] {
                            for (int k = 0; k < kDemands; ++k) question(k);
                          }) /
           kDemands;
  };
  std::vector<double> ours, floats;
  for (int round = 0; round < 5; ++round) {
    ours.push_back(each([&](int k) {
      cone->AssignForces(s.set.generators);
      Keep(ConeMembership(*cone, s.demands[k], workspace).where);
    }));
    floats.push_back(each([&](int k) { FloatOnly(s, k, cone, workspace); }));
  }
  cell.ours = Median(ours);
  cell.floats = Median(floats);
  cell.glpk = each([&](int k) { Keep(peers::GlpkMember(s.wrenches, s.demanded[k])); });
  cell.cgal = each([&](int k) { Keep(peers::CgalQpMember(s.wrenches, s.demanded[k])); });
  // Along a path: a demand that moves by a millimetre at a time.
  numeric::ConeBatch batch(*cone);
  AppliedForce demand = s.demands[0];
  constexpr int kSteps = 400;
  cell.batch = MicrosecondsOf(kSteps, [&] {
    demand.p[0] += 0.001;
    Keep(batch.Membership(demand).where);
  });
  for (int k = 0; k < kDemands; ++k) {
    const ConeAnswer answer = ConeMembership(*cone, s.demands[k], workspace);
    ++totals->asked;
    totals->fast += answer.stage == ConeStage::kFast;
    // CGAL sees rounded moments, which differ from ours by 1e-16: no question here is so near.
    totals->disagreed += (answer.where != exact::Membership::kOutside) !=
                         peers::CgalQpMember(s.wrenches, s.demanded[k]);
  }
  return cell;
}

void ReportGrid(std::FILE* out, Storage storage, Totals* totals) {
  std::fprintf(out,
               "| patches x sides | ours us | float only | batch | GLPK | CGAL QP | over CGAL | "
               "over GLPK |\n");
  std::fprintf(out, "|---|---|---|---|---|---|---|---|\n");
  WrenchCone cone;
  ConeWorkspace workspace;
  for (const int sides : {4, 8}) {
    for (const int patches : {1, 2, 3, 4, 8}) {
      std::vector<double> ours, floats, batch, glpk, cgal;
      for (const Stance& s : MakeStances(patches, sides, storage)) {
        const Cell cell = MeasureStance(s, &cone, &workspace, totals);
        ours.push_back(cell.ours);
        floats.push_back(cell.floats);
        batch.push_back(cell.batch);
        glpk.push_back(cell.glpk);
        cgal.push_back(cell.cgal);
      }
      const double o = Median(ours);
      totals->over_cgal.push_back(Median(cgal) / o);
      totals->over_glpk.push_back(Median(glpk) / o);
      totals->batch_over_cgal.push_back(Median(cgal) / Median(batch));
      totals->overhead.push_back(o / Median(floats));
      std::fprintf(out, "| %d x %d | %.2f | %.2f | %.3f | %.1f | %.0f | %.0fx | %.0fx |\n", patches,
                   sides, o, Median(floats), Median(batch), Median(glpk), Median(cgal),
                   Median(cgal) / o, Median(glpk) / o);
      std::fflush(out);
    }
  }
}

/** Questions that doubles decline: exact ties, and computed boundary points and their neighbours.
 */
void ReportExactStage(std::FILE* out) {
  Rng rng(77);
  ConeWorkspace workspace;
  std::vector<double> times;
  long interior = 0, boundary = 0, outside = 0;
  const auto ask = [&](const WrenchCone& cone, const AppliedForce& demand) {
    const numeric::WrenchDemand v(demand);
    if (TryConeMembership(cone, v, &workspace)) return;
    ConeAnswer answer;
    times.push_back(MicrosecondsOf(1, [&] { answer = ConeMembership(cone, v, &workspace); }));
    ++(answer.where == exact::Membership::kInterior   ? interior
       : answer.where == exact::Membership::kBoundary ? boundary
                                                      : outside);
  };
  for (const testing::TieCase& tie : testing::TieCases(4000, rng)) {
    ask(WrenchCone::OfForces(tie.set.generators), tie.demand);
  }
  for (int i = 0; i < 400; ++i) {
    const Storage storage = i % 2 ? Storage::kRounded : Storage::kSnapped;
    const WrenchSet set = testing::RandomStanceSet(1 + i % 4, i % 3 ? 4 : 8, storage, rng);
    const WrenchCone cone = WrenchCone::OfForces(set.generators);
    const AppliedForce demand = testing::RandomDemand(set, storage, rng);
    double in = -(demand.p - set.centroid).head<2>().norm(), out_side = 2;
    const auto inside = [&](double offset) {
      return ConeMembership(cone, testing::Displaced(set, demand, offset), &workspace).where !=
             exact::Membership::kOutside;
    };
    if (!inside(in) || inside(out_side)) continue;
    for (int k = 0; k < 60; ++k) {
      const double middle = 0.5 * (in + out_side);
      (inside(middle) ? in : out_side) = middle;
    }
    for (const double offset : {0.0, 1e-16, -1e-16, 1e-15, -1e-15, 1e-14}) {
      ask(cone, testing::Displaced(set, demand, in + offset));
    }
  }
  std::fprintf(out,
               "exact stage on %zu ties and near ties (%ld interior, %ld boundary, %ld outside): "
               "median %.0f us, "
               "99th percentile %.0f us, 99.9th %.0f us, largest %.0f us\n",
               times.size(), interior, boundary, outside, Median(times), Quantile(times, 0.99),
               Quantile(times, 0.999), Quantile(times, 1));
}

}  // namespace

void ReportMembership(std::FILE* out) {
  std::fprintf(out, "## Membership in the cone of a generator list\n");
  Totals totals;
  for (const Storage storage : {Storage::kRounded, Storage::kSnapped}) {
    std::fprintf(out, "\n%s stances, median us per question\n\n",
                 storage == Storage::kRounded ? "Rounded" : "Snapped");
    ReportGrid(out, storage, &totals);
  }
  std::fprintf(out,
               "\nover CGAL QP: geometric mean %.0fx, least %.0fx; batches: geometric mean %.0fx, "
               "least %.0fx\n",
               GeometricMean(totals.over_cgal), Least(totals.over_cgal),
               GeometricMean(totals.batch_over_cgal), Least(totals.batch_over_cgal));
  std::fprintf(out, "over GLPK: geometric mean %.0fx, least %.0fx\n",
               GeometricMean(totals.over_glpk), Least(totals.over_glpk));
  std::fprintf(out, "certification costs %.0f %% over the float proposal (geometric mean)\n",
               100 * (GeometricMean(totals.overhead) - 1));
  std::fprintf(
      out, "decided without exact arithmetic: %ld of %ld (%.2f %%); disagreements with CGAL: %ld\n",
      totals.fast, totals.asked,
      100.0 * static_cast<double>(totals.fast) / static_cast<double>(totals.asked),
      totals.disagreed);
  ReportExactStage(out);
}

}  // namespace cguide::benchmark_tools
