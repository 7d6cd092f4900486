#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "ist/measure/pose_rows.h"
#include "ist/tree/sphere_tree.h"
#include "sweep/pose_source.h"
#include "sweep/sweep_body.h"

namespace ist {

/// The content of a sweep file: two bodies, poses, and the questions at each pose.
struct SweepFile {
  std::filesystem::path file;
  SweepBody fixed, moving;
  std::shared_ptr<const PoseSource> poses;
  RowQuestions questions;
  std::optional<SpherePolicy> spheres;  ///< by default the tightest that both bodies have
  double margin = 0;                    ///< springs begin at this distance, mean voxel sizes
  double stiffness = 1;                 ///< of springs, N/mm³ for meshes in mm
  std::uint64_t rows_per_part = 100000;
};

/// The most poses of a sweep, and the most parts.
inline constexpr std::uint64_t kMostRows = 1'000'000'000'000, kMostParts = 1'000'000;

/// Reads a sweep file (TOML), opens its file of poses, and computes the hashes of its bodies.
/// Throws kFileUnreadable; kInputInvalid with line and remedy for a wrong value, an unknown key, a
/// missing body, and a body that has another hash than the sweep file says; kNotATree,
/// kTreeVersion, kTreeTruncated.
[[nodiscard]] SweepFile read_sweep_file(const std::filesystem::path& file);

}  // namespace ist
