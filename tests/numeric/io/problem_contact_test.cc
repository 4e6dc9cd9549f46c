#include <set>

#include "cguide/numeric/sites.h"
#include "tests/numeric/io/problem_tools.h"

namespace cguide::numeric::io {
namespace {

std::vector<Site> SitesOn(const Model& model, const std::string& link) {
  std::vector<Site> sites;
  for (const Site& site : model.sites) {
    if (site.link == FindLink(model.robot, link)) sites.push_back(site);
  }
  return sites;
}

TEST_CASE("all rules of contact are read") {
  const LegProblem leg;
  const ContactRules rules =
      leg.Read(
             "contact: {epsilon_m: 0.03, friction: 0.5, generators: 8, model: nearest, skin_m: "
             "0.002, "
             "seam_m: 0.01, may_touch: [], bodies: all, site_spacing_m: 0.5, sites: {}}\n")
          .model.contact;
  CHECK(rules.epsilon == 0.03);
  CHECK(rules.generators == 8);
  CHECK(rules.model == ContactModel::kNearest);
  CHECK(rules.skin == 0.002);
  CHECK(rules.seam == 0.01);
  CHECK(rules.may_touch.empty());
}

TEST_CASE("sites are the defaults at the spacing asked for, sorted by link") {
  const LegProblem leg;
  const Model wide = leg.Read("contact: {site_spacing_m: 0.5}\n").model;
  const Model usual = leg.Read("").model;
  CHECK(usual.sites.size() > wide.sites.size());
  for (const char* link : {"trunk", "badge", "thigh", "shank", "wheel"}) {
    const int index = FindLink(usual.robot, link);
    CHECK(SitesOn(usual, link) == DefaultSites(usual.robot, index, {}));
    CHECK(SitesOn(wide, link) == DefaultSites(wide.robot, index, {0.5}));
  }
  CHECK(std::is_sorted(usual.sites.begin(), usual.sites.end(),
                       [](const Site& a, const Site& b) { return a.link < b.link; }));
}

TEST_CASE("sites of the file replace the defaults of their link alone; none is a choice too") {
  const LegProblem leg;
  const Model model = leg.Read(
                             "contact: {sites: {shank: [[0, 0, -0.35], {xyz_m: [0.02, 0, -0.2], "
                             "radius_m: 0.01}], thigh: []}}\n")
                          .model;
  const int shank = FindLink(model.robot, "shank");
  const std::vector<Site> expected = {{shank, {0, 0, -0.35}, 0}, {shank, {0.02, 0, -0.2}, 0.01}};
  CHECK(SitesOn(model, "shank") == expected);
  CHECK(SitesOn(model, "thigh").empty());
  CHECK(SitesOn(model, "trunk").size() >= 8);
}

TEST_CASE("a site may be up to a millimetre off its body, the links welded to it included") {
  const LegProblem leg;
  leg.Read("contact: {sites: {shank: [[0, 0, -0.3509]]}}\n");
  const std::string message = leg.Message("contact: {sites: {shank: [[0, 0, -0.3511]]}}\n");
  CHECK(Contains(message, "contact.sites.shank[0]"));
  CHECK(Contains(message, "0.0011"));
  // On the badge, given in the trunk's frame and in its own; its ball ends at 0.25.
  leg.Read("contact: {sites: {trunk: [[0.2505, 0, 0]]}}\n");
  leg.Read("contact: {sites: {badge: [[0.0505, 0, 0], [-0.4, 0, 0]]}}\n");
  leg.Message("contact: {sites: {trunk: [[0.2515, 0, 0]]}}\n");
}

TEST_CASE("bodies are named by any of their links; only they have sites") {
  const LegProblem leg;
  const Model model = leg.Read("contact: {bodies: [wheel, badge]}\n").model;
  CHECK(model.contact.bodies == std::vector<int>{0, 3});
  std::set<int> links;
  for (const Site& site : model.sites) links.insert(site.link);
  CHECK(links == std::set<int>{FindLink(model.robot, "trunk"), FindLink(model.robot, "badge"),
                               FindLink(model.robot, "wheel")});
}

TEST_CASE("pairs that may touch are sorted, without repeats") {
  const LegProblem leg;
  const Model model =
      leg.Read(
             "contact: {may_touch: [[wheel, b], [wheel, a], [badge, b], [trunk, b]]}\n"
             "scene: [{name: a, sphere: {radius_m: 1}}, {name: b, sphere: {radius_m: "
             "1}}]\n")
          .model;
  const std::vector<std::pair<int, int>> expected = {{0, 1}, {3, 0}, {3, 1}};
  CHECK(model.contact.may_touch == expected);
}

}  // namespace
}  // namespace cguide::numeric::io
