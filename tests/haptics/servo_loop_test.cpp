#include "ist/haptics/servo_loop.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <thread>
#include <vector>

#include "haptics/haptic_cases.h"
#include "support/errors.h"

namespace ist::test {
namespace {

using namespace std::chrono_literals;

// A hand that goes down 5 µm a tick from 0.5 mm above the surface, and remembers what it was told.
class DownwardHand final : public Device {
 public:
  explicit DownwardHand(const HapticBodies& bodies) : bodies_(bodies) { told_.reserve(1 << 16); }

  [[nodiscard]] DeviceMechanics mechanics() const noexcept override { return {}; }
  [[nodiscard]] std::optional<Placement> read() noexcept override {
    ++reads_;
    if (stop_at_ == reads_) stop_->store(true);
    if (reads_ >= lost_from_ && reads_ < lost_from_ + lost_) return std::nullopt;
    return bodies_.at(5e-4 - 5e-6 * static_cast<double>(reads_));
  }
  void write(const Vector6& wrench, double dt) noexcept override {
    EXPECT_EQ(dt, 1e-3);
    if (told_.size() < told_.capacity()) told_.push_back(wrench);
  }
  [[nodiscard]] bool done() const noexcept override { return reads_ >= done_after_; }

  void lose(std::uint64_t from, std::uint64_t count) {
    lost_from_ = from;
    lost_ = count;
  }
  void stop_at(std::uint64_t read, std::atomic<bool>& stop) {
    stop_at_ = read;
    stop_ = &stop;
  }
  void done_after(std::uint64_t reads) { done_after_ = reads; }
  [[nodiscard]] const std::vector<Vector6>& told() const { return told_; }
  [[nodiscard]] std::uint64_t reads() const { return reads_; }

 private:
  const HapticBodies& bodies_;
  std::uint64_t reads_ = 0, lost_from_ = 0, lost_ = 0, stop_at_ = 0, done_after_ = UINT64_MAX;
  std::atomic<bool>* stop_ = nullptr;
  std::vector<Vector6> told_;
};

ServoOptions unpaced(std::uint64_t ticks) { return {.ticks = ticks, .paced = false}; }
ServoOptions paced(std::uint64_t ticks) {
  return {.ticks = ticks, .real_time = {.lock_memory = false}};
}

class ServoLoop : public ::testing::Test {
 protected:
  [[nodiscard]] static std::vector<TickRecord> all_of(TickRing<TickRecord>& ring) {
    std::vector<TickRecord> records(ring.capacity());
    records.resize(ring.pop(records));
    return records;
  }

  const HapticBodies bodies_ = ball_over_box();
  Simulation simulation_ = bodies_.simulation();
  DownwardHand hand_{bodies_};
  TickRing<TickRecord> ring_{1 << 12};
  std::atomic<bool> stop_{false};
};

TEST_F(ServoLoop, MakesTheTicksThatItIsAskedForInOrder) {
  constexpr std::uint64_t kTicks = 500;
  const ServoReport report =
      run_servo_loop(simulation_, hand_, unpaced(kTicks), {&ring_, nullptr}, stop_);
  EXPECT_EQ(report.ticks, kTicks);
  EXPECT_EQ(report.missed + report.held + report.faults + report.lost_records, 0u);
  for (const LatencyHistogram* times : {&report.late, &report.execution, &report.cpu}) {
    EXPECT_EQ(times->count(), kTicks);
  }
  EXPECT_EQ(report.late.max(), 0ns);
  EXPECT_GT(report.cpu.max(), 0ns);
  const std::vector<TickRecord> records = all_of(ring_);
  ASSERT_EQ(records.size(), kTicks);
  ASSERT_EQ(hand_.told().size(), kTicks + 1);
  double felt = 0;
  for (std::uint64_t i = 0; i < kTicks; ++i) {
    const TickRecord& record = records[i];
    EXPECT_EQ(record.tick, i);
    EXPECT_TRUE(record.device_known);
    EXPECT_GE(record.execution_ns, 0);
    EXPECT_GE(record.begin_ns, i > 0 ? records[i - 1].begin_ns : 0);
    const double z = 5e-4 - 5e-6 * static_cast<double>(i + 1);
    EXPECT_EQ(record.device[2], bodies_.at(z).translation.z());
    for (int axis = 0; axis < 6; ++axis) {
      EXPECT_EQ(record.wrench[static_cast<std::size_t>(axis)], hand_.told()[i][axis]);
    }
    felt = std::max(felt, record.wrench[2]);
  }
  EXPECT_GT(felt, 0.5);  // it did press
}

TEST_F(ServoLoop, TellsTheDeviceToRestAtTheEnd) {
  const ServoReport report = run_servo_loop(simulation_, hand_, unpaced(400), {}, stop_);
  EXPECT_EQ(report.ticks, 400u);
  ASSERT_EQ(hand_.told().size(), 401u);
  EXPECT_GT(hand_.told()[399].norm(), 0.1);
  EXPECT_EQ(hand_.told()[400], Vector6(Vector6::Zero()));
}

TEST_F(ServoLoop, EndsWhereItIsAskedToStop) {
  hand_.stop_at(120, stop_);
  const ServoReport report =
      run_servo_loop(simulation_, hand_, unpaced(100'000), {&ring_, nullptr}, stop_);
  EXPECT_EQ(report.ticks, 120u);  // the tick at hand is made
  EXPECT_EQ(all_of(ring_).size(), 120u);
  EXPECT_EQ(hand_.told().back(), Vector6(Vector6::Zero()));
  EXPECT_EQ(run_servo_loop(simulation_, hand_, unpaced(10), {}, stop_).ticks, 0u);
}

TEST_F(ServoLoop, EndsWithItsDevice) {
  hand_.done_after(33);
  EXPECT_EQ(run_servo_loop(simulation_, hand_, unpaced(1000), {}, stop_).ticks, 33u);
}

TEST_F(ServoLoop, CountsFaultsAndTellsThemAsZero) {
  hand_.lose(300, 7);
  const ServoReport report =
      run_servo_loop(simulation_, hand_, unpaced(400), {&ring_, nullptr}, stop_);
  EXPECT_EQ(report.faults, 7u);
  const std::vector<TickRecord> records = all_of(ring_);
  ASSERT_EQ(records.size(), 400u);
  EXPECT_GT(hand_.told()[298].norm(), 0.1);
  for (std::size_t i = 0; i < records.size(); ++i) {
    const bool lost = i >= 299 && i < 306;
    EXPECT_EQ(records[i].fault, lost) << i;
    EXPECT_EQ(records[i].device_known, !lost) << i;
    if (lost) {
      EXPECT_EQ(hand_.told()[i], Vector6(Vector6::Zero())) << i;
    }
  }
  EXPECT_GT(hand_.told()[399].norm(), 0);
}

// Every tick is made, or counted as missed; a loop that is late loses none of its count.
TEST_F(ServoLoop, KeepsItsBeat) {
  constexpr std::uint64_t kTicks = 200;
  const auto begin = std::chrono::steady_clock::now();
  const ServoReport report =
      run_servo_loop(simulation_, hand_, paced(kTicks), {&ring_, nullptr}, stop_);
  const auto took = std::chrono::steady_clock::now() - begin;
  EXPECT_GE(took, (kTicks - 1) * 1ms);
  const std::vector<TickRecord> records = all_of(ring_);
  EXPECT_EQ(records.size(), report.ticks);
  EXPECT_EQ(report.lost_records, 0u);
  std::uint64_t left_out = 0, over = 0, next = 0;
  for (const TickRecord& record : records) {
    ASSERT_GE(record.tick, next);
    left_out += record.tick - next;
    next = record.tick + 1;
    EXPECT_GE(record.late_ns, 0);
    over += record.late_ns + record.execution_ns > 1'000'000 ? 1U : 0U;
  }
  EXPECT_LE(next, kTicks);
  // Those behind the last one were missed too; one that ended late is missed and made.
  EXPECT_LE(left_out, report.missed);
  EXPECT_GE(report.ticks + report.missed, kTicks);
  EXPECT_LE(report.ticks + left_out, kTicks);
  EXPECT_LE(over, report.missed);
}

// A loop that waits for nobody loses what finds no room, and says how many.
TEST_F(ServoLoop, CountsTheRecordsThatFindNoRoom) {
  TickRing<TickRecord> small(16);
  hand_.stop_at(40, stop_);  // ticks that are made, however many a busy machine leaves out
  const ServoReport report =
      run_servo_loop(simulation_, hand_, paced(1'000'000'000), {&small, nullptr}, stop_);
  EXPECT_EQ(report.ticks, 40u);
  EXPECT_EQ(report.lost_records, 24u);
  const std::vector<TickRecord> records = all_of(small);
  ASSERT_EQ(records.size(), 16u);
  EXPECT_EQ(records.front().tick, 0u);
}

TEST_F(ServoLoop, RefusesAFractionOutOfRange) {
  for (const double fraction : {0.0, -0.5, 1.01, std::nan("")}) {
    const std::optional<Error> error = error_of([&] {
      const ServoOptions options{.ticks = 1, .paced = false, .query_time_fraction = fraction};
      static_cast<void>(run_servo_loop(simulation_, hand_, options, {}, stop_));
    });
    ASSERT_TRUE(error) << fraction;
    EXPECT_EQ(error->code(), ErrorCode::kArgumentInvalid);
  }
  EXPECT_EQ(hand_.reads(), 0u);
}

TEST(ServoLoopThreads, AnotherThreadSeesWholeTicksOneAfterTheOther) {
  const HapticBodies bodies = ball_over_box();
  Simulation simulation = bodies.simulation();
  DownwardHand hand(bodies);
  Snapshot<TickRecord> snapshot;
  TickRing<TickRecord> ring(64);
  std::atomic<bool> stop{false};
  constexpr std::uint64_t kTicks = 400;
  ServoReport report;
  std::thread loop([&] {
    report = run_servo_loop(simulation, hand, unpaced(kTicks), {&ring, &snapshot}, stop);
  });
  // Without a beat it waits for who writes its records down, so all of them come.
  std::uint64_t seen = 0, torn = 0, backwards = 0, last = 0;
  std::vector<TickRecord> taken(16);
  while (seen < kTicks) {
    const std::size_t count = ring.pop(taken);
    for (std::size_t i = 0; i < count; ++i) torn += taken[i].tick != seen + i ? 1U : 0U;
    seen += count;
    const TickRecord now = snapshot.read();
    if (now.tick < last) ++backwards;
    last = now.tick;
    const double z = 5e-4 - 5e-6 * static_cast<double>(now.tick + 1);
    if (now.device_known && now.device[2] != bodies.at(z).translation.z()) ++torn;
  }
  loop.join();
  EXPECT_EQ(torn + backwards, 0u);
  EXPECT_EQ(report.lost_records, 0u);
  EXPECT_EQ(snapshot.read().tick, kTicks - 1);
}

}  // namespace
}  // namespace ist::test
