#include <algorithm>

#include "cguide/numeric/clearance_internal.h"
#include "cguide/numeric/contact_internal.h"

namespace cguide::numeric {
namespace {

// The nearer of two objects; of objects equally near the one of lower friction.
bool Nearer(const DirectedClearance& a, double friction_a, const DirectedClearance& b,
            double friction_b) {
  const double d_a = a.overlap ? -a.depth : a.hi, d_b = b.overlap ? -b.depth : b.hi;
  return d_a != d_b ? d_a < d_b : friction_a < friction_b;
}

void AddContact(int body, int object, double friction, double epsilon, double skin,
                const DirectedClearance& d, std::vector<Contact>* contacts) {
  Contact contact;
  contact.body = body;
  contact.object = object;
  contact.friction = friction;
  contact.x_W = d.a_W;
  contact.y_W = d.b_W;
  contact.n_W = d.n_W;
  contact.distance = d.overlap ? -d.depth : d.hi;
  // Of parallel faces any pair of opposite points is a closest pair: the points are one choice,
  // within the enclosure's width of being closest.
  contact.error = std::max(0.0, d.hi - d.lo);
  if (d.lo >= epsilon || (d.overlap && d.depth >= skin)) return;
  contact.certain = d.overlap ? d.depth < skin : d.hi < epsilon && (d.lo > 0 || skin > 0);
  contacts->push_back(contact);
}

}  // namespace

void FindNearestContacts(const World& world, Workspace* workspace, std::vector<Contact>* contacts) {
  const Geometry& g = world.geometry();
  const double epsilon = world.model().contact.epsilon;
  for (int body : g.contact_bodies) {
    int best_object = -1;
    DirectedClearance best;
    for (int object = 0; object < g.num_objects; ++object) {
      const DirectedClearance one = BodyClearance(world, {body, object, false}, epsilon, workspace);
      const double friction = world.model().objects[object].friction;
      if (one.lo >= epsilon ||
          (best_object >= 0 &&
           !Nearer(one, friction, best, world.model().objects[best_object].friction))) {
        continue;
      }
      best = one;
      best_object = object;
    }
    if (best_object < 0) continue;
    AddContact(body, best_object, world.model().objects[best_object].friction, epsilon,
               g.PairSkin(body, best_object), best, contacts);
  }
}

}  // namespace cguide::numeric
