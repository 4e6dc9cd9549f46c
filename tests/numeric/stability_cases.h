#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <random>
#include <vector>

#include "cguide/numeric/sampling.h"
#include "cguide/numeric/stability.h"

// Contact sets as a humanoid meets them, for the tests and the benchmark of static stability.
namespace cguide::numeric::testing {

/** Contact at force point p with unit normal n; the site is a point 2 cm off the surface. */
inline Contact PointContact(const Eigen::Vector3d& p, const Eigen::Vector3d& n, double mu) {
  Contact contact;
  contact.x_W = p;
  contact.n_W = n;
  contact.distance = 0.02;
  contact.y_W = p - 0.02 * n;
  contact.normal_error = 0x1p-51;  // n is normalised in doubles
  contact.friction = mu;
  return contact;
}

struct Stance {
  std::vector<Contact> contacts;
  Eigen::Vector3d com = Eigen::Vector3d::Zero();
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();

  StabilityQuery Query() const {
    StabilityQuery query;
    query.contacts = contacts;
    query.com_W = com;
    query.mass = 58;
    return query;
  }
};

inline double Between(Rng& rng, double a, double b) { return a + (b - a) * Uniform(rng); }

/** Four corners of a patch of the given half sizes about p, z axis n. */
inline void AddPatch(const Eigen::Vector3d& p, const Eigen::Vector3d& n, double yaw, double mu,
                     double a, double b, Stance* stance) {
  const Eigen::Quaterniond R = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), n) *
                               Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ());
  for (const double i : {-1.0, 1.0}) {
    for (const double j : {-1.0, 1.0}) {
      stance->contacts.push_back(PointContact(p + R * Eigen::Vector3d(i * a, j * b, 0), n, mu));
    }
  }
}

/** One flat foot at the origin, 250 by 125 mm. */
inline Stance Foot() {
  Stance stance;
  AddPatch({0, 0, 0}, {0, 0, 1}, 0, 0.5, 0.125, 0.0625, &stance);
  return stance;
}

/** `patches` supports of four points: feet on the floor (some on slopes), then hands, knees and a
 seat at heights and normals of their kind. The CoM is drawn within 0.35 m of the centroid. */
inline Stance RandomStance(int patches, Rng& rng) {
  Stance stance;
  for (int k = 0; k < patches; ++k) {
    Eigen::Vector3d n(0, 0, 1);
    Eigen::Vector3d p(Between(rng, -0.5, 0.5), Between(rng, -0.5, 0.5), 0);
    if (k >= 1 && Uniform(rng) < 0.3) {
      n = Eigen::Vector3d(Normal(rng) * 0.3, Normal(rng) * 0.3, 1).normalized();
    }
    if (k >= 2) {
      p[2] = Between(rng, 0.2, 1.2);
      if (Uniform(rng) < 0.5) {  // a wall
        const double yaw = Between(rng, -3.14, 3.14);
        n = Eigen::Vector3d(std::cos(yaw), std::sin(yaw), 0);
        p -= 0.6 * n;
      }
    }
    AddPatch(p, n, Between(rng, -3.14, 3.14), Between(rng, 0.3, 0.9), 0.11, 0.06, &stance);
  }
  for (const Contact& c : stance.contacts) {
    stance.centroid += c.force_point_W() / double(stance.contacts.size());
  }
  stance.com = stance.centroid + Eigen::Vector3d(Between(rng, -0.35, 0.35),
                                                 Between(rng, -0.35, 0.35), Between(rng, 0.2, 0.8));
  return stance;
}

}  // namespace cguide::numeric::testing
