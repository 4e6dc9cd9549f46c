#include "tests/benchmark/dual_section.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <vector>

#include "cguide/exact/linear_algebra.h"
#include "cguide/numeric/certified_facets.h"
#include "cguide/numeric/double_description.h"
#include "tests/benchmark/timing.h"
#include "tests/cases/wrench_sets.h"
#include "tests/peers/cdd_peer.h"
#include "tests/peers/ppl_peer.h"
#include "tests/peers/qhull_peer.h"

namespace cguide::benchmark_tools {
namespace {

using numeric::Vector6d;
using testing::Storage;
using testing::WrenchSet;

constexpr int kSets = 5;     // a cell
constexpr int kPplSets = 2;  // of them, for the slowest
constexpr int kRepeats = 5;  // ours: the median; peers are called once, Qhull kRepeats times

/** Times in microseconds, one a set; NaN (nothing) where a peer does not apply. */
struct Cell {
  std::vector<double> flt, certified, normals, cdd, qhull, ppl;
  std::vector<double> certified_ratio, cdd_ratio, qhull_ratio, ppl_ratio;
  std::vector<double> facets;
  int float_differs = 0, cdd_differs = 0, cdd_failed = 0, wrong = 0, checked = 0;
};

template <typename Work>
double MedianOf(const Work& work) {
  std::vector<double> t;
  for (int i = 0; i < kRepeats; ++i) t.push_back(MicrosecondsOf(1, work));
  return Median(t);
}

std::vector<mpz_class> IntegerRow(const AppliedForce& g) {
  const Vector3q u = Lift(g.u), m = exact::Cross(Lift(g.p), u);
  VectorXq row(6);
  row << u[0], u[1], u[2], m[0], m[1], m[2];
  row = exact::Primitive(row);
  std::vector<mpz_class> result;
  for (const Rational& x : row) result.push_back(x.get_num());
  return result;
}

bool SameFacets(const exact::HalfspaceCone& ours, const peers::PplFacets& theirs) {
  if (ours.equations.size() != theirs.equations.size()) return false;
  std::vector<std::vector<mpz_class>> a, b = theirs.facets;
  for (const VectorXq& h : ours.facets) {
    a.emplace_back();
    for (const Rational& x : h) a.back().push_back(x.get_num());
  }
  std::sort(b.begin(), b.end());
  // Modulo equations the representatives differ: then only the number is compared.
  return ours.equations.empty() ? a == b : a.size() == b.size();
}

void MeasureSet(const WrenchSet& set, bool with_ppl, Cell* cell) {
  std::vector<Vector6d> wrenches;
  std::vector<std::vector<mpz_class>> integers;
  for (const AppliedForce& g : set.generators) {
    wrenches.emplace_back();
    wrenches.back() << g.u, g.p.cross(g.u);
    if (with_ppl) integers.push_back(IntegerRow(g));
  }
  numeric::DualWorkspace workspace;
  numeric::CertifiedDualWorkspace certified_workspace;
  numeric::ConeFacets flt;
  numeric::CertifiedDual dual;
  exact::HalfspaceCone normals;
  cell->flt.push_back(MedianOf([&] { DualDescription(wrenches, {}, &workspace, &flt); }));
  cell->certified.push_back(
      MedianOf([&] { CertifiedFacets(set.generators, &certified_workspace, &dual); }));
  cell->normals.push_back(MedianOf([&] {
    CertifiedFacets(set.generators, &certified_workspace, &dual);
    normals = ExactFacets(set.generators, dual);
  }));
  cell->facets.push_back(static_cast<double>(dual.facets.size()));
  cell->float_differs += flt.facets.size() != dual.facets.size();
  const double base = cell->flt.back();
  cell->certified_ratio.push_back(cell->certified.back() / base);
  peers::FacetList cdd;
  const double cdd_time = MicrosecondsOf(1, [&] { cdd = peers::CddFacets(wrenches); });
  if (!cdd.failed) {  // "numerically inconsistent" comes early and is no time for a list
    cell->cdd.push_back(cdd_time);
    cell->cdd_ratio.push_back(cdd_time / base);
  }
  cell->cdd_failed += cdd.failed;
  cell->cdd_differs += cdd.failed || cdd.facets.size() != dual.facets.size();
  Vector6d w = Vector6d::Zero();
  for (const auto& facet : dual.facets) w -= facet.normal;
  std::vector<Vector6d> hull;
  bool applies = !dual.facets.empty();
  for (const Vector6d& a : wrenches) applies = applies && w.dot(a) > 1e-9;
  if (applies && peers::QhullFacets(wrenches, w, &hull)) {
    cell->qhull.push_back(MedianOf([&] { peers::QhullFacets(wrenches, w, &hull); }));
    cell->qhull_ratio.push_back(cell->qhull.back() / base);
  }
  if (!with_ppl) return;
  peers::PplFacets ppl;
  cell->ppl.push_back(MicrosecondsOf(1, [&] { ppl = peers::PplFacetsOf(integers, 6); }));
  cell->ppl_ratio.push_back(cell->ppl.back() / cell->normals.back());
  cell->wrong += !SameFacets(normals, ppl);
  ++cell->checked;
}

void PrintRatio(std::FILE* out, const char* name, const std::vector<double>& x) {
  if (x.empty()) return;
  double sum = 0;
  for (const double v : x) sum += v;
  std::fprintf(out, "  %-34s geometric mean %6.1f  mean %6.1f  least %6.2f  largest %6.1f\n", name,
               GeometricMean(x), sum / static_cast<double>(x.size()), Least(x), Quantile(x, 1));
}

}  // namespace

void ReportDual(std::FILE* out) {
  peers::RestoreRounding();
  std::fprintf(out,
               "Facets of wrench cones: medians of thread CPU time (us) over %d stances a cell.\n"
               "float/cdd differ: stances whose list has another length than the exact one.\n"
               "%-7s %5s %7s %6s | %7s %7s %7s | %9s %7s %10s | %s\n",
               kSets, "storage", "sides", "patches", "facets", "float", "certif.", "+normals",
               "cdd", "qhull", "ppl", "float differs, cdd differs (failed), wrong/checked");
  for (const Storage storage : {Storage::kSnapped, Storage::kRounded}) {
    const char* const name = storage == Storage::kSnapped ? "snapped" : "rounded";
    std::vector<double> certified, cdd, qhull, ppl;
    for (const int sides : {4, 8}) {
      for (const int patches : {1, 2, 3, 4, 8}) {
        numeric::Rng rng(1000 + 10 * patches + sides);
        Cell cell;
        for (int i = 0; i < kSets; ++i) {
          MeasureSet(RandomStanceSet(patches, sides, storage, rng), i < kPplSets, &cell);
        }
        std::fprintf(
            out, "%-7s %5d %7d %6.0f | %7.0f %7.0f %7.0f | %9.0f %7.0f %10.0f | %d %d(%d) %d/%d\n",
            name, sides, patches, Median(cell.facets), Median(cell.flt), Median(cell.certified),
            Median(cell.normals), Median(cell.cdd), Median(cell.qhull), Median(cell.ppl),
            cell.float_differs, cell.cdd_differs, cell.cdd_failed, cell.wrong, cell.checked);
        std::fflush(out);
        certified.push_back(Median(cell.certified_ratio));
        if (!cell.cdd_ratio.empty()) cdd.push_back(Median(cell.cdd_ratio));
        if (!cell.qhull_ratio.empty()) qhull.push_back(Median(cell.qhull_ratio));
        ppl.push_back(Median(cell.ppl_ratio));
      }
    }
    std::fprintf(out, "%s, ratios of the cells' medians of ratios:\n", name);
    PrintRatio(out, "certified / float", certified);
    PrintRatio(out, "cdd / float", cdd);
    PrintRatio(out, "qhull / float", qhull);
    PrintRatio(out, "ppl / (certified + exact normals)", ppl);
  }
}

}  // namespace cguide::benchmark_tools
