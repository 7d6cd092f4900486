#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <span>

#include "ist/base/progress.h"
#include "sweep/row_layout.h"
#include "sweep/sweep_file.h"
#include "sweep/sweep_folder.h"

namespace ist {

/// The same questions about two bodies at many poses, cut into parts that any process may make.
///
/// A sweep is read from a file; its poses are computed from their index, or read from their file,
/// when a part asks for them. The rows of a part are the same bytes whoever makes it, by any number
/// of threads. Any number of threads may call the functions of one sweep at a time.
class Sweep {
 public:
  /// Reads the sweep file and computes the hashes of the files that it names. The first part loads
  /// trees, and builds trees of meshes. Throws the errors of read_sweep_file(). Has cancellation
  /// points.
  explicit Sweep(const std::filesystem::path& file);

  [[nodiscard]] const SweepFile& file() const noexcept { return file_; }
  [[nodiscard]] const RowLayout& layout() const noexcept { return layout_; }
  [[nodiscard]] const SweepIdentity& identity() const noexcept { return identity_; }
  /// The number of poses. Each pose has a row.
  [[nodiscard]] std::uint64_t rows() const noexcept { return identity_.rows; }
  [[nodiscard]] std::uint64_t parts() const noexcept { return identity_.parts(); }

  /// Computes the poses from number `first` on. Precondition: first + poses.size() <= rows().
  void poses(std::uint64_t first, std::span<Eigen::Isometry3d> poses) const;

  /// Opens the folder of the parts. If nobody has begun, loads the bodies and makes the folder, so
  /// that a sweep whose bodies cannot answer leaves none. Throws what SweepFolder and run_part()
  /// do.
  [[nodiscard]] SweepFolder open_folder(const std::filesystem::path& folder) const;

  /// How run_part() ended.
  enum class Outcome { kMade, kWasThere, kGivenUp, kStopped };

  /// Makes a part in the folder, unless it is there or was begun and lost three times.
  ///
  /// @param threads the most threads; 0: one for each core
  /// @param proceed asked every 20 ms with the share of the part that is done; false ends the call
  ///                (kStopped), and leaves no file
  ///
  /// Throws kPartBusy if another process is making the part now (shares overlap); kInputInvalid
  /// for a part that is there and of another sweep or damaged, and for a body or a file of poses
  /// that changed since; kPolicyMissing; UnwritableFile; what answer_rows() throws. Has
  /// cancellation points.
  /// Memory: the trees, and for each thread a query and 2 MB.
  Outcome run_part(const SweepFolder& folder, std::uint64_t part, std::size_t threads,
                   const Proceed& proceed = {}) const;

 private:
  struct Bodies;
  // Loads the bodies once. Throws if their files changed since identity() was computed.
  [[nodiscard]] std::shared_ptr<const Bodies> bodies() const;
  // Writes a part's rows. Returns whether `proceed` let it come to its end.
  bool write_rows(std::uint64_t part, const Bodies& bodies, std::size_t threads,
                  const std::function<void(std::span<const std::byte>)>& write,
                  const Proceed& proceed) const;

  SweepFile file_;
  RowLayout layout_;
  SweepIdentity identity_;
  mutable std::mutex loading_;
  mutable std::shared_ptr<const Bodies> bodies_;
};

}  // namespace ist
