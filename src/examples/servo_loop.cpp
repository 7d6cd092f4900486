// A servo loop with its own device: lowers a ball on a block, and prints the force on the hand.
// `servo_loop probe.toml` makes 1000 ticks as fast as it can; `servo_loop probe.toml --paced` one a
// millisecond.
#include <ist/haptics.h>
#include <ist/scene.h>

#include <array>
#include <cstdio>
#include <thread>

// Replace this by your hardware. The loop's thread calls read() and then write() once a tick:
// neither may allocate, lock, print or throw. Units are metres, newtons and newton metres, in the
// axes of the scene.
class Probe final : public ist::Device {
 public:
  explicit Probe(const ist::Placement& start) : pose_(start) {}
  // The values of [device] in the scene, by which build_scene() keeps the coupling stable.
  ist::DeviceMechanics mechanics() const noexcept override {
    return {.damping = 2, .angular_damping = 2e-3};
  }
  // Returns the pose of the encoders; std::nullopt if it is unknown, and the force is then zero.
  std::optional<ist::Placement> read() noexcept override { return pose_; }
  // Sends the wrench to the motors. This device feels nothing, and sinks by 4 mm/s.
  void write(const ist::Vector6& /*wrench*/, double dt) noexcept override {
    pose_.translation.z() -= 0.004 * dt;
  }

 private:
  ist::Placement pose_;
};

int main(int argc, char** argv) try {
  ist::BuiltScene built = ist::build_scene(ist::read_scene(argc > 1 ? argv[1] : "probe.toml"));
  Probe probe(*built.device->read());  // starts at the ball's pose in the scene

  // The loop writes ticks into a ring, for which a paced loop never waits.
  ist::TickRing<ist::TickRecord> ticks(1 << 10);
  std::atomic<bool> stop{false}, done{false};
  ist::ServoReport report;
  std::thread loop([&] {
    const ist::ServoOptions options{.ticks = 1000, .paced = argc > 2};
    report = ist::run_servo_loop(*built.simulation, probe, options, {.records = &ticks}, stop);
    done = true;
  });
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
} catch (const std::exception& error) {  // an ist::Error names place, cause and remedy
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
