#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

struct XXH64_state_s;

namespace ist {

/// XXH64, seed 0, of all that is added: what circuits' tables and vectors are named by, because
/// other tools have it (`xxhsum -H1`).
class Xxh64 {
 public:
  Xxh64();

  void add(const void* data, std::size_t bytes) noexcept;
  [[nodiscard]] std::uint64_t value() const noexcept;

 private:
  struct Free {
    void operator()(XXH64_state_s* state) const noexcept;
  };
  std::unique_ptr<XXH64_state_s, Free> state_;
};

}  // namespace ist
