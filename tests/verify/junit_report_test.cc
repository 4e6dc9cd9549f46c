#include <tinyxml2.h>

#include <catch2/catch.hpp>
#include <map>
#include <set>

#include "cguide/verify/ci_report.h"
#include "tests/verify/every_outcome.h"

namespace cguide::verify {
namespace {

using tinyxml2::XMLElement;

std::string Report() {
  const AuditSubject subject{"guides/" + test::kHostileName + ".json", "room.yaml", "sha256:0",
                             "1"};
  return WriteJunit(subject, ChecksOf(test::HostileModel(), test::EveryOutcome()));
}

// What Jenkins' junit-10.xsd and Surefire's surefire-test-report.xsd ask of the elements that are
// used: those elements, these attributes and no others.
void CheckElement(const XMLElement& element, const std::set<std::string>& attributes,
                  const std::set<std::string>& children) {
  CAPTURE(element.Name());
  std::set<std::string> found;
  for (auto a = element.FirstAttribute(); a != nullptr; a = a->Next()) found.insert(a->Name());
  CHECK(found == attributes);
  for (auto child = element.FirstChildElement(); child; child = child->NextSiblingElement()) {
    CAPTURE(child->Name());
    CHECK(children.count(child->Name()) == 1);
  }
}

TEST_CASE("the report has the elements and attributes of the published schemas") {
  tinyxml2::XMLDocument document;
  REQUIRE(document.Parse(Report().c_str()) == tinyxml2::XML_SUCCESS);
  const XMLElement* suites = document.RootElement();
  REQUIRE(std::string(suites->Name()) == "testsuites");
  CheckElement(*suites, {"name", "tests", "failures", "errors"}, {"testsuite"});
  const XMLElement* suite = suites->FirstChildElement();
  CHECK(suite->NextSiblingElement() == nullptr);
  CheckElement(*suite, {"name", "tests", "failures", "errors", "skipped", "time"},
               {"properties", "testcase"});
  const XMLElement* properties = suite->FirstChildElement();
  CheckElement(*properties, {}, {"property"});
  for (auto p = properties->FirstChildElement(); p; p = p->NextSiblingElement()) {
    CheckElement(*p, {"name", "value"}, {});
  }
  std::map<std::string, int> count;
  std::set<std::string> names;
  for (auto c = suite->FirstChildElement("testcase"); c; c = c->NextSiblingElement()) {
    CheckElement(*c, {"name", "classname", "time"}, {"failure", "error", "skipped"});
    CHECK(names.insert(c->Attribute("name")).second);
    ++count["tests"];
    const XMLElement* finding = c->FirstChildElement();
    if (finding == nullptr) continue;
    CHECK(finding->NextSiblingElement() == nullptr);
    ++count[finding->Name()];
    const bool skipped = std::string(finding->Name()) == "skipped";
    CheckElement(
        *finding,
        skipped ? std::set<std::string>{"message"} : std::set<std::string>{"message", "type"}, {});
  }
  CHECK(count["tests"] == suite->IntAttribute("tests"));
  CHECK(count["failure"] == suite->IntAttribute("failures"));
  CHECK(count["error"] == suite->IntAttribute("errors"));
  CHECK(count["skipped"] == suite->IntAttribute("skipped"));
  CHECK(count ==
        std::map<std::string, int>{{"tests", 15}, {"failure", 4}, {"error", 4}, {"skipped", 1}});
}

TEST_CASE("a refutation names place and bodies, what is undecided is an error with its reason") {
  tinyxml2::XMLDocument document;
  REQUIRE(document.Parse(Report().c_str()) == tinyxml2::XML_SUCCESS);
  std::map<std::string, const XMLElement*> cases;
  const XMLElement* suite = document.RootElement()->FirstChildElement();
  for (auto c = suite->FirstChildElement("testcase"); c; c = c->NextSiblingElement()) {
    cases[c->Attribute("name")] = c->FirstChildElement();
  }
  const std::string failure = cases.at("edge 1: collision")->Attribute("message");
  CHECK(failure.find("s = 0.375: ") == 0);
  CHECK(failure.find("floor a<b>&\"'\\]]>") != std::string::npos);
  CHECK(std::string(cases.at("edge 1: collision")->GetText()).find(failure.substr(0, 20)) == 0);
  CHECK(std::string(cases.at("edge 1: collision")->Attribute("type")) == "collision");
  CHECK(std::string(cases.at("edge 3: balance")->Name()) == "error");
  const std::string open = cases.at("edge 3: balance")->Attribute("message");
  CHECK(open.find("undecided, s = 0.125: only corners") == 0);
  CHECK(std::string(cases.at("edge 4: balance")->Attribute("type")) == "interrupted");
  CHECK(std::string(cases.at("edge 1: balance")->Name()) == "skipped");
  CHECK(cases.at("edge 0: collision") == nullptr);
}

TEST_CASE("the XML holds no byte that XML forbids, and the same audit gives the same bytes") {
  const std::string text = Report();
  CHECK(text == Report());
  for (const char c : text) CHECK((static_cast<unsigned char>(c) >= 0x20 || c == '\n'));
  CHECK(text.find('\xff') == std::string::npos);
  CHECK(text.find("\xEF\xBF\xBF") == std::string::npos);
  CHECK(text.find("\xC3\xA9") != std::string::npos);
}

}  // namespace
}  // namespace cguide::verify
