#pragma once

#include <Eigen/Geometry>
#include <cstdint>

#include "ist/base/progress.h"
#include "ist/query/query.h"

namespace ist {

/// Tells poses at which two bodies are free: no triangles meet, and if a body is closed, no part of
/// the other one is inside it.
class FreeTest {
 public:
  /// Refers to both. The query's trees have triangles.
  FreeTest(Query& query, const Proceed& proceed) : query_(query), proceed_(proceed) {}

  /// Returns whether the bodies are free at a rigid pose. False if that is unknown, and at every
  /// pose after the search has ended.
  [[nodiscard]] bool at(const Eigen::Isometry3d& pose);

  /// Whether the caller ended the search, or another thread is using the query.
  [[nodiscard]] bool is_ended() const noexcept { return is_stopped_ || is_busy_; }
  [[nodiscard]] bool is_busy() const noexcept { return is_busy_; }
  /// Notes that another thread is using the query.
  void end_busy() noexcept { is_busy_ = true; }
  [[nodiscard]] std::uint64_t verdicts() const noexcept { return verdicts_; }

 private:
  Query& query_;
  const Proceed& proceed_;
  std::uint64_t verdicts_ = 0;
  bool is_stopped_ = false, is_busy_ = false;
};

}  // namespace ist
