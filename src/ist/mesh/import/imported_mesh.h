#pragma once

#include <filesystem>
#include <string_view>

#include "ist/mesh/mesh.h"

namespace ist {

/// Reads the content of a file by the program ist-import: glTF, 3MF and what assimp knows. A crash
/// of a foreign reader ends that process alone. It gets the content, and the file's path for side
/// files, in a process with limits: 4 GiB, 120 seconds, no network, no file to write. No process,
/// zombie or file descriptor stays behind, however the call ends.
///
/// The program is the one that the environment variable IST_IMPORT names; else it lies beside the
/// library, in ../libexec/ist or ../../libexec/ist seen from there, in the libexec folder of the
/// build's prefix, or beside the host's program.
/// Any number of threads may call. Ends at a cancellation point.
/// Errors: the ones of read_mesh(); kFileUnreadable if the program is missing, has another version
/// or cannot run; kNotAMesh if it crashes; kMeshTooLarge if it meets a limit.
[[nodiscard]] TriangleMesh read_imported(std::string_view content,
                                         const std::filesystem::path& file);

}  // namespace ist
