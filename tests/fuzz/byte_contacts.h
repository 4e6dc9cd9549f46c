#pragma once

#include <vector>

#include "cguide/numeric/contact.h"
#include "tests/fuzz/byte_stream.h"

namespace cguide::fuzz {

/** Contacts of a point without errors, their normals along axes; now and then one that only may be
 active. */
inline std::vector<numeric::Contact> PointContacts(ByteStream& in, int count) {
  std::vector<numeric::Contact> contacts(static_cast<std::size_t>(count));
  for (numeric::Contact& contact : contacts) {
    contact.x_W = in.Point();
    const int axis = in.Below(3);
    contact.n_W = Eigen::Vector3d::Unit(axis) * (in.Below(5) == 0 ? -1.0 : 1.0);
    contact.normal_error = 0;
    contact.distance = 0.02;
    contact.y_W = contact.x_W - 0.02 * contact.n_W;
    contact.friction = 0.25 * in.Below(5);
    contact.certain = in.Below(8) != 0;
  }
  return contacts;
}

}  // namespace cguide::fuzz
