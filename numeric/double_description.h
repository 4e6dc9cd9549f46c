#pragma once

#include <memory>
#include <span>
#include <vector>

#include "cguide/numeric/friction.h"

namespace cguide::numeric {

/** { x : h.x <= 0 for every facet h, e.x = 0 for every equation e } in the space of wrenches. */
struct ConeFacets {
  std::vector<Vector6d> facets;     ///< unit outward normals, one a facet
  std::vector<Vector6d> equations;  ///< orthonormal; 6 - rank of them
};

struct DualOptions {
  /** A product h.a counts as zero below this, for unit h and a. */
  double tolerance = 1e-9;
};

/** Storage that DualDescription reuses from call to call; one a thread. */
class DualWorkspace {
 public:
  DualWorkspace();
  ~DualWorkspace();
  DualWorkspace(DualWorkspace&&) noexcept;
  DualWorkspace& operator=(DualWorkspace&&) noexcept;

  struct Impl;
  Impl* impl() { return impl_.get(); }

 private:
  std::unique_ptr<Impl> impl_;
};

/** The facets of the cone of the generators, by the double description method: the extreme rays of
 the polar cone { h : h.a <= 0 } are kept minimal while its half-spaces are added one by one, new
 rays arising between adjacent rays on either side [Motzkin, Raiffa, Thompson and Thrall 1953;
 minimal generators as in Padberg 1999, ch. 7]. The adjacency graph is kept, so that only rays on
 the new hyperplane are compared. It starts from the simplicial cone of a basis chosen by pivoting;
 the other half-spaces follow, the outermost generators first: those far from the mean of all in the
 metric of their second moments, so that linear maps of the generators hardly change the order.

 The whole space gives neither facets nor equations; a cone of rank k < 6 gives 6 - k equations.
 Zero and repeated generators are allowed. Floating point with a tolerance: the result carries NO
 proof, a facet may be missing or spurious where generators are nearly coplanar. exact::FacetsOf is
 the reference, CertifiedFacets the fast proof of the same list.
 @throws Error where a generator is not finite. */
ConeFacets DualDescription(std::span<const Vector6d> generators, const DualOptions& options = {});

/** The same into `result`, with storage reused. */
void DualDescription(std::span<const Vector6d> generators, const DualOptions& options,
                     DualWorkspace* workspace, ConeFacets* result);

/** The paper's verdict by dual facets, as a number: max over facets of h.v and over equations of
 |e.v|, in the units of v. Negative: inside, by that distance; -infinity for the whole space. Not a
 proof. */
double FacetExcess(const ConeFacets& cone, const Vector6d& v);

}  // namespace cguide::numeric
