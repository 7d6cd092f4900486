// Presses walls with couplings of many stiffnesses, and finds the least stiffness at which the wall
// is active, beside the one that largest_stiffness() computes. Prints JSON lines. The script
// scripts/stability_border.py keeps and draws them. Not timed: the same lines on every machine.
#include "loop/haptics/stability_border.h"

#include <fmt/format.h>

#include <cstdio>

#include "haptics/wall_press.h"

namespace ist::bench {
namespace {

using test::PressedWall;
using test::PressResult;
using test::PressSettings;

constexpr double kRates[] = {500, 1000, 4000};
constexpr double kDelays[] = {0, 1e-3};
constexpr double kDampings[] = {0.5, 1, 1.5, 2, 3, 4};  // N s/m, and a thousandth of it if it turns
constexpr double kParts[] = {0.3, 0.5, 0.65, 0.8, 0.9, 1, 1.1, 1.25, 1.5, 2, 2.5};  // of the border

void print(const char* wall, const char* stop, const PressSettings& settings, double computed,
           const std::string& found) {
  fmt::print(R"({{"wall": "{}", "stop": "{}", "rate": {}, "delay": {}, "damping": {}, )"
             R"("resolution": {}, "computed": {}, {}}})"
             "\n",
             wall, stop, settings.rate, settings.delay, settings.damping, settings.resolution,
             computed, found);
}

void sweep(const char* name, const PressedWall& wall) {
  const char* stop = wall.springs ? "springs" : "constraint";
  for (const double rate : kRates) {
    for (const double delay : kDelays) {
      for (const double damping : kDampings) {
        PressSettings settings{.rate = rate,
                               .delay = delay,
                               .damping = wall.turns ? 1e-3 * damping : damping,
                               .resolution = wall.turns ? 2e-5 : 2e-6};
        const double computed = largest_stiffness(settings.damping, 0, 1 / rate, delay);
        for (const double part : kParts) {
          settings.stiffness = part * computed;
          const PressResult result = press(wall, settings);
          print(
              name, stop, settings, computed,
              fmt::format(R"("stiffness": {}, "returned": {}, "allowance": {}, "growth": {})",
                          settings.stiffness, result.returned, result.allowance, result.growth()));
        }
        print(name, stop, settings, computed,
              fmt::format(R"("measured": {})", measured_border(wall, settings, computed)));
      }
      std::fflush(stdout);
    }
  }
}

}  // namespace
}  // namespace ist::bench

int main() {
  using ist::test::Stop;
  for (const Stop stop : {Stop::kConstraint, Stop::kSprings}) {
    ist::bench::sweep("push", ist::test::slab_wall(stop));
    ist::bench::sweep("turn", ist::test::stop_wall(stop));
  }
}
