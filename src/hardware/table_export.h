#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

namespace ist {

/// The output formats of the table.
enum class TableFormat : std::uint8_t {
  kC,        ///< a C11 header: the words, the fixed radii, macros that decode a word
  kVerilog,  ///< module ist_table_rom: clk, mask, word a clock later
  kVhdl,     ///< entity ist_table_rom, with the same ports
  kMem,      ///< for $readmemh
  kJson,     ///< an array of masks 1 … 255 with centre and squared radius
};

inline constexpr std::pair<const char*, TableFormat> kTableFormats[] = {
    {"c", TableFormat::kC},
    {"verilog", TableFormat::kVerilog},
    {"vhdl", TableFormat::kVhdl},
    {"mem", TableFormat::kMem},
    {"json", TableFormat::kJson}};

/// Returns the table as text, which names its checksum (table_checksum) and its generator.
[[nodiscard]] std::string table_text(TableFormat format, std::string_view generator);

}  // namespace ist
