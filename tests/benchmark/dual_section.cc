#include "tests/benchmark/dual_section.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <string>
#include <vector>

#include "cguide/exact/linear_algebra.h"
#include "cguide/numeric/certified_facets.h"
#include "cguide/numeric/double_description.h"
#include "tests/benchmark/timing.h"
#include "tests/cases/wrench_sets.h"
#include "tests/peers/cdd_gmp_peer.h"
#include "tests/peers/cdd_peer.h"
#include "tests/peers/ppl_peer.h"
#include "tests/peers/qhull_peer.h"

namespace cguide::benchmark_tools {
namespace {

using numeric::Vector6d;
using testing::Storage;
using testing::WrenchSet;

constexpr int kSets = 25;      // a cell
constexpr int kExactSets = 2;  // of them, for the slowest: PPL and cddlib in rationals
// cddlib in rationals takes seconds for more generators, and minutes for those of eight patches.
constexpr std::size_t kMostForCddGmp = 64;
// Ours: the median of so many calls, floats and certified in turn, so that a change of the
// machine's speed is both's; Qhull likewise, the other peers are called once.
constexpr int kRepeats = 11;

/** Times in microseconds, one a set; NaN (nothing) where a peer does not apply. */
struct Cell {
  std::vector<double> flt, certified, normals, cdd, qhull, ppl, cdd_gmp;
  std::vector<double> certified_ratio, cdd_ratio, qhull_ratio, ppl_ratio, cdd_gmp_ratio;
  std::vector<double> facets, float_facets, cdd_facets;
  std::vector<double> float_per_facet, certified_per_facet;  // of lists that are not empty
  // Only of stances where the other list has the same facets.
  std::vector<double> certified_ratio_right, cdd_ratio_right, cdd_certified_right;
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

template <typename Facets>
bool SameFacets(const exact::HalfspaceCone& ours, const Facets& theirs) {
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

/** Whether the lists have equally many facets, of which each is nearest to another one of the exact
 list and near it. */
bool AreSame(const std::vector<Vector6d>& list, const std::vector<Vector6d>& exact) {
  constexpr double kNear = 1e-6;  // far above what rounding moves a normal that is not ill-posed
  if (list.size() != exact.size()) return false;
  std::vector<bool> met(exact.size(), false);
  for (const Vector6d& h : list) {
    const Vector6d unit = h.normalized();
    const auto nearer = [&](const Vector6d& a, const Vector6d& b) {
      return (a - unit).squaredNorm() < (b - unit).squaredNorm();
    };
    const auto nearest = std::min_element(exact.begin(), exact.end(), nearer);
    const auto k = static_cast<std::size_t>(nearest - exact.begin());
    if (met[k] || !((*nearest - unit).norm() < kNear)) return false;
    met[k] = true;
  }
  return true;
}

std::vector<Vector6d> Rounded(const exact::HalfspaceCone& cone) {
  std::vector<Vector6d> normals;
  for (const VectorXq& h : cone.facets) {
    Rational largest = 0;
    for (const Rational& x : h) largest = std::max<Rational>(largest, abs(x));
    Vector6d normal;
    for (int k = 0; k < 6; ++k) normal[k] = NearestDouble(h[k] / largest);
    normals.push_back(normal.normalized());
  }
  return normals;
}

/** Lists of one stance. */
struct Lists {
  std::vector<Vector6d> wrenches;
  numeric::ConeFacets flt;
  numeric::CertifiedDual dual;
  exact::HalfspaceCone normals;
  std::vector<Vector6d> truth;  // normals, rounded
};

void MeasureOurs(const WrenchSet& set, Lists* lists, Cell* cell) {
  numeric::DualWorkspace workspace;
  numeric::CertifiedDualWorkspace certified_workspace;
  std::vector<double> flt, certified;
  for (int i = 0; i < kRepeats; ++i) {
    flt.push_back(
        MicrosecondsOf(1, [&] { DualDescription(lists->wrenches, {}, &workspace, &lists->flt); }));
    certified.push_back(MicrosecondsOf(
        1, [&] { CertifiedFacets(set.generators, &certified_workspace, &lists->dual); }));
  }
  cell->flt.push_back(Median(flt));
  cell->certified.push_back(Median(certified));
  cell->normals.push_back(MedianOf([&] {
    CertifiedFacets(set.generators, &certified_workspace, &lists->dual);
    lists->normals = ExactFacets(set.generators, lists->dual);
  }));
  lists->truth = Rounded(lists->normals);
  const auto of_float = static_cast<double>(lists->flt.facets.size()),
             of_exact = static_cast<double>(lists->dual.facets.size());
  const double base = cell->flt.back();
  cell->facets.push_back(of_exact);
  cell->float_facets.push_back(of_float);
  cell->certified_ratio.push_back(cell->certified.back() / base);
  if (AreSame(lists->flt.facets, lists->truth)) {
    cell->certified_ratio_right.push_back(cell->certified_ratio.back());
  } else {
    ++cell->float_differs;
  }
  if (of_float == 0 || of_exact == 0) return;
  cell->float_per_facet.push_back(base / of_float);
  cell->certified_per_facet.push_back(cell->certified.back() / of_exact);
}

void MeasureCdd(const Lists& lists, Cell* cell) {
  peers::FacetList cdd;
  const double time = MicrosecondsOf(1, [&] { cdd = peers::CddFacets(lists.wrenches); });
  const bool right = !cdd.failed && AreSame(cdd.facets, lists.truth);
  if (!cdd.failed) {  // "numerically inconsistent" comes early and is no time for a list
    cell->cdd.push_back(time);
    cell->cdd_ratio.push_back(time / cell->flt.back());
    cell->cdd_facets.push_back(static_cast<double>(cdd.facets.size()));
  }
  if (right) {
    cell->cdd_ratio_right.push_back(time / cell->flt.back());
    cell->cdd_certified_right.push_back(time / cell->certified.back());
  }
  cell->cdd_failed += cdd.failed;
  cell->cdd_differs += !right;
}

// Of the section of the cone by a plane, where that is bounded.
void MeasureQhull(const Lists& lists, Cell* cell) {
  Vector6d w = Vector6d::Zero();
  for (const auto& facet : lists.dual.facets) w -= facet.normal;
  std::vector<Vector6d> hull;
  bool applies = !lists.dual.facets.empty();
  for (const Vector6d& a : lists.wrenches) applies = applies && w.dot(a) > 1e-9;
  if (!applies || !peers::QhullFacets(lists.wrenches, w, &hull)) return;
  cell->qhull.push_back(MedianOf([&] { peers::QhullFacets(lists.wrenches, w, &hull); }));
  cell->qhull_ratio.push_back(cell->qhull.back() / cell->flt.back());
}

peers::CddGmpFunction CddGmp() {
  static const peers::CddGmpFunction function = peers::LoadCddGmp(CGUIDE_CDD_GMP_MODULE);
  return function;
}

// The exact peers.
void MeasureExact(const WrenchSet& set, const Lists& lists, Cell* cell) {
  std::vector<std::vector<mpz_class>> integers;
  for (const AppliedForce& g : set.generators) integers.push_back(IntegerRow(g));
  peers::PplFacets ppl;
  cell->ppl.push_back(MicrosecondsOf(1, [&] { ppl = peers::PplFacetsOf(integers, 6); }));
  cell->ppl_ratio.push_back(cell->ppl.back() / cell->normals.back());
  cell->wrong += !SameFacets(lists.normals, ppl);
  ++cell->checked;
  if (CddGmp() == nullptr || integers.size() > kMostForCddGmp) return;
  peers::CddGmpFacets cdd;
  const double time = MicrosecondsOf(1, [&] { cdd = CddGmp()(integers, 6); });
  if (cdd.failed) return;
  cell->cdd_gmp.push_back(time);
  cell->cdd_gmp_ratio.push_back(time / cell->normals.back());
  cell->wrong += !SameFacets(lists.normals, cdd);
  ++cell->checked;
}

void MeasureSet(const WrenchSet& set, bool with_exact, Cell* cell) {
  Lists lists;
  for (const AppliedForce& g : set.generators) {
    lists.wrenches.emplace_back();
    lists.wrenches.back() << g.u, g.p.cross(g.u);
  }
  MeasureOurs(set, &lists, cell);
  MeasureCdd(lists, cell);
  MeasureQhull(lists, cell);
  if (with_exact) MeasureExact(set, lists, cell);
}

void PrintRatio(std::FILE* out, const char* name, const std::vector<double>& x) {
  if (x.empty()) return;
  double sum = 0;
  for (const double v : x) sum += v;
  std::fprintf(out, "  %-34s geometric mean %6.1f  mean %6.1f  least %6.2f  largest %6.1f\n", name,
               GeometricMean(x), sum / static_cast<double>(x.size()), Least(x), Quantile(x, 1));
}

/** Over a storage's cells: their medians, and those of the restricted ratios where there are any.
 */
struct Totals {
  std::vector<double> certified, certified_per_facet, cdd, qhull, ppl, cdd_gmp;
  std::vector<double> certified_right, cdd_right, cdd_certified_right;
  int stances = 0, cdd_differs = 0, cdd_failed = 0, float_differs = 0;
};

void AddMedian(const std::vector<double>& x, std::vector<double>* medians) {
  if (!x.empty()) medians->push_back(Median(x));
}

void AddCell(const Cell& cell, Totals* totals) {
  AddMedian(cell.certified_ratio, &totals->certified);
  if (!cell.float_per_facet.empty()) {
    totals->certified_per_facet.push_back(Median(cell.certified_per_facet) /
                                          Median(cell.float_per_facet));
  }
  AddMedian(cell.cdd_ratio, &totals->cdd);
  AddMedian(cell.qhull_ratio, &totals->qhull);
  AddMedian(cell.ppl_ratio, &totals->ppl);
  AddMedian(cell.cdd_gmp_ratio, &totals->cdd_gmp);
  AddMedian(cell.certified_ratio_right, &totals->certified_right);
  AddMedian(cell.cdd_ratio_right, &totals->cdd_right);
  AddMedian(cell.cdd_certified_right, &totals->cdd_certified_right);
  totals->stances += static_cast<int>(cell.facets.size());
  totals->cdd_differs += cell.cdd_differs;
  totals->cdd_failed += cell.cdd_failed;
  totals->float_differs += cell.float_differs;
}

// A median in a column of eight, or a dash.
void PrintMedian(std::FILE* out, const std::vector<double>& x) {
  if (x.empty()) {
    std::fprintf(out, " %7s", "-");
  } else {
    std::fprintf(out, " %7.2f", Median(x));
  }
}

std::string MedianText(const std::vector<double>& x) {
  char text[32] = "-";
  if (!x.empty()) std::snprintf(text, sizeof text, "%.0f", Median(x));
  return text;
}

void PrintCell(std::FILE* out, const char* name, int sides, int patches, const Cell& cell) {
  std::fprintf(out,
               "%-7s %5d %7d %6.0f %6.0f %6.0f | %7.0f %7.0f %7.0f | %9.0f %7.0f %10.0f %10s | "
               "%d/%d %d/%d(%d) %d/%d |",
               name, sides, patches, Median(cell.facets), Median(cell.float_facets),
               Median(cell.cdd_facets), Median(cell.flt), Median(cell.certified),
               Median(cell.normals), Median(cell.cdd), Median(cell.qhull), Median(cell.ppl),
               MedianText(cell.cdd_gmp).c_str(), kSets - cell.float_differs, kSets,
               kSets - cell.cdd_differs, kSets, cell.cdd_failed, cell.wrong, cell.checked);
  PrintMedian(out, cell.certified_ratio);
  PrintMedian(out, cell.certified_ratio_right);
  PrintMedian(out, cell.float_per_facet);
  PrintMedian(out, cell.certified_per_facet);
  PrintMedian(out, cell.cdd_ratio);
  PrintMedian(out, cell.cdd_ratio_right);
  PrintMedian(out, cell.cdd_certified_right);
  std::fprintf(out, "\n");
  std::fflush(out);
}

void PrintTotals(std::FILE* out, const char* name, const Totals& totals) {
  std::fprintf(
      out,
      "%s, ratios of the cells' medians of ratios (of %d stances the float list differs on "
      "%d, cdd's on %d, %d of them errors):\n",
      name, totals.stances, totals.float_differs, totals.cdd_differs, totals.cdd_failed);
  PrintRatio(out, "certified / float", totals.certified);
  PrintRatio(out, "  only where float is right", totals.certified_right);
  PrintRatio(out, "  time a facet of either list", totals.certified_per_facet);
  PrintRatio(out, "cdd / float", totals.cdd);
  PrintRatio(out, "  only where cdd is right", totals.cdd_right);
  PrintRatio(out, "cdd / certified, where cdd is right", totals.cdd_certified_right);
  PrintRatio(out, "qhull / float", totals.qhull);
  PrintRatio(out, "ppl / (certified + exact normals)", totals.ppl);
  PrintRatio(out, "cdd gmp / (the same)", totals.cdd_gmp);
}

}  // namespace

void ReportDual(std::FILE* out, const std::string& only) {
  peers::RestoreRounding();
  std::fprintf(
      out,
      "Facets of wrench cones: medians of thread CPU time (us) over %d stances a cell.\n"
      "Right: lists of the exact cone's facets, as many and each normal within 1e-6, of all\n"
      "stances. Where a list is not right it is mostly much shorter (facets: of the exact cone, "
      "of\n"
      "the float list, of cdd's): its time buys fewer facets, and the times a facet compare like\n"
      "with like. A dash: no stance of the cell has such a list.\n"
      "cdd's times are of the calls that ended without an error, be the list right or not.\n"
      "%-7s %5s %7s %6s %6s %6s | %7s %7s %7s | %9s %7s %10s %10s | %s | %s\n",
      kSets, "storage", "sides", "patches", "facets", "float", "cdd", "float", "certif.",
      "+normals", "cdd", "qhull", "ppl", "cdd gmp",
      "float right, cdd right (failed), ours wrong/checked",
      "certified/float, where float is right, us a facet: float, certified, cdd/float, where cdd "
      "is right, cdd/certified there");
  for (const Storage storage : {Storage::kSnapped, Storage::kRounded}) {
    const char* const name = storage == Storage::kSnapped ? "snapped" : "rounded";
    Totals totals;
    for (const int sides : {4, 8}) {
      for (const int patches : {1, 2, 3, 4, 8}) {
        const std::string cell_name =
            std::string(name) + "-" + std::to_string(sides) + "-" + std::to_string(patches);
        if (!only.empty() && only != cell_name) continue;
        numeric::Rng rng(1000 + 10 * patches + sides);
        Cell cell;
        for (int i = 0; i < kSets; ++i) {
          MeasureSet(RandomStanceSet(patches, sides, storage, rng), i < kExactSets, &cell);
        }
        PrintCell(out, name, sides, patches, cell);
        AddCell(cell, &totals);
      }
    }
    if (totals.stances > 0) PrintTotals(out, name, totals);
  }
}

}  // namespace cguide::benchmark_tools
