#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace cguide::cli {

/** Exit codes (DESIGN part 4). */
enum ExitCode {
  kExitOk = 0,
  kExitRefuted = 1,
  kExitUsage = 2,
  kExitBadInput = 3,
  kExitUndecided = 4,
  kExitInternal = 70,
  kExitInterrupted = 130
};

/** What every command takes. */
struct CommonArguments {
  bool quiet = false;  ///< no talk on stderr but errors
  int threads = 0;     ///< 0: all that the machine has
};

/** How a path file is to be read. */
struct PathArguments {
  std::string format = "auto";  ///< auto, guide, csv, ompl, moveit
  std::string joint_order;      ///< names with commas; of a matrix, which has no header
  std::string root;             ///< x,y,z,qx,qy,qz,qw where the file has no root
};

inline constexpr double kEdgeStep = 0.005;

struct PlanArguments {
  CommonArguments common;
  std::string problem;
  std::string output;
  std::string planner = "rrt";  ///< rrt, prm, contacts
  std::string space = "guide";  ///< guide, free
  std::uint64_t seed = 1;
  double time_limit_s = 300;
  long iteration_limit = 10'000'000;
  std::string edges = "proved";     ///< proved, sampled
  std::string certificate;          ///< file that takes the proofs, or empty
  std::string robust;               ///< "mu=0.05,pose_mm=2,com_mm=5": of every model in the box
  std::optional<double> edge_step;  ///< of the samples; else kEdgeStep
  double extension = 0;             ///< 0: the planner's default
  std::string link = "straight";    ///< straight, flow
  std::optional<int> shortcut_rounds;
  int corner_cuts = 0;
  std::string stats;              ///< file for times and counters, or empty
  std::vector<std::string> hold;  ///< links that stay where they are
  std::string roadmap;  ///< of prm: file that is read, if it is there, and written; or empty
};

struct AuditArguments {
  CommonArguments common;
  std::string path;  ///< guide JSON, or a foreign path together with `problem`
  PathArguments reading;
  std::string problem;          ///< overrides the one the guide names
  double dense_step = 0;        ///< 0: none given
  std::string format = "text";  ///< text, json, junit, sarif
  std::string output;           ///< file, or empty for stdout
  std::string certificate;      ///< file that takes the proofs, or empty
  bool resume = false;          ///< take the proofs that `certificate` has
  std::string critical;         ///< "mu": ask how much friction the path needs
  std::string robust;           ///< "mu=0.05,pose_mm=2,com_mm=5": prove a box of models
  std::string list;             ///< file that names paths, instead of `path`
  std::string folder;           ///< with `list`: takes reports, certificates and manifest
  int shard = 1;                ///< with `list`: of `shards`
  int shards = 1;
};

struct MergeArguments {
  CommonArguments common;
  std::string folder;
  int expect = 1;               ///< how many shards
  std::string format = "text";  ///< text, json
};

struct StabilityArguments {
  CommonArguments common;
  std::string problem;
  std::string posture;  ///< "start", "goal" or a posture's name at the start's root pose
  std::string guide;
  double at = -1;    ///< edge index + s along the guide
  std::string coms;  ///< CSV file of centres of mass to ask instead of the configuration's own
  std::vector<double> acceleration;  ///< of the centre of mass (m/s^2, in W); empty or three
  std::string format = "text";
};

struct ModelArguments {
  CommonArguments common;
  std::string problem;
  std::string output;  ///< file, or empty for stdout
};

struct DoctorArguments {
  CommonArguments common;
  std::string problem;  ///< empty: the machine alone
};

struct ViewArguments {
  CommonArguments common;
  std::string guide;
  PathArguments reading;
  std::string problem;
  std::string output;
  std::string certificate;  ///< may be empty
  int frames = 0;           ///< 0: chosen from the guide's length
};

/** Each runs one command and returns its exit code; errors leave as cguide::Error. */
int RunPlan(const PlanArguments& arguments);
int RunAudit(const AuditArguments& arguments);
int RunAuditList(const AuditArguments& arguments);
int RunMerge(const MergeArguments& arguments);
int RunStability(const StabilityArguments& arguments);
int RunModel(const ModelArguments& arguments);
int RunDoctor(const DoctorArguments& arguments);
int RunView(const ViewArguments& arguments);

}  // namespace cguide::cli
