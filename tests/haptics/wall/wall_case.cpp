#include "haptics/wall/wall_case.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <numbers>
#include <utility>

#include "ist/tree/sphere_tree.h"
#include "loop/haptics/simulation_parts.h"
#include "support/shapes.h"

namespace ist::test {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Placement at_mm(double x, double y, double z, const Matrix3d& turn) {
  return {turn, 1e-3 * Vector3d(x, y, z)};
}

Matrix3d turn_about(const Vector3d& axis, double degrees) {
  return Eigen::AngleAxisd(degrees * std::numbers::pi / 180, axis.normalized()).toRotationMatrix();
}

TriangleMesh fine_box(const Vector3d& min, const Vector3d& max, int cells) {
  TriangleMesh mesh;
  std::map<std::array<int, 3>, std::uint32_t> vertices;
  const auto at = [&](int i, int j, int k) {
    const auto [found, is_new] =
        vertices.try_emplace({i, j, k}, static_cast<std::uint32_t>(mesh.vertices.size()));
    if (is_new) {
      const Vector3d part = Vector3d(i, j, k) / cells;
      mesh.vertices.emplace_back(min + part.cwiseProduct(max - min));
    }
    return found->second;
  };
  const auto square = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  };
  const int n = cells;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      square(at(i, j, 0), at(i, j + 1, 0), at(i + 1, j + 1, 0), at(i + 1, j, 0));
      square(at(i, j, n), at(i + 1, j, n), at(i + 1, j + 1, n), at(i, j + 1, n));
      square(at(i, 0, j), at(i + 1, 0, j), at(i + 1, 0, j + 1), at(i, 0, j + 1));
      square(at(i, n, j), at(i, n, j + 1), at(i + 1, n, j + 1), at(i + 1, n, j));
      square(at(0, i, j), at(0, i, j + 1), at(0, i + 1, j + 1), at(0, i + 1, j));
      square(at(n, i, j), at(n, i + 1, j), at(n, i + 1, j + 1), at(n, i, j + 1));
    }
  }
  return mesh;
}

TriangleMesh prism(const std::vector<Eigen::Vector2d>& outline, double half) {
  TriangleMesh mesh;
  const auto n = static_cast<std::uint32_t>(outline.size());
  for (const double x : {-half, half}) {
    for (const Eigen::Vector2d& point : outline) mesh.vertices.emplace_back(x, point[0], point[1]);
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t next = (i + 1) % n;
    mesh.triangles.push_back({i, next + n, next});
    mesh.triangles.push_back({i, i + n, next + n});
    if (i == 0 || next == 0) continue;
    mesh.triangles.push_back({0, next, i});
    mesh.triangles.push_back({n, i + n, next + n});
  }
  return mesh;
}

TriangleMesh wall_plate() { return box({-20, -20, -2}, {20, 20, 0}); }
TriangleMesh wall_cube() { return box({-5, -5, -5}, {5, 5, 5}); }

namespace {

double radius_of(const TriangleMesh& mesh) {
  double radius = 0;
  for (const Vector3d& vertex : mesh.vertices) radius = std::max(radius, vertex.norm());
  return 1e-3 * radius;
}

}  // namespace

WallCase::WallCase(std::vector<WallFixed> fixed, const TriangleMesh& held, const Placement& start,
                   const WallCaseOptions& options, std::unique_ptr<Effect> effect)
    : options_(options), device_(start) {
  detail::SimulationParts parts{.coupling = {kStiffness, 0, 1, 0, options.max_force, 100},
                                .safety = {1e4, 1e3, 1e9, 1e9, 0},
                                .max_step = Tool::kNoLimit,
                                .start = start,
                                .dt = 1e-3};
  if (effect) parts.effects.push_back(std::move(effect));
  const auto tool = std::make_shared<const WallBody>(build_tree(held));
  std::vector<BodyPart> bodies;
  parts.wall.emplace(WallSettings{kSkin, kTrust, kSteps, options.friction});
  for (std::size_t i = 0; i < fixed.size(); ++i) {
    const auto body = std::make_shared<const WallBody>(build_tree(fixed[i].mesh));
    const Placement place = fixed[i].script ? fixed[i].script->start() : Placement();
    bodies.push_back({.name = "fixed",
                      .place = place,
                      .centre = Vector3d::Zero(),
                      .radius = radius_of(fixed[i].mesh),
                      .script = std::move(fixed[i].script)});
    WallPair::Options of_pair;
    of_pair.workers = options.workers;
    of_pair.target = options.target;
    parts.wall->add({i, fixed.size()}, std::make_unique<WallPair>(body, tool, of_pair));
    judges_.push_back(std::make_unique<Query>(body->tree, tool->tree));
  }
  bodies.push_back({.name = "held",
                    .place = Placement(),
                    .centre = Vector3d::Zero(),
                    .radius = radius_of(held),
                    .held = true});
  parts.bodies = HandBodies(1e-3, Placement(), std::move(bodies));
  sim_.emplace(detail::simulation_from(std::move(parts)));
}

Eigen::Isometry3d WallCase::judged(std::size_t body, const Placement& tool) const {
  return BodyFrames{1e-3, sim_->body_pose(body), Vector3d::Zero()}.query_pose(tool);
}

void WallCase::expect_bounds(const Tick& tick, const Placement& device, const Placement& tool) {
  const Vector6 stretch = motion_between(tick.tool, tick.device);
  const double force = kStiffness * stretch.head<3>().norm();
  const double part = force > options_.max_force ? options_.max_force / force : 1;
  EXPECT_LE(tick.wrench.head<3>().norm(), options_.max_force * (1 + 1e-12));
  EXPECT_LT((tick.wrench.head<3>() + part * kStiffness * stretch.head<3>()).norm(), 1e-9);
  // Small turns are added within a tick.
  const double turn = motion_between(tool, tick.tool).tail<3>().norm();
  const double turns = stretch.tail<3>().norm() + turn;
  EXPECT_LT((tick.wrench.tail<3>() + stretch.tail<3>()).norm(), 1e-9 + turn * turns * (1 + turns));
  if (is_new_) return;
  const double way = (tick.device.translation - device.translation).norm();
  EXPECT_LE((tick.wrench - wrench_).head<3>().norm(), kStiffness * (way + kSteps * kTrust) + 1e-9);
}

Tick WallCase::tick(const std::optional<Placement>& device, const TickBudget& budget) {
  const Placement before = std::exchange(device_, device.value_or(device_)), last = pose();
  const Tick tick = sim_->tick(device, budget);
  held_ += tick.held;
  halved_ += tick.halved;
  for (std::size_t i = 0; i < judges_.size(); ++i) {
    EXPECT_EQ(judges_[i]->intersects(judged(i, tick.tool)).answer, Answer::kNo) << "body " << i;
  }
  if (tick.fault) {
    EXPECT_EQ(tick.wrench, Vector6(Vector6::Zero()));
  } else {
    expect_bounds(tick, before, last);
  }
  is_new_ = tick.fault;
  wrench_ = tick.wrench;
  unsigned char bytes[sizeof(double) * 12];
  std::memcpy(bytes, tick.tool.rotation.data(), 9 * sizeof(double));
  std::memcpy(bytes + 9 * sizeof(double), tick.tool.translation.data(), 3 * sizeof(double));
  for (const unsigned char byte : bytes) path_ = (path_ ^ byte) * 0x100000001b3;
  return tick;
}

Tick WallCase::hold(const Placement& device, int ticks) {
  Tick last;
  for (int i = 0; i < ticks; ++i) last = tick(device);
  return last;
}

Tick WallCase::go(const Placement& to, int ticks) {
  const Placement from = device_;
  const Vector6 motion = motion_between(from, to);
  Tick last;
  for (int i = 1; i <= ticks; ++i) {
    last = tick(i == ticks ? to : from.moved(motion * (static_cast<double>(i) / ticks)));
  }
  return last;
}

Tick WallCase::go_at(const Placement& to, double speed) {
  const double way = 1e3 * (to.translation - device_.translation).norm();
  return go(to, std::max(1, static_cast<int>(std::lround(1e3 * way / speed))));
}

double WallCase::gap() {
  double least = HUGE_VAL;
  for (std::size_t i = 0; i < judges_.size(); ++i) {
    const Eigen::Isometry3d pose = judged(i, sim_->tool_pose());
    least = std::min(least, judges_[i]->distance(pose, 1e-8).nearest->distance);
  }
  return least;
}

void expect_balance(const Tick& tick) {
  Vector3d force = Vector3d::Zero(), torque = Vector3d::Zero();
  for (const ContactPoint& point : tick.points) {
    const Vector3d on_tool = point.position + point.gap * point.normal;
    force += point.force;
    torque += (on_tool - tick.tool.translation).cross(point.force);
  }
  EXPECT_LT((force - tick.wrench.head<3>()).norm(), 1e-8);
  EXPECT_LT((torque - tick.wrench.tail<3>()).norm(), 1e-8);
}

}  // namespace ist::test
