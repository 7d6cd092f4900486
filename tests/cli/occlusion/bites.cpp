#include "cli/occlusion/bites.h"

#include <png.h>

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "support/shapes.h"

namespace ist::test {
namespace {

using Vector = Eigen::Vector3d;

answers::BiteBody body_of(const char* name, const SphereTree& tree, SurfaceOcclusion surface,
                          const answers::Bite& bite, const Eigen::Isometry3d& to_fixed) {
  answers::BiteBody body;
  body.name = name;
  body.hash = "0123456789abcdef";
  body.mesh = tree.triangles();
  body.to_fixed = to_fixed;
  body.closed = check_mesh(*body.mesh).closed;
  std::size_t limit = 0;
  for (const double micrometres : bite.preset->micrometres) {
    body.areas.push_back(micrometres > 0 ? surface.areas[limit++] : surface.penetrating_area);
  }
  body.sides = answers::balance_of(surface, *body.mesh, to_fixed, bite.sides);
  body.fore_aft = answers::balance_of(surface, *body.mesh, to_fixed, bite.fore_aft);
  body.surface = std::move(surface);
  return body;
}

}  // namespace

const answers::Preset& preset_of(std::string_view name) {
  for (const answers::Preset& preset : answers::presets()) {
    if (preset.name == name) return preset;
  }
  throw std::invalid_argument("no such preset");
}

std::unique_ptr<MadeBite> bite_of(const TriangleMesh& fixed, const TriangleMesh& moving,
                                  const Eigen::Isometry3d& pose, std::string_view preset) {
  auto made = std::make_unique<MadeBite>(MadeBite{
      build_tree(fixed, {.voxel_size = 0.5}), build_tree(moving, {.voxel_size = 0.5}), {}});
  answers::Bite& bite = made->bite;
  bite.pose = pose;
  bite.unit = "mm";
  bite.preset = &preset_of(preset);
  bite.sides = {Vector::UnitX(), 0, true, "+x", "-x"};
  bite.fore_aft = {Vector::UnitY(), 0, true, "+y", "-y"};
  OcclusionOptions options{.reach = bite.reach, .limits = {}};
  for (const double limit : bite.preset->micrometres) {
    if (limit > 0) options.limits.push_back(limit * bite.units_per_micrometre());
  }
  Query query(made->fixed, made->moving);
  Occlusion found = occlusion(query, pose, options);
  bite.fixed = body_of("fixed.stl", made->fixed, std::move(found.fixed), bite,
                       Eigen::Isometry3d::Identity());
  bite.moving = body_of("moving.stl", made->moving, std::move(found.moving), bite, pose);
  bite.number_contacts();
  bite.findings.touch = query.intersects(pose).answer;
  bite.findings.distance = query.distance(pose, 1e-3).distance;
  bite.findings.depth.at_vertices =
      std::max(bite.fixed.surface.depth_at_vertices, bite.moving.surface.depth_at_vertices);
  bite.findings.depth.area =
      0.5 * (bite.fixed.surface.penetrating_area + bite.moving.surface.penetrating_area);
  return made;
}

TriangleMesh plate(double half, double edge) {
  const auto squares = static_cast<std::uint32_t>(2 * half / edge + 0.5), row = squares + 1;
  TriangleMesh mesh;
  for (std::uint32_t y = 0; y < row; ++y) {
    for (std::uint32_t x = 0; x < row; ++x) {
      mesh.vertices.emplace_back(x * edge - half, y * edge - half, 0);
    }
  }
  for (std::uint32_t y = 0; y < squares; ++y) {
    for (std::uint32_t x = 0; x < squares; ++x) {
      const std::uint32_t at = y * row + x;
      mesh.triangles.push_back({at, at + 1, at + row + 1});
      mesh.triangles.push_back({at, at + row + 1, at + row});
    }
  }
  return mesh;
}

std::unique_ptr<MadeBite> sphere_over_plate(const Vector& lowest, std::string_view preset) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = lowest + Vector(0, 0, 4);
  return bite_of(plate(10, 0.25), icosphere(5, 4), pose, preset);
}

cli::Picture decoded(const std::string& png) {
  png_image image = {};
  image.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_memory(&image, png.data(), png.size()) == 0) {
    throw std::runtime_error(image.message);
  }
  const bool is_rgb = image.format == PNG_FORMAT_RGB;
  image.format = PNG_FORMAT_RGB;
  cli::Picture picture{static_cast<int>(image.width), static_cast<int>(image.height), {}};
  picture.rgb.resize(PNG_IMAGE_SIZE(image));
  if (png_image_finish_read(&image, nullptr, picture.rgb.data(), 0, nullptr) == 0 || !is_rgb) {
    throw std::runtime_error(is_rgb ? image.message : "the PNG is not of 8 bits, RGB");
  }
  return picture;
}

answers::Colour pixel_at(const cli::Picture& picture, int x, int y) {
  const std::size_t at =
      3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) +
           static_cast<std::size_t>(x));
  return {picture.rgb.at(at), picture.rgb.at(at + 1), picture.rgb.at(at + 2)};
}

}  // namespace ist::test
