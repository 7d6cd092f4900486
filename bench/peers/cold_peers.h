#pragma once

#include <cstddef>

#include "peers/peer.h"

namespace ist::bench {

/// Memory that is gone through so that no cache keeps anything of a question: twice the last
/// level's size, bytes; little where it is quick().
[[nodiscard]] std::size_t swept_bytes();

/// The quickest of `all`, IST first, under their own names, each with caches as they are when
/// something else has used them: before each question swept_bytes() are gone through, outside of
/// the time that is taken. `all` must outlive them.
[[nodiscard]] Peers cold_peers(const Peers& all);

}  // namespace ist::bench
