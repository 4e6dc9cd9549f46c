#include "cguide/planner/potential_field.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "cguide/exact/core/error.h"
#include "cguide/planner/potential_edge_internal.h"

namespace cguide::planner {
namespace {

using Eigen::Vector3d;
using Eigen::Vector4d;
using Eigen::VectorXd;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kLeafEdges = 4;  // fewer cost more in nodes than they spare in distances

// What a search minimises: price d(q, gamma(s)) - reward s over s in [begin, end].
struct Objective {
  double price = 1;
  double reward = 0;
  double begin = 0;
  double end = 0;
};

// A range of edges and a ball around one waypoint that holds it.
struct Node {
  int begin = 0;
  int end = 0;
  int centre = 0;     // a waypoint
  double radius = 0;  // d(centre, gamma(s)) <= radius on the range
  int left = -1;      // -1 at leaves
  int right = -1;
};

struct Best {
  double value = kInfinity;
  int edge = 0;
  double t = 0;
};

bool SameSizes(const std::vector<Configuration>& guide) {
  return std::all_of(guide.begin(), guide.end(), [&guide](const Configuration& q) {
    return q.joints.size() == guide.front().joints.size();
  });
}

void CheckOptions(const PotentialOptions& options) {
  Require(options.weight >= 1 && options.weight < kInfinity, "weight must be at least 1");
  Require(options.window > 0, "window must be positive");
  const MetricWeights& metric = options.metric;
  Require(metric.translation >= 0 && metric.rotation >= 0 && metric.joints >= 0,
          "metric weights must not be negative");
}

}  // namespace

struct GuidePotential::Curve {
  Curve(const std::vector<Configuration>& guide, PotentialOptions potential_options);

  double length() const { return edges.back().s0 + edges.back().length; }
  double EndOf(int edge) const { return edges[edge].s0 + edges[edge].length; }
  int EdgeAt(double s) const;
  Objective MakeObjective(double price, double reward, std::optional<double> s_prev) const;
  GuidePoint Minimise(const Configuration& q, const Objective& objective,
                      std::optional<double> s_prev) const;

  PotentialOptions options;
  std::vector<Configuration> waypoints;
  std::vector<PotentialPoint> points;
  std::vector<PotentialEdge> edges;  // at least one: a single waypoint makes one of length 0

 private:
  int BuildNode(int begin, int end);
  double Radius(const Node& node) const;
  double Distance(const PotentialPoint& q, int waypoint) const {
    return WeightedDistance(q, points[waypoint], options.metric);
  }
  double NodeBound(const PotentialPoint& q, const Node& node, const Objective& objective,
                   Best* best) const;
  void OfferWaypoint(int waypoint, double distance, const Objective& objective, Best* best) const;
  void SearchEdge(const PotentialPoint& q, int edge, const Objective& objective, Best* best) const;
  void SearchLeaf(const PotentialPoint& q, const Node& node, const Objective& objective,
                  Best* best) const;
  void SearchTree(const PotentialPoint& q, const Objective& objective, Best* best) const;

  std::vector<Node> nodes_;
};

GuidePotential::Curve::Curve(const std::vector<Configuration>& guide,
                             PotentialOptions potential_options)
    : options(potential_options), waypoints(guide) {
  CheckOptions(options);
  Require(!waypoints.empty(), "a guide needs at least one waypoint");
  Require(SameSizes(waypoints), "the waypoints of a guide must have the same number of joints");
  if (waypoints.size() == 1) waypoints.push_back(waypoints.front());
  for (const Configuration& q : waypoints) points.emplace_back(q);
  double s = 0;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    edges.emplace_back(points[i], points[i + 1], options.metric);
    edges.back().s0 = s;
    s += edges.back().length;
  }
  BuildNode(0, static_cast<int>(edges.size()));
}

int GuidePotential::Curve::BuildNode(int begin, int end) {
  const int index = static_cast<int>(nodes_.size());
  nodes_.push_back({begin, end, (begin + end) / 2, 0, -1, -1});
  nodes_[index].radius = Radius(nodes_[index]);
  if (end - begin > kLeafEdges) {
    const int left = BuildNode(begin, (begin + end) / 2);
    const int right = BuildNode((begin + end) / 2, end);
    nodes_[index].left = left;
    nodes_[index].right = right;
  }
  return index;
}

// On an edge of length l between waypoints at distances a and b from the centre the distance is at
// most min(a + x, b + l - x) <= (a + b + l) / 2.
double GuidePotential::Curve::Radius(const Node& node) const {
  double radius = 0;
  double a = Distance(points[node.begin], node.centre);
  for (int i = node.begin; i < node.end; ++i) {
    const double b = Distance(points[i + 1], node.centre);
    radius = std::max(radius, 0.5 * (a + b + edges[i].length));
    a = b;
  }
  return radius;
}

// A waypoint whose distance is known anyway is an upper bound.
void GuidePotential::Curve::OfferWaypoint(int waypoint, double distance, const Objective& objective,
                                          Best* best) const {
  const bool last = waypoint == static_cast<int>(edges.size());
  const double s = last ? length() : edges[waypoint].s0;
  const double value = objective.price * distance - objective.reward * s;
  if (s < objective.begin || s > objective.end || !(value < best->value)) return;
  *best = {value, last ? waypoint - 1 : waypoint, last ? 1.0 : 0.0};
}

// Two bounds on price d - reward s over the node. By the ball: d >= D - radius, s <= s_end. By arc
// length: d >= D - |s - s_c|, so the sum is at least that of one end, since reward <= price.
double GuidePotential::Curve::NodeBound(const PotentialPoint& q, const Node& node,
                                        const Objective& objective, Best* best) const {
  const double s_begin = edges[node.begin].s0;
  const double s_end = EndOf(node.end - 1);
  const double s_centre = edges[node.centre].s0;
  if (s_end < objective.begin || s_begin > objective.end) return kInfinity;
  const double d = Distance(q, node.centre);
  OfferWaypoint(node.centre, d, objective, best);
  const auto bound = [&objective](double distance, double s) {
    return objective.price * std::max(0.0, distance) - objective.reward * s;
  };
  return std::max(bound(d - node.radius, s_end), std::min(bound(d - (s_centre - s_begin), s_begin),
                                                          bound(d - (s_end - s_centre), s_end)));
}

void GuidePotential::Curve::SearchEdge(const PotentialPoint& q, int edge,
                                       const Objective& objective, Best* best) const {
  const PotentialEdge& e = edges[edge];
  double begin = 0, end = 1;
  if (e.length > 0) {
    begin = std::clamp((objective.begin - e.s0) / e.length, 0.0, 1.0);
    end = std::clamp((objective.end - e.s0) / e.length, begin, 1.0);
  }
  const EdgeCost cost(e, q, options.metric, objective.price, objective.reward * e.length);
  const double offset = objective.reward * e.s0;
  const EdgeCost::Sample sample = cost.Minimum(begin, end, best->value + offset);
  if (sample.value - offset < best->value) *best = {sample.value - offset, edge, sample.t};
}

// With distances a and b of its waypoints, d >= max(a - x, b - l + x) at x along an edge of length
// l; price d - reward x is least where the two meet, x = (a - b + l) / 2, since reward <= price.
void GuidePotential::Curve::SearchLeaf(const PotentialPoint& q, const Node& node,
                                       const Objective& objective, Best* best) const {
  double a = Distance(q, node.begin);
  for (int i = node.begin; i < node.end; ++i) {
    const double b = Distance(q, i + 1);
    OfferWaypoint(i + 1, b, objective, best);
    const PotentialEdge& e = edges[i];
    const double bound = 0.5 * objective.price * (a + b - e.length) -
                         objective.reward * (e.s0 + 0.5 * (a - b + e.length));
    const bool outside = EndOf(i) < objective.begin || e.s0 > objective.end;
    if (!outside && bound < best->value) SearchEdge(q, i, objective, best);
    a = b;
  }
}

// Depth first, the child with the lower bound first.
void GuidePotential::Curve::SearchTree(const PotentialPoint& q, const Objective& objective,
                                       Best* best) const {
  struct Entry {
    double bound;
    int node;
  };
  std::array<Entry, 64> stack;  // one entry a level waits, and there are at most 31 levels
  int size = 0;
  stack[size++] = {NodeBound(q, nodes_[0], objective, best), 0};
  while (size > 0) {
    const Entry entry = stack[--size];
    if (!(entry.bound < best->value)) continue;
    const Node& node = nodes_[entry.node];
    if (node.left < 0) {
      SearchLeaf(q, node, objective, best);
      continue;
    }
    Entry near{NodeBound(q, nodes_[node.left], objective, best), node.left};
    Entry far{NodeBound(q, nodes_[node.right], objective, best), node.right};
    if (far.bound < near.bound) std::swap(near, far);
    stack[size++] = far;
    stack[size++] = near;
  }
}

int GuidePotential::Curve::EdgeAt(double s) const {
  const auto after = std::upper_bound(edges.begin(), edges.end(), s,
                                      [](double x, const PotentialEdge& e) { return x < e.s0; });
  return std::max(0, static_cast<int>(after - edges.begin()) - 1);
}

Objective GuidePotential::Curve::MakeObjective(double price, double reward,
                                               std::optional<double> s_prev) const {
  if (!s_prev) return {price, reward, 0, length()};
  const double centre = std::clamp(*s_prev, 0.0, length());
  return {price, reward, std::max(0.0, centre - options.window),
          std::min(length(), centre + options.window)};
}

GuidePoint GuidePotential::Curve::Minimise(const Configuration& q, const Objective& objective,
                                           std::optional<double> s_prev) const {
  Require(q.joints.size() == waypoints.front().joints.size(),
          "the configuration has another number of joints than the guide");
  const PotentialPoint point(q);
  Best best;
  if (s_prev) SearchEdge(point, EdgeAt(std::clamp(*s_prev, 0.0, length())), objective, &best);
  SearchTree(point, objective, &best);
  GuidePoint result;
  result.edge = best.edge;
  result.fraction = best.t;
  result.s = edges[best.edge].s0 + best.t * edges[best.edge].length;
  result.distance = (best.value + objective.reward * result.s) / objective.price;
  result.value = (length() - result.s) + options.weight * result.distance;
  return result;
}

GuidePotential::GuidePotential(const std::vector<Configuration>& guide, PotentialOptions options)
    : curve_(std::make_shared<const Curve>(guide, options)) {}

double GuidePotential::length() const { return curve_->length(); }

double GuidePotential::LipschitzConstant() const {
  const MetricWeights& metric = curve_->options.metric;
  const MetricWeights unit;  // Distance
  return curve_->options.weight *
         std::max({metric.translation / unit.translation, metric.rotation / unit.rotation,
                   metric.joints / unit.joints});
}

GuidePoint GuidePotential::Attractor(const Configuration& q, std::optional<double> s_prev) const {
  return curve_->Minimise(q, curve_->MakeObjective(curve_->options.weight, 1, s_prev), s_prev);
}

GuidePoint GuidePotential::Nearest(const Configuration& q, std::optional<double> s_prev) const {
  return curve_->Minimise(q, curve_->MakeObjective(1, 0, s_prev), s_prev);
}

Configuration GuidePotential::At(const GuidePoint& point) const {
  Require(point.edge >= 0 && point.edge < static_cast<int>(curve_->edges.size()),
          "the point belongs to another guide");
  return Interpolate({curve_->waypoints[point.edge], curve_->waypoints[point.edge + 1]},
                     point.fraction);
}

Configuration GuidePotential::At(double s) const {
  const double clamped = std::clamp(s, 0.0, curve_->length());
  GuidePoint point;
  point.edge = curve_->EdgeAt(clamped);
  const PotentialEdge& edge = curve_->edges[point.edge];
  if (edge.length > 0) point.fraction = std::min(1.0, (clamped - edge.s0) / edge.length);
  return At(point);
}

double GuidePotential::LargestShortcut(double step) const {
  Require(step > 0, "step must be positive");
  const double count = std::ceil(length() / step);
  double largest = 0;
  for (double i = 0; i <= count; ++i) {
    const double s = count > 0 ? length() * i / count : 0;
    largest = std::max(largest, length() - s - Value(At(s)));
  }
  return largest;
}

// The quaternion of the rotation from gamma to q is (cos a, n sin a) or its negative, a = acos|.|
// the metric's angle and n the axis in W; turning q by omega dt about W changes a by n.omega / 2
// dt.
VectorXd GuidePotential::Gradient(const Configuration& q, std::optional<double> s_prev) const {
  const PotentialOptions& options = curve_->options;
  const PotentialPoint target(At(Attractor(q, s_prev)));
  const PotentialPoint point(q);
  VectorXd gradient = VectorXd::Zero(6 + q.joints.size());
  const Vector3d dp = point.p - target.p;
  if (dp.norm() > 0) gradient.head<3>() = options.metric.translation * dp.normalized();
  // The vector part of point * conjugate(target).
  const Vector3d u = point.q.head<3>(), v = target.q.head<3>();
  const double dot = point.q.dot(target.q);
  const Vector3d axis = (dot < 0 ? -1 : 1) * (target.q[3] * u - point.q[3] * v - u.cross(v));
  if (axis.norm() > 0 && dot != 0) {
    gradient.segment<3>(3) = 0.5 * options.metric.rotation * axis.normalized();
  }
  const VectorXd dj = point.joints - target.joints;
  if (dj.norm() > 0) gradient.tail(dj.size()) = options.metric.joints * dj.normalized();
  return options.weight * gradient;
}

}  // namespace cguide::planner
