#include "cguide/verify/view.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "cguide/exact/core/error.h"
#include "cguide/verify/report/assets_internal.h"
#include "cguide/verify/report/page_data_internal.h"
#include "cguide/verify/report/text_internal.h"

namespace cguide::verify {
namespace {

using report::EscapeHtml;

[[noreturn]] void Refuse(const std::string& place, const std::string& why) {
  throw Error(Error::Code::kInvalidArgument, "RenderPage: " + place + ": " + why);
}

void CheckIndex(int i, std::size_t count, const std::string& place, const char* what) {
  if (i < 0 || static_cast<std::size_t>(i) >= count) {
    Refuse(place, std::string(what) + " " + std::to_string(i) + " does not exist; there are " +
                      std::to_string(count));
  }
}

void CheckInstant(const ViewInput& input, int edge, double s, const std::string& place) {
  const std::size_t waypoints = input.path.waypoints.size();
  CheckIndex(edge, std::max<std::size_t>(2, waypoints) - 1, place, "edge");
  if (!(s >= 0 && s <= 1)) Refuse(place, "s = " + std::to_string(s) + " is outside [0,1]");
}

void CheckFrame(const ViewInput& input, const ViewFrame& frame, const std::string& place) {
  const std::size_t bodies = input.model.robot.bodies.size();
  CheckInstant(input, frame.edge, frame.s, place);
  if (frame.X_WB.size() != bodies) {
    Refuse(place, "it has " + std::to_string(frame.X_WB.size()) + " poses for " +
                      std::to_string(bodies) + " bodies");
  }
  bool finite = frame.com_W.allFinite();
  for (const ViewPose& X : frame.X_WB) finite = finite && X.R.allFinite() && X.p.allFinite();
  for (const Eigen::Vector2d& p : frame.support_W) finite = finite && p.allFinite();
  for (const ViewContact& contact : frame.contacts) {
    finite = finite && contact.point_W.allFinite() && contact.normal_W.allFinite() &&
             std::isfinite(contact.friction);
    CheckIndex(contact.body, bodies, place, "body");
    CheckIndex(contact.object, input.model.objects.size(), place, "object");
  }
  if (!finite) Refuse(place, "a coordinate is NaN or infinite");
  for (const int body : frame.marked_bodies) CheckIndex(body, bodies, place, "body");
}

void CheckInput(const ViewInput& input) {
  const std::size_t edges = std::max<std::size_t>(2, input.path.waypoints.size()) - 1;
  if (!input.proved_edges.empty() && input.proved_edges.size() != edges) {
    Refuse("proved_edges",
           std::to_string(input.proved_edges.size()) + " for " + std::to_string(edges) + " edges");
  }
  if (input.frames.empty()) Refuse("frames", "there are none; give at least one instant");
  for (std::size_t i = 0; i < input.frames.size(); ++i) {
    const std::string place = "frame " + std::to_string(i);
    const ViewFrame& frame = input.frames[i];
    CheckFrame(input, frame, place);
    if (i == 0) continue;
    const ViewFrame& last = input.frames[i - 1];
    if (std::pair(frame.edge, frame.s) < std::pair(last.edge, last.s)) {
      Refuse(place, "it lies before the frame that precedes it; order them by edge and s");
    }
  }
  for (std::size_t i = 0; i < input.worst.size(); ++i) {
    CheckInstant(input, input.worst[i].edge, input.worst[i].s, "worst " + std::to_string(i));
  }
}

bool AllProved(const ViewInput& input) {
  const auto& proved = input.proved_edges;
  return input.verdict != Verdict::kFails && !proved.empty() &&
         std::all_of(proved.begin(), proved.end(), [](bool p) { return p; });
}

std::string VerdictName(const ViewInput& input) {
  if (AllProved(input)) return "proved";
  switch (input.verdict) {
    case Verdict::kHolds:
      return "holds";
    case Verdict::kFails:
      return "fails";
    case Verdict::kUndecided:
      return "undecided";
  }
  return "undecided";
}

std::string Headline(const ViewInput& input) {
  if (AllProved(input)) return "Proved for every instant";
  switch (input.verdict) {
    case Verdict::kHolds:
      return "Holds at every instant that was sampled";
    case Verdict::kFails:
      return "Fails";
    case Verdict::kUndecided:
      break;
  }
  return "Undecided";
}

std::string Rounded(double x, int digits) {
  if (std::isnan(x)) return "n/a";
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out.precision(digits);
  out << x;
  return out.str();
}

// Lengths below a decimetre read better in millimetres.
std::string Quantity(double value, const std::string& unit) {
  const bool small = unit == "m" && std::abs(value) < 0.0995;
  const std::string shown = small ? "mm" : unit;
  return Rounded(small ? 1000 * value : value, 3) +
         (shown.empty() ? "" : "&thinsp;" + EscapeHtml(shown));
}

std::string ProvenanceList(const ViewInput& input) {
  std::string out;
  for (const auto& [label, text] : input.provenance) {
    out += "<dt>" + EscapeHtml(label) + "</dt><dd>" + EscapeHtml(text) + "</dd>\n";
  }
  return out;
}

std::string WorstRows(const ViewInput& input) {
  if (input.worst.empty()) return "<tr><td class=\"none\">None were given.</td></tr>\n";
  const report::PathClock clock(input.path);
  std::string out;
  for (const ViewInstant& instant : input.worst) {
    const int frame = report::NearestFrame(input, clock, instant.edge, instant.s);
    out += "<tr data-frame=\"" + std::to_string(frame) + "\" tabindex=\"0\"><td class=\"kind\">" +
           EscapeHtml(instant.kind) + "</td><td class=\"number\">" + std::to_string(instant.edge) +
           " &middot; " + Rounded(instant.s, 3) + "</td><td class=\"number\">" +
           Quantity(instant.value, instant.unit) + "</td><td class=\"text\">" +
           EscapeHtml(instant.text) + "</td></tr>\n";
  }
  return out;
}

constexpr const char* kProvedLegend = "<span><i class=\"held\"></i>proved for every s</span>";
constexpr const char* kNothingBetween = "between two of them nothing is claimed";
constexpr const char* kProvedBetween =
    "of what lies between two of them nothing is claimed but where the line above the strip says "
    "that the edge is proved";

}  // namespace

std::string RenderPage(const ViewInput& input) {
  CheckInput(input);
  const report::PageData data = report::PackPageData(input);
  return report::FillTemplate(report::kPageHtml, [&](std::string_view name) -> std::string {
    if (name == "title") return EscapeHtml(input.title);
    if (name == "verdict") return VerdictName(input);
    if (name == "legend") return input.proved_edges.empty() ? "" : kProvedLegend;
    if (name == "between") return input.proved_edges.empty() ? kNothingBetween : kProvedBetween;
    if (name == "headline") return Headline(input);
    if (name == "tested") return EscapeHtml(input.tested);
    if (name == "summary") return EscapeHtml(input.summary);
    if (name == "provenance") return ProvenanceList(input);
    if (name == "worst") return WorstRows(input);
    if (name == "frames") return std::to_string(input.frames.size());
    if (name == "css") return std::string(report::kPageCss);
    if (name == "json") return data.json;
    if (name == "blob") return data.blob;
    if (name == "script") return std::string(report::kPageJs);
    throw Error(Error::Code::kInternal,
                "the page's template has no value for " + std::string(name));
  });
}

}  // namespace cguide::verify
