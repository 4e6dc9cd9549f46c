#include "cguide/numeric/io/problem_reader.h"

#include <algorithm>
#include <cstdio>
#include <exception>
#include <set>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/io/file_internal.h"
#include "cguide/numeric/io/guide_io.h"
#include "cguide/numeric/io/problem_parts_internal.h"

namespace cguide::numeric::io {
namespace {

constexpr std::size_t kMaxProblemBytes = 4u << 20;
constexpr const char* kSchema = "cguide-problem/1";

void CheckSchema(const YamlView& problem) {
  const YamlView schema = problem.Get("schema");
  if (schema.Text() != kSchema) {
    schema.Fail(Quote(schema.Text()) + " is not a schema this program reads; it reads \"" +
                kSchema + "\"");
  }
}

RobotFiles ReadRobotFiles(const YamlView& view) {
  view.AllowKeys({"urdf", "srdf", "packages"});
  RobotFiles files;
  files.urdf = view.Get("urdf").File();
  if (const auto srdf = view.Find("srdf")) files.srdf = srdf->File();
  if (const auto packages = view.Find("packages")) {
    for (const auto& [name, folder] : packages->Entries()) files.packages[name] = folder.Folder();
  }
  return files;
}

// Pairs that must keep apart: both bear geometry, no other geometry-bearing body lies between them
// on fewer than two joints (NeighbourBodies), and the SRDF does not disable them.
std::vector<std::pair<int, int>> SelfPairs(const RobotDescription& description) {
  const Robot& robot = description.robot;
  std::set<std::pair<int, int>> excluded(description.disabled_bodies.begin(),
                                         description.disabled_bodies.end());
  for (const auto& pair : NeighbourBodies(robot)) excluded.insert(pair);
  std::vector<int> solid;
  for (int body = 0; body < static_cast<int>(robot.bodies.size()); ++body) {
    for (int link : robot.bodies[body].links) {
      if (robot.links[link].shapes.empty()) continue;
      solid.push_back(body);
      break;
    }
  }
  std::vector<std::pair<int, int>> pairs;
  for (std::size_t i = 0; i < solid.size(); ++i) {
    for (std::size_t j = i + 1; j < solid.size(); ++j) {
      const std::pair<int, int> pair(solid[i], solid[j]);
      if (!excluded.contains(pair)) pairs.push_back(pair);
    }
  }
  return pairs;
}

void ReadGuideRules(const std::optional<YamlView>& guide, Model* model) {
  if (!guide) return;
  guide->AllowKeys({"require", "self_collision"});
  if (const auto require = guide->Find("require")) {
    model->require = require->Choice({"stability", "contact"}) == 0 ? GuideRequirement::kStability
                                                                    : GuideRequirement::kContact;
  }
  if (const auto self = guide->Find("self_collision")) model->self_collision = self->Bool();
}

void ReadGravity(const std::optional<YamlView>& gravity, Model* model) {
  if (!gravity) return;
  model->gravity = gravity->Vector3(1e3);
  if (model->gravity.isZero(0)) gravity->Fail("gravity is zero; balance has no meaning without it");
}

Pose ReadRoot(const YamlView& endpoint) {
  endpoint.AllowKeys({"posture", "root"});
  const YamlView root = endpoint.Get("root");
  root.Get("xyz_m");
  return ReadPose(root);
}

Model ReadModelParts(const YamlView& view, const RobotDescription& description,
                     const PackageMap& packages, std::vector<std::string>* warnings) {
  Model model;
  model.robot = description.robot;
  ReadGravity(view.Find("gravity"), &model);
  ReadGuideRules(view.Find("guide"), &model);
  const std::optional<YamlView> contact = view.Find("contact");
  const double friction = ReadDefaultFriction(contact);
  const SceneNames names = ReadScene(view.Get("scene"), packages, friction, &model, warnings);
  ReadContact(contact, names, &model);
  if (model.self_collision) model.self_pairs = SelfPairs(description);
  return model;
}

// A hull that adds much to its mesh makes a robot bulkier than it is; a tenth is worth saying.
std::vector<std::string> HullNotes(const RobotDescription& description) {
  std::vector<std::string> notes;
  for (const HullVolume& volume : description.hull_volumes) {
    if (!(volume.hull > 1.1 * volume.mesh)) continue;
    char text[64];
    std::snprintf(text, sizeof text, "%.3g to %.3g litres", 1000 * volume.mesh, 1000 * volume.hull);
    notes.push_back("link \"" + volume.link + "\": the convex hull of " + volume.mesh_file +
                    " raises its volume from " + text);
  }
  return notes;
}

Problem ReadParts(const YamlView& view) {
  view.AllowKeys({"schema", "robot", "gravity", "scene", "contact", "guide", "sampling", "postures",
                  "start", "goal"});
  CheckSchema(view);
  const YamlView robot = view.Get("robot");
  const RobotFiles files = ReadRobotFiles(robot);
  const RobotDescription description = AtPlace(robot.Place(), [&] { return ReadRobot(files); });
  Problem problem;
  problem.warnings = description.warnings;
  problem.notes = HullNotes(description);
  problem.model = ReadModelParts(view, description, files.packages, &problem.warnings);

  const KinematicTree tree(description.robot);
  PostureTable postures(description, view.Find("postures"), tree, &problem.warnings);
  const YamlView start = view.Get("start");
  const YamlView goal = view.Get("goal");
  problem.start.X_WB = ReadRoot(start);
  problem.goal.X_WB = ReadRoot(goal);
  problem.sampling = ReadSampling(view.Find("sampling"), &postures, problem.start.X_WB,
                                  problem.goal.X_WB, &problem.warnings);
  problem.start.joints = postures.Exact(start.Get("posture"));
  problem.goal.joints = postures.Exact(goal.Get("posture"));
  problem.postures = postures.All();
  return problem;
}

}  // namespace

Problem ReadProblem(const std::filesystem::path& file) {
  return GuardedRead(file, [&] {
    const std::string text = ReadTextFile(file, kMaxProblemBytes);
    const YamlNode root = ParseYaml(text, file.string());
    Problem problem = ReadParts(YamlView(root, file));
    AtPlace(file.string(), [&] { CheckModel(problem.model); });
    problem.name = file.stem().string();
    problem.model_digest = Digest(WriteModel(problem.model));
    problem.problem_digest = Digest(text);
    return problem;
  });
}

}  // namespace cguide::numeric::io
