#include "cguide/planner/path_projection.h"

#include <cvode/cvode.h>
#include <cvode/cvode_proj.h>
#include <nvector/nvector_serial.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <algorithm>

#include "cguide/exact/core/error.h"
#include "cguide/planner/contact_flow_internal.h"

namespace cguide::planner {
namespace {

using Eigen::VectorXd;
using VectorMap = Eigen::Map<VectorXd>;
using numeric::World;

VectorMap MapOf(N_Vector v) { return {N_VGetArrayPointer(v), N_VGetLength(v)}; }

/** CVODE on a ContactFlow, one step at a time. Every flag is checked: a solver of the Adams kind
 would drop the projection without a word, one that is set up in the wrong order ignores options. */
class Integrator {
 public:
  Integrator(ContactFlow* flow, const PathProjectionOptions& options)
      : flow_(*flow), options_(options) {
    Check(SUNContext_Create(nullptr, &context_), "SUNContext_Create");
    y_ = N_VNew_Serial(flow_.size(), context_);
    solver_ = y_ ? SUNNonlinSol_FixedPoint(y_, 0, context_) : nullptr;
    memory_ = CVodeCreate(CV_BDF, context_);
    if (!y_ || !solver_ || !memory_) Fail("CVodeCreate", CV_MEM_NULL);
    N_VConst(0, y_);
    Check(CVodeInit(memory_, Rate, 0, y_), "CVodeInit");
    Check(CVodeSetErrHandlerFn(memory_, Silence, nullptr), "CVodeSetErrHandlerFn");
    Check(CVodeSetUserData(memory_, this), "CVodeSetUserData");
    Check(CVodeSStolerances(memory_, options.tolerance, options.tolerance), "CVodeSStolerances");
    Check(CVodeSetNonlinearSolver(memory_, solver_), "CVodeSetNonlinearSolver");
    Check(CVodeSetProjFn(memory_, Project), "CVodeSetProjFn");
    Check(CVodeSetProjErrEst(memory_, SUNFALSE), "CVodeSetProjErrEst");
    Check(CVodeSetMaxStep(memory_, options.longest), "CVodeSetMaxStep");
    Check(CVodeRootInit(memory_, options.watch_balance ? 2 : 1, Roots), "CVodeRootInit");
    Check(CVodeSetNoInactiveRootWarn(memory_), "CVodeSetNoInactiveRootWarn");
  }
  Integrator(const Integrator&) = delete;
  Integrator& operator=(const Integrator&) = delete;
  ~Integrator() {
    if (memory_) CVodeFree(&memory_);
    if (solver_) SUNNonlinSolFree(solver_);
    if (y_) N_VDestroy(y_);
    if (context_) SUNContext_Free(&context_);
  }

  void StartAt(const Configuration& q) {
    MapOf(y_) = flow_.StateOf(q);
    t_ = 0;
    Check(CVodeReInit(memory_, 0, y_), "CVodeReInit");
  }

  enum class Step { kTaken, kRoot, kFailed };
  Step Advance() {
    const int flag = CVode(memory_, 1e3, y_, &t_, CV_ONE_STEP);
    if (flag == CV_ROOT_RETURN) return Step::kRoot;
    return flag >= 0 ? Step::kTaken : Step::kFailed;
  }

  /** The state reached; projected, as CVODE leaves states at roots unprojected. */
  VectorXd State() { return MapOf(y_) + flow_.Correction(MapOf(y_)); }

  long evaluations = 0;
  long corrections = 0;

 private:
  [[noreturn]] static void Fail(const char* what, int flag) {
    throw Error(Error::Code::kInternal,
                std::string("CVODE: ") + what + " returned " + std::to_string(flag));
  }
  static void Check(int flag, const char* what) {
    if (flag != CV_SUCCESS) Fail(what, flag);
  }
  static void Silence(int, const char*, const char*, char*, void*) {}

  static int Rate(realtype, N_Vector y, N_Vector rate, void* self) {
    Integrator& i = *static_cast<Integrator*>(self);
    VectorXd v;
    i.flow_.Velocity(MapOf(y), &v);
    MapOf(rate) = v;
    ++i.evaluations;
    return v.allFinite() ? 0 : 1;
  }
  static int Project(realtype, N_Vector y, N_Vector correction, realtype, N_Vector, void* self) {
    Integrator& i = *static_cast<Integrator*>(self);
    MapOf(correction) = i.flow_.Correction(MapOf(y));
    ++i.corrections;
    return MapOf(correction).allFinite() ? 0 : 1;
  }
  static int Roots(realtype, N_Vector y, realtype* g, void* self) {
    Integrator& i = *static_cast<Integrator*>(self);
    double clearance = 0, balance = 0;
    i.flow_.Events(i.flow_.ConfigurationOf(MapOf(y)), i.options_.watch_balance, &clearance,
                   &balance);
    g[0] = clearance;
    if (i.options_.watch_balance) g[1] = balance;
    return 0;
  }

  ContactFlow& flow_;
  const PathProjectionOptions& options_;
  SUNContext context_ = nullptr;
  N_Vector y_ = nullptr;
  SUNNonlinearSolver solver_ = nullptr;
  void* memory_ = nullptr;
  realtype t_ = 0;
};

class Follower {
 public:
  Follower(const World& world, const Configuration& target, const EdgeOracle& oracle,
           const PathProjectionOptions& options, ProjectionWorkspace* workspace)
      : world_(world),
        target_(target),
        oracle_(oracle),
        options_(options),
        workspace_(*workspace),
        flow_(world, target, workspace),
        integrator_(&flow_, options) {}

  ProjectedPath Run(const Configuration& from);

 private:
  bool Holds(const Configuration& from, const Configuration& to) {
    if (numeric::TestConfiguration(world_, to, numeric::Space::kGuide, &workspace_.guide).verdict !=
        Verdict::kHolds) {
      return false;
    }
    ++path_.chords;
    return oracle_({from, to}) == Verdict::kHolds;
  }
  PathStop Flow(const Configuration& from);
  bool TakeFarthest(const Configuration& from);

  const World& world_;
  const Configuration& target_;
  const EdgeOracle& oracle_;
  const PathProjectionOptions& options_;
  ProjectionWorkspace& workspace_;
  ContactFlow flow_;
  Integrator integrator_;
  std::vector<Configuration> passed_;  ///< by the flow since the last node
  ProjectedPath path_;
};

// Lets the flow run for the length of a chord; says why it ended sooner, kMaxNodes where it did
// not.
PathStop Follower::Flow(const Configuration& from) {
  constexpr int kMostSteps = 200;
  passed_.clear();
  integrator_.StartAt(from);
  VectorXd rate;
  for (int i = 0; i < kMostSteps; ++i) {
    const Integrator::Step step = integrator_.Advance();
    ++path_.steps;
    if (step == Integrator::Step::kFailed) return PathStop::kIntegrator;
    const VectorXd y = integrator_.State();
    if (flow_.Velocity(y, &rate) < options_.min_speed) return PathStop::kAtRest;
    passed_.push_back(flow_.ConfigurationOf(y));
    if (step == Integrator::Step::kRoot) return PathStop::kEvent;
    if (Distance(from, passed_.back()) >= options_.longest) break;
  }
  return PathStop::kMaxNodes;
}

// The farthest of the states passed whose chord holds, by halving their number.
bool Follower::TakeFarthest(const Configuration& from) {
  for (std::size_t count = passed_.size(); count > 0; count /= 2) {
    const Configuration& q = passed_[count - 1];
    if (Distance(from, q) < options_.shortest) break;
    if (!Holds(from, q)) continue;
    path_.nodes.push_back(q);
    return true;
  }
  return false;
}

ProjectedPath Follower::Run(const Configuration& from) {
  Configuration at = from;
  path_.stop = PathStop::kMaxNodes;
  while (static_cast<int>(path_.nodes.size()) < options_.max_nodes) {
    if (Distance(at, target_) <= options_.longest && Holds(at, target_)) {
      path_.nodes.push_back(target_);
      path_.stop = PathStop::kReached;
      break;
    }
    if (!flow_.AnchorAt(at)) {
      path_.stop = PathStop::kOutside;
      break;
    }
    const PathStop stop = Flow(at);
    if (!TakeFarthest(at)) {
      path_.stop = stop == PathStop::kMaxNodes ? PathStop::kNoChord : stop;
      break;
    }
    at = path_.nodes.back();
  }
  path_.evaluations = integrator_.evaluations;
  path_.corrections = integrator_.corrections;
  return std::move(path_);
}

}  // namespace

const char* ToString(PathStop stop) {
  switch (stop) {
    case PathStop::kReached:
      return "reached";
    case PathStop::kAtRest:
      return "at_rest";
    case PathStop::kEvent:
      return "event";
    case PathStop::kNoChord:
      return "no_chord";
    case PathStop::kMaxNodes:
      return "max_nodes";
    case PathStop::kIntegrator:
      return "integrator";
    case PathStop::kOutside:
      return "outside";
  }
  return "unknown";
}

ProjectedPath ProjectPath(const World& world, const Configuration& from,
                          const Configuration& target, const EdgeOracle& oracle,
                          const PathProjectionOptions& options, ProjectionWorkspace* workspace) {
  return Follower(world, target, oracle, options, workspace).Run(from);
}

}  // namespace cguide::planner
