#include "support/stability.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <limits>
#include <nlohmann/json.hpp>

namespace ist::test {

StabilityCase::StabilityCase(std::string group, std::string name, std::string error)
    : group_(std::move(group)), name_(std::move(name)), error_(std::move(error)) {}

void StabilityCase::sample(double error, double bound, const std::string& what) {
  samples_of(1, error, bound, what);
}

void StabilityCase::samples_of(std::uint64_t count, double error, double bound,
                               const std::string& what) {
  tried_ += count;
  const bool holds = error <= bound;  // false for what is no number
  if (!holds && ++broken_ <= 5) {
    ADD_FAILURE() << group_ << ", " << name_ << ": " << error << " " << error_ << " where at most "
                  << bound << " is guaranteed" << (what.empty() ? "" : ": ") << what;
  }
  const double ratio = !holds      ? std::numeric_limits<double>::infinity()
                       : bound > 0 ? error / bound
                                   : 0;
  if (ratio > worst_ratio_) {
    worst_ratio_ = ratio;
    worst_ = error;
    bound_ = bound;
  }
}

StabilityCase::~StabilityCase() {
  EXPECT_GT(tried_, 0u) << group_ << ", " << name_ << ": nothing was tried";
  EXPECT_EQ(broken_, 0u) << group_ << ", " << name_ << ": so many of " << tried_ << " samples";
  const char* file = std::getenv("IST_STABILITY");
  if (file == nullptr) return;
  const nlohmann::ordered_json line = {{"group", group_},   {"name", name_},   {"samples", tried_},
                                       {"broken", broken_}, {"error", error_}, {"worst", worst_},
                                       {"bound", bound_}};
  const std::string text = line.dump() + "\n";
  // Tests run side by side: a line is appended whole.
  const int out = ::open(file, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (out < 0 || ::write(out, text.data(), text.size()) != static_cast<ssize_t>(text.size())) {
    ADD_FAILURE() << "IST_STABILITY: " << file << " cannot be written";
  }
  if (out >= 0) ::close(out);
}

}  // namespace ist::test
