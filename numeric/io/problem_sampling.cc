#include <cmath>
#include <limits>

#include "cguide/numeric/io/file_internal.h"
#include "cguide/numeric/io/problem_parts_internal.h"

namespace cguide::numeric::io {
namespace {

UniformPosition ReadUniform(const YamlView& view) {
  const std::vector<YamlView> corners = view.Items();
  if (corners.size() != 2) view.Fail("write the two corners [[x, y, z], [x, y, z]]");
  UniformPosition box{corners[0].Vector3(kMaxLength), corners[1].Vector3(kMaxLength)};
  if ((box.lower.array() > box.upper.array()).any()) {
    view.Fail("the first corner exceeds the second; write the smaller coordinates first");
  }
  return box;
}

GaussianPosition ReadGaussian(const YamlView& view) {
  view.AllowKeys({"mean_m", "sigma_m"});
  GaussianPosition gaussian;
  gaussian.mean = view.Get("mean_m").Vector3(kMaxLength);
  const YamlView sigma = view.Get("sigma_m");
  gaussian.sigma = sigma.IsList() ? sigma.Vector3(kMaxLength)
                                  : Eigen::Vector3d::Constant(sigma.Number(0, kMaxLength));
  if (gaussian.sigma.minCoeff() < 0) sigma.Fail("a standard deviation must not be negative");
  return gaussian;
}

PositionSampling ReadPosition(const YamlView& view) {
  view.AllowKeys({"box_m", "gaussian"});
  const auto box = view.Find("box_m");
  const auto gaussian = view.Find("gaussian");
  if (box.has_value() == gaussian.has_value()) view.Fail("give exactly one of box_m, gaussian");
  if (box) return ReadUniform(*box);
  return ReadGaussian(*gaussian);
}

// Without a word on positions: the box about start and goal, half a metre wider on every side.
UniformPosition DefaultPosition(const Pose& start, const Pose& goal) {
  const Eigen::Vector3d margin = Eigen::Vector3d::Constant(0.5);
  return {start.p.cwiseMin(goal.p) - margin, start.p.cwiseMax(goal.p) + margin};
}

std::vector<OrientationMode> ReadOrientation(const YamlView& view) {
  std::vector<OrientationMode> modes;
  for (const YamlView& item : view.Items()) {
    item.AllowKeys({"mean_rpy", "mean_quaternion", "kappa", "weight"});
    OrientationMode mode;
    mode.mean = ReadRotation(item, "mean_rpy", "mean_quaternion");
    mode.kappa = item.Get("kappa").Number(0, 1e15);
    if (const auto weight = item.Find("weight")) mode.weight = weight->Number(1e-9, 1e9);
    modes.push_back(mode);
  }
  if (modes.empty()) view.Fail("the list is empty; give at least one mode, or drop the key");
  return modes;
}

// k may be infinite: lambda is then uniform in a cube.
double ReadNorm(const YamlView& view) {
  if (view.IsText() && (view.Text() == ".inf" || view.Text() == "inf")) {
    return std::numeric_limits<double>::infinity();
  }
  return view.Number(1, 1e6);
}

PostureSampling ReadPosture(const YamlView& view, PostureTable* postures,
                            std::vector<std::string>* warnings) {
  view.AllowKeys({"base", "keys", "k", "local_fraction", "local_sigma_rad"});
  PostureSampling sampling;
  postures->SetBase(view.Find("base"), warnings);
  sampling.base = postures->base();
  if (const auto keys = view.Find("keys")) {
    for (const YamlView& key : keys->Items()) sampling.keys.push_back(postures->Key(key, warnings));
  }
  if (const auto k = view.Find("k")) sampling.k = ReadNorm(*k);
  if (const auto f = view.Find("local_fraction")) sampling.local_fraction = f->Number(0, 1);
  if (const auto s = view.Find("local_sigma_rad")) sampling.local_sigma = s->Number(0, 100);
  return sampling;
}

}  // namespace

SamplingRules ReadSampling(const std::optional<YamlView>& sampling, PostureTable* postures,
                           const Pose& start, const Pose& goal,
                           std::vector<std::string>* warnings) {
  SamplingRules rules;
  rules.position = DefaultPosition(start, goal);
  if (sampling) {
    sampling->AllowKeys({"position", "orientation", "posture"});
    if (const auto view = sampling->Find("position")) rules.position = ReadPosition(*view);
    if (const auto view = sampling->Find("orientation")) rules.orientation = ReadOrientation(*view);
    if (const auto view = sampling->Find("posture")) {
      rules.posture = ReadPosture(*view, postures, warnings);
    }
  }
  if (rules.posture.base.size() == 0) {
    postures->SetBase(std::nullopt, warnings);
    rules.posture.base = postures->base();
  }
  return rules;
}

}  // namespace cguide::numeric::io
