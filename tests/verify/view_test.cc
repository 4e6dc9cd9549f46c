#include "cguide/verify/view.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <regex>

#include "cguide/exact/core/error.h"
#include "tests/verify/page_reader.h"
#include "tests/verify/view_demo.h"

namespace cguide::verify {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// The page without the content of its scripts, of which the bundled library is one.
std::string WithoutScripts(std::string html) {
  for (std::size_t at = html.find("<script"); at != std::string::npos;
       at = html.find("<script", at + 1)) {
    const std::size_t start = html.find('>', at) + 1;
    html.erase(start, html.find("</script", start) - start);
  }
  return html;
}

std::string MessageOf(const ViewInput& input) {
  try {
    RenderPage(input);
  } catch (const Error& error) {
    CHECK(error.code() == Error::Code::kInvalidArgument);
    return error.what();
  }
  return "";
}

TEST_CASE("the page is a document whose elements nest and close") {
  const std::string html = RenderPage(DemoInput());
  CHECK(html.starts_with("<!doctype html>"));
  const std::vector<std::string> tags = ReadTags(html);
  CHECK(std::count(tags.begin(), tags.end(), "script") == 3);
  CHECK(std::count(tags.begin(), tags.end(), "tr") == 1 + 3);
}

TEST_CASE("the page names no other resource and forbids requests") {
  const std::string html = RenderPage(DemoInput());
  const std::string outside = WithoutScripts(html);
  CHECK(outside.find("default-src 'none'") != std::string::npos);
  CHECK_FALSE(
      std::regex_search(outside, std::regex("https?:|//[a-z]|@import|url\\(|<img|<iframe")));
  CHECK_FALSE(std::regex_search(outside, std::regex("\\bsrc=|\\bhref=\"(?!data:,\")")));
  // A bundle that was not resolved would load its parts at run time.
  CHECK(html.find("three.module.js") == std::string::npos);
}

TEST_CASE("the page claims samples and nothing beyond them") {
  const std::regex claim("\\bproved\\b", std::regex::icase);
  const std::string html = RenderPage(DemoInput());
  CHECK_FALSE(std::regex_search(WithoutScripts(html), claim));
  std::string folded = html;
  std::transform(folded.begin(), folded.end(), folded.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  CHECK(folded.find("proved") == std::string::npos);
  ViewInput input = DemoInput();
  input.verdict = Verdict::kHolds;
  CHECK(RenderPage(input).find("<h1>Holds at every instant that was sampled</h1>") !=
        std::string::npos);
}

TEST_CASE("the verdict of the guide stands on the page as it was given") {
  ViewInput input = DemoInput();
  const std::pair<Verdict, std::string> cases[] = {
      {Verdict::kHolds, "holds"}, {Verdict::kFails, "fails"}, {Verdict::kUndecided, "undecided"}};
  for (const auto& [verdict, name] : cases) {
    input.verdict = verdict;
    CHECK(RenderPage(input).find("<html lang=\"en\" data-verdict=\"" + name + "\"") !=
          std::string::npos);
  }
}

TEST_CASE("proofs stand on the page where they were given, and do not outvote a violation") {
  ViewInput input = DemoInput();
  const std::size_t edges = input.path.waypoints.size() - 1;
  input.verdict = Verdict::kHolds;
  input.proved_edges.assign(edges, true);
  std::string html = RenderPage(input);
  CHECK(html.find("data-verdict=\"proved\"") != std::string::npos);
  CHECK(html.find("<h1>Proved for every instant</h1>") != std::string::npos);
  CHECK(html.find(">proved for every s</span>") != std::string::npos);
  CHECK(html.find("between two of them nothing is claimed,") == std::string::npos);
  input.proved_edges[edges - 1] = false;
  html = RenderPage(input);
  CHECK(html.find("data-verdict=\"holds\"") != std::string::npos);
  CHECK(html.find("<h1>Holds at every instant that was sampled</h1>") != std::string::npos);
  std::string held = "\"held\":[";
  for (std::size_t i = 0; i < edges; ++i) held += i + 1 < edges ? "1," : "0]";
  CHECK(html.find(held) != std::string::npos);
  input.proved_edges.assign(edges, true);
  input.verdict = Verdict::kFails;
  CHECK(RenderPage(input).find("data-verdict=\"fails\"") != std::string::npos);
  input.proved_edges.push_back(true);
  CHECK(MessageOf(input).find("proved_edges") != std::string::npos);
}

TEST_CASE("no text of the input changes the page's structure") {
  const std::vector<std::string> expected = ReadTags(RenderPage(DemoInput()));
  const std::string hostile[] = {"</script><img src=x onerror=alert(1)>",
                                 "\"><svg onload=alert(1)>",
                                 "' onclick='alert(1)",
                                 "<!--<script>",
                                 "-->",
                                 "]]>",
                                 "{{script}}{{json}}",
                                 "&lt;b&gt;",
                                 "\xFF\xFE\x00<",
                                 "</title><h1>",
                                 "\xE2\x80\xA8 line separator",
                                 "\\\"},\"frames\":0,{\"",
                                 "</style><style>*{display:none}"};
  for (const std::string& text : hostile) {
    CAPTURE(text);
    ViewInput input = DemoInput();
    input.title = input.summary = input.tested = text;
    input.provenance = {{text, text}, {"a", "b"}, {"c", "d"}, {"e", "f"}, {"g", "h"}};
    input.model.robot.name = text;
    for (Link& link : input.model.robot.links) link.name = text;
    for (Body& body : input.model.robot.bodies) body.name = text;
    for (Object& object : input.model.objects) object.name = text;
    for (ViewFrame& frame : input.frames) frame.note = text;
    for (ViewInstant& instant : input.worst) instant.kind = instant.text = instant.unit = text;
    const std::string html = RenderPage(input);
    CHECK(ReadTags(html) == expected);
    CHECK(html.find("<img") == std::string::npos);
    const PackedPage page(html);
    const std::string name = page.json["bodies"][0]["links"][0]["name"];
    CHECK(name == page.json["objects"][2]["name"].get<std::string>());
    if (text.find('\xFF') == std::string::npos) CHECK(name == text);
  }
}

TEST_CASE("the packed frames are those of the input") {
  const ViewInput input = DemoInput();
  const PackedPage page(RenderPage(input));
  const nlohmann::json& frames = page.json["frames"];
  const std::size_t bodies = input.model.robot.bodies.size();
  REQUIRE(frames["count"] == input.frames.size());
  const std::vector<float> poses = page.Floats(frames["poses"]), com = page.Floats(frames["com"]);
  const std::vector<float> contacts = page.Floats(frames["contacts"]["items"]);
  const std::vector<std::uint32_t> ends = page.Words(frames["contacts"]["ends"]);
  REQUIRE(poses.size() == 7 * bodies * input.frames.size());
  REQUIRE(ends.size() == input.frames.size());
  std::size_t contact = 0;
  for (std::size_t f = 0; f < input.frames.size(); ++f) {
    const ViewFrame& frame = input.frames[f];
    for (std::size_t b = 0; b < bodies; ++b) {
      const float* x = &poses[7 * (f * bodies + b)];
      const Eigen::Matrix3f R = Eigen::Quaternionf(x[6], x[3], x[4], x[5]).toRotationMatrix();
      CHECK((R - frame.X_WB[b].R).cwiseAbs().maxCoeff() < 2e-6f);
      CHECK(Eigen::Vector3f(x[0], x[1], x[2]) == frame.X_WB[b].p);
    }
    for (const ViewContact& expected : frame.contacts) {
      const float* x = &contacts.at(10 * contact++);
      CHECK(x[2] == static_cast<float>(expected.point_W[2]));
      CHECK(x[5] == static_cast<float>(expected.normal_W[2]));
      CHECK(x[6] == static_cast<float>(expected.friction));
      CHECK(std::pair<int, int>(x[7], x[8]) == std::pair(expected.body, expected.object));
      CHECK((x[9] == 1) == expected.certain);
    }
    CHECK(ends[f] == contact);
    CHECK(com[3 * f + 2] == static_cast<float>(frame.com_W[2]));
  }
  CHECK(contact > 8 * input.frames.size());
}

TEST_CASE("margins that were not computed stay unknown") {
  ViewInput input = DemoInput();
  input.frames[3].com_margin.reset();
  input.frames[3].clearance = 0;
  const PackedPage page(RenderPage(input));
  CHECK(std::isnan(page.Floats(page.json["frames"]["comMargin"])[3]));
  CHECK(page.Floats(page.json["frames"]["clearance"])[3] == 0);
  CHECK_FALSE(std::isnan(page.Floats(page.json["frames"]["comMargin"])[2]));
}

TEST_CASE("time is the share of the path's length and never runs backwards") {
  const ViewInput input = DemoInput();
  const PackedPage page(RenderPage(input));
  const std::vector<float> t = page.Floats(page.json["frames"]["t"]);
  CHECK(t.front() == 0);
  CHECK(t.back() < 1);
  CHECK(std::is_sorted(t.begin(), t.end()));
  double whole = 0, before = 0;
  for (std::size_t i = 1; i < input.path.waypoints.size(); ++i) {
    const double edge = Distance(input.path.waypoints[i - 1], input.path.waypoints[i]);
    whole += edge;
    if (i <= 7) before += edge;
  }
  CHECK(page.json["waypoints"][7].get<double>() == Approx(before / whole));
  CHECK(page.json["waypoints"].back().get<double>() == 1);
}

TEST_CASE("a worst instant leads to the frame nearest to it") {
  ViewInput input = DemoInput();
  input.worst = {{"a", 4, 0.34, "", 0, ""},
                 {"b", 4, 1.0, "", 0, ""},
                 {"c", 5, 0.0, "", 0, ""},
                 {"d", 0, 0, "", 0, ""}};
  const std::string html = RenderPage(input);
  const PackedPage page(html);
  CHECK(page.json["worst"][0]["frame"] == 4 * 3 + 1);
  CHECK(page.json["worst"][1]["frame"] == 5 * 3);
  CHECK(page.json["worst"][2]["frame"] == 5 * 3);
  CHECK(page.json["worst"][3]["frame"] == 0);
  CHECK(html.find("<tr data-frame=\"13\"") != std::string::npos);
}

TEST_CASE("shapes stand in their body's frame, fixed joints followed") {
  const ViewInput input = DemoInput();
  const PackedPage page(RenderPage(input));
  const int hand = FindLink(input.model.robot, "left_hand");
  const int body = input.model.robot.links[hand].body;
  REQUIRE(input.model.robot.bodies[body].name == "left_forearm");
  const nlohmann::json& links = page.json["bodies"][body]["links"];
  REQUIRE(links.size() == 2);
  CHECK(links[1]["name"] == "left_hand");
  CHECK(links[1]["shapes"][0]["p"][2].get<double>() == Approx(-0.27 - 0.03));
}

TEST_CASE("every kind of shape reaches the page with its numbers") {
  const ViewInput input = DemoInput();
  const PackedPage page(RenderPage(input));
  std::map<std::string, int> kinds;
  for (const nlohmann::json& object : page.json["objects"]) {
    for (const nlohmann::json& piece : object["pieces"]) ++kinds[piece["kind"]];
  }
  for (const char* kind :
       {"box", "sphere", "cylinder", "capsule", "halfspace", "surface", "solid"}) {
    CAPTURE(kind);
    CHECK(kinds[kind] > 0);
  }
  const nlohmann::json& hull = page.json["bodies"][0]["links"][0]["shapes"][0];
  REQUIRE(hull["kind"] == "hull");
  CHECK(page.Floats(hull["vertices"]).size() == 3 * 8);
  const std::vector<std::uint32_t> triangles = page.Words(hull["triangles"]);
  CHECK(triangles.size() == 3 * 12);
  CHECK(*std::max_element(triangles.begin(), triangles.end()) == 7);
}

TEST_CASE("the same input gives the same bytes") {
  CHECK(RenderPage(DemoInput()) == RenderPage(DemoInput()));
}

TEST_CASE("a single configuration without path or extras is enough") {
  ViewInput input;
  Link link;
  link.name = "stone";
  link.mass = 1;
  input.model.robot.links = {link};
  AssignBodiesAndColumns(&input.model.robot);
  input.frames.resize(1);
  input.frames[0].X_WB.resize(1);
  const PackedPage page(RenderPage(input));
  CHECK(page.Floats(page.json["frames"]["t"]) == std::vector<float>{0});
  CHECK(page.json["length"] == 0);
}

TEST_CASE("a path that does not move keeps its frames in order") {
  ViewInput input = DemoInput();
  for (Configuration& q : input.path.waypoints) q = input.path.waypoints.front();
  const PackedPage page(RenderPage(input));
  const std::vector<float> t = page.Floats(page.json["frames"]["t"]);
  CHECK(std::is_sorted(t.begin(), t.end()));
  CHECK(t[30] == Approx(0.5));
}

TEST_CASE("what cannot be drawn is refused with its place") {
  const std::pair<std::string, std::function<void(ViewInput*)>> cases[] = {
      {"frames: there are none", [](ViewInput* i) { i->frames.clear(); }},
      {"frame 4: it lies before", [](ViewInput* i) { std::swap(i->frames[3], i->frames[4]); }},
      {"frame 2: edge 20 does not exist; there are 20",
       [](ViewInput* i) { i->frames[2].edge = 20; }},
      {"frame 2: edge -1", [](ViewInput* i) { i->frames[2].edge = -1; }},
      {"frame 2: s = 1.5", [](ViewInput* i) { i->frames[2].s = 1.5; }},
      {"frame 2: s = ", [](ViewInput* i) { i->frames[2].s = kNan; }},
      {"frame 5: it has 12 poses for 13 bodies",
       [](ViewInput* i) { i->frames[5].X_WB.pop_back(); }},
      {"frame 5: a coordinate", [](ViewInput* i) { i->frames[5].X_WB[2].R(1, 1) = kNan; }},
      {"frame 5: a coordinate", [](ViewInput* i) { i->frames[5].com_W[0] = INFINITY; }},
      {"frame 5: a coordinate", [](ViewInput* i) { i->frames[5].contacts[0].normal_W[1] = kNan; }},
      {"frame 5: a coordinate", [](ViewInput* i) { i->frames[5].support_W[1][1] = kNan; }},
      {"frame 5: body 13", [](ViewInput* i) { i->frames[5].contacts[0].body = 13; }},
      {"frame 5: object -1", [](ViewInput* i) { i->frames[5].contacts[0].object = -1; }},
      {"frame 5: body 99", [](ViewInput* i) { i->frames[5].marked_bodies = {99}; }},
      {"worst 1: edge 77", [](ViewInput* i) { i->worst[1].edge = 77; }}};
  for (const auto& [message, spoil] : cases) {
    CAPTURE(message);
    ViewInput input = DemoInput();
    spoil(&input);
    CHECK(MessageOf(input).find(message) != std::string::npos);
  }
}

}  // namespace
}  // namespace cguide::verify
