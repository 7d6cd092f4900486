#pragma once

#include <stdexcept>

namespace ist::cli {

/// More deadlines were missed than --allow-missed.
class DeadlinesMissed : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace ist::cli
