#include <algorithm>
#include <cmath>

#include "cguide/verify/kept_patch_internal.h"

// Which part of a patch serves for which t.
namespace cguide::verify::patch_internal {
namespace {

/** Chooses which part serves for which t: proposals, BoundParts proves. */
class Cover {
 public:
  static constexpr std::size_t kMost = 16;

  Cover(const std::vector<Part>& parts, const FootPath& path) : parts_(parts), path_(path) {}

  std::vector<std::pair<int, double>> Find() {
    constexpr int kHalvings = 32;
    if (!parts_.empty() && !Extend(-1, 1, kHalvings)) chosen_.clear();
    return chosen_;
  }

 private:
  double Cost(const Part& part, double t) const {
    const double gap = GapAt(part, At(path_.foot, t));
    return gap * gap + 2 * path_.height * std::max(0.0, part.depth);
  }

  bool Extend(double from, double to, int halvings) {
    constexpr double kEnough = 1e-17;  // (3e-9 m)^2
    const double t[] = {from, 0.5 * (from + to), to};
    double best[3], cost[3];
    std::fill(std::begin(best), std::end(best), INFINITY);
    for (const Part& part : parts_) {
      for (int k = 0; k < 3; ++k) best[k] = std::min(best[k], Cost(part, t[k]));
    }
    int chosen = -1;
    double least = INFINITY;
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      double worst = 0;
      for (int k = 0; k < 3; ++k) {
        cost[k] = Cost(parts_[i], t[k]);
        worst = std::max(worst, cost[k] / std::max(kEnough, best[k]));
      }
      if (!(worst < least)) continue;
      least = worst;
      chosen = static_cast<int>(i);
    }
    if (chosen < 0) return false;
    if (least > 1.5 && halvings > 0) {
      return Extend(from, t[1], halvings - 1) && Extend(t[1], to, halvings - 1);
    }
    if (!chosen_.empty() && chosen_.back().first == chosen) chosen_.pop_back();
    chosen_.emplace_back(chosen, to);
    return chosen_.size() <= kMost;
  }

  const std::vector<Part>& parts_;
  const FootPath& path_;
  std::vector<std::pair<int, double>> chosen_;
};

}  // namespace

std::vector<std::pair<int, double>> ChooseParts(const std::vector<Part>& parts,
                                                const FootPath& path) {
  return Cover(parts, path).Find();
}

}  // namespace cguide::verify::patch_internal
