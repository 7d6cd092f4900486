#include "cli/occlusion/map_picture.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "answers/formats/poly_data.h"
#include "answers/occlusion/map_statistics.h"

namespace ist::cli {

using namespace answers;

namespace {

// Weights of a triangle's corners at a place, which add up to 1. Coordinates are samples, y runs
// down, and z is towards the eye.
class Weights {
 public:
  Weights(const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Eigen::Vector3f& c)
      : a_(a.head<2>()), u_(b.head<2>() - a_), v_(c.head<2>() - a_) {
    const float area = u_.x() * v_.y() - u_.y() * v_.x();
    scale_ = area == 0 ? 0 : 1 / area;
  }
  // Not if it is a line to the eye.
  [[nodiscard]] bool has_area() const { return scale_ != 0 && std::isfinite(scale_); }
  // Whether it is counter-clockwise to the eye.
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

// For each sample of a picture the triangle that is nearest to the eye.
class DepthBuffer {
 public:
  static constexpr std::uint32_t kNothing = 0xFFFFFFFF;

  DepthBuffer(int width, int height)
      : width_(width),
        height_(height),
        triangles_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), kNothing),
        near_(triangles_.size(), -std::numeric_limits<float>::infinity()) {}

  // Draws a triangle; of two that are equally near the first stays.
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
  // kNothing on the background.
  [[nodiscard]] std::uint32_t triangle(int x, int y) const { return triangles_[place(x, y)]; }
  // The middle of a sample.
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

using Eigen::Vector3f;

constexpr int kFine = 2;  // samples along the edge of a pixel
const Vector3f kWhite(255, 255, 255), kInnerSide(150, 142, 136);

// The mesh as the eye sees it.
struct SeenMesh {
  std::vector<Vector3f> points;   // in samples from the first, and down; z towards the eye
  std::vector<Vector3f> normals;  // across, up, towards
};

SeenMesh seen(const BiteBody& body, const BiteView& view, int width, int height) {
  SeenMesh mesh;
  const std::vector<Vector3f> normals = vertex_normals(poly_data(*body.mesh));
  Eigen::Matrix3d axes;
  axes << view.across, view.up, view.towards;
  const Eigen::Matrix3f turn = (axes.transpose() * body.to_fixed.linear()).cast<float>();
  for (std::size_t v = 0; v < normals.size(); ++v) {
    const Eigen::Vector3d point = body.to_fixed * body.mesh->vertices[v];
    const Eigen::Vector2d place = kFine * place_in(view, width, height, point);
    const double near = view.towards.dot(point - view.middle) / view.pixel;
    mesh.points.emplace_back(place.cast<float>().x(), place.cast<float>().y(),
                             static_cast<float>(near));
    mesh.normals.push_back(turn * normals[v]);
  }
  return mesh;
}

// Whether the numbers may be taken as linear on a triangle: known at all corners, and nowhere
// steeper than they can be.
bool is_mapped(const BiteBody& body, const ShownMap& map, const Triangle& t) {
  for (std::size_t i = 0; i < 3; ++i) {
    const std::uint32_t a = t[i], b = t[(i + 1) % 3];
    const double apart = (body.mesh->vertices[a] - body.mesh->vertices[b]).norm();
    const double differ = std::abs(map.numbers[a] - map.numbers[b]);
    if (!(differ <= 1.001 * map.steepest * apart)) return false;  // nor with a NaN
  }
  return true;
}

Vector3f vector_of(const Colour& colour) { return Vector3f(colour[0], colour[1], colour[2]); }

// A surface that faces the eye keeps its colour. Towards the light it is paler, else darker.
Vector3f shaded(const Vector3f& colour, const Vector3f& normal) {
  const Vector3f light(-0.35f, 0.45f, 1);
  const float length = normal.norm();
  const float lit = length > 0 ? std::max(normal.dot(light) / length, 0.0f) : 1;
  if (lit <= 1) return colour * (0.4f + 0.6f * lit);
  return colour + std::min(2.2f * (lit - 1), 0.3f) * (kWhite - colour);
}

// The colours of the samples of a body.
class Painter {
 public:
  Painter(const BiteBody& body, const ShownMap& map, const SeenMesh& mesh, const MapScale& scale)
      : body_(body), map_(map), mesh_(mesh), scale_(scale) {
    mapped_.reserve(body.mesh->triangles.size());
    for (const Triangle& t : body.mesh->triangles)
      mapped_.push_back(is_mapped(body, map, t) ? 1 : 0);
  }
  [[nodiscard]] Vector3f at(std::uint32_t triangle, int x, int y) const {
    if (triangle == DepthBuffer::kNothing) return kWhite;
    const Triangle& t = body_.mesh->triangles[triangle];
    const Weights weights(mesh_.points[t[0]], mesh_.points[t[1]], mesh_.points[t[2]]);
    const Vector3f weight = weights.at(DepthBuffer::centre(x), DepthBuffer::centre(y));
    Vector3f normal = Vector3f::Zero();
    for (int i = 0; i < 3; ++i) normal += weight[i] * mesh_.normals[t[static_cast<std::size_t>(i)]];
    if (!weights.faces_eye()) return shaded(kInnerSide, -normal);
    return shaded(flat(triangle, t, weight, x, y), normal);
  }

 private:
  [[nodiscard]] Vector3f flat(std::uint32_t triangle, const Triangle& t, const Vector3f& weight,
                              int x, int y) const {
    if (mapped_[triangle] == 0) return vector_of(kBareSurface);
    double number = 0;
    for (int i = 0; i < 3; ++i) {
      number += static_cast<double>(weight[i]) * map_.numbers[t[static_cast<std::size_t>(i)]];
    }
    const bool lined = scale_.is_hatched(number) && (x + y) % (6 * kFine) < 2 * kFine;
    return lined ? kWhite : vector_of(scale_.colour(number));
  }

  const BiteBody& body_;
  const ShownMap& map_;
  const SeenMesh& mesh_;
  const MapScale& scale_;
  std::vector<std::uint8_t> mapped_;
};

void draw_dot(Picture& picture, const Eigen::Vector2d& place, bool filled) {
  constexpr double kRadius = 3.2, kCore = 1.8;
  const auto paint = [&](int x, int y, double radius, std::uint8_t grey) {
    const double away = (Eigen::Vector2d(x + 0.5, y + 0.5) - place).norm();
    const double part = std::clamp(radius - away + 0.5, 0.0, 1.0);
    const std::size_t first =
        3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) +
             static_cast<std::size_t>(x));
    for (std::size_t i = first; i < first + 3; ++i) {
      picture.rgb[i] =
          static_cast<std::uint8_t>(std::lround(picture.rgb[i] + part * (grey - picture.rgb[i])));
    }
  };
  for (int y = std::max(0, static_cast<int>(place.y()) - 5);
       y < std::min<double>(picture.height, place.y() + 5); ++y) {
    for (int x = std::max(0, static_cast<int>(place.x()) - 5);
         x < std::min<double>(picture.width, place.x() + 5); ++x) {
      paint(x, y, kRadius, filled ? 255 : 0);
      paint(x, y, kCore, filled ? 0 : 255);
    }
  }
}

}  // namespace

Eigen::Vector2d place_in(const BiteView& view, int width, int height,
                         const Eigen::Vector3d& point) {
  const Eigen::Vector3d away = (point - view.middle) / view.pixel;
  return {0.5 * width + view.across.dot(away), 0.5 * height - view.up.dot(away)};
}

Picture draw_map(const BiteBody& body, const ShownMap& map, const BiteView& view,
                 const MapScale& scale, int width, int height) {
  const SeenMesh mesh = seen(body, view, width, height);
  DepthBuffer buffer(kFine * width, kFine * height);
  for (std::uint32_t i = 0; i < body.mesh->triangles.size(); ++i) {
    const Triangle& t = body.mesh->triangles[i];
    buffer.draw(i, mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]]);
  }
  const Painter painter(body, map, mesh, scale);
  Picture picture{width, height, {}};
  picture.rgb.resize(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      Vector3f sum = Vector3f::Zero();
      for (int sample = 0; sample < kFine * kFine; ++sample) {
        const int fine_x = kFine * x + sample % kFine, fine_y = kFine * y + sample / kFine;
        sum += painter.at(buffer.triangle(fine_x, fine_y), fine_x, fine_y);
      }
      const std::size_t at = 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                                  static_cast<std::size_t>(x));
      for (int i = 0; i < 3; ++i) {
        picture.rgb[at + static_cast<std::size_t>(i)] =
            static_cast<std::uint8_t>(std::lround(sum[i] / (kFine * kFine)));
      }
    }
  }
  return picture;
}

Picture draw_map(const BiteBody& body, const BiteView& view, std::span<const MapBand> bands,
                 int width, int height) {
  const std::vector<double> distances = distances_of(body);
  Picture picture = draw_map(body, ShownMap{distances}, view,
                             MapScale::of_bands({bands.begin(), bands.end()}), width, height);
  for (std::size_t k = 0; k < body.contacts.size(); ++k) {
    draw_dot(picture, place_in(view, width, height, body.surface.regions[k].closest),
             body.contacts[k] <= body.on_both);
  }
  return picture;
}

}  // namespace ist::cli
