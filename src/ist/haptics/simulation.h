#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "ist/base/api.h"
#include "ist/haptics/coupling.h"
#include "ist/haptics/effects/effect.h"
#include "ist/haptics/safety.h"
#include "ist/haptics/tool.h"
#include "ist/haptics/touch_query.h"

namespace ist {

/// What a tick's queries may spend, one after the other.
struct TickBudget {
  Budget contacts, proximity;
};

/// What a tick came to.
struct Tick {
  Placement device;  ///< as it was read; where it was not, as it was last
  Placement tool;    ///< where the tool is after the tick
  Vector6 wrench;    ///< what the hand feels, about the tool's origin
  bool fault;        ///< no device, or numbers that are none: the wrench is zero
  bool held;         ///< the contacts' answer was not complete, so the tool is where one last was
  /// Of the queries at the pose before; nothing where no effect needs them. Mesh units.
  std::optional<QueryResult> contacts, proximity;
  double leaf_pairs;  ///< that bear a load, by weight
};

/// What the loop turns: from where the hand is to what it feels, one tick after the other, without
/// a clock. The same bits for the same device poses and the same answers of the queries.
///
/// A tick asks what touches the tool where it is, moves it there where coupling and effects are in
/// balance, no farther than a voxel, and passes on what the coupling pulls. Where the contacts'
/// answer is not complete the tool goes back to where one last was, with the contacts found there,
/// and dares half as long a step from there: lack of time never lowers resistance. Where
/// proximity's is not, what brakes is what it was.
///
/// A tick allocates nothing, locks nothing and makes no system call. Cost: that of the queries, and
/// 5 to 15 µs.
class IST_API Simulation {
 public:
  struct Parts {
    std::unique_ptr<TouchQuery> contacts;   ///< null where no effect needs it
    std::unique_ptr<TouchQuery> proximity;  ///< likewise
    std::vector<std::unique_ptr<Effect>> effects;
    CouplingSettings coupling;
    SafetySettings safety;
    Tool tool;
    Placement start;  ///< of the tool
    double dt;        ///< of a tick, s
  };
  explicit Simulation(Parts parts);

  /// @param device where the hand is; nothing where that is not known
  [[nodiscard]] Tick tick(const std::optional<Placement>& device,
                          const TickBudget& budget) noexcept;
  /// What is felt becomes zero, and returns only through the soft start.
  void fault() noexcept;

  [[nodiscard]] double dt() const noexcept { return dt_; }
  /// Where the tool is.
  [[nodiscard]] const Placement& at() const noexcept { return at_; }
  /// Each with the time that it took in all ticks so far.
  [[nodiscard]] std::span<const Tool::TimedEffect> effects() const noexcept { return effects_; }
  /// Bytes of what answers queries.
  [[nodiscard]] std::size_t bytes() const noexcept {
    return (contacts_ ? contacts_->bytes() : 0) + (proximity_ ? proximity_->bytes() : 0);
  }

 private:
  // What touches the tool at a pose where all answers were complete.
  struct Known {
    Placement tool;
    TouchSet contacts, proximity;
  };
  [[nodiscard]] IST_LOCAL bool ask(const TickBudget& budget, Tick& tick) noexcept;
  [[nodiscard]] IST_LOCAL std::optional<Vector6> move(
      const VirtualCoupling::Stretch& stretch) noexcept;

  std::unique_ptr<TouchQuery> contacts_, proximity_;
  std::vector<Tool::TimedEffect> effects_;
  VirtualCoupling coupling_;
  WrenchGuard guard_;
  Tool tool_;
  double dt_;
  Placement at_;                     // of the tool
  std::optional<Placement> device_;  // a tick before
  Known known_, asked_;
  // Of the tool since all was known; nothing where it has not moved. Effects are told of it when
  // all is known where it led, for a tool that goes back must not leave them there.
  std::optional<Vector6> motion_;
  double dares_ = 1;  // part of the longest step
};

}  // namespace ist
