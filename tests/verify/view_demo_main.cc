// view_demo FILE [--hostile]: writes the demonstration page, to look at it or to load it in a
// browser's test; with --hostile every text tries to break out of its place.
#include <fstream>
#include <iostream>

#include "tests/verify/view_demo.h"

namespace {

void MakeHostile(cguide::verify::ViewInput* input) {
  const std::string text =
      "</script><img src=x onerror=\"document.documentElement.dataset.hacked=1\">'\"><script>"
      "document.documentElement.dataset.hacked=2</script>";
  input->title = input->summary = input->tested = input->model.robot.name = text;
  for (auto& [label, value] : input->provenance) label = value = text;
  for (cguide::Link& link : input->model.robot.links) link.name = text;
  for (cguide::Body& body : input->model.robot.bodies) body.name = text;
  for (cguide::Object& object : input->model.objects) object.name = text;
  for (cguide::verify::ViewFrame& frame : input->frames) frame.note = text;
  for (cguide::verify::ViewInstant& instant : input->worst) {
    instant.kind = instant.text = instant.unit = text;
  }
}

}  // namespace

int main(int argc, char** argv) {
  const bool hostile = argc == 3 && std::string(argv[2]) == "--hostile";
  if (argc != 2 && !hostile) {
    std::cerr << "usage: view_demo page.html [--hostile]\n";
    return 2;
  }
  cguide::verify::ViewInput input = cguide::verify::DemoInput();
  if (hostile) MakeHostile(&input);
  std::ofstream file(argv[1], std::ios::binary);
  file << cguide::verify::RenderPage(input);
  file.close();
  return file ? 0 : 1;
}
