#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "answers/bodies.h"
#include "cli/cli11_fwd.h"
#include "ist/base/progress.h"
#include "ist/mesh/mesh.h"
#include "ist/tree/sphere_tree.h"

namespace ist::cli {

/// A mesh read from a file, with warnings of its flaws as sentences.
struct CheckedMesh {
  TriangleMesh mesh;
  std::vector<std::string> warnings;
  bool has_border = false;  ///< no flaw, because scans have one
};
/// Reads and checks a mesh. Throws kNotAMesh for a tree, and the errors of read_mesh().
[[nodiscard]] CheckedMesh load_mesh(const std::filesystem::path& file);

/// Prints "warning: …" lines to stderr.
void print_warnings(const std::vector<std::string>& warnings);

/// Returns a sentence without a full stop about the files whose surfaces have a border.
[[nodiscard]] std::string open_surfaces(const std::vector<std::string>& names);

/// Refuses a --voxel-size of 0.
void check_voxel_size(const std::optional<double>& voxel_size);

/// Builds a tree under a progress bar: its own, or `progress`. Adds a warning that begins with
/// `name` if components were turned outward.
[[nodiscard]] SphereTree build_with_progress(const std::string& name, TriangleMesh mesh,
                                             const BuildOptions& options,
                                             std::vector<std::string>& warnings,
                                             BuildReport* report = nullptr,
                                             Progress* progress = nullptr);

/// The files of two bodies: each a mesh to build, or a tree to read.
struct BodyFiles {
  /// Whether meshes get voxels.
  enum class Voxels : std::uint8_t {
    kMade,    ///< and trees must have some
    kNeeded,  ///< made if the other body is a tree without triangles
    kNone,
  };

  std::filesystem::path fixed, moving;
  Voxels voxels = Voxels::kMade;
  std::string voxels_for = "this command";  ///< with kMade: the option that needs them, for errors
  /// Of meshes that get voxels, mesh units; empty: 1/500 of Bodies::extent().
  std::optional<double> voxel_size;
  std::optional<SpherePolicy> policy;  ///< empty: the tightest that both have
  std::uint64_t max_memory = BuildOptions{}.max_memory;
  LengthUnit unit = LengthUnit::kUnknown;          ///< of both files, if they do not say it
  LengthUnit moving_unit = LengthUnit::kUnknown;   ///< of the moving one, if it has another one
  PatientFrame to_frame = PatientFrame::kUnknown;  ///< meshes of the other frame are turned into it
};

/// Adds --unit, --unit-moving and --to-frame to a subcommand.
void add_units_and_frame(CLI::App& command, BodyFiles& files);

/// Loads both bodies. Trees of meshes keep their triangles. A moving mesh in another known unit
/// than the fixed body's is converted to that one.
///
/// Says on stderr if it takes a voxel size, converts or turns a mesh, if both files hold one mesh,
/// if the bodies seem to be in different units, and if voxels are large for their body. Throws
/// a Refusal for a voxel size of two trees, for a moving tree of another unit than the
/// fixed body's, for a unit that a file contradicts, and for files in different frames.
[[nodiscard]] answers::Bodies load_bodies(const BodyFiles& files);

/// Loads one body. A mesh gets no voxels.
[[nodiscard]] SphereTree load_body(const std::filesystem::path& file, std::uint64_t max_memory);

}  // namespace ist::cli
