#include "support/conformal.h"

#include "support/shapes.h"

namespace ist::test {

ConformalPair shell_in_shell(int level, double radius, double gap) {
  return {"shells", icosphere(level, radius + gap), icosphere(level, radius), gap};
}

ConformalPair peg_in_hole(int quarter, double radius, double gap) {
  return {"peg", moved(pipe(quarter, radius + gap, 1.5 * radius, radius), {0, 0, 0.5 * radius}),
          cylinder(quarter, radius, 2 * radius), gap};
}

ConformalPair plates(double size, double gap) {
  const double half = 0.5 * size, thick = 0.25 * size;
  return {"plates", box({-half, -half, -thick}, {half, half, 0}),
          box({-half, -half, gap}, {half, half, gap + thick}), gap};
}

ConformalPair one_inside(int level, double radius) {
  return {"inside", icosphere(level, radius),
          moved(icosphere(level, 0.25 * radius), {0.25 * radius, 0, 0}), 0.5 * radius};
}

std::vector<ConformalPair> conformal_pairs(int level, double radius, double gap) {
  std::vector<ConformalPair> pairs;
  pairs.push_back(shell_in_shell(level, radius, gap));
  pairs.push_back(peg_in_hole(1 << level, radius, gap));
  pairs.push_back(plates(2 * radius, gap));
  pairs.push_back(one_inside(level, radius));
  return pairs;
}

}  // namespace ist::test
