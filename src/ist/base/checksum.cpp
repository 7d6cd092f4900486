#include "ist/base/checksum.h"

#include <fmt/format.h>
#define XXH_INLINE_ALL  // so the library needs the header alone
#include <xxhash.h>

namespace ist {

struct Checksum::State {
  XXH3_state_t xxh3;
};

Checksum::Checksum() : state_(std::make_unique<State>()) { XXH3_64bits_reset(&state_->xxh3); }
Checksum::~Checksum() = default;
void Checksum::add(const void* data, std::size_t bytes) {
  XXH3_64bits_update(&state_->xxh3, data, bytes);
}
std::uint64_t Checksum::value() const { return XXH3_64bits_digest(&state_->xxh3); }

struct ContentHash::State {
  XXH3_state_t xxh3;
};

ContentHash::ContentHash() : state_(std::make_unique<State>()) {
  XXH3_128bits_reset(&state_->xxh3);
}
ContentHash::~ContentHash() = default;
void ContentHash::add(const void* data, std::size_t bytes) {
  XXH3_128bits_update(&state_->xxh3, data, bytes);
}
std::string ContentHash::text() const {
  const XXH128_hash_t value = XXH3_128bits_digest(&state_->xxh3);
  return fmt::format("{:016x}{:016x}", value.high64, value.low64);
}

}  // namespace ist
