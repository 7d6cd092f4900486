#include "loop/haptics/bodies/hand_bodies.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace ist {

HandBodies::HandBodies(double unit, const Placement& home, std::vector<BodyPart> parts)
    : unit_(unit) {
  bool is_first = true;
  for (BodyPart& part : parts) {
    Body body{.name = std::move(part.name),
              .place = part.place,
              .next = part.place,
              .origin = part.centre,
              .centre = part.centre,
              .radius = part.radius,
              .held = part.held,
              .attachable = part.attachable,
              .script = std::move(part.script)};
    // The tool's frame is that of the first held body, which needs no rounding.
    if (body.held && !std::exchange(is_first, false)) take(body, home);
    has_scripts_ |= body.script.has_value();
    bodies_.push_back(std::move(body));
  }
}

void HandBodies::take(Body& body, const Placement& tool) const noexcept {
  const Eigen::Matrix3d to_tool = tool.rotation.transpose();
  body.turn = to_tool * body.place.rotation;
  body.origin =
      body.turn.transpose() * (to_tool * ((tool.translation - body.place.translation) / unit_));
}

Placement HandBodies::place(std::size_t body, const Placement& tool) const noexcept {
  const Body& of = bodies_[body];
  if (!of.held) return of.place;
  const Eigen::Matrix3d rotation = tool.rotation * of.turn;
  return {rotation, tool.translation - unit_ * (rotation * of.origin)};
}

// From the tool's origin to the middle of a held body, tool axes, m.
Eigen::Vector3d HandBodies::arm(const Body& held) const noexcept {
  return unit_ * (held.turn * (held.centre - held.origin));
}

HandBodies::Ball HandBodies::ball(std::size_t fixed) const noexcept {
  const Body& body = bodies_[fixed];
  return {body.place.rotation * (unit_ * body.centre) + body.place.translation, body.radius};
}

double HandBodies::gap(std::size_t fixed, std::size_t held, const Placement& tool) const noexcept {
  const auto [centre, radius] = ball(fixed);
  const Eigen::Vector3d to = tool.rotation * arm(bodies_[held]) + tool.translation;
  return std::sqrt((to - centre).squaredNorm()) - (radius + bodies_[held].radius);
}

double HandBodies::held_radius() const noexcept {
  double radius = 0;
  for (const Body& body : bodies_) {
    if (body.held) radius = std::max(radius, std::sqrt(arm(body).squaredNorm()) + body.radius);
  }
  return radius;
}

void HandBodies::attach(std::size_t body, const Placement& tool) noexcept {
  take(bodies_[body], tool);
  bodies_[body].held = true;
}

void HandBodies::release(std::size_t body, const Placement& tool) noexcept {
  bodies_[body].place = bodies_[body].next = place(body, tool);
  bodies_[body].held = false;
}

void HandBodies::set_time(double time, double step) noexcept {
  for (Body& body : bodies_) {
    if (!body.script) continue;
    body.place = body.script->at(time).pose;
    body.next = body.script->at(time + step).pose;
  }
}

Vector6 HandBodies::drift(std::size_t fixed, const Placement& tool) const noexcept {
  const Body& body = bodies_[fixed];
  const bool rests =
      body.next.rotation == body.place.rotation && body.next.translation == body.place.translation;
  if (rests) return Vector6::Zero();
  const Eigen::Matrix3d turn = body.next.rotation * body.place.rotation.transpose();
  Vector6 drift = motion_between({body.place.rotation}, {body.next.rotation});
  drift.head<3>() = (turn * (tool.translation - body.place.translation) + body.next.translation) -
                    tool.translation;
  return drift;
}

}  // namespace ist
