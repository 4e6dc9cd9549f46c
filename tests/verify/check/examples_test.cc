#include <catch2/catch.hpp>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/io/guide_io.h"
#include "cguide/verify/certificate_writer.h"
#include "cguide/verify/check/check.h"

// The certificates that verify/FORMAT.md works by hand.
namespace cguide::check {
namespace {

using nlohmann::json;

std::string ReadExample(const std::string& name) {
  std::ifstream file(CGUIDE_FIXTURES "/certificates/" + name);
  REQUIRE(file);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

bool IsProved(const json& certificate, int bits = 0) {
  try {
    return CheckCertificate(ParseCertificate(certificate.dump()), {bits}).IsProved();
  } catch (const Error&) {
    return false;
  }
}

}  // namespace

TEST_CASE("The examples of the format are proved, in doubles and in MPFR numbers") {
  for (const char* name : {"block.json", "standing.json", "kinds.json"}) {
    for (const int bits : {0, 53, 300}) CHECK(IsProved(json::parse(ReadExample(name)), bits));
  }
}

TEST_CASE("Nothing of the examples' proofs can be left out") {
  for (const char* name : {"block.json", "standing.json"}) {
    const json whole = json::parse(ReadExample(name));
    const json& tree = whole["proofs"][0]["tree"];
    const auto without = [&](const std::string& pointer) {
      json mutant = whole;
      const json::json_pointer place("/proofs/0/tree" + pointer);
      json& parent = mutant[place.parent_pointer()];
      if (parent.is_array()) parent.erase(std::stoul(place.back()));
      if (parent.is_object()) parent.erase(place.back());
      return mutant;
    };
    for (const auto& [key, value] : tree.items()) CHECK(!IsProved(without("/" + key)));
    for (const char* list : {"apart", "balance/contacts", "balance/forces"}) {
      const json::json_pointer place(std::string("/") + list);
      if (!tree.contains(place)) continue;
      for (std::size_t i = 0; i < tree[place].size(); ++i) {
        CAPTURE(name, list, i);
        CHECK(!IsProved(without(std::string("/") + list + "/" + std::to_string(i))));
      }
    }
  }
}

TEST_CASE("Of every kind of evidence in one certificate none holds with a wrong number") {
  const json whole = json::parse(ReadExample("kinds.json"));
  const auto is_proved_with = [&](const std::string& pointer, const json& value) {
    json mutant = whole;
    mutant[json::json_pointer("/proofs/0" + pointer)] = value;
    return IsProved(mutant);
  };
  const std::string contacts = "/tree/halves/0/balance/contacts/";
  CHECK(is_proved_with("/tree/apart/0/2/3", 15.02));
  CHECK(!is_proved_with("/tree/apart/0/2/3", 14.9));  // below the wedge
  CHECK(!is_proved_with("/tree/apart/0/2/3", 15.8));  // above the ball
  CHECK(!is_proved_with("/outside", json::array()));
  CHECK(!is_proved_with("/outside/0/0", 0));
  CHECK(!is_proved_with("/outside/0/1", 2));
  CHECK(!is_proved_with(contacts + "1/flat/face", 5));
  CHECK(!is_proved_with(contacts + "2/flat/triangles", {2}));
  CHECK(!is_proved_with(contacts + "2/flat/side", -1));
  CHECK(!is_proved_with(contacts + "3/flat/triangles/1", 0));
  CHECK(!is_proved_with(contacts + "4/near/y/2", 0.5));
  CHECK(!is_proved_with(contacts + "5/near/y/2", 0.25));
  CHECK(!is_proved_with(contacts + "6/near/y/1", 0.25));
  CHECK(!is_proved_with(contacts + "7/near/corners/0/0", 1));
  CHECK(is_proved_with(contacts + "8/patch/plane/3", 0.501));
  CHECK(!is_proved_with(contacts + "8/patch/plane/3", 0.499));  // the face rises above it
  CHECK(!is_proved_with(contacts + "8/patch/plane/0", 0.1));
  CHECK(!is_proved_with(contacts + "8/patch/slack", -1e-3));
  CHECK(!is_proved_with(contacts + "8/patch/slack", 0.02));
  CHECK(!is_proved_with(contacts + "8/patch/parts/0/triangle", 2));
  CHECK(!is_proved_with(contacts + "8/patch/parts/1/piece", 3));
  CHECK(!is_proved_with(contacts + "8/patch/parts/1/until", 0.9));
  for (int i = 0; i < 8; ++i) {
    CHECK(!is_proved_with(contacts + std::to_string(i) + "/site", (i + 1) % 8));
    CHECK(!is_proved_with(contacts + std::to_string(i) + "/piece", (i + 1) % 8));
  }
}

TEST_CASE(
    "A plane for all pieces behind it is as good as one for a pair, and no number of it is free") {
  json whole = json::parse(ReadExample("block.json"));
  json& tree = whole["proofs"][0]["tree"];
  tree.erase("apart");
  CHECK(!IsProved(whole));
  // The cube is above x + y = -0.4 in -n, the post's corner at -0.459.
  tree["above"] = json::parse("[[[-1, -1, 0, -0.43], 0]]");
  for (const int bits : {0, 128}) CHECK(IsProved(whole, bits));
  const Certificate read = ParseCertificate(whole.dump());
  const std::string text = verify::WriteCertificate(read.model, read.path, "", {&read.proofs[0]});
  CHECK(IsProved(json::parse(text)));
  const auto is_proved_with = [&](const std::string& place, const json& value) {
    json mutant = whole;
    mutant[json::json_pointer("/proofs/0/tree/above/0" + place)] = value;
    return IsProved(mutant);
  };
  CHECK(is_proved_with("/0/3", -0.45));
  CHECK(!is_proved_with("/0/3", -0.46));  // the post's corner is above
  CHECK(!is_proved_with("/0/3", -0.39));  // and the cube's
  CHECK(!is_proved_with("/0/0", 1));
  CHECK(!is_proved_with("/0/1", -1.5));
  CHECK(!is_proved_with("/0/2", 2));
  CHECK(!is_proved_with("/1", 1));  // there is no such shape
}

TEST_CASE("The examples do not prove what is false") {
  const auto altered = [](const char* name, const std::string& pointer, const json& value) {
    json mutant = json::parse(ReadExample(name));
    mutant[json::json_pointer(pointer)] = value;
    return IsProved(mutant);
  };
  CHECK(altered("block.json", "/path/waypoints/1/0", 0.12));
  CHECK(!altered("block.json", "/path/waypoints/1/0", 0.2));   // into the post
  CHECK(!altered("block.json", "/path/waypoints/1/2", 0.1));   // onto the floor
  CHECK(!altered("block.json", "/path/waypoints/1/2", 0.14));  // eps above it
  CHECK(!altered("block.json", "/model/contact/bodies", json::array()));
  CHECK(!altered("standing.json", "/model/objects/0/friction", 0.49));
  CHECK(altered("standing.json", "/model/objects/0/friction", 0.51));
  CHECK(altered("standing.json", "/model/links/0/com", {0.01, 0, 0.5}));
  CHECK(!altered("standing.json", "/model/links/0/com", {0.1, 0, 0}));
  CHECK(!altered("standing.json", "/model/gravity", {0, 0, 10}));
  CHECK(!altered("standing.json", "/model/links/0/mass", 5));
}

TEST_CASE("What is written of an example is read as the same certificate") {
  for (const char* name : {"block.json", "standing.json", "kinds.json"}) {
    const Certificate first = ParseCertificate(ReadExample(name));
    const auto write = [](const Certificate& c) {
      return verify::WriteCertificate(c.model, c.path, c.tool, {&c.proofs[0]});
    };
    const std::string text = write(first);
    const Certificate second = ParseCertificate(text);
    CHECK(second.model == first.model);
    CHECK(second.path.waypoints == first.path.waypoints);
    CHECK(write(second) == text);
    CHECK(IsProved(json::parse(text)));
    CHECK(HasModelText(text, numeric::io::WriteModel(first.model)));
  }
}

}  // namespace cguide::check
