#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace ist {

/// What the table can be written as.
enum class TableFormat : std::uint8_t {
  kC,        ///< a C11 header: the words, the fixed radii, macros that decode a word
  kVerilog,  ///< module ist_table_rom: clk, mask, word a clock later
  kVhdl,     ///< entity ist_table_rom, likewise
  kMem,      ///< for $readmemh
  kJson,     ///< an array of masks 1 … 255 with centre and squared radius
};

struct TableFormatName {
  const char* name;
  TableFormat format;
};
inline constexpr std::array kTableFormats = {
    TableFormatName{"c", TableFormat::kC}, TableFormatName{"verilog", TableFormat::kVerilog},
    TableFormatName{"vhdl", TableFormat::kVhdl}, TableFormatName{"mem", TableFormat::kMem},
    TableFormatName{"json", TableFormat::kJson}};

/// The table as text, which names its checksum (table_checksum) and who wrote it.
///
/// @param generator name and version, without quotes
[[nodiscard]] std::string table_text(TableFormat format, std::string_view generator);

}  // namespace ist
