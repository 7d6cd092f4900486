#include "ist/base/checksum.h"

#include <fmt/format.h>
#define XXH_INLINE_ALL  // so the library needs the header alone
#include <xxhash.h>

#include <algorithm>
#include <vector>

namespace ist {

std::string hash_of_file(const InputFile& file) {
  constexpr std::uint64_t kAtOnce = 1 << 20;  // bytes
  std::vector<char> block(std::min(kAtOnce, file.size()));
  Checksum hash;
  for (std::uint64_t at = 0; at < file.size(); at += kAtOnce) {
    const std::size_t bytes = std::min(kAtOnce, file.size() - at);
    file.read_at(at, block.data(), bytes);
    hash.add(block.data(), bytes);
  }
  return hash.text();
}

std::string hash_of_file(const std::filesystem::path& file) {
  return hash_of_file(InputFile(file));
}

struct Checksum::State {
  XXH3_state_t xxh3;
};

Checksum::Checksum() : state_(std::make_unique<State>()) { XXH3_64bits_reset(&state_->xxh3); }
Checksum::~Checksum() = default;
void Checksum::add(const void* data, std::size_t bytes) {
  XXH3_64bits_update(&state_->xxh3, data, bytes);
}
std::uint64_t Checksum::value() const { return XXH3_64bits_digest(&state_->xxh3); }
std::string Checksum::text() const {
  const XXH128_hash_t value = XXH3_128bits_digest(&state_->xxh3);
  return fmt::format("{:016x}{:016x}", value.high64, value.low64);
}

}  // namespace ist
