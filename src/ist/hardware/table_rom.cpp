#include "ist/hardware/table_rom.h"

#include "ist/hardware/xxh64.h"

namespace ist {

static_assert(kTableRom[0] == kNoRadius << 9);
static_assert(kTableRom[1] == 0x1FF);  // -3, -3, -3: 7, 7, 7; and the smallest radius, 0
static_assert(kTableRom[255] == 4 << 9);
static_assert(kFixedRadii == std::array<std::uint16_t, 5>{1331, 1882, 2304, 2509, 2661});

std::uint64_t table_checksum() {
  std::array<std::uint8_t, 2 * kTableRom.size()> bytes{};
  for (std::size_t mask = 0; mask < kTableRom.size(); ++mask) {
    bytes[2 * mask] = static_cast<std::uint8_t>(kTableRom[mask] & 0xFF);
    bytes[2 * mask + 1] = static_cast<std::uint8_t>(kTableRom[mask] >> 8);
  }
  Xxh64 checksum;
  checksum.add(bytes.data(), bytes.size());
  return checksum.value();
}

}  // namespace ist
