#include "cli/bench/machine.h"

#include <fmt/format.h>
#include <sched.h>
#include <sys/utsname.h>

#include <cstdlib>
#include <fstream>
#include <string_view>

namespace ist::cli {
namespace {

// The part of a core that other work may take.
constexpr double kIdle = 0.5;
// The slow runs of the fixed loop over its fast ones.
constexpr double kSteady = 1.1;

// ARM64's kernel names no model; the architecture then has to do.
std::string processor_name() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) {
      return line.substr(colon + 2);
    }
  }
  utsname system{};
  return uname(&system) == 0 ? system.machine : "unknown processor";
}

unsigned usable_cores() {
  cpu_set_t cores;
  return sched_getaffinity(0, sizeof(cores), &cores) == 0 ? static_cast<unsigned>(CPU_COUNT(&cores))
                                                          : 1;
}

std::string governor_name() {
  std::string name;
  std::getline(std::ifstream("/sys/devices/system/cpu/cpu0/cpufreq/scaling_governor"), name);
  return name;
}

}  // namespace

Machine this_machine() {
  Machine machine{processor_name(), usable_cores(), governor_name(), std::nullopt};
  std::array<double, 3> load{};
  if (getloadavg(load.data(), 3) == 3) machine.load = load;
  return machine;
}

std::optional<std::string> noise_of(const Machine& machine, const Samples& loop) {
  const double unsteady = loop.quantile(0.95) / loop.quantile(0.05);
  const double load = machine.load ? machine.load->front() : 0;
  std::string found;
  if (load > kIdle) found = fmt::format("other work took {:.1f} cores in the minute before", load);
  if (unsteady > kSteady) {
    found += fmt::format("{}a fixed loop took {:.2f} times as long at times",
                         found.empty() ? "" : ", and ", unsteady);
  }
  if (found.empty()) return std::nullopt;
  return found + (load > kIdle
                      ? ": ratios are rough, and most of all with two workers: repeat this "
                        "when nothing else runs"
                      : ": ratios hold, since all queries take turns; times do not compare "
                        "with another run");
}

}  // namespace ist::cli
