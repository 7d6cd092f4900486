#include "ist/hardware/xxh64.h"

#include <xxhash.h>

namespace ist {

Xxh64::Xxh64() : state_(XXH64_createState()) { XXH64_reset(state_.get(), 0); }
void Xxh64::add(const void* data, std::size_t bytes) noexcept {
  XXH64_update(state_.get(), data, bytes);
}
std::uint64_t Xxh64::value() const noexcept { return XXH64_digest(state_.get()); }
void Xxh64::Free::operator()(XXH64_state_s* state) const noexcept { XXH64_freeState(state); }

}  // namespace ist
