#pragma once

#include <cstddef>

namespace ist::import {

/// Limits this process before it looks at foreign content: 4 GiB more memory than the content has
/// bytes, 60 seconds of processor time, no core file. It writes to no file but its stdout, inherits
/// no file descriptor but the first three, and ends with the program that started it.
void limit_resources(std::size_t content_bytes);

/// Lets the kernel refuse all system calls but the ones that reading a mesh needs: no network, no
/// program, no file opened for writing, none created, removed or renamed. Returns whether the
/// kernel could be told.
bool limit_system_calls();

}  // namespace ist::import
