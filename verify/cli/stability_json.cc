#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>

#include "cguide/verify/cli/stability_report.h"

namespace cguide::cli {
namespace {

using Json = nlohmann::ordered_json;

const char* StageName(numeric::StabilityRung rung) {
  switch (rung) {
    case numeric::StabilityRung::kFast:
      return "fast";
    case numeric::StabilityRung::kStored:
      return "exact";
    case numeric::StabilityRung::kBits106:
      return "exact_106_bits";
    case numeric::StabilityRung::kBits256:
      return "exact_256_bits";
    case numeric::StabilityRung::kUndecided:
      break;
  }
  return "none";
}

const char* VerdictName(Verdict verdict) {
  return verdict == Verdict::kHolds   ? "stable"
         : verdict == Verdict::kFails ? "unstable"
                                      : "undecided";
}

Json ToJson(const Eigen::Vector3d& v) { return Json::array({v.x(), v.y(), v.z()}); }

Json Number(double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); }

/** The ends; infinite ones as null. */
Json ToJson(const exact::Enclosure& x) { return Json::array({Number(x.lo), Number(x.hi)}); }

Json ToJson(const exact::EnclosedVector& box) {
  return Json::array({ToJson(box[0]), ToJson(box[1]), ToJson(box[2])});
}

/** Enclosures by component; null where nothing is proved. */
Json GradientJson(const std::optional<numeric::ProvedMarginGradient>& gradient) {
  if (!gradient) return nullptr;
  Json json;
  json["com"] = ToJson(gradient->com_W);
  json["contacts"] = Json::array();
  for (const exact::EnclosedVector& box : gradient->contact_W) {
    json["contacts"].push_back(ToJson(box));
  }
  return json;
}

Json ForcesJson(const StabilityReport& report) {
  Json forces = Json::array();
  const auto add = [&forces](int contact, const Eigen::Vector3d& f) {
    forces.push_back({{"contact", contact}, {"force_n", ToJson(f)}});
  };
  if (report.distribution) {
    for (std::size_t i = 0; i < report.contacts.size(); ++i) {
      const Eigen::Vector3d& f = report.distribution->force_W[i];
      if (!f.isZero(0)) add(static_cast<int>(i), f);
    }
  } else if (report.stability.verdict != Verdict::kFails) {
    for (const numeric::WitnessForce& f : report.forces) add(f.contact, f.weight * f.u_W);
  }
  return forces;
}

Json RegionJson(const numeric::ProvedSupportRegion& region) {
  Json corners = Json::array();
  for (const Eigen::Vector3d& p : region.inner_W) corners.push_back(ToJson(p));
  return corners;
}

Json AcceleratedJson(const AccelerationReport& report) {
  Json json;
  json["acceleration_m_s2"] = ToJson(report.a_W);
  json["verdict"] = VerdictName(report.stability.answer.verdict);
  json["reason"] = report.stability.reason.empty() ? Json(nullptr) : Json(report.stability.reason);
  json["com_margin_enclosure_m"] = ToJson(report.com_margin);
  json["largest_enclosure_m_s2"] = ToJson(report.largest);
  json["support_region_m"] = RegionJson(report.region);
  json["support_region_gap_m"] = Number(report.region.gap);
  return json;
}

}  // namespace

void PrintJson(const std::string& what, const Model& model, const StabilityReport& report) {
  Json json;
  json["schema"] = "cguide-stability/1";
  json["configuration"] = what;
  json["verdict"] = VerdictName(report.stability.verdict);
  json["stage"] = StageName(report.rung);
  json["reason"] = report.reason.empty() ? Json(nullptr) : Json(report.reason);
  json["rank"] = report.rank ? Json(*report.rank) : Json(nullptr);
  json["com_m"] = ToJson(report.com_W);
  json["com_margin_m"] = Number(report.com_margin.lo);
  json["com_margin_enclosure_m"] = ToJson(report.com_margin);
  json["com_margin_gradient"] = GradientJson(report.gradient);
  json["force_margin"] = Number(report.force_margin.lo);
  json["force_margin_enclosure"] = nullptr;
  if (report.force_checked) json["force_margin_enclosure"] = ToJson(report.force_margin);
  json["contacts"] = Json::array();
  for (const numeric::Contact& c : report.contacts) {
    Json contact;
    contact["body"] = model.robot.bodies[c.body].name;
    contact["object"] = model.objects[c.object].name;
    contact["point_m"] = ToJson(c.force_point_W());
    contact["normal"] = ToJson(c.n_W);
    contact["gap_m"] = c.distance - c.radius;
    contact["friction"] = c.friction;
    contact["certain"] = c.certain;
    json["contacts"].push_back(contact);
  }
  json["forces"] = ForcesJson(report);
  json["separating_wrench"] = nullptr;
  json["supporting_wrench"] = nullptr;
  if (report.stability.verdict != Verdict::kHolds && HasWrench(report)) {
    Json& wrench = json[IsBoundary(report) ? "supporting_wrench" : "separating_wrench"];
    wrench = Json::array();
    for (double y : report.stability.separator.y) wrench.push_back(y);
  }
  json["support_region_m"] = RegionJson(report.region);
  json["support_region_gap_m"] = Number(report.region.gap);
  if (report.accelerated) json["accelerated"] = AcceleratedJson(*report.accelerated);
  // A file name may be any bytes.
  std::cout << json.dump(1, ' ', false, Json::error_handler_t::replace) << '\n';
}

}  // namespace cguide::cli
