/// Runs the tool of docs/chai3d.md in the hand of a scripted device: free, pressed 2 mm into the
/// block of probe.toml, free again and turned, 4,000 turns in all. chai3d_tool.py writes the page's
/// class to ist_tool.h, and compiles this with CHAI3D or with the declarations of stubs/.
///
///   turns SCENE

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

#include "ist_tool.h"

namespace {

constexpr int kTurns = 4000;    // of a millisecond each
constexpr double kWay = 0.004;  // downwards, m; the block begins after half of it
constexpr double kInside = 0.002;
constexpr double kAngle = 0.1;  // about the scene's x axis, at the end, radians

int failures = 0;

void holds(const char* what, double value, double least, double most) {
  const bool is_held = value >= least && value <= most;
  std::printf("%-32s %12.6g, from %g to %g%s\n", what, value, least, most,
              is_held ? "" : ": WRONG");
  if (!is_held) ++failures;
}

double length(const chai3d::cVector3d& v) { return std::hypot(v(0), v(1), v(2)); }

chai3d::cVector3d cross(const chai3d::cVector3d& a, const chai3d::cVector3d& b) {
  return {a(1) * b(2) - a(2) * b(1), a(2) * b(0) - a(0) * b(2), a(0) * b(1) - a(1) * b(0)};
}

/// A device whose frame is turned and placed otherwise than the scene's.
class ScriptedDevice : public chai3d::cGenericHapticDevice {
 public:
  bool open() override { return is_open = true; }
  bool close() override {
    is_open = false;
    return true;
  }
  bool calibrate(bool /*force_calibration*/) override { return true; }
  bool getPosition(chai3d::cVector3d& at) override {
    at = position;
    return true;
  }
  bool getRotation(chai3d::cMatrix3d& turn) override {
    turn = rotation;
    return true;
  }
  bool setForceAndTorqueAndGripperForce(const chai3d::cVector3d& newtons,
                                        const chai3d::cVector3d& newton_metres,
                                        const double gripper) override {
    force = newtons;
    torque = newton_metres;
    gripper_force = gripper;
    return true;
  }

  bool is_open = false;
  chai3d::cVector3d position{0.03, -0.02, 0.05}, force{0, 0, 0}, torque{0, 0, 0};
  chai3d::cMatrix3d rotation{0.6, 0.0, 0.8, 0.0, 1.0, 0.0, -0.8, 0.0, 0.6};
  double gripper_force = 1;
};

/// The part of the way that is done: rests of half a second, ways of a second, a second pressed.
double part_at(int turn) {
  return std::clamp(std::min(turn - 500, 3500 - turn) / 1000.0, 0.0, 1.0);
}

/// A turn about the x axis, after the way.
chai3d::cMatrix3d turned_at(int turn) {
  const double angle = kAngle * std::clamp((turn - 3500) / 400.0, 0.0, 1.0);
  const double c = std::cos(angle), s = std::sin(angle);
  return chai3d::cMatrix3d(1.0, 0.0, 0.0, 0.0, c, -s, 0.0, s, c);
}

void run(ist_servo* servo) {
  ist_servo_info info = {};
  info.struct_size = sizeof info;
  ist_servo_get_info(servo, &info);
  const chai3d::cVector3d start(info.tool[12], info.tool[13],
                                info.tool[14]);  // about which torques are
  const chai3d::cVector3d centre(0, 0, 0.012);   // of the ball, where it starts

  const auto world = std::make_unique<chai3d::cWorld>();
  const auto tool = new IstTool(world.get(), servo);  // its world deletes it
  world->addChild(tool);
  const auto device = std::make_shared<ScriptedDevice>();
  tool->setHapticDevice(device);
  holds("started", tool->start(), 1, 1);
  tool->begin();
  const chai3d::cMatrix3d turn = tool->getGlobalRot();
  const chai3d::cVector3d begin = device->position;
  const chai3d::cMatrix3d begin_turned = device->rotation;

  int errors = 0;
  for (int i = 0; i < kTurns; ++i) {
    const chai3d::cVector3d down(0, 0, -kWay * part_at(i));
    device->position = begin + chai3d::cTranspose(turn) * down;
    device->rotation = chai3d::cMul(chai3d::cMul(chai3d::cTranspose(turn), turned_at(i)),
                                    chai3d::cMul(turn, begin_turned));
    world->computeGlobalPositions(true);
    tool->updateFromDevice();
    if (i == 0)
      holds("begins off its start, m", length(tool->getDeviceGlobalPos() - start), 0, 1e-12);
    tool->computeInteractionForces();
    tool->applyToDevice();
    if (tool->last() != IST_OK) ++errors;

    world->computeGlobalPositions(true);
    const chai3d::cVector3d force = turn * device->force, image = tool->m_image->getGlobalPos();
    const double sunk = image(2) - tool->getDeviceGlobalPos()(2);
    if (i == 499) holds("free: force, N", length(force), 0, 1e-6);
    if (i == 2499) {
      holds("pressed: upwards, N", force(2), 0.2, 20);
      holds("pressed: sideways of upwards", std::hypot(force(0), force(1)) / force(2), 0, 0.05);
      holds("pressed: torque off it, N m",
            length(turn * device->torque - cross(centre - start, force)), 0, 2e-4);
      holds("pressed: drawn above hand, m", sunk, 0.75 * kInside, 1.25 * kInside);
    }
    if (i == kTurns - 1) {
      holds("free again: force, N", length(force), 0, 1e-3);
      holds("free again: drawn off hand, m", std::abs(sunk), 0, 1e-5);
      holds("free again: drawn turned, sine", tool->m_image->getGlobalRot()(2, 1),
            std::sin(kAngle) - 1e-4, std::sin(kAngle) + 1e-4);
      holds("gripper, N", device->gripper_force, 0, 0);
    }
  }
  ist_servo_get_info(servo, &info);
  holds("ticks", static_cast<double>(info.ticks), kTurns, kTurns);
  holds("turns that were not IST_OK", errors, 0, 0);
  holds("faults", static_cast<double>(info.faults), 0, 0);
  tool->stop();
  holds("open after stop()", device->is_open, 0, 0);
}

}  // namespace

int main(int argc, char** argv) {
  ist_servo_options options = {};
  options.struct_size = sizeof options;
  options.unit = IST_UNIT_M;
  options.sphere_tests = 1'000'000;  // and no limit of time, so that each run gives the same forces
  ist_servo* servo = nullptr;
  if (argc != 2 || ist_servo_open_scene(argv[1], &options, &servo) != IST_OK) {
    std::fprintf(stderr, "turns SCENE: %s\n", ist_last_error_message());
    return 2;
  }
  run(servo);
  ist_servo_free(servo);
  return failures == 0 ? 0 : 1;
}
