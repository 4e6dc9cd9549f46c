#include <catch2/catch.hpp>
#include <fstream>
#include <sstream>

#include "cguide/exact/core/error.h"
#include "cguide/verify/check/certificate.h"

namespace cguide::check {
namespace {

/** A body of one box above a floor, one waypoint, and a proof without content. */
const std::string kGood = R"({"schema": "cguide-certificate/1",
"model": {"schema": "cguide-model/1", "gravity": [0, 0, -9.81], "require": "contact",
"self_collision": true,
"contact": {"epsilon": 0.04, "skin": 0, "seam": 0.001, "generators": 4, "model": "sites",
 "may_touch": [], "bodies": [0]},
"robot": "block", "links": [{"name": "block", "mass": 1, "com": [0, 0, 0], "shapes":
 [{"p": [0, 0, 0], "q": [0, 0, 0, 1], "box": {"size": [0.2, 0.2, 0.2]}}]}], "joints": [],
"objects": [{"name": "floor", "friction": 0.6, "pieces":
 [{"p": [0, 0, 0], "q": [0, 0, 0, 1], "halfspace": {"normal": [0, 0, 1], "offset": 0}}]}],
"sites": [{"link": 0, "x": [0.1, 0.1, -0.1], "radius": 0}], "self_pairs": []},
"path": {"joint_names": [], "waypoints": [[0, 0, 0.11, 0, 0, 0, 1]]},
"tool": "by hand",
"proofs": [{"edge": 0, "tree": {"balance": {"contacts": [{"site": 0, "piece": 0, "flat": {}}],
 "forces": []}}}]}
)";

std::string Refusal(const std::string& text) {
  try {
    ParseCertificate(text);
  } catch (const Error& e) {
    CHECK(e.code() == Error::Code::kBadInput);
    return e.what();
  }
  return {};
}

std::string With(const std::string& from, const std::string& to) {
  std::string text = kGood;
  const std::size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

}  // namespace

TEST_CASE("A certificate written by hand is read") {
  const Certificate certificate = ParseCertificate(kGood);
  CHECK(certificate.tool == "by hand");
  CHECK(certificate.model.objects[0].name == "floor");
  REQUIRE(certificate.proofs.size() == 1);
  CHECK(certificate.proofs[0].root.balance->contacts[0].flat);
}

TEST_CASE("Malformed certificates are refused with the place named") {
  struct Case {
    std::string text, says;
  };
  const Case cases[] = {
      {"", "not JSON"},
      {kGood.substr(0, kGood.size() / 2), "not JSON"},
      {"[1, 2]", "an object is expected"},
      {With("certificate/1", "certificate/2"), "/schema"},
      {With("\"tool\"", "\"tool\": 1, \"tool\""), "twice"},
      {With("\"tool\"", "\"toll\""), "unknown"},
      {With("0.04", "1e400"), "not JSON"},
      {With("0.04", "NaN"), "not JSON"},
      {With("0.04", "1e12"), "beyond 1e9"},
      {With("[0, 0, 0.11, 0, 0, 0, 1]", "[0, 0, 0.11, 0, 0, 0]"), "/path/waypoints/0"},
      {With("\"site\": 0", "\"site\": 1"), "/proofs/0/tree/balance/contacts/0/site"},
      {With("\"piece\": 0", "\"piece\": -1"), "/proofs/0/tree/balance/contacts/0/piece"},
      {With("\"flat\": {}", "\"flat\": {\"triangles\": [0]}"), "triangles"},
      {With("\"flat\": {}", "\"flat\": {\"face\": 6}"), "face"},
      {With("\"flat\": {}", "\"flat\": {}, \"near\": {}"), "one of"},
      {With("\"flat\": {}", "\"near\": {\"corners\": [[0, 1, 2]]}"), "[index, weight]"},
      {With("\"flat\": {}", "\"near\": {\"corners\": [[0, \"1\"]]}"), "a number"},
      {With("\"forces\": []", "\"forces\": [[0, 1, 2]]"), "a force is"},
      {With("\"forces\": []", "\"forces\": [[1, 0, 0, 1, 1, 0]]"), "names nothing"},
      {With("\"edge\": 0", "\"edge\": -1"), "/proofs/0/edge"},
      {With("{\"balance\"", "{\"halves\": [{}], \"balance\""), "two halves"},
      {With("{\"balance\"", "{\"apart\": [[0, 3, [0, 0, 1]]], \"balance\""), "/apart/0/1"},
      {With("{\"balance\"", "{\"apart\": [[0, 0, [0, 0]]], \"balance\""), "three to five"},
      {With("{\"balance\"", "{\"above\": [[[0, 0, 1, 0]]], \"balance\""), "a plane and the shapes"},
      {With("{\"balance\"", "{\"above\": [[[0, 0, 1, 0, 0], 0]], \"balance\""), "does not move"},
      {With("{\"balance\"", "{\"above\": [[[0, 0], 0]], \"balance\""), "three to five"},
      {With("{\"balance\"", "{\"above\": [[[0, 0, 1], 0, 1]], \"balance\""), "/above/0/2"},
      {With("{\"balance\"", "{\"above\": [[0, 0]], \"balance\""), "/above/0/0"},
      {With("\"size\": [0.2, 0.2, 0.2]", "\"size\": [0.2, -0.2, 0.2]"), "must be positive"},
      {With("\"mass\": 1", "\"mass\": 0"), "total mass"},
      {With("\"bodies\": [0]", "\"bodies\": [1]"), "does not exist"},
  };
  for (const Case& c : cases) {
    CAPTURE(c.text);
    CHECK_THAT(Refusal(c.text), Catch::Contains(c.says));
  }
}

TEST_CASE("Deep nesting is refused before it can hurt") {
  std::string deep = "{\"halves\": [{}, {}]}";
  for (int i = 0; i < 60; ++i) deep = "{\"halves\": [" + deep + ", {}]}";
  CHECK(Refusal(With("{\"balance\"", deep.substr(0, deep.size() - 1) + ", \"balance\"")) == "");
  for (int i = 0; i < 60; ++i) deep = "{\"halves\": [" + deep + ", {}]}";
  CHECK_THAT(Refusal(With("{\"balance\"", deep.substr(0, deep.size() - 1) + ", \"balance\"")),
             Catch::Contains("200 levels"));
  const std::string bomb(5000000, '[');
  CHECK_THAT(Refusal(bomb), Catch::Contains("200 levels"));
}

}  // namespace cguide::check
