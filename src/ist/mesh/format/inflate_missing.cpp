// What inflate.cpp does, in a build without zlib.

#include "ist/mesh/format/inflate.h"

namespace ist {

bool can_inflate() { return false; }

bool inflate_bytes(std::string_view, std::span<char>) { return false; }

}  // namespace ist
