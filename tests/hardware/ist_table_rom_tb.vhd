-- Reads every word of ist_table_rom and compares it with a file of 256 hexadecimal words, one a line.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
use std.textio.all;
use std.env.all;

entity ist_table_rom_tb is
  generic (words : string);
end entity ist_table_rom_tb;

architecture bench of ist_table_rom_tb is
  signal clk  : std_logic := '0';
  signal mask : std_logic_vector(7 downto 0) := (others => '0');
  signal word : std_logic_vector(11 downto 0);
begin
  rom : entity work.ist_table_rom port map (clk => clk, mask => mask, word => word);

  process
    file source     : text open read_mode is words;
    variable row    : line;
    variable wanted : std_logic_vector(11 downto 0);
    variable wrong  : natural := 0;
  begin
    for i in 0 to 255 loop
      if endfile(source) then
        report words & " has fewer than 256 words" severity error;
        stop(1);
      end if;
      readline(source, row);
      hread(row, wanted);
      mask <= std_logic_vector(to_unsigned(i, 8));
      wait for 5 ns;
      clk <= '1';
      wait for 5 ns;
      clk <= '0';
      if word /= wanted then
        report "mask " & integer'image(i) & ": " & to_hstring(word) & ", and should be "
          & to_hstring(wanted) severity error;
        wrong := wrong + 1;
      end if;
    end loop;
    if wrong > 0 then
      stop(1);
    end if;
    write(output, "256 words are alike" & LF);
    stop(0);
  end process;
end architecture bench;
