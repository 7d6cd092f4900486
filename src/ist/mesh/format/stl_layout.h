#pragma once

#include <cstddef>

namespace ist {

/// The parts of a binary STL, bytes: a header, the number of facets, and the facets.
inline constexpr std::size_t kStlHeaderBytes = 80;
inline constexpr std::size_t kStlCountEnd = 84;
inline constexpr std::size_t kStlNormalBytes = 12;  ///< at the begin of a facet
inline constexpr std::size_t kStlFacetBytes = 50;

}  // namespace ist
