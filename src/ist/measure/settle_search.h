#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "ist/base/progress.h"
#include "ist/constraint/features.h"
#include "ist/constraint/nearest_motion.h"
#include "ist/constraint/surface.h"
#include "ist/measure/settle_frame.h"
#include "ist/query/query.h"

namespace ist {

namespace detail {
/// The surfaces of both bodies of a query.
struct SettleBodies {
  /// Throws kTrianglesMissing.
  explicit SettleBodies(const Query& query);
  Surface fixed, moving;
};
}  // namespace detail

/// What a body settles under. Lengths are in mesh units.
struct SettleLoad {
  Eigen::Vector3d closing;   ///< unit vector, fixed axes
  std::array<bool, 6> held;  ///< coordinates of the frame
  Vector6 limits;            ///< largest coordinates
  double radius;             ///< the length by which turns count
  double millimetre;         ///< 1 mm
};

/// Moves a body as far as a load pushes it: successive linear programs within a radius of trust.
class SettleSearch {
 public:
  SettleSearch(Query& query, const detail::SettleBodies& bodies, const SettleFrame& frame,
               const SettleLoad& load);

  enum class End : std::uint8_t {
    kDone,     ///< no step closes farther
    kStopped,  ///< the steps or the caller ended it
    kBusy,     ///< another thread is using the query
  };
  /// Moves from coordinates at which the surfaces are apart. They are so at every step's end.
  End run(Vector6& at, int most_steps, const Proceed& proceed);
  [[nodiscard]] int steps() const noexcept { return steps_; }

 private:
  struct Step {
    Vector6 motion;   // scaled
    double gain = 0;  // promised, mesh units
    double length = 0;
    bool restores = false;  // it widens gaps to the skin
  };

  bool look(const Vector6& at);
  void bound(const Vector6& at, FeatureList::Which which);
  Step step(double missing);
  bool solve(double pull, bool restores);
  [[nodiscard]] Vector6 moved(const Vector6& at, const Vector6& motion) const noexcept;
  [[nodiscard]] double missing() const noexcept;
  End close_gap(Vector6& at, bool& moved_on);

  Query& query_;
  const SettleFrame& frame_;
  const SettleLoad& load_;
  Vector6 pull_;  // direction of the load, scaled coordinates
  std::vector<NearPair> near_;
  std::size_t near_count_ = 0;
  FeatureList features_;
  struct Bound {
    Vector6 along;
    double least;
  };
  std::vector<Bound> bounds_;
  NearestMotion nearest_;
  double trust_, skin_;
  double penalty_ = 2;  // of a missing skin
  int steps_ = 0;
};

}  // namespace ist
