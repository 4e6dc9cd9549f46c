#include "cguide/exact/core/error.h"
#include "cguide/numeric/io/urdf_document_internal.h"

namespace cguide::numeric::io {
namespace {

// The peer reader frees the tree recursively, so that a chain must not be endless.
constexpr std::size_t kMostLinks = 10'000;

[[noreturn]] void Refuse(const std::string& what) { throw Error(Error::Code::kBadInput, what); }

// The joint above each link, -1 for roots.
std::vector<int> FindParents(const UrdfDocument& document) {
  std::vector<int> parent(document.links.size(), -1);
  for (std::size_t j = 0; j < document.joints.size(); ++j) {
    const UrdfJoint& joint = document.joints[j];
    int& above = parent[joint.child];
    if (above >= 0) {
      Refuse(joint.place + ": link \"" + document.links[joint.child].name +
             "\" has two parents, by joints \"" + document.joints[above].name + "\" and \"" +
             joint.name + "\"; a robot is a tree, so remove one of them");
    }
    above = static_cast<int>(j);
  }
  return parent;
}

int FindRoot(const UrdfDocument& document, const std::vector<int>& parent) {
  int root = -1;
  for (std::size_t i = 0; i < document.links.size(); ++i) {
    if (parent[i] >= 0) continue;
    if (root >= 0) {
      Refuse(document.links[i].place + ": links \"" + document.links[root].name + "\" and \"" +
             document.links[i].name +
             "\" both have no parent; a robot has one root, so connect them by a joint");
    }
    root = static_cast<int>(i);
  }
  if (root < 0) {
    Refuse(document.file +
           ": no link is without parent, so the joints make a cycle; remove a joint");
  }
  return root;
}

}  // namespace

void OrderLinks(UrdfDocument* document) {
  if (document->links.empty()) Refuse(document->file + ": holds no <link>; give a URDF file");
  if (document->links.size() > kMostLinks) {
    Refuse(document->file + ": more than 10000 links; give a robot with fewer");
  }
  const std::vector<int> parent = FindParents(*document);
  const int root = FindRoot(*document, parent);
  std::vector<std::vector<int>> below(document->links.size());
  for (std::size_t j = document->joints.size(); j-- > 0;) {
    below[document->joints[j].parent].push_back(static_cast<int>(j));
  }
  // A stack instead of recursion, because a chain may be as long as the file. `below` is in reverse
  // document order, so that the first joint is popped first.
  document->link_order = {root};
  std::vector<int> stack = below[root];
  while (!stack.empty()) {
    const int joint = stack.back();
    stack.pop_back();
    const int child = document->joints[joint].child;
    document->joint_order.push_back(joint);
    document->link_order.push_back(child);
    stack.insert(stack.end(), below[child].begin(), below[child].end());
  }
  if (document->link_order.size() == document->links.size()) return;
  std::vector<bool> reached(document->links.size(), false);
  for (int link : document->link_order) reached[link] = true;
  std::size_t lost = 0;
  while (reached[lost]) ++lost;
  Refuse(document->links[lost].place + ": link \"" + document->links[lost].name +
         "\" cannot be reached from the root \"" + document->links[root].name +
         "\", because joint \"" + document->joints[parent[lost]].name +
         "\" and others make a cycle; remove one of them");
}

}  // namespace cguide::numeric::io
