#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace ist {

/// The most bytes that an entry may unpack to, because a few bytes of an archive can claim any
/// number; a surface of some six million triangles as XML.
inline constexpr std::size_t kMostUnpacked = std::size_t{1} << 29;

/// Returns the unpacked bytes of an entry of a zip archive, by its name in any case; nothing where
/// the archive does not hold it. `file` is named in errors. Errors: kNotAMesh, kMeshTruncated;
/// kMeshTooLarge beyond kMostUnpacked, before anything is unpacked.
[[nodiscard]] std::optional<std::string> unzip(std::string_view archive, std::string_view name,
                                               std::string_view file);

}  // namespace ist
