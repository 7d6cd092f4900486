#pragma once

#include <Eigen/Geometry>
#include <span>
#include <stdexcept>

#include "cli/bodies.h"
#include "cli/engine.h"

namespace ist::cli {

/// An answer that is not what every query promises.
class PromiseBroken : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Asks each engine each pose once more, untimed, under a progress bar, and checks the answers
/// against what a query promises (PromiseCheck). Says on stderr what was checked; throws
/// PromiseBroken, which names pose, engine and pair.
void verify(const Engines& engines, const Bodies& bodies, std::span<const Eigen::Isometry3d> poses);

}  // namespace ist::cli
