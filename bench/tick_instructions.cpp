// Makes ticks for callgrind to count, and prints what they came to:
//
//   tick_instructions SCENE TICKS                of a scene file
//   tick_instructions --by-hand EFFECTS TICKS    of parts that a program puts together by itself,
//                                                with effects as contact,gravity, or none
//
// Nothing but a tick happens in count_tick(), where --toggle-collect begins and ends.
#include <fmt/format.h>

#include <cstdint>
#include <exception>
#include <optional>
#include <set>
#include <sstream>
#include <string>

#include "ist/haptics/recording.h"
#include "ist/scene.h"
#include "support/ball_on_box.h"

namespace {

// Of everything that ticks come to, bit by bit: FNV-1a, G. Fowler, L. C. Noll and K.-P. Vo.
class Digest {
 public:
  void add(const ist::Tick& tick) noexcept {
    add(ist::to_numbers(tick.tool).data(), sizeof(ist::TickRecord::Pose));
    add(tick.wrench.data(), 6 * sizeof(double));
  }
  [[nodiscard]] std::uint64_t value() const noexcept { return value_; }

 private:
  void add(const void* data, std::size_t bytes) noexcept {
    const auto* at = static_cast<const unsigned char*>(data);
    for (std::size_t i = 0; i < bytes; ++i) value_ = (value_ ^ at[i]) * 0x100000001b3U;
  }
  std::uint64_t value_ = 0xcbf29ce484222325U;
};

}  // namespace

extern "C" [[gnu::noinline]] void count_tick(ist::Simulation& simulation,
                                             const std::optional<ist::Placement>& at,
                                             ist::Tick& tick) {
  tick = simulation.tick(at, {});
}

namespace {

void count(ist::Simulation& simulation, ist::Device& device, int ticks) {
  Digest digest;
  ist::Tick tick{};
  for (int i = 0; i < ticks; ++i) {
    count_tick(simulation, device.read(), tick);
    device.write(tick.wrench, simulation.dt());
    digest.add(tick);
  }
  fmt::print("{:016x} {}\n", digest.value(), simulation.effects().size());
}

std::set<std::string> names_in(const std::string& list) {
  std::set<std::string> names;
  std::istringstream stream(list);
  for (std::string name; std::getline(stream, name, ',');) names.insert(name);
  return names;
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc == 4 && argv[1] == std::string("--by-hand")) {
    const ist::bench::BallOnBox made = ist::bench::make_ball_on_box(names_in(argv[2]));
    count(*made.simulation, *made.device, std::stoi(argv[3]));
  } else if (argc == 3) {
    const ist::BuiltScene scene = ist::build_scene(ist::read_scene(argv[1]));
    count(*scene.simulation, *scene.device, std::stoi(argv[2]));
  } else {
    fmt::print(stderr, "usage: tick_instructions SCENE TICKS, or --by-hand EFFECTS TICKS\n");
    return 2;
  }
} catch (const std::exception& error) {
  fmt::print(stderr, "tick_instructions: {}\n", error.what());
  return 1;
}
