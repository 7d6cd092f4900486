// ist_pair_test with as few pins as a package has, to be placed and routed for its clock alone: what
// it is given comes through a shift register.
module ist_pair_test_pins (
    input  wire clk,
    input  wire reset,
    input  wire serial,
    input  wire valid_in,
    output wire valid_out,
    output wire hit
);
  reg [457:0] given;
  always @(posedge clk) given <= {given[456:0], serial};
  ist_pair_test circuit (
      .clk(clk), .reset(reset), .rotation(given[179:0]), .radius(given[259:180]), .pad(given[275:260]),
      .valid_in(valid_in), .fixed_centre(given[335:276]), .fixed_level(given[340:336]),
      .fixed_mask(given[348:341]), .moving_centre(given[444:349]), .moving_level(given[449:445]),
      .moving_mask(given[457:450]), .valid_out(valid_out), .hit(hit), .reach());
endmodule
