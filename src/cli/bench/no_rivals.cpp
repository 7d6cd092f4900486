#include "cli/bench/rivals.h"

namespace ist::cli {

std::vector<Rival> rivals() { return {{"fcl", ""}, {"embree", ""}}; }

}  // namespace ist::cli
