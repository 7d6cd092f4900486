#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "ist/base/files.h"
#include "sweep/pose_source.h"
#include "sweep/row_layout.h"

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

/// Returns the header of a .npy file of `rows` rows of that layout, by which numpy.load() gives an
/// array of structs. Source: NumPy's format 1.0, numpy.lib.format.
[[nodiscard]] std::string npy_header(const RowLayout& layout, std::uint64_t rows);

/// An array of doubles in a .npy file, in C order and little-endian.
struct NpyDoubles {
  std::vector<std::uint64_t> shape;
  std::uint64_t offset;  ///< of the first number, bytes
};

/// Reads a .npy file's header from its begin. Throws kInputInvalid, with a remedy, for another
/// file, another type or order of numbers, and a file that is not as long as its shape says.
[[nodiscard]] NpyDoubles read_npy_header(InputFile& file);

}  // namespace ist
