#pragma once

#include <filesystem>
#include <string_view>

#include "ist/mesh/mesh.h"

namespace ist {

/// Reads the content of a file by the program ist-import: glTF, 3MF and what assimp knows. A crash
/// of a foreign reader ends that process alone. The program gets the content, and the file's path
/// for side files. Its limits are 4 GiB of memory, 60 seconds of processor time and 120 seconds on
/// the clock, no network, no file to write. No process, zombie or file descriptor stays behind,
/// however the call ends.
///
/// The environment variable IST_IMPORT names the program by an absolute path. Without it the
/// program lies beside the library, in ../libexec/ist or ../../libexec/ist seen from there, in the
/// libexec folder of the build's prefix, or beside the host's program.
/// Any number of threads may call. Ends at a cancellation point.
/// Errors: the ones of read_mesh(); kFileUnreadable if the program is missing, has another version
/// or cannot run; kNotAMesh if it crashes; kMeshTooLarge if it meets a limit.
[[nodiscard]] TriangleMesh read_imported(std::string_view content,
                                         const std::filesystem::path& file);

/// Returns the formats that this platform reads, for messages: without processes there is no
/// ist-import.
[[nodiscard]] std::string_view readable_formats();

}  // namespace ist
