#include "ist/sweep/file_hash.h"

#include <algorithm>
#include <vector>

#include "ist/base/checksum.h"

namespace ist {

std::string hash_of_file(const InputFile& file) {
  constexpr std::uint64_t kAtOnce = 1 << 20;  // bytes
  std::vector<char> block(std::min(kAtOnce, file.size()));
  ContentHash hash;
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

}  // namespace ist
