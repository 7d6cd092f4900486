#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "ist/measure/pose_rows.h"
#include "ist/mesh/mesh.h"
#include "ist/tree/sphere_tree.h"
#include "loop/scene/table_reader.h"

namespace ist {

/// A body of a sweep, as the sweep file names it: a mesh or a tree.
struct SweepBody {
  std::filesystem::path file;  ///< the sweep file names it relative to its own folder
  std::string hash;            ///< XXH3-128 of the file
  std::string place;           ///< of its name, for messages: "job.toml:5: 'file' in [fixed]"
  bool is_mesh = false;
  double voxel_size = 0;  ///< of a mesh, mesh units; 0: its tree has no voxels
  /// Of a mesh, if its file does not say it.
  LengthUnit unit = LengthUnit::kUnknown;
  PatientFrame frame = PatientFrame::kUnknown;

  /// Returns a text that differs for another file or other options.
  [[nodiscard]] std::string identity() const;
};

/// Reads the keys of a body: `name = "upper.stl"`, or a table [name] with `file` and options. The
/// hash stays empty. Throws kInputInvalid with line and remedy for a wrong value, a missing file,
/// and a mesh without the voxels that the questions need; kFileUnreadable.
[[nodiscard]] SweepBody read_sweep_body(TableReader& sweep, std::string_view name,
                                        const RowQuestions& questions);

/// Computes the hash of the file. Throws kInputInvalid if the key `hash` has another one;
/// kFileUnreadable; the errors of a tree's header. Has cancellation points.
void compute_hash(TableReader& sweep, std::string_view name, SweepBody& body);

/// Reads the tree, or builds it of the mesh. Each error begins with SweepBody::place.
///
/// @param spheres the bounds of voxels that a mesh gets; by default the tightest
///
/// Throws kInputInvalid if the file has another hash than SweepBody::hash, or a mesh says another
/// unit or frame than the sweep file; what read_mesh(), build_tree() and read_tree() do. Has
/// cancellation points.
[[nodiscard]] SphereTree load_tree(const SweepBody& body, std::optional<SpherePolicy> spheres);

}  // namespace ist
