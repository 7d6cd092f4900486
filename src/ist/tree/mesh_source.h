#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "ist/base/api.h"
#include "ist/tree/sphere_tree.h"

namespace ist {

/// The largest length of MeshSource::name, bytes.
inline constexpr std::size_t kMaxSourceName = 255;

/// Returns `text` as a name that MeshSource allows: '?' stands for each byte of a control
/// character, of a slash or backslash and of text that is not UTF-8, and the end is cut off between
/// two characters. An allowed name stays as it is.
[[nodiscard]] std::string source_name(std::string_view text);

/// Returns the reason why MeshSource does not allow a name or a unit, a clause without a full stop;
/// nullptr for an allowed source.
[[nodiscard]] const char* source_flaw(const MeshSource& source);

/// Returns the reason why two trees cannot be compared, with a remedy: their meshes are in
/// different frames, or in different units. Returns an empty string if they can be.
[[nodiscard]] IST_LOOP_API std::string contradiction(const SphereTree& a, std::string_view a_name,
                                                     const SphereTree& b, std::string_view b_name);

}  // namespace ist
