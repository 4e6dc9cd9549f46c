#include "picture.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

namespace contact_planner {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kScale = 200;  // pixels a metre
constexpr double kWide = 10;    // faces with longer half sides are floors (m)
constexpr double kGap = 20;
constexpr double kTitle = 28;

/** Pixels of one view: the plane of x and one other axis, up. */
struct View {
  int axis = 1;
  Vector2d lower, upper;  // of the room drawn (m)
  Vector2d corner;        // top left (pixels)
  Vector2d size() const { return kScale * (upper - lower); }
  Vector2d Pixel(const Vector3d& x_W) const {
    const Vector2d x{x_W.x(), x_W[axis]};
    return corner + kScale * Vector2d(x[0] - lower[0], upper[1] - x[1]);
  }
};

std::string Points(const View& view, const std::vector<Vector3d>& points) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(1);
  for (const Vector3d& x : points) text << view.Pixel(x)[0] << ',' << view.Pixel(x)[1] << ' ';
  return text.str();
}

void DrawPolygon(const View& view, const std::vector<Vector3d>& points, const std::string& style,
                 std::ostream& out) {
  out << "<polygon points='" << Points(view, points) << "' style='" << style << "'/>\n";
}

void DrawLine(const View& view, const std::vector<Vector3d>& points, const std::string& style,
              std::ostream& out) {
  out << "<polyline points='" << Points(view, points) << "' style='fill:none;" << style << "'/>\n";
}

void DrawCircle(const View& view, const Vector3d& x_W, double radius, const std::string& style,
                std::ostream& out) {
  out << "<circle cx='" << view.Pixel(x_W)[0] << "' cy='" << view.Pixel(x_W)[1] << "' r='" << radius
      << "' style='" << style << "'/>\n";
}

std::vector<Vector3d> Corners(const Face& f) {
  const Vector3d u = f.half[0] * f.u_W, v = f.half[1] * f.v_W;
  return {f.centre_W + u + v, f.centre_W - u + v, f.centre_W - u - v, f.centre_W + u - v};
}

void DrawRoom(const View& view, const Setting& setting, std::ostream& out) {
  for (const Face& f : setting.faces) {
    const bool wide = f.half.maxCoeff() > kWide;
    DrawPolygon(view, Corners(f),
                wide ? "fill:none;stroke:#999" : "fill:#d8d2c4;fill-opacity:0.35;stroke:#8a8272",
                out);
  }
}

// Corners of a sole in turn, whatever the order of its sites.
std::vector<Vector3d> Outline(std::vector<Vector3d> points, const Vector3d& normal) {
  Vector3d centre = Vector3d::Zero();
  for (const Vector3d& x : points) centre += x / static_cast<double>(points.size());
  const Vector3d a = (points.front() - centre).normalized();
  const auto angle = [&](const Vector3d& x) {
    return std::atan2(normal.cross(a).dot(x - centre), a.dot(x - centre));
  };
  std::sort(points.begin(), points.end(),
            [&](const Vector3d& x, const Vector3d& y) { return angle(x) < angle(y); });
  return points;
}

void DrawContacts(const View& view, const Setting& setting, const StanceNode& node,
                  std::ostream& out) {
  static const char* const kColours[] = {"#1b7837", "#762a83", "#b35806", "#2166ac"};
  for (const Grip& grip : node.stance) {
    const std::string style =
        std::string("fill:none;stroke-width:1.2;stroke:") + kColours[grip.limb % 4];
    if (setting.limbs[grip.limb].hold == Hold::kSurface) {
      DrawPolygon(view, Outline(grip.at_W, setting.faces[grip.face].normal_W), style, out);
    } else {
      for (const Vector3d& x : grip.at_W) DrawCircle(view, x, 4, style, out);
    }
  }
}

void DrawSearch(const View& view, const Setting& setting, const SearchResult& result,
                const std::vector<Vector3d>& guide, std::ostream& out) {
  DrawLine(view, guide, "stroke:#2166ac;stroke-width:5;stroke-opacity:0.25", out);
  out << "<g style='fill:#c1272d;fill-opacity:0.4'>\n";
  for (const int i : result.expanded) {
    const Vector2d x = view.Pixel(result.nodes[i].q.X_WB.p);
    out << "<circle cx='" << x[0] << "' cy='" << x[1] << "' r='2.5'/>\n";
  }
  out << "</g>\n";
  std::vector<Vector3d> track;
  for (const int i : result.Sequence()) {
    track.push_back(result.nodes[i].transition.X_WB.p);
    track.push_back(result.nodes[i].q.X_WB.p);
    DrawContacts(view, setting, result.nodes[i], out);
  }
  DrawLine(view, track, "stroke:#000;stroke-width:1.6", out);
  DrawCircle(view, guide.front(), 5, "fill:#fff;stroke:#000", out);
  DrawCircle(view, guide.back(), 5, "fill:#000", out);
}

/** What the views show: the roots, the room apart from floors, and a margin. */
void CoverRoom(const Setting& setting, const std::vector<Vector3d>& guide,
               const std::vector<Drawing>& drawings, Vector3d* lower, Vector3d* upper) {
  *lower = *upper = guide.front();
  const auto cover = [&](const Vector3d& x) {
    *lower = lower->cwiseMin(x);
    *upper = upper->cwiseMax(x);
  };
  for (const Vector3d& x : guide) cover(x);
  for (const Drawing& drawing : drawings) {
    for (const StanceNode& node : drawing.result->nodes) cover(node.q.X_WB.p);
  }
  for (const Face& f : setting.faces) {
    if (f.half.maxCoeff() > kWide) continue;
    for (const Vector3d& x : Corners(f)) cover(x);
  }
  *lower -= Vector3d::Constant(0.3);
  *upper += Vector3d::Constant(0.3);
  lower->z() = -0.05;
}

void DrawView(const View& view, const Setting& setting, const SearchResult& result,
              const std::vector<Vector3d>& guide, std::ostream& out) {
  std::ostringstream clip;
  clip << "clip" << view.corner[0] << '-' << view.corner[1];
  out << "<clipPath id='" << clip.str() << "'><rect x='" << view.corner[0] << "' y='"
      << view.corner[1] << "' width='" << view.size()[0] << "' height='" << view.size()[1]
      << "'/></clipPath>\n<g clip-path='url(#" << clip.str() << ")'>\n";
  DrawRoom(view, setting, out);
  DrawSearch(view, setting, result, guide, out);
  out << "</g>\n";
}

}  // namespace

std::string Picture(const Setting& setting, const std::vector<cguide::Configuration>& guide,
                    const std::vector<Drawing>& drawings) {
  std::vector<Vector3d> roots;
  for (const auto& q : guide) roots.push_back(q.X_WB.p);
  Vector3d lower, upper;
  CoverRoom(setting, roots, drawings, &lower, &upper);
  View top{1, {lower.x(), lower.y()}, {upper.x(), upper.y()}, {kGap, kTitle}};
  View side{2, {lower.x(), lower.z()}, {upper.x(), upper.z()}, {2 * kGap + top.size()[0], kTitle}};
  const double row = kTitle + kGap + std::max(top.size()[1], side.size()[1]);
  std::ostringstream out;
  out << std::fixed << std::setprecision(1);
  out << "<svg xmlns='http://www.w3.org/2000/svg' width='" << 3 * kGap + 2 * top.size()[0]
      << "' height='" << row * static_cast<double>(drawings.size())
      << "' font-family='sans-serif' font-size='14'>\n<rect width='100%' height='100%' "
         "fill='#fff'/>\n";
  for (const Drawing& drawing : drawings) {
    out << "<text x='" << kGap << "' y='" << top.corner[1] - 9 << "'>" << drawing.title
        << "</text>\n";
    for (const View& view : {top, side}) DrawView(view, setting, *drawing.result, roots, out);
    top.corner[1] += row;
    side.corner[1] += row;
  }
  out << "</svg>\n";
  return out.str();
}

}  // namespace contact_planner
