#include "tests/benchmark/wrong_section.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "cguide/exact/linear_algebra.h"
#include "cguide/numeric/cone_membership.h"
#include "tests/cases/wrench_sets.h"
#include "tests/peers/cdd_peer.h"
#include "tests/peers/cgal_qp_peer.h"
#include "tests/peers/glpk_peer.h"
#include "tests/peers/ppl_peer.h"
#include "tests/peers/qhull_peer.h"

namespace cguide::benchmark_tools {
namespace {

using exact::Membership;
using numeric::ConeWorkspace;
using numeric::Rng;
using numeric::WrenchCone;
using testing::Storage;
using testing::WrenchSet;
using Vector6d = WrenchCone::Vector6d;

Vector6d Rounded(const AppliedForce& a) {
  Vector6d wrench;
  wrench << a.u, a.p[1] * a.u[2] - a.p[2] * a.u[1], a.p[2] * a.u[0] - a.p[0] * a.u[2],
      a.p[0] * a.u[1] - a.p[1] * a.u[0];
  return wrench;
}

enum Engine { kGlpk, kGlpkFine, kCdd, kQhull, kCgalDouble, kCgal, kPpl, kFast, kOurs, kEngines };
constexpr const char* kNames[] = {"GLPK",         "GLPK 1e-12",      "cdd facets",
                                  "Qhull facets", "CGAL QP, double", "CGAL QP, Gmpzf",
                                  "PPL facets",   "ours, fast",      "ours"};

/** Wrong verdicts of one family; `unsafe` are those that call an outside wrench a member. */
struct Row {
  std::string name;
  long asked = 0, wrong[kEngines] = {}, unsafe[kEngines] = {}, failed[kEngines] = {};
};

/** The facets as their users read them: the closed cone, by the raw signs. */
bool InsideFacets(const peers::FacetList& list, const Vector6d& v) {
  for (const Vector6d& h : list.facets) {
    if (h.dot(v) > 0) return false;
  }
  for (const Vector6d& e : list.equations) {
    if (e.dot(v) != 0) return false;
  }
  return true;
}

/** The wrench times a power of two, its doubles exactly. */
std::vector<mpz_class> ToIntegers(const Vector6d& a) {
  VectorXq row(6);
  for (int k = 0; k < 6; ++k) row[k] = Lift(a[k]);
  row = exact::Primitive(row);
  std::vector<mpz_class> result;
  for (const Rational& x : row) result.push_back(x.get_num());
  return result;
}

int SignOfProduct(const std::vector<mpz_class>& h, const Vector6d& v) {
  Rational sum = 0;
  for (int k = 0; k < 6; ++k) sum += h[static_cast<std::size_t>(k)] * Lift(v[k]);
  return sgn(sum);
}

/** The exact facets, asked exactly. */
bool InsideFacets(const peers::PplFacets& list, const Vector6d& v) {
  for (const auto& h : list.facets) {
    if (SignOfProduct(h, v) > 0) return false;
  }
  for (const auto& e : list.equations) {
    if (SignOfProduct(e, v) != 0) return false;
  }
  return true;
}

/** Qhull wants a section of the cone: by w.x = 1 with w minus the sum of the exact facets' normals,
 the best one could give it. Cones with lines or without interior have none. */
peers::FacetList QhullFacetsOf(const std::vector<Vector6d>& generators,
                               const peers::PplFacets& exact) {
  Vector6d w = Vector6d::Zero();
  for (const auto& h : exact.facets) {
    Vector6d normal;
    long exponent;
    mpz_class largest = 0;
    for (const mpz_class& x : h) largest = std::max<mpz_class>(largest, abs(x));
    mpz_get_d_2exp(&exponent, largest.get_mpz_t());
    for (int k = 0; k < 6; ++k) {
      Rational x = h[static_cast<std::size_t>(k)];
      mpq_div_2exp(x.get_mpq_t(), x.get_mpq_t(), static_cast<mp_bitcnt_t>(exponent));
      normal[k] = NearestDouble(x);
    }
    w -= normal.normalized();
  }
  peers::FacetList list;
  list.failed = exact.facets.empty() || !exact.equations.empty();
  std::vector<Vector6d> rays;
  for (const Vector6d& a : generators) {
    if (!a.isZero(0)) rays.push_back(a);
  }
  for (const Vector6d& a : rays) list.failed |= !(w.dot(a) > 1e-9 * a.norm());
  if (!list.failed) list.failed = !peers::QhullFacets(rays, w, &list.facets);
  return list;
}

/** One generator list with everything that is prepared for it. */
struct Subject {
  std::vector<Vector6d> generators;
  WrenchCone cone;
  peers::FacetList cdd, qhull;
  peers::PplFacets ppl;

  explicit Subject(const WrenchSet& set) {
    std::vector<std::vector<mpz_class>> integers;
    for (const AppliedForce& a : set.generators) {
      generators.push_back(Rounded(a));
      integers.push_back(ToIntegers(generators.back()));
    }
    cone = WrenchCone::OfWrenches(generators);
    cdd = peers::CddFacets(generators);
    ppl = peers::PplFacetsOf(integers, 6);
    qhull = QhullFacetsOf(generators, ppl);
  }
};

class Judge {
 public:
  void Ask(const Subject& subject, const Vector6d& v, Row* row) {
    const numeric::ConeAnswer answer = ConeMembership(subject.cone, v, &workspace_);
    const bool proved =
        exact::CheckConeMembership(subject.cone.ExactColumns(), numeric::WrenchDemand(v).Exact(),
                                   ExactProof(subject.cone, v, answer));
    const bool member = answer.where != Membership::kOutside;
    ++row->asked;
    const auto note = [&](int engine, bool says, bool failed) {
      row->failed[engine] += failed;
      if (failed || says == member) return;
      ++row->wrong[engine];
      row->unsafe[engine] += says;
    };
    const auto& generators = subject.generators;
    note(kGlpk, peers::GlpkMember(generators, v), false);
    note(kGlpkFine, peers::GlpkMember(generators, v, {.tolerance = 1e-12}), false);
    note(kCdd, InsideFacets(subject.cdd, v), subject.cdd.failed);
    note(kQhull, InsideFacets(subject.qhull, v), subject.qhull.failed);
    const std::optional<bool> in_doubles = peers::CgalQpMemberInDoubles(generators, v);
    note(kCgalDouble, in_doubles.value_or(false), !in_doubles);
    note(kCgal, peers::CgalQpMember(generators, v), false);
    note(kPpl, InsideFacets(subject.ppl, v), false);
    const auto fast = TryConeMembership(subject.cone, v, &workspace_);
    note(kFast, fast && fast->where != Membership::kOutside, !fast);
    if (!proved) ++row->wrong[kOurs];
  }

  bool IsMember(const Subject& subject, const Vector6d& v) {
    return ConeMembership(subject.cone, v, &workspace_).where != Membership::kOutside;
  }

 private:
  ConeWorkspace workspace_;
};

void Print(std::FILE* out, const Row& row) {
  std::fprintf(out, "| %s | %ld |", row.name.c_str(), row.asked);
  for (int e = 0; e < kEngines; ++e) {
    std::fprintf(out, " %ld (%ld)", row.wrong[e], row.unsafe[e]);
    if (row.failed[e] > 0)
      std::fprintf(out, e == kFast ? ", %ld declined" : ", %ld failed", row.failed[e]);
    std::fprintf(out, " |");
  }
  std::fprintf(out, "\n");
}

Row OrdinaryStances(Judge* judge) {
  Row row{"ordinary stances"};
  Rng rng(501);
  for (int i = 0; i < 60; ++i) {
    const Storage storage = i % 2 ? Storage::kRounded : Storage::kSnapped;
    const WrenchSet set = testing::RandomStanceSet(1 + i % 4, i % 3 ? 4 : 8, storage, rng);
    const Subject subject(set);
    for (int k = 0; k < 30; ++k) {
      judge->Ask(subject, Rounded(testing::RandomDemand(set, storage, rng)), &row);
    }
  }
  return row;
}

/** Rows for 10^-3, 10^-6 ... m on either side of the boundary, and the boundary as computed. */
std::vector<Row> NearTies(Judge* judge) {
  std::vector<Row> rows;
  for (const int decade : {-3, -6, -8, -10, -12, -14, -15})
    rows.push_back({"1e" + std::to_string(decade) + " m from a tie"});
  rows.push_back({"a tie as computed"});
  Rng rng(502);
  for (int i = 0; i < 80; ++i) {
    const Storage storage = i % 2 ? Storage::kRounded : Storage::kSnapped;
    const WrenchSet set = testing::RandomStanceSet(1 + i % 3, 4, storage, rng);
    const Subject subject(set);
    const AppliedForce demand = testing::RandomDemand(set, storage, rng);
    const auto at = [&](double offset) { return Rounded(testing::Displaced(set, demand, offset)); };
    double in = -(demand.p - set.centroid).head<2>().norm(), out = 2;
    if (!judge->IsMember(subject, at(in)) || judge->IsMember(subject, at(out))) continue;
    for (int k = 0; k < 60; ++k) {
      const double middle = 0.5 * (in + out);
      (judge->IsMember(subject, at(middle)) ? in : out) = middle;
    }
    int row = 0;
    for (const double step : {1e-3, 1e-6, 1e-8, 1e-10, 1e-12, 1e-14, 1e-15}) {
      for (const double side : {-1.0, 1.0}) judge->Ask(subject, at(in + side * step), &rows[row]);
      ++row;
    }
    for (const double offset : {in, out}) judge->Ask(subject, at(offset), &rows[row]);
  }
  return rows;
}

std::vector<Row> ExactTies(Judge* judge) {
  std::vector<Row> rows;
  Rng rng(503);
  for (const testing::TieCase& tie : testing::TieCases(1000, rng)) {
    if (tie.set.generators.empty()) continue;
    Row* row = nullptr;
    for (Row& known : rows) {
      if (known.name == tie.name) row = &known;
    }
    if (!row) row = &rows.emplace_back(Row{tie.name});
    judge->Ask(Subject(tie.set), Rounded(tie.demand), row);
  }
  return rows;
}

}  // namespace

long ReportWrongMembership(std::FILE* out) {
  peers::RestoreRounding();
  std::fprintf(out,
               "\nWrong verdicts on membership in the closed cone, (of these: unsafe, a non-member "
               "called member)\n\n");
  std::fprintf(out, "| family | asked |");
  for (const char* name : kNames) std::fprintf(out, " %s |", name);
  std::fprintf(out, "\n|---|---|---|---|---|---|---|---|---|---|---|\n");
  std::fflush(out);  // a peer forks
  Judge judge;
  std::vector<Row> rows{OrdinaryStances(&judge)};
  for (const Row& row : NearTies(&judge)) rows.push_back(row);
  for (const Row& row : ExactTies(&judge)) rows.push_back(row);
  long wrong = 0;
  for (const Row& row : rows) {
    Print(out, row);
    std::fflush(out);
    wrong += row.wrong[kFast] + row.wrong[kOurs];
  }
  return wrong;
}

}  // namespace cguide::benchmark_tools
