#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace ist::cli {

/// Weights of a triangle's corners at a place, which add up to 1. Coordinates are samples, y runs
/// down, and z is towards the eye.
class Weights {
 public:
  Weights(const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Eigen::Vector3f& c)
      : a_(a.head<2>()), u_(b.head<2>() - a_), v_(c.head<2>() - a_) {
    const float area = u_.x() * v_.y() - u_.y() * v_.x();
    scale_ = area == 0 ? 0 : 1 / area;
  }
  /// Not if it is a line to the eye.
  [[nodiscard]] bool has_area() const { return scale_ != 0 && std::isfinite(scale_); }
  /// Whether it is counter-clockwise to the eye.
  [[nodiscard]] bool faces_eye() const { return scale_ < 0; }
  [[nodiscard]] Eigen::Vector3f at(float x, float y) const {
    const float dx = x - a_.x(), dy = y - a_.y();
    const float b = (dx * v_.y() - dy * v_.x()) * scale_;
    const float c = (u_.x() * dy - u_.y() * dx) * scale_;
    return {1 - b - c, b, c};
  }

 private:
  Eigen::Vector2f a_, u_, v_;
  float scale_;
};

/// For each sample of a picture the triangle that is nearest to the eye.
class DepthBuffer {
 public:
  static constexpr std::uint32_t kNothing = 0xFFFFFFFF;

  DepthBuffer(int width, int height)
      : width_(width),
        height_(height),
        triangles_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), kNothing),
        near_(triangles_.size(), -std::numeric_limits<float>::infinity()) {}

  /// Draws a triangle; of two that are equally near the first stays.
  void draw(std::uint32_t index, const Eigen::Vector3f& a, const Eigen::Vector3f& b,
            const Eigen::Vector3f& c) {
    const Weights weights(a, b, c);
    if (!weights.has_area()) return;
    const Eigen::Vector3f low = a.cwiseMin(b).cwiseMin(c), high = a.cwiseMax(b).cwiseMax(c);
    const int begin = first(low.x()), end = last(high.x(), width_);
    const Eigen::Vector3f near(a.z(), b.z(), c.z());
    for (int y = first(low.y()); y <= last(high.y(), height_); ++y) {
      for (int x = begin; x <= end; ++x) {
        const Eigen::Vector3f weight = weights.at(centre(x), centre(y));
        if (weight.minCoeff() < 0) continue;
        const std::size_t at = place(x, y);
        const float depth = near.dot(weight);
        if (depth <= near_[at]) continue;
        near_[at] = depth;
        triangles_[at] = index;
      }
    }
  }
  /// kNothing on the background.
  [[nodiscard]] std::uint32_t triangle(int x, int y) const { return triangles_[place(x, y)]; }
  /// The middle of a sample.
  [[nodiscard]] static float centre(int x) { return static_cast<float>(x) + 0.5f; }

 private:
  [[nodiscard]] static int first(float low) {
    return static_cast<int>(std::clamp(std::floor(low), 0.0f, 1e6f));
  }
  [[nodiscard]] static int last(float high, int count) {
    return static_cast<int>(std::clamp(std::floor(high), -1.0f, static_cast<float>(count - 1)));
  }
  [[nodiscard]] std::size_t place(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(x);
  }

  int width_, height_;
  std::vector<std::uint32_t> triangles_;
  std::vector<float> near_;
};

}  // namespace ist::cli
