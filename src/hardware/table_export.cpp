#include "hardware/table_export.h"

#include <fmt/format.h>

#include <array>

#include "ist/hardware/table_rom.h"

namespace ist {
namespace {

struct Stamp {
  std::string_view generator;
  std::string checksum;
};

// Returns the beginning of every text, as comments of its language.
std::string preface(const Stamp& stamp, std::string_view begin) {
  return fmt::format(
      "{0} The smallest ball round the children of an octree node, by occupancy mask; bit k of a\n"
      "{0} mask is the child at +x where k & 1, +y where k & 2, +z where k & 4. A word of 12 "
      "bits:\n"
      "{0} [2:0] x, [5:3] y, [8:6] z of the ball's centre, from the node's: a sign (bit 2) and 0, "
      "2\n"
      "{0} or 3; [11:9] radius code: radius squared 27, 54, 81, 96, 108, and 7 for mask 0, which\n"
      "{0} holds nothing. Units: a sixth of half the node's edge.\n"
      "{0} generator: {1}\n"
      "{0} checksum: xxh64 {2} of the 256 words, 16 bits each, little endian\n",
      begin, stamp.generator, stamp.checksum);
}

// Returns all words with `separator` between them, `a_row` in a row.
std::string words(std::string_view format, std::string_view separator, std::size_t a_row) {
  std::string text;
  for (std::size_t mask = 0; mask < table_rom().size(); ++mask) {
    text += mask % a_row == 0 ? "  " : " ";
    text += fmt::format(fmt::runtime(format), table_rom()[mask]);
    if (mask + 1 < table_rom().size()) text += separator;
    if (mask % a_row == a_row - 1) text += "\n";
  }
  return text;
}

std::string c_text(const Stamp& stamp) {
  return preface(stamp, "//") +
         fmt::format(R"(#ifndef IST_TABLE_ROM_H
#define IST_TABLE_ROM_H

#include <stdint.h>

#define IST_TABLE_GENERATOR "{}"
#define IST_TABLE_CHECKSUM UINT64_C(0x{})

/* A coordinate of a word's centre: 0, 2 or 3, of either sign. */
#define IST_TABLE_COORDINATE(word, shift) \
  ((((word) >> (shift)) & 4) ? -(int)(((word) >> (shift)) & 3) : (int)(((word) >> (shift)) & 3))
#define IST_TABLE_X(word) IST_TABLE_COORDINATE(word, 0)
#define IST_TABLE_Y(word) IST_TABLE_COORDINATE(word, 3)
#define IST_TABLE_Z(word) IST_TABLE_COORDINATE(word, 6)
/* 0 ... 4, or 7 for mask 0. */
#define IST_TABLE_RADIUS_CODE(word) (((word) >> 9) & 7)

/* By radius code. */
static const uint16_t ist_table_radius_squared[5] = {{{}}};
/* By radius code: the radius at level 0, rounded up, with 8 bits after the point. */
static const uint16_t ist_table_fixed_radius[5] = {{{}}};

/* By mask. */
static const uint16_t ist_table_rom[256] = {{
{}}};

#endif
)",
                     stamp.generator, stamp.checksum, fmt::join(kRadiusSquared, ", "),
                     fmt::join(kFixedRadii, ", "), words("0x{:03x}", ",", 8));
}

std::string verilog_text(const Stamp& stamp) {
  std::string text = preface(stamp, "//") + R"(module ist_table_rom (
    input  wire        clk,
    input  wire [ 7:0] mask,
    output reg  [11:0] word  // of the mask at the last rising edge
);
  reg [11:0] rom [0:255];

  initial begin
)";
  for (std::size_t mask = 0; mask < table_rom().size(); ++mask) {
    text += fmt::format("    rom[{}] = 12'h{:03x};\n", mask, table_rom()[mask]);
  }
  return text + R"(  end

  always @(posedge clk) word <= rom[mask];
endmodule
)";
}

std::string vhdl_text(const Stamp& stamp) {
  return preface(stamp, "--") + R"(library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

entity ist_table_rom is
  port (
    clk  : in  std_logic;
    mask : in  std_logic_vector(7 downto 0);
    word : out std_logic_vector(11 downto 0)  -- of the mask at the last rising edge
  );
end entity ist_table_rom;

architecture rtl of ist_table_rom is
  type rom_type is array (0 to 255) of std_logic_vector(11 downto 0);
  constant rom : rom_type := (
)" + words("x\"{:03x}\"", ",", 8) +
         R"(  );
begin
  process (clk)
  begin
    if rising_edge(clk) then
      word <= rom(to_integer(unsigned(mask)));
    end if;
  end process;
end architecture rtl;
)";
}

std::string mem_text(const Stamp& stamp) { return preface(stamp, "//") + words("{:03x}", "", 16); }

std::string json_text(const Stamp& stamp) {
  std::string text = "[\n";
  for (std::size_t mask = 1; mask < table_rom().size(); ++mask) {
    const std::uint16_t word = table_rom()[mask];
    text += fmt::format(
        R"({{"mask": {}, "centre": [{}, {}, {}], "radius_squared": {}, "generator": "{}", )"
        R"("checksum": "xxh64 {}"}}{})",
        mask, rom_coordinate(word, 0), rom_coordinate(word, 1), rom_coordinate(word, 2),
        kRadiusSquared[rom_radius_code(word)], stamp.generator, stamp.checksum,
        mask + 1 < table_rom().size() ? ",\n" : "\n");
  }
  return text + "]\n";
}

}  // namespace

std::string table_text(TableFormat format, std::string_view generator) {
  const Stamp stamp{generator, fmt::format("{:016x}", table_checksum())};
  constexpr std::array kTexts = {c_text, verilog_text, vhdl_text, mem_text, json_text};
  return kTexts[static_cast<std::size_t>(format)](stamp);
}

}  // namespace ist
