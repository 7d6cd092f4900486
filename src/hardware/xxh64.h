#pragma once

#include <xxhash.h>

#include <cstddef>
#include <cstdint>
#include <memory>

namespace ist {

/// The XXH64 checksum, seed 0, of all added bytes. It identifies tables and vectors for circuits,
/// because other tools compute it too (`xxhsum -H1`).
class Xxh64 {
 public:
  Xxh64() : state_(XXH64_createState(), XXH64_freeState) { XXH64_reset(state_.get(), 0); }

  void add(const void* data, std::size_t bytes) noexcept {
    XXH64_update(state_.get(), data, bytes);
  }
  [[nodiscard]] std::uint64_t value() const noexcept { return XXH64_digest(state_.get()); }

 private:
  std::unique_ptr<XXH64_state_t, decltype(&XXH64_freeState)> state_;
};

}  // namespace ist
