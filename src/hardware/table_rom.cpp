#include "ist/hardware/table_rom.h"

#include "hardware/table_words.h"
#include "hardware/xxh64.h"

namespace ist {

static_assert(kRomWords[0] == kNoRadius << 9);
static_assert(kRomWords[1] == 0x1FF);  // centre -3, -3, -3, codes 7, 7, 7; radius code 0
static_assert(kRomWords[255] == 4 << 9);
static_assert(kFixedRadii == std::array<std::uint16_t, 5>{1331, 1882, 2304, 2509, 2661});

const std::array<std::uint16_t, 256>& table_rom() noexcept { return kRomWords; }

std::uint64_t table_checksum() {
  std::array<std::uint8_t, 2 * 256> bytes{};
  for (std::size_t mask = 0; mask < table_rom().size(); ++mask) {
    bytes[2 * mask] = static_cast<std::uint8_t>(table_rom()[mask] & 0xFF);
    bytes[2 * mask + 1] = static_cast<std::uint8_t>(table_rom()[mask] >> 8);
  }
  Xxh64 checksum;
  checksum.add(bytes.data(), bytes.size());
  return checksum.value();
}

}  // namespace ist
