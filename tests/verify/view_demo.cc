#include "tests/verify/view_demo.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace cguide::verify {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kSeatTop = 0.45, kBand = 0.04;
using Vector = Eigen::Vector3d;

LinkShape At(const Vector& p, ConvexShape shape, const Eigen::Quaterniond& q = {1, 0, 0, 0}) {
  LinkShape out;
  out.X_LS = {p, {q.x(), q.y(), q.z(), q.w()}};
  out.geometry = std::move(shape);
  return out;
}

Eigen::Quaterniond Turn(double angle, const Vector& axis) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis));
}

// A frustum about z: corners of two rectangles, with outward triangles.
template <typename Mesh>
Mesh Frustum(Eigen::Vector2d below, Eigen::Vector2d above, double height) {
  Mesh mesh;
  for (const auto& [half, z] : {std::pair(below, -height / 2), std::pair(above, height / 2)}) {
    mesh.vertices.insert(mesh.vertices.end(), {{-half[0], -half[1], z},
                                               {half[0], -half[1], z},
                                               {half[0], half[1], z},
                                               {-half[0], half[1], z}});
  }
  const std::vector<std::array<int, 3>> triangles = {{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7},
                                                     {0, 1, 5}, {0, 5, 4}, {1, 2, 6}, {1, 6, 5},
                                                     {2, 3, 7}, {2, 7, 6}, {3, 0, 4}, {3, 4, 7}};
  if constexpr (requires { mesh.faces; }) mesh.faces = triangles;
  if constexpr (requires { mesh.triangles; }) mesh.triangles = triangles;
  return mesh;
}

class RobotBuilder {
 public:
  RobotBuilder() {
    robot_.name = "box humanoid";
    robot_.links.push_back({});
    robot_.links[0].name = "pelvis";
  }
  int Add(const std::string& name, int parent, JointType type, const Vector& origin,
          const Vector& axis) {
    Joint joint;
    joint.name = name + "_joint";
    joint.type = type;
    joint.parent = parent;
    joint.child = static_cast<int>(robot_.links.size());
    joint.X_PJ.p = origin;
    joint.axis = axis;
    joint.lower = -3;
    joint.upper = 3;
    Link link;
    link.name = name;
    link.joint = static_cast<int>(robot_.joints.size());
    robot_.joints.push_back(joint);
    robot_.links.push_back(link);
    return joint.child;
  }
  void Fill(int link, double mass, std::vector<LinkShape> shapes) {
    robot_.links[link].mass = mass;
    robot_.links[link].com_L = shapes.front().X_LS.p;
    robot_.links[link].shapes = std::move(shapes);
  }
  Robot Finish() {
    AssignBodiesAndColumns(&robot_);
    return std::move(robot_);
  }

 private:
  Robot robot_;
};

void AddLeg(RobotBuilder* b, const std::string& side, double y) {
  const Vector pitch = Vector::UnitY();
  const int thigh = b->Add(side + "_thigh", 0, JointType::kRevolute, {0, y, -0.03}, pitch);
  b->Fill(thigh, 6, {At({0, 0, -0.19}, Capsule{0.072, 0.27})});
  const int shank = b->Add(side + "_shank", thigh, JointType::kRevolute, {0, 0, -0.40}, pitch);
  b->Fill(shank, 3, {At({0, 0, -0.19}, Cylinder{0.05, 0.32}), At({0, 0, 0}, Sphere{0.062})});
  const int foot = b->Add(side + "_foot", shank, JointType::kRevolute, {0, 0, -0.40}, pitch);
  b->Fill(foot, 1.2, {At({0.045, 0, -0.05}, Box{{0.25, 0.11, 0.06}})});
}

void AddArm(RobotBuilder* b, const std::string& side, int chest, double y) {
  const Vector pitch = Vector::UnitY();
  const int upper = b->Add(side + "_upper_arm", chest, JointType::kRevolute, {0, y, 0.28}, pitch);
  b->Fill(upper, 2, {At({0, 0, -0.13}, Capsule{0.045, 0.2}), At({0, 0, 0}, Sphere{0.062})});
  const int fore = b->Add(side + "_forearm", upper, JointType::kRevolute, {0, 0, -0.28}, pitch);
  b->Fill(fore, 1.4, {At({0, 0, -0.12}, Cylinder{0.036, 0.2}), At({0, 0, 0}, Sphere{0.044})});
  const int hand = b->Add(side + "_hand", fore, JointType::kFixed, {0, 0, -0.27}, pitch);
  b->Fill(hand, 0.5, {At({0, 0, -0.03}, Box{{0.05, 0.08, 0.12}})});
}

Robot DemoRobot() {
  RobotBuilder b;
  b.Fill(0, 11, {At({0, 0, 0.02}, Frustum<Hull>({0.085, 0.12}, {0.10, 0.155}, 0.18))});
  const int chest = b.Add("chest", 0, JointType::kRevolute, {0, 0, 0.14}, Vector::UnitY());
  b.Fill(chest, 17, {At({0, 0, 0.18}, Frustum<Hull>({0.085, 0.125}, {0.115, 0.185}, 0.32))});
  const int head = b.Add("head", chest, JointType::kRevolute, {0, 0, 0.38}, Vector::UnitY());
  b.Fill(head, 4,
         {At({0.01, 0, 0.12}, Sphere{0.105}), At({0, 0, 0}, Cylinder{0.045, 0.1}),
          At({0.095, 0, 0.13}, Box{{0.06, 0.14, 0.05}})});
  AddLeg(&b, "left", 0.095);
  AddLeg(&b, "right", -0.095);
  AddArm(&b, "left", chest, 0.245);
  AddArm(&b, "right", chest, -0.245);
  return b.Finish();
}

Object MakeObject(const std::string& name, PieceShape shape, const Vector& p,
                  const Eigen::Quaterniond& q = {1, 0, 0, 0}) {
  return {name, 0.6, {{{p, {q.x(), q.y(), q.z(), q.w()}}, std::move(shape)}}};
}

std::vector<Object> DemoScene() {
  std::vector<Object> scene;
  scene.push_back(MakeObject("floor", Halfspace{}, {0, 0, 0}));
  Object chair = MakeObject("chair", Box{{0.42, 0.46, 0.04}}, {-0.04, 0, kSeatTop - 0.02});
  chair.pieces.push_back({{{-0.27, 0, 0.66}, {}}, Box{{0.035, 0.46, 0.40}}});
  for (const double x : {-0.22, 0.14}) {
    for (const double y : {-0.2, 0.2})
      chair.pieces.push_back({{{x, y, 0.205}, {}}, Cylinder{0.018, 0.41}});
  }
  scene.push_back(chair);
  Object table = MakeObject("table", Box{{0.7, 1.2, 0.04}}, {0.98, 0, 0.72});
  for (const double y : {-0.5, 0.5})
    table.pieces.push_back({{{1.0, y, 0.35}, {}}, Box{{0.5, 0.05, 0.70}}});
  scene.push_back(table);
  scene.push_back(MakeObject("bowl on the table",
                             Solid(Frustum<Solid>({0.06, 0.06}, {0.11, 0.11}, 0.08)),
                             {1.0, 0.3, 0.78}));
  scene.push_back(MakeObject("ball", Sphere{0.12}, {0.5, -0.8, 0.12}));
  scene.push_back(MakeObject("bolster", Capsule{0.09, 0.5}, {-0.1, 0.75, 0.09},
                             Turn(kPi / 2, Vector::UnitX())));
  Surface cloth;
  for (int i = 0; i <= 8; ++i) {
    for (int j = 0; j <= 1; ++j)
      cloth.vertices.push_back({0.05 * i, 0.4 * j, 0.03 * std::sin(0.9 * i)});
    if (i > 0)
      cloth.triangles.insert(cloth.triangles.end(),
                             {{2 * i - 2, 2 * i, 2 * i + 1}, {2 * i - 2, 2 * i + 1, 2 * i - 1}});
  }
  scene.push_back(MakeObject("cloth <b>\"quoted\"</b>", cloth, {0.72, -0.52, 0.775}));
  return scene;
}

// Frames of the links' bodies, by walking the tree.
std::vector<Eigen::Isometry3d> PlaceLinks(const Robot& robot, const Configuration& q) {
  const auto lift = [](const Pose& X) {
    Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
    out.linear() = Eigen::Quaterniond(X.q.w, X.q.x, X.q.y, X.q.z).normalized().toRotationMatrix();
    out.translation() = X.p;
    return out;
  };
  std::vector<Eigen::Isometry3d> X_WL(robot.links.size());
  X_WL[0] = lift(q.X_WB);
  for (const Joint& joint : robot.joints) {
    X_WL[joint.child] = X_WL[joint.parent] * lift(joint.X_PJ);
    if (joint.column >= 0) X_WL[joint.child].rotate(Turn(q.joints[joint.column], joint.axis));
  }
  return X_WL;
}

// hip, knee, waist, shoulder and elbow bend; the ankle keeps the foot level.
Configuration MakePosture(const Robot& robot, const std::array<double, 6>& bend, double foot_x) {
  const auto [pitch, hip, knee, waist, shoulder, elbow] = bend;
  Configuration q;
  const Eigen::Quaterniond tilt = Turn(pitch, Vector::UnitY());
  q.X_WB.q = {tilt.x(), tilt.y(), tilt.z(), tilt.w()};
  q.joints = Eigen::VectorXd::Zero(robot.num_columns);
  const auto set = [&](const std::string& name, double value) {
    q.joints[robot.joints[FindJoint(robot, name + "_joint")].column] = value;
  };
  set("chest", waist);
  set("head", -0.5 * (pitch + waist));
  for (const std::string side : {"left", "right"}) {
    set(side + "_thigh", hip);
    set(side + "_shank", knee);
    set(side + "_foot", -(pitch + hip + knee));
    set(side + "_upper_arm", shoulder);
    set(side + "_forearm", elbow);
  }
  const Vector ankle = PlaceLinks(robot, q)[FindLink(robot, "left_foot")].translation();
  q.X_WB.p = {foot_x - ankle[0], 0, 0.082 - ankle[2]};
  return q;
}

Path DemoPath(const Robot& robot) {
  // pitch, hip, knee, waist, shoulder, elbow (rad), one line per key posture.
  const std::vector<std::array<double, 6>> keys = {
      {0.0, -1.52, 1.52, 0.05, -0.35, -0.9}, {0.35, -1.75, 1.62, 0.3, -0.5, -0.8},
      {0.42, -1.8, 1.6, 0.35, -0.9, -0.5},   {0.42, -1.35, 1.15, 0.3, -0.9, -0.5},
      {0.2, -0.65, 0.75, 0.1, -0.3, -0.6},   {0.0, -0.05, 0.1, 0.0, 0.05, -0.25}};
  Path path;
  path.joint_names = ColumnNames(robot);
  constexpr int kSteps = 4;
  for (std::size_t k = 0; k + 1 < keys.size(); ++k) {
    for (int i = 0; i < kSteps; ++i) {
      std::array<double, 6> bend;
      for (int j = 0; j < 6; ++j) bend[j] = keys[k][j] + (keys[k + 1][j] - keys[k][j]) * i / kSteps;
      path.waypoints.push_back(MakePosture(robot, bend, 0.34));
    }
  }
  path.waypoints.push_back(MakePosture(robot, keys.back(), 0.34));
  return path;
}

std::vector<Eigen::Vector2d> HullOf(std::vector<Eigen::Vector2d> points) {
  const auto less = [](const auto& a, const auto& b) {
    return std::pair(a[0], a[1]) < std::pair(b[0], b[1]);
  };
  std::sort(points.begin(), points.end(), less);
  std::vector<Eigen::Vector2d> hull;
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t start = hull.size();
    for (const Eigen::Vector2d& p : points) {
      while (hull.size() >= start + 2) {
        const Eigen::Vector2d a = hull[hull.size() - 1] - hull[hull.size() - 2],
                              b = p - hull.back();
        if (a[0] * b[1] - a[1] * b[0] > 0) break;
        hull.pop_back();
      }
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

double MarginIn(const std::vector<Eigen::Vector2d>& hull, const Eigen::Vector2d& p) {
  double margin = 1e9;
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Eigen::Vector2d a = hull[i], b = hull[(i + 1) % hull.size()], n(a[1] - b[1], b[0] - a[0]);
    margin = std::min(margin, n.dot(p - a) / n.norm());
  }
  return margin;
}

// Lowest corners of the feet on the floor, undersides of the thighs on the seat.
void AddContacts(const Model& model, const std::vector<Eigen::Isometry3d>& X_WL, ViewFrame* frame) {
  for (const std::string side : {"left", "right"}) {
    const int foot = FindLink(model.robot, side + "_foot"),
              thigh = FindLink(model.robot, side + "_thigh");
    for (const Vector& corner : {Vector{0.17, 0.055, -0.08},
                                 {0.17, -0.055, -0.08},
                                 {-0.08, 0.055, -0.08},
                                 {-0.08, -0.055, -0.08}}) {
      const Vector p = X_WL[foot] * corner;
      if (p[2] < kBand)
        frame->contacts.push_back({model.robot.links[foot].body, 0, p, Vector::UnitZ(), 0.6, true});
    }
    for (const double along : {-0.06, -0.18, -0.3}) {
      const Vector p = X_WL[thigh] * Vector{0, 0, along} - Vector{0, 0, 0.072};
      if (p[2] - kSeatTop < kBand && p[0] < 0.17) {
        frame->contacts.push_back(
            {model.robot.links[thigh].body, 1, p, Vector::UnitZ(), 0.6, p[2] - kSeatTop < 0.035});
      }
    }
  }
}

ViewFrame MakeFrame(const Model& model, const Path& path, int edge, double s) {
  const Robot& robot = model.robot;
  const auto X_WL =
      PlaceLinks(robot, Interpolate({path.waypoints[edge], path.waypoints[edge + 1]}, s));
  ViewFrame frame;
  frame.edge = edge;
  frame.s = s;
  for (const Body& body : robot.bodies) {
    const Eigen::Isometry3d& X = X_WL[body.links.front()];
    frame.X_WB.push_back({X.linear().cast<float>(), X.translation().cast<float>()});
  }
  for (std::size_t l = 0; l < robot.links.size(); ++l) {
    frame.com_W += robot.links[l].mass / TotalMass(robot) * (X_WL[l] * robot.links[l].com_L);
  }
  AddContacts(model, X_WL, &frame);
  std::vector<Eigen::Vector2d> points;
  for (const ViewContact& contact : frame.contacts) points.push_back(contact.point_W.head<2>());
  frame.support_W = HullOf(points);
  frame.com_margin = MarginIn(frame.support_W, frame.com_W.head<2>());
  frame.clearance = 0.004 + 0.05 * std::abs(std::sin(3 * (edge + s) / 5.0));
  frame.verdict = *frame.com_margin < 0      ? Verdict::kFails
                  : *frame.com_margin < 0.02 ? Verdict::kUndecided
                                             : Verdict::kHolds;
  if (frame.verdict == Verdict::kFails) {
    frame.note = "stability: the centre of mass leaves the support region";
    frame.marked_bodies = {0, 1};
  }
  if (frame.verdict == Verdict::kUndecided) frame.note = "stability: boundary (rank 6)";
  return frame;
}

}  // namespace

ViewInput DemoInput() {
  ViewInput input;
  input.title = "Rising from a chair (demonstration)";
  input.provenance = {{"Guide", "demo.json"},
                      {"Problem", "chair_and_table.yaml"},
                      {"Seed", "7"},
                      {"Model", "sha256:5f2c0d9b7a1e4c38"},
                      {"Tool", "cguide 0.1.0"}};
  input.tested = "sampled(0.33)";
  input.model.robot = DemoRobot();
  input.model.objects = DemoScene();
  input.path = DemoPath(input.model.robot);
  const int edges = static_cast<int>(input.path.waypoints.size()) - 1;
  for (int edge = 0; edge < edges; ++edge) {
    for (int i = 0; i < 3; ++i)
      input.frames.push_back(MakeFrame(input.model, input.path, edge, i / 3.0));
  }
  const auto by_margin = [](const ViewFrame& a, const ViewFrame& b) {
    return a.com_margin < b.com_margin;
  };
  const auto by_clearance = [](const ViewFrame& a, const ViewFrame& b) {
    return a.clearance < b.clearance;
  };
  const ViewFrame& least = *std::min_element(input.frames.begin(), input.frames.end(), by_margin);
  const ViewFrame& nearest =
      *std::min_element(input.frames.begin(), input.frames.end(), by_clearance);
  input.worst = {
      {"stability", least.edge, least.s, "centre of mass against the support region",
       *least.com_margin, "m"},
      {"clearance", nearest.edge, nearest.s, "left_thigh against chair", *nearest.clearance, "m"},
      {"contact gap", edges - 1, 0.5, "left_foot above floor", 0.0021, "m"}};
  const auto fails = std::count_if(input.frames.begin(), input.frames.end(),
                                   [](const ViewFrame& f) { return f.verdict == Verdict::kFails; });
  input.verdict = fails > 0 ? Verdict::kFails : Verdict::kHolds;
  input.summary =
      std::to_string(fails) + " of " + std::to_string(input.frames.size()) + " instants fail.";
  return input;
}

}  // namespace cguide::verify
