#include "cli/occlusion/sides.h"

#include <CLI/CLI.hpp>
#include <cmath>

#include "cli/poses/numbers.h"
#include "cli/refusals.h"
#include "ist/base/direction.h"

namespace ist::cli {
namespace {

using Vector = Eigen::Vector3d;

std::optional<Vector> triple(const std::string& text, const std::string& option) {
  if (text.empty()) return std::nullopt;
  std::optional<Vector> given = vector_of(text);
  refuse_if(!given, option, text + ": give x,y,z, such as 1,0,0");
  return given;
}

std::optional<Vector> direction(const std::string& text, const std::string& option) {
  const std::optional<Vector> given = triple(text, option);
  if (!given) return std::nullopt;
  const std::optional<Direction> towards = direction_of(*given);
  refuse_if(!towards, option, text + ": it is no direction");
  return towards->unit;
}

}  // namespace

std::pair<Division, Division> divisions(const SideOptions& options,
                                        const Eigen::AlignedBox3d& box) {
  std::optional<Vector> left = direction(options.left, "--left"),
                        front = direction(options.front, "--front");
  const std::optional<Vector> midline = triple(options.midline, "--midline");
  refuse_if(!options.frame.empty() && (left || front), "--frame",
            "contradicts --left and --front, which say the same");
  if (options.frame == "lps") {
    left = Vector(1, 0, 0);
    front = Vector(0, -1, 0);
  } else if (options.frame == "ras") {
    left = Vector(-1, 0, 0);
    front = Vector(0, 1, 0);
  }
  refuse_if(left && front && !(std::abs(left->dot(*front)) < 0.99), "--front",
            "it is the direction of --left: give another");
  Division sides, fore_aft;
  sides.direction = left.value_or(Vector(1, 0, 0));
  sides.first = left ? "left" : "+x";
  sides.second = left ? "right" : "-x";
  sides.assumed = !midline;
  sides.at = sides.direction.dot(midline.value_or(box.center()));
  fore_aft.direction = front.value_or(Vector(0, 1, 0));
  fore_aft.first = front ? "anterior" : "+y";
  fore_aft.second = front ? "posterior" : "-y";
  fore_aft.at = fore_aft.direction.dot(box.center());
  return {sides, fore_aft};
}

}  // namespace ist::cli
