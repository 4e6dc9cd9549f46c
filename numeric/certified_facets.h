#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "cguide/exact/cone.h"
#include "cguide/exact/core/wrench.h"
#include "cguide/numeric/friction.h"

namespace cguide::numeric {

/** The facets of a cone of generators a_0 .. a_(n-1) in R^6, combinatorially exact: which
 generators lie on which facet, and what the cone spans. */
struct CertifiedDual {
  struct Facet {
    /** Outward normal h, unit, in the space of the generators: h.a_i = 0 on the facet, < 0 off it,
     up to rounding (relative 1e-6 in coordinates scaled to the generators): the doubles are an
     approximation of a proved facet, ExactFacets has the normal itself. */
    Vector6d normal;
    /** Independent generators on the facet: the first rank - 1 entries. They span it. */
    std::array<int, 5> basis;
  };

  int num_generators = 0;
  int rank = 0;                     ///< of the generators
  std::vector<Facet> facets;        ///< in no particular order
  std::vector<VectorXq> equations;  ///< 6 - rank, as in exact::FacetsOf

  /** Whether the generator lies on the facet, exactly. Zero generators lie on every facet. */
  bool Holds(std::size_t facet, int generator) const {
    return incidence[facet * words() + generator / 64] >> (generator % 64) & 1;
  }
  std::size_t words() const { return (static_cast<std::size_t>(num_generators) + 63) / 64; }
  std::vector<std::uint64_t> incidence;  ///< words() a facet, bit i % 64 of word i / 64

  /** How the sides of rays and planes were decided: counters of this run. */
  struct Counters {
    std::int64_t rays = 0;           ///< born in the run
    std::int64_t fixed_normals = 0;  ///< of them, computed in fixed point of 128 bits
    std::int64_t exact_normals = 0;  ///< of them, computed in integers
    std::int64_t sheared_signs = 0;  ///< in integers too, but half as long
    std::int64_t exact_sides = 0;    ///< sides that doubles left open
    bool reference = false;          ///< numbers too wide: the list is exact::FacetsOf's
  };
  Counters counters;
};

/** Storage that CertifiedFacets reuses from call to call; one a thread. */
class CertifiedDualWorkspace {
 public:
  CertifiedDualWorkspace();
  ~CertifiedDualWorkspace();
  CertifiedDualWorkspace(CertifiedDualWorkspace&&) noexcept;
  CertifiedDualWorkspace& operator=(CertifiedDualWorkspace&&) noexcept;

  struct Impl;
  Impl* impl() { return impl_.get(); }

 private:
  std::unique_ptr<Impl> impl_;
};

/** The facets of the cone of the exact wrenches (u, p x u), or of the given vectors (their doubles
 are exact): precisely the facets, equations and incidences that exact::FacetsOf finds, for any
 finite input.

 The double description method of DualDescription, with every decision of the run proved, so that
 the run is that of exact arithmetic. A decision is the sign of a 6 x 6 determinant of generators:
 the ray in the planes of five of them against a sixth. Doubles decide where the determinant exceeds
 its error bound; points and forces that generators share, fixed point of 128 bits beyond its bound
 and integers of fixed width decide the others, ties among them. Forces at one point are recognised
 as such where they are listed side by side; where two of the five share a point, a third of the
 arithmetic is enough. Coordinates so far apart that the integers do not fit (over 1500 bits) are
 left to exact::FacetsOf.
 @throws Error where a number is not finite or the rounding mode is not to nearest. */
CertifiedDual CertifiedFacets(std::span<const AppliedForce> generators);
CertifiedDual CertifiedFacets(std::span<const Vector6d> generators);
void CertifiedFacets(std::span<const AppliedForce> generators, CertifiedDualWorkspace* workspace,
                     CertifiedDual* result);
void CertifiedFacets(std::span<const Vector6d> generators, CertifiedDualWorkspace* workspace,
                     CertifiedDual* result);

/** Primitive integer normals of the facets of `dual`, which came from the same generators: equal to
 exact::FacetsOf of the exact cone, order included. */
exact::HalfspaceCone ExactFacets(std::span<const AppliedForce> generators,
                                 const CertifiedDual& dual);
exact::HalfspaceCone ExactFacets(std::span<const Vector6d> generators, const CertifiedDual& dual);

}  // namespace cguide::numeric
