#include "stance.h"

#include <cguide/exact/core/error.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <variant>

namespace contact_planner {
namespace {

using Eigen::Vector3d;

constexpr double kWide = 50;  // half of what stands for a plane (m)

void AddBoxFaces(const cguide::numeric::Transform& X_WP, const Vector3d& half, int object,
                 const std::string& name, std::vector<Face>* faces) {
  static const char* const kSides[] = {"-x", "+x", "-y", "+y", "-z", "+z"};
  for (int axis = 0; axis < 3; ++axis) {
    const int a = (axis + 1) % 3, b = (axis + 2) % 3;
    for (const int sign : {-1, 1}) {
      Face face;
      face.object = object;
      face.name = name + " " + kSides[2 * axis + (sign > 0 ? 1 : 0)];
      face.normal_W = sign * X_WP.R.col(axis);
      face.centre_W = X_WP.p + half[axis] * face.normal_W;
      face.u_W = X_WP.R.col(a);
      face.v_W = X_WP.R.col(b);
      face.half = {half[a], half[b]};
      faces->push_back(face);
    }
  }
}

void AddPlane(const cguide::numeric::Transform& X_WP, const cguide::Halfspace& plane, int object,
              const std::string& name, std::vector<Face>* faces) {
  Face face;
  face.object = object;
  face.name = name;
  face.normal_W = X_WP.R * plane.normal.normalized();
  face.centre_W = X_WP.p + plane.offset / plane.normal.norm() * face.normal_W;
  face.u_W = face.normal_W.unitOrthogonal();
  face.v_W = face.normal_W.cross(face.u_W);
  face.half = {kWide, kWide};
  faces->push_back(face);
}

// Whether the points lie within 1 um of the plane of the widest triangle with the first of them.
bool Coplanar(const cguide::Model& model, const std::vector<int>& sites) {
  const auto from_first = [&](int site) -> Vector3d {
    return model.sites[site].x_L - model.sites[sites.front()].x_L;
  };
  Vector3d normal = Vector3d::Zero();
  for (const int a : sites) {
    for (const int b : sites) {
      const Vector3d n = from_first(a).cross(from_first(b));
      if (n.norm() > normal.norm()) normal = n;
    }
  }
  if (normal.norm() == 0) return false;
  return std::all_of(sites.begin(), sites.end(), [&](int site) {
    return std::abs(normal.normalized().dot(from_first(site))) < 1e-6;
  });
}

}  // namespace

std::vector<Face> FacesOf(const cguide::Model& model) {
  std::vector<Face> faces;
  for (std::size_t i = 0; i < model.objects.size(); ++i) {
    const int object = static_cast<int>(i);
    for (const cguide::Piece& piece : model.objects[i].pieces) {
      const auto X_WP = cguide::numeric::ToTransform(piece.X_WP);
      if (const auto* box = std::get_if<cguide::Box>(&piece.geometry)) {
        AddBoxFaces(X_WP, 0.5 * box->size, object, model.objects[i].name, &faces);
      } else if (const auto* plane = std::get_if<cguide::Halfspace>(&piece.geometry)) {
        AddPlane(X_WP, *plane, object, model.objects[i].name, &faces);
      }
    }
  }
  return faces;
}

std::vector<Limb> LimbsOf(const cguide::Model& model, const std::vector<std::string>& links) {
  std::vector<Limb> limbs;
  for (const std::string& name : links) {
    const int link = cguide::FindLink(model.robot, name);
    cguide::Require(link >= 0, ("the robot has no link " + name).c_str());
    Limb limb;
    limb.name = name;
    limb.body = model.robot.links[link].body;
    for (std::size_t i = 0; i < model.sites.size(); ++i) {
      if (model.sites[i].link == link) limb.sites.push_back(static_cast<int>(i));
    }
    cguide::Require(!limb.sites.empty(), ("no contact site is on link " + name).c_str());
    if (Coplanar(model, limb.sites)) limb.hold = Hold::kSurface;
    limbs.push_back(limb);
  }
  return limbs;
}

const Grip* FindGrip(const Stance& stance, int limb) {
  const auto grip =
      std::find_if(stance.begin(), stance.end(), [limb](const Grip& g) { return g.limb == limb; });
  return grip == stance.end() ? nullptr : &*grip;
}

Stance With(Stance stance, const Grip& grip) {
  const auto before = std::find_if(stance.begin(), stance.end(),
                                   [&grip](const Grip& g) { return g.limb > grip.limb; });
  stance.insert(before, grip);
  return stance;
}

Stance Without(Stance stance, int limb) {
  std::erase_if(stance, [limb](const Grip& g) { return g.limb == limb; });
  return stance;
}

bool Alike(const Stance& a, const Stance& b, double spacing) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [spacing](const Grip& g, const Grip& h) {
                      if (g.limb != h.limb || g.face != h.face || g.sites != h.sites) return false;
                      for (std::size_t i = 0; i < g.at_W.size(); ++i) {
                        if ((g.at_W[i] - h.at_W[i]).norm() > spacing) return false;
                      }
                      return true;
                    });
}

std::string Describe(const Grip& grip, const std::vector<Limb>& limbs,
                     const std::vector<Face>& faces) {
  return limbs[grip.limb].name + " on " + faces[grip.face].name;
}

Vector3d SitePosition(const cguide::Model& model, const cguide::numeric::KinematicTree& tree,
                      const cguide::numeric::KinematicState& state, int site) {
  const cguide::Site& s = model.sites[site];
  return state.X_WB[tree.link_body[s.link]] * (tree.X_BL[s.link] * s.x_L);
}

}  // namespace contact_planner
