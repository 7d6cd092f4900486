#pragma once

#include <filesystem>
#include <string>

#include "ist/base/files.h"
#include "ist/sweep/pose_source.h"

namespace ist {

/// Poses from a .npy file of float64, shape (N, 4, 4), each row by row. The file stays open, and a
/// part reads of it the poses that it needs.
class NpyPoses : public PoseSource {
 public:
  /// Opens the file and computes its hash. Throws kFileUnreadable; kInputInvalid for another file
  /// or shape. Has cancellation points.
  explicit NpyPoses(const std::filesystem::path& file);

  [[nodiscard]] std::uint64_t count() const override { return count_; }
  void read(std::uint64_t first, std::span<Eigen::Isometry3d> poses) const override;
  [[nodiscard]] std::string identity() const override;
  void require_unchanged() const override;

 private:
  InputFile file_;
  std::int64_t written_at_;
  std::uint64_t count_, offset_;
  std::string hash_;
};

}  // namespace ist
