// SPDX-License-Identifier: Apache-2.0
#include "cguide/exact/core/error.h"
#include "cguide/verify/check/certificate.h"
#include "cguide/verify/check/json_internal.h"

namespace cguide::check {
namespace {

constexpr const char* kBegin = "{\"schema\": \"cguide-certificate/1\",\n\"model\": ";

/** How many of each thing the model has. */
struct Counts {
  explicit Counts(const Model& model) : sites(model.sites.size()) {
    for (const Link& link : model.robot.links) shapes += link.shapes.size();
    for (const Object& object : model.objects) {
      for (const Piece& piece : object.pieces) {
        pieces.push_back(std::visit(
            [](const auto& g) -> std::size_t {
              if constexpr (requires { g.faces; }) return g.faces.size();
              if constexpr (requires { g.triangles; }) return g.triangles.size();
              return 0;
            },
            piece.geometry));
      }
    }
  }
  std::size_t shapes = 0;
  std::vector<std::size_t> pieces;  ///< faces or triangles of each
  std::size_t sites = 0;
};

/** [nx, ny, nz], then m0, then m1 where given. */
Plane ReadPlane(const View& given) {
  const std::size_t size = given.Size();
  if (size < 3 || size > 5) given.Fail("a plane has three to five numbers");
  Plane plane;
  for (int k = 0; k < 3; ++k) plane.n[k] = given.At(k).Number();
  if (size > 3) plane.m0 = given.At(3).Number();
  if (size > 4) plane.m1 = given.At(4).Number();
  return plane;
}

/** [shape, other, plane, plane ...] */
std::vector<Plane> ReadPlanes(const View& view, std::size_t first) {
  std::vector<Plane> planes;
  for (std::size_t i = first; i < view.Size(); ++i) planes.push_back(ReadPlane(view.At(i)));
  return planes;
}

/** [plane, shape, shape ...] */
SharedPlane ReadSharedPlane(const View& view, std::size_t shapes) {
  if (view.Size() < 2) view.Fail("a plane and the shapes above it are expected here");
  if (view.At(0).Size() > 4) view.At(0).Fail("a plane of shapes and pieces does not move");
  SharedPlane shared{ReadPlane(view.At(0)), {}};
  for (std::size_t i = 1; i < view.Size(); ++i) shared.shapes.push_back(view.At(i).Index(shapes));
  return shared;
}

std::vector<Separation> ReadSeparations(const View& view, std::size_t shapes, std::size_t others) {
  std::vector<Separation> result;
  for (std::size_t i = 0; i < view.Size(); ++i) {
    const View item = view.At(i);
    result.push_back({item.At(0).Index(shapes), item.At(1).Index(others), ReadPlanes(item, 2)});
  }
  return result;
}

FlatEvidence ReadFlat(const View& view, std::size_t triangles) {
  view.AllowKeys({"face", "triangles", "side"});
  FlatEvidence flat;
  if (view.Has("face")) flat.face = view.Get("face").Index(6);
  if (view.Has("side")) {
    const double side = view.Get("side").Number();
    if (side != 1 && side != -1) view.Fail("a side is 1 or -1");
    flat.side = side > 0 ? 1 : -1;
  }
  if (!view.Has("triangles")) return flat;
  const View list = view.Get("triangles");
  for (std::size_t i = 0; i < list.Size(); ++i)
    flat.triangles.push_back(list.At(i).Index(triangles));
  return flat;
}

NearEvidence ReadNear(const View& view) {
  view.AllowKeys({"y", "corners"});
  NearEvidence near;
  if (view.Has("y")) near.y_P = view.Get("y").Vector3();
  if (!view.Has("corners")) return near;
  const View list = view.Get("corners");
  for (std::size_t i = 0; i < list.Size(); ++i) {
    const View corner = list.At(i);
    if (corner.Size() != 2) corner.Fail("a corner is [index, weight]");
    near.corners.emplace_back(corner.At(0).Index(1'000'000'000), corner.At(1).Number());
  }
  return near;
}

RidgeEvidence ReadRidge(const View& view) {
  view.AllowKeys({"corners"});
  const View list = view.Get("corners");
  if (list.Size() < 1 || list.Size() > 2) list.Fail("one or two corners are expected here");
  RidgeEvidence ridge;
  for (std::size_t i = 0; i < list.Size(); ++i) {
    ridge.corners.push_back(list.At(i).Index(1'000'000'000));
  }
  return ridge;
}

std::vector<int> ReadCorners(const View& list) {
  if (list.Size() < 1 || list.Size() > 3) list.Fail("one to three corners are expected here");
  std::vector<int> corners;
  for (std::size_t i = 0; i < list.Size(); ++i) corners.push_back(list.At(i).Index(1'000'000'000));
  return corners;
}

PatchEvidence ReadPatch(const View& view, const Counts& counts) {
  view.AllowKeys({"plane", "slack", "parts"});
  PatchEvidence patch;
  const View plane = view.Get("plane");
  if (plane.Size() != 4) plane.Fail("the plane of a patch has four numbers");
  for (int k = 0; k < 3; ++k) patch.n[k] = plane.At(k).Number();
  patch.m0 = plane.At(3).Number();
  if (view.Has("slack")) patch.slack = view.Get("slack").Number();
  const View parts = view.Get("parts");
  for (std::size_t i = 0; i < parts.Size(); ++i) {
    const View given = parts.At(i);
    given.AllowKeys({"piece", "face", "triangle", "corners", "until"});
    PatchPart part;
    part.piece = given.Get("piece").Index(counts.pieces.size());
    if (given.Has("face")) part.face = given.Get("face").Index(6);
    if (given.Has("triangle")) {
      part.triangle = given.Get("triangle").Index(counts.pieces[part.piece]);
    }
    if (given.Has("corners")) part.corners = ReadCorners(given.Get("corners"));
    if (given.Has("until")) part.until = given.Get("until").Number();
    patch.parts.push_back(std::move(part));
  }
  return patch;
}

ContactEvidence ReadContact(const View& view, const Counts& counts) {
  view.AllowKeys({"site", "piece", "flat", "near", "ridge", "patch", "apart"});
  ContactEvidence contact;
  contact.site = view.Get("site").Index(counts.sites);
  contact.piece = view.Get("piece").Index(counts.pieces.size());
  if (view.Has("flat") + view.Has("near") + view.Has("ridge") + view.Has("patch") != 1) {
    view.Fail("one of \"flat\", \"near\", \"ridge\" and \"patch\" belongs here");
  }
  if (view.Has("flat")) contact.flat = ReadFlat(view.Get("flat"), counts.pieces[contact.piece]);
  if (view.Has("near")) contact.near = ReadNear(view.Get("near"));
  if (view.Has("ridge")) contact.ridge = ReadRidge(view.Get("ridge"));
  if (view.Has("patch")) contact.patch = ReadPatch(view.Get("patch"), counts);
  if (!view.Has("apart")) return contact;
  const View list = view.Get("apart");
  for (std::size_t i = 0; i < list.Size(); ++i) {
    const View item = list.At(i);
    contact.apart.push_back({-1, item.At(0).Index(counts.pieces.size()), ReadPlanes(item, 1)});
  }
  return contact;
}

std::vector<ForceEvidence> ReadForces(const View& view, std::size_t contacts) {
  std::vector<ForceEvidence> forces;
  for (std::size_t i = 0; i < view.Size(); ++i) {
    const View force = view.At(i);
    if (force.Size() != 6) force.Fail("a force is [contact, ux, uy, uz, w0, w1]");
    ForceEvidence read;
    read.contact = force.At(0).Index(contacts);
    for (int k = 0; k < 3; ++k) read.u_W[k] = force.At(1 + k).Number();
    read.w0 = force.At(4).Number();
    read.w1 = force.At(5).Number();
    forces.push_back(read);
  }
  return forces;
}

Balance ReadBalance(const View& view, const Counts& counts) {
  view.AllowKeys({"contacts", "forces", "displaced"});
  Balance balance;
  const View contacts = view.Get("contacts");
  for (std::size_t i = 0; i < contacts.Size(); ++i) {
    balance.contacts.push_back(ReadContact(contacts.At(i), counts));
  }
  if (view.Has("forces")) {
    balance.forces = ReadForces(view.Get("forces"), balance.contacts.size());
  }
  if (!view.Has("displaced")) return balance;
  const View displaced = view.Get("displaced");
  for (std::size_t i = 0; i < displaced.Size(); ++i) {
    balance.displaced.push_back(ReadForces(displaced.At(i), balance.contacts.size()));
  }
  return balance;
}

Node ReadNode(const View& view, const Counts& counts) {
  view.AllowKeys({"apart", "self_apart", "above", "balance", "halves"});
  Node node;
  if (view.Has("apart")) {
    node.apart = ReadSeparations(view.Get("apart"), counts.shapes, counts.pieces.size());
  }
  if (view.Has("self_apart")) {
    node.self_apart = ReadSeparations(view.Get("self_apart"), counts.shapes, counts.shapes);
  }
  if (view.Has("above")) {
    const View list = view.Get("above");
    for (std::size_t i = 0; i < list.Size(); ++i) {
      node.above.push_back(ReadSharedPlane(list.At(i), counts.shapes));
    }
  }
  if (view.Has("balance")) node.balance = ReadBalance(view.Get("balance"), counts);
  if (!view.Has("halves")) return node;
  const View halves = view.Get("halves");
  if (halves.Size() != 2) halves.Fail("two halves belong here");
  for (std::size_t i = 0; i < 2; ++i) node.halves.push_back(ReadNode(halves.At(i), counts));
  return node;
}

EdgeProof ReadProof(const View& view, const Counts& counts) {
  view.AllowKeys({"edge", "outside", "tree"});
  EdgeProof proof;
  proof.edge = view.Get("edge").Index(1'000'000'000);
  if (view.Has("outside")) {
    const View list = view.Get("outside");
    for (std::size_t i = 0; i < list.Size(); ++i) {
      const View ray = list.At(i);
      if (ray.Size() != 5) ray.Fail("a ray is [shape, piece, ux, uy, uz]");
      OutsideRay read{ray.At(0).Index(counts.shapes), ray.At(1).Index(counts.pieces.size()), {}};
      for (int k = 0; k < 3; ++k) read.direction[k] = ray.At(2 + k).Number();
      proof.outside.push_back(read);
    }
  }
  proof.root = ReadNode(view.Get("tree"), counts);
  return proof;
}

Path ReadPath(const View& view) {
  view.AllowKeys({"joint_names", "waypoints"});
  Path path;
  const View names = view.Get("joint_names");
  for (std::size_t i = 0; i < names.Size(); ++i) path.joint_names.push_back(names.At(i).Text());
  const View waypoints = view.Get("waypoints");
  for (std::size_t i = 0; i < waypoints.Size(); ++i) {
    const View row = waypoints.At(i);
    if (row.Size() != 7 + path.joint_names.size()) {
      row.Fail("a waypoint is [x, y, z, qx, qy, qz, qw, joints ...]");
    }
    const auto at = [&](std::size_t k) { return row.At(k).Number(); };
    Configuration q{{{at(0), at(1), at(2)}, {at(3), at(4), at(5), at(6)}}, {}};
    q.joints.resize(static_cast<Eigen::Index>(path.joint_names.size()));
    for (std::size_t k = 0; k < path.joint_names.size(); ++k) q.joints[k] = at(7 + k);
    path.waypoints.push_back(std::move(q));
  }
  return path;
}

Robustness ReadRobustness(const View& view) {
  view.AllowKeys({"friction", "pose", "com"});
  const auto width = [&](const char* key) {
    const double value = view.Get(key).Number();
    if (!(value >= 0)) view.Get(key).Fail("a width is not negative");
    return value;
  };
  return {width("friction"), width("pose"), width("com")};
}

}  // namespace

Certificate ParseCertificate(const std::string& text) {
  const nlohmann::json json = ParseJson(text);
  const View view(json);
  view.AllowKeys({"schema", "model", "robust", "path", "tool", "proofs"});
  const View schema = view.Get("schema");
  if (schema.Text() != "cguide-certificate/1") {
    schema.Fail("this program reads \"cguide-certificate/1\" alone");
  }
  Certificate certificate;
  if (view.Has("tool")) certificate.tool = view.Get("tool").Text();
  certificate.model = ReadModel(view.Get("model"));
  if (view.Has("robust")) certificate.robust = ReadRobustness(view.Get("robust"));
  certificate.path = ReadPath(view.Get("path"));
  const Counts counts(certificate.model);
  const View proofs = view.Get("proofs");
  int last = -1;
  for (std::size_t i = 0; i < proofs.Size(); ++i) {
    const View proof = proofs.At(i);
    certificate.proofs.push_back(ReadProof(proof, counts));
    if (certificate.proofs.back().edge <= last) proof.Fail("proofs are ordered by edge, each once");
    last = certificate.proofs.back().edge;
  }
  return certificate;
}

bool HasModelText(const std::string& certificate, const std::string& model_file) {
  std::string model = model_file;
  while (!model.empty() && (model.back() == '\n' || model.back() == '\r')) model.pop_back();
  const std::string begin = kBegin + model + ",\n\"path\": ";
  return certificate.compare(0, begin.size(), begin) == 0;
}

}  // namespace cguide::check
