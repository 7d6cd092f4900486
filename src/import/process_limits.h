#pragma once

#include <cstddef>

namespace ist::import {

/// Limits this process before it looks at foreign content: 4 GiB more memory than the content has
/// bytes, `seconds` of processor time, no core file. The process can write to no file but its
/// stdout. It closes all file descriptors but the first three, and ends if its parent ends. Returns
/// false if the kernel refuses a limit.
[[nodiscard]] bool limit_resources(std::size_t content_bytes, unsigned seconds = 60);

/// Lets the kernel refuse all system calls that reading a mesh does not need: no network, no
/// program, no file opened for writing, none created, removed or renamed. Returns false if the
/// kernel refuses. A program that takes over the process can still read this user's files;
/// SideFiles keeps assimp itself to the folder of the mesh.
[[nodiscard]] bool limit_system_calls();

}  // namespace ist::import
