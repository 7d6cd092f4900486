#include "support/peak_memory.h"

#include <malloc.h>

#include <fstream>
#include <string>

namespace ist::bench {

void reset_peak_memory() {
  malloc_trim(0);  // what an earlier measurement freed is not this one's
  std::ofstream("/proc/self/clear_refs") << "5";
}

double peak_memory_mb() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with("VmHWM:")) return std::stod(line.substr(6)) * 1024 / 1e6;
  }
  return 0;
}

}  // namespace ist::bench
