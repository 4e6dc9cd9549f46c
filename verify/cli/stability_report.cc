#include "cguide/verify/cli/stability_report.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <sstream>

#include "cguide/verify/cli/console.h"

namespace cguide::cli {
namespace {

const char* StageText(numeric::StabilityRung rung) {
  switch (rung) {
    case numeric::StabilityRung::kFast:
      return " (decided in doubles with a bound)";
    case numeric::StabilityRung::kStored:
      return " (decided by the exact twin)";
    case numeric::StabilityRung::kBits106:
      return " (decided by the exact twin, kinematics of 106 bits)";
    case numeric::StabilityRung::kBits256:
      return " (decided by the exact twin, kinematics of 256 bits)";
    case numeric::StabilityRung::kUndecided:
      break;
  }
  return "";
}

std::string VerdictText(const StabilityReport& report) {
  const char* stage = StageText(report.rung);
  switch (report.stability.verdict) {
    case Verdict::kHolds:
      return std::string("statically stable") + stage;
    case Verdict::kFails:
      return std::string("not statically stable") + stage;
    case Verdict::kUndecided:
      break;
  }
  return "undecided: " + report.reason;
}

std::string Vector(const Eigen::Vector3d& v) {
  return "[" + Short(v.x()) + " " + Short(v.y()) + " " + Short(v.z()) + "]";
}

/** The value in the unit with so many digits, rounded up or down. */
std::string Rounded(double value, double unit, int digits, bool up) {
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  if (value == 0) return "0";
  const double scaled = value / unit;
  const double step = std::pow(10.0, std::floor(std::log10(std::abs(scaled))) + 1 - digits);
  // Quotient and power may be off by an ulp or so: a hundredth of a step more.
  const double steps = up ? std::ceil(scaled / step + 0.01) : std::floor(scaled / step - 0.01);
  std::ostringstream out;
  out.precision(digits);
  out << steps * step;
  return out.str();
}

std::string Enclosed(const exact::Enclosure& x, double unit) {
  return "[" + Rounded(x.lo, unit, 8, false) + ", " + Rounded(x.hi, unit, 8, true) + "]";
}

/** The middle of a box in metres per metre, and how far it may be off. */
std::string Enclosed(const exact::EnclosedVector& box) {
  Eigen::Vector3d middle;
  double off = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    // Shown to 1e-4; the rest counts as error.
    const double x = std::round((box[k].lo + box[k].hi) * 5e3) * 1e-4 + 0.0;  // no -0
    middle[static_cast<int>(k)] = x;
    off = std::max({off, box[k].hi - x, x - box[k].lo});
  }
  return Vector(middle) + " within " + Rounded(off, 1, 2, true);
}

std::string ContactName(const Model& model, const numeric::Contact& contact) {
  return "\"" + model.robot.bodies[contact.body].name + "\" on \"" +
         model.objects[contact.object].name + "\"";
}

std::string ForceMarginText(const StabilityReport& report) {
  if (!report.force_checked) return Short(report.force_margin.lo) + " (a float, not checked)";
  return Enclosed(report.force_margin, 1) + ", checked exactly for pyramids of " +
         std::to_string(report.sides) + " sides";
}

void PrintForces(const StabilityReport& report) {
  if (report.distribution) {
    std::cout << "forces that balance it, checked exactly (N)\n";
    for (std::size_t i = 0; i < report.contacts.size(); ++i) {
      // Shown to a tenth of a millinewton.
      const Eigen::Vector3d f =
          (report.distribution->force_W[i] * 1e4).array().round() * 1e-4 + 0.0;  // no -0
      if (f.isZero(0)) continue;
      std::cout << "  " << Vector(f) << " at " << Vector(report.contacts[i].force_point_W())
                << '\n';
    }
    return;
  }
  std::cout << "forces that balance it (N)\n";
  for (const numeric::WitnessForce& f : report.forces) {
    const auto at = static_cast<std::size_t>(f.contact);
    std::cout << "  " << Vector(f.weight * f.u_W) << " at "
              << Vector(report.contacts[at].force_point_W()) << '\n';
  }
}

/** How the com margin changes with each point that it depends on by more than is shown. */
void PrintGradient(const StabilityReport& report) {
  if (!report.gradient) return;
  std::cout << "gradient of the com margin, checked exactly (mm per mm)\n  "
            << Enclosed(report.gradient->com_W) << " as the centre of mass moves\n";
  for (std::size_t i = 0; i < report.contacts.size(); ++i) {
    const exact::EnclosedVector& box = report.gradient->contact_W[i];
    const bool idle = std::all_of(box.begin(), box.end(), [](const exact::Enclosure& e) {
      return e.lo > -1e-4 && e.hi < 1e-4;
    });
    if (idle) continue;
    std::cout << "  " << Enclosed(box) << " as the contact at "
              << Vector(report.contacts[i].force_point_W()) << " moves\n";
  }
}

void PrintRegion(const numeric::ProvedSupportRegion& region) {
  const char* what = "support region of the centre of mass";
  if (region.is_empty) std::cout << what << ": empty, checked exactly\n";
  if (region.whole_plane) std::cout << what << ": the whole plane, checked exactly\n";
  if (region.inner_W.empty()) return;
  std::cout << what << ", complete "
            << (std::isinf(region.gap) ? "on no side"
                                       : "within " + Rounded(region.gap, 1e-3, 2, true) + " mm")
            << ", checked exactly (m)\n";
  for (const Eigen::Vector3d& p : region.inner_W) {
    std::cout << "  " << Short(p.x()) << ' ' << Short(p.y()) << '\n';
  }
}

/** The same while the centre of mass accelerates. */
void PrintAccelerated(const AccelerationReport& report) {
  const numeric::StabilityAnswer& answer = report.stability.answer;
  std::cout << "while the centre of mass accelerates by " << Vector(report.a_W) << " m/s^2\n  "
            << (answer.verdict == Verdict::kHolds   ? "forces can balance it"
                : answer.verdict == Verdict::kFails ? "no forces balance it"
                                                    : "undecided: " + report.stability.reason)
            << "\n  com margin   " << Enclosed(report.com_margin, 1e-3) << " mm, checked exactly\n"
            << "  largest acceleration along it " << Enclosed(report.largest, 1)
            << " m/s^2, checked exactly\n";
  PrintRegion(report.region);
}

}  // namespace

bool IsBoundary(const StabilityReport& report) {
  return report.stability.verdict == Verdict::kUndecided && !report.forces.empty();
}

bool HasWrench(const StabilityReport& report) { return !report.stability.separator.y.isZero(0); }

void PrintText(const std::string& what, const Model& model, const StabilityReport& report) {
  std::cout << what << ": " << VerdictText(report) << '\n'
            << "  centre of mass " << Vector(report.com_W) << " m\n"
            << "  com margin   " << Enclosed(report.com_margin, 1e-3) << " mm, checked exactly\n"
            << "  force margin " << ForceMarginText(report) << '\n'
            << report.contacts.size() << " contact points\n";
  for (const numeric::Contact& contact : report.contacts) {
    std::cout << "  " << ContactName(model, contact) << " at " << Vector(contact.force_point_W())
              << " m, normal " << Vector(contact.n_W) << ", gap "
              << Millimetres(contact.distance - contact.radius) << ", mu "
              << Short(contact.friction) << (contact.certain ? "" : ", perhaps not active") << '\n';
  }
  if (report.stability.verdict == Verdict::kHolds || IsBoundary(report)) PrintForces(report);
  if (report.stability.verdict != Verdict::kHolds && HasWrench(report)) {
    std::cout << (IsBoundary(report) ? "supporting" : "separating")
              << " wrench about the centre of mass\n  [";
    for (int i = 0; i < 6; ++i)
      std::cout << (i ? " " : "") << Short(report.stability.separator.y[i]);
    std::cout << "]\n";
  }
  PrintGradient(report);
  PrintRegion(report.region);
  if (report.accelerated) PrintAccelerated(*report.accelerated);
}

}  // namespace cguide::cli
