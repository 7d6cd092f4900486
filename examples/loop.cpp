// A haptic loop with a device of its own: it lowers a ball on a block, and prints the force on the
// hand. `loop probe.toml` makes 1000 ticks as fast as it can. `loop probe.toml --paced` makes one
// tick each millisecond.
#include <ist/haptics.h>
#include <ist/scene.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <exception>
#include <optional>
#include <thread>

// Replace this device by your hardware. The thread of the loop calls read() and then write() once a
// tick. Neither may allocate, lock, print or throw. Units are metres, newtons and newton metres, in
// the axes of the scene.
class Probe final : public ist::Device {
 public:
  explicit Probe(const ist::Placement& start) : pose_(start) {}
  // The same values as [device] in the scene. By them build_scene() keeps the coupling stable.
  ist::DeviceMechanics mechanics() const noexcept override {
    return {.damping = 2, .angular_damping = 2e-3};
  }
  // Returns the pose of the encoders. std::nullopt means an unknown pose; the force is then zero.
  std::optional<ist::Placement> read() noexcept override { return pose_; }
  // Sends the wrench to the motors. This device ignores the wrench, and sinks by 4 mm/s.
  void write(const ist::Vector6& /*wrench*/, double dt) noexcept override {
    pose_.translation.z() -= 0.004 * dt;
  }

 private:
  ist::Placement pose_;
};

int main(int argc, char** argv) try {
  ist::BuiltScene built = ist::build_scene(ist::read_scene(argc > 1 ? argv[1] : "probe.toml"));
  Probe probe(*built.device->read());  // it starts at the pose of the ball in the scene

  // The loop pushes a record of each tick into a ring. A paced loop never waits for the ring.
  ist::TickRing<ist::TickRecord> ticks(1 << 10);
  std::atomic<bool> stop{false}, done{false};
  ist::ServoReport report;
  std::thread loop([&] {
    const ist::ServoOptions options{.ticks = 1000, .paced = argc > 2};
    report = ist::run_servo_loop(*built.simulation, probe, options, {.records = &ticks}, stop);
    done = true;
  });

  // Another thread, here that of main(), pops the records and prints the force of each 100th tick.
  std::array<ist::TickRecord, 100> some;
  for (bool last = false; !last; std::this_thread::sleep_for(std::chrono::milliseconds(1))) {
    last = done;
    while (const std::size_t count = ticks.pop(some)) {
      for (std::size_t i = 0; i < count; ++i) {
        if (some[i].tick % 100 == 99) std::printf("%6.3f N\n", some[i].wrench[2]);
      }
    }
  }
  loop.join();
  std::printf("%ju ticks, %ju missed\n", report.ticks, report.missed);
} catch (const std::exception& error) {
  // The text of an ist::Error names the place, the cause and the remedy.
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
