#include <algorithm>
#include <set>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/io/file_internal.h"
#include "cguide/numeric/io/problem_parts_internal.h"
#include "cguide/numeric/sites.h"

namespace cguide::numeric::io {
namespace {

constexpr double kSiteTolerance = 1e-3;  // m; how far from its body a site may be [DESIGN part 2]

bool BearsGeometry(const Robot& robot, int body) {
  return std::any_of(robot.bodies[body].links.begin(), robot.bodies[body].links.end(),
                     [&](int link) { return !robot.links[link].shapes.empty(); });
}

int LinkNamed(const YamlView& place, const Robot& robot, const std::string& name) {
  const int link = FindLink(robot, name);
  if (link >= 0) return link;
  std::vector<std::string> names;
  for (const Link& l : robot.links) names.push_back(l.name);
  place.Fail("robot \"" + robot.name + "\" has no link " + Quote(name) + "; did you mean \"" +
             NearestName(name, names) + "\"?");
}

std::vector<int> ReadBodies(const std::optional<YamlView>& view, const Robot& robot) {
  std::set<int> bodies;
  if (!view || (view->IsText() && view->Text() == "all")) {
    for (int body = 0; body < static_cast<int>(robot.bodies.size()); ++body) {
      if (BearsGeometry(robot, body)) bodies.insert(body);
    }
  } else if (!view->IsList()) {
    view->Fail("write all, or a list of links");
  } else {
    for (const YamlView& item : view->Items()) {
      const int body = robot.links[LinkNamed(item, robot, item.Text())].body;
      if (!BearsGeometry(robot, body)) item.Fail("this body has no collision shape to touch with");
      bodies.insert(body);
    }
  }
  return {bodies.begin(), bodies.end()};
}

std::vector<std::pair<int, int>> ReadMayTouch(const YamlView& view, const SceneNames& names,
                                              const Robot& robot) {
  std::set<std::pair<int, int>> pairs;
  for (const YamlView& item : view.Items()) {
    const std::vector<YamlView> words = item.Items();
    if (words.size() != 2) item.Fail("write a pair [link of the robot, object of the scene]");
    const int body = robot.links[LinkNamed(words[0], robot, words[0].Text())].body;
    const auto objects = names.find(words[1].Text());
    if (objects == names.end()) {
      std::vector<std::string> known;
      for (const auto& [name, indices] : names) known.push_back(name);
      words[1].Fail("the scene has no object " + Quote(words[1].Text()) + "; did you mean \"" +
                    NearestName(words[1].Text(), known) + "\"?");
    }
    for (int object : objects->second) pairs.emplace(body, object);
  }
  return {pairs.begin(), pairs.end()};
}

// Distance of a point of one link from the union of the shapes of its whole body.
double DistanceToBody(const Robot& robot, const KinematicTree& tree, int link,
                      const Eigen::Vector3d& x_L) {
  const Eigen::Vector3d x_B = tree.X_BL[link] * x_L;
  double nearest = std::numeric_limits<double>::infinity();
  for (int other : robot.bodies[robot.links[link].body].links) {
    if (robot.links[other].shapes.empty()) continue;
    const Transform& X_BO = tree.X_BL[other];
    const Eigen::Vector3d x_O = X_BO.R.transpose() * (x_B - X_BO.p);
    nearest = std::min(nearest, DistanceToLink(robot, other, x_O));
  }
  return nearest;
}

Site ReadSite(const YamlView& view, int link) {
  if (view.IsList()) return {link, view.Vector3(kMaxLength), 0};
  view.AllowKeys({"xyz_m", "radius_m"});
  Site site{link, view.Get("xyz_m").Vector3(kMaxLength), 0};
  if (const auto radius = view.Find("radius_m")) site.radius = radius->Number(0, kMaxLength);
  return site;
}

std::vector<Site> ReadSites(const YamlView& view, const Robot& robot, const KinematicTree& tree,
                            int link) {
  std::vector<Site> sites;
  for (const YamlView& item : view.Items()) {
    sites.push_back(ReadSite(item, link));
    const double distance = DistanceToBody(robot, tree, link, sites.back().x_L);
    if (distance > kSiteTolerance) {
      item.Fail("the site is " + ShortestDouble(distance) + " m away from the body of link \"" +
                robot.links[link].name +
                "\", more than 0.001; sites lie on or in the body, in the link's frame");
    }
  }
  return sites;
}

using SitesByLink = std::map<int, std::vector<Site>>;

SitesByLink ReadSiteMap(const YamlView& view, const Model& model) {
  const Robot& robot = model.robot;
  const KinematicTree tree(robot);
  SitesByLink sites;
  for (const auto& [name, list] : view.Entries()) {
    const int link = LinkNamed(list, robot, name);
    const std::vector<int>& bodies = model.contact.bodies;
    if (!std::binary_search(bodies.begin(), bodies.end(), robot.links[link].body)) {
      list.Fail("its body is not among contact.bodies; add the link there or drop its sites");
    }
    sites[link] = ReadSites(list, robot, tree, link);
  }
  return sites;
}

void FillSites(const SitesByLink& given, const SiteOptions& options, Model* model) {
  for (int link = 0; link < static_cast<int>(model->robot.links.size()); ++link) {
    const std::vector<int>& bodies = model->contact.bodies;
    if (!std::binary_search(bodies.begin(), bodies.end(), model->robot.links[link].body)) continue;
    const auto own = given.find(link);
    const std::vector<Site> sites =
        own != given.end() ? own->second : DefaultSites(model->robot, link, options);
    model->sites.insert(model->sites.end(), sites.begin(), sites.end());
  }
}

}  // namespace

double ReadDefaultFriction(const std::optional<YamlView>& contact) {
  const auto friction = contact ? contact->Find("friction") : std::nullopt;
  return friction ? friction->Number(0, 100) : 0.6;
}

void ReadContact(const std::optional<YamlView>& contact, const SceneNames& names, Model* model) {
  ContactRules& rules = model->contact;
  SiteOptions options;
  SitesByLink sites;
  if (!contact) {
    rules.bodies = ReadBodies(std::nullopt, model->robot);
    return FillSites(sites, options, model);
  }
  contact->AllowKeys({"epsilon_m", "friction", "generators", "model", "skin_m", "seam_m",
                      "may_touch", "bodies", "site_spacing_m", "sites"});
  if (const auto view = contact->Find("epsilon_m")) rules.epsilon = view->Number(1e-6, 10);
  if (const auto view = contact->Find("skin_m")) rules.skin = view->Number(0, 1);
  if (const auto view = contact->Find("seam_m")) rules.seam = view->Number(1e-9, 1);
  if (const auto view = contact->Find("generators")) rules.generators = view->Integer(3, 64);
  if (const auto view = contact->Find("model")) {
    rules.model =
        view->Choice({"sites", "nearest"}) == 0 ? ContactModel::kSites : ContactModel::kNearest;
  }
  if (const auto view = contact->Find("site_spacing_m")) options.spacing = view->Number(1e-3, 10);
  rules.bodies = ReadBodies(contact->Find("bodies"), model->robot);
  if (const auto view = contact->Find("may_touch")) {
    rules.may_touch = ReadMayTouch(*view, names, model->robot);
  }
  if (const auto view = contact->Find("sites")) sites = ReadSiteMap(*view, *model);
  FillSites(sites, options, model);
}

}  // namespace cguide::numeric::io
