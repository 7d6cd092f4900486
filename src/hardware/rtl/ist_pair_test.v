// Tests whether the spheres of two octree nodes overlap: the pair test of src/hardware/README.md,
// bit for bit. One pair a clock, its answer after LATENCY stages; no root, no division, four
// multiplications.
//
// Lengths are in units of h/6, h half the edge of a fixed leaf; Q.8 has 8 bits after the point.
//
// The registers of a query, `rotation`, `radius` and `pad`, are held while its pairs are in the
// circuit. Each is read at one stage: if they change one clock (rotation, radius) or three (pad)
// after the first pair of the next query, the pipeline need not be drained.
module ist_pair_test (
    input  wire         clk,
    input  wire         reset,          // forgets the pairs in the circuit; needed once, at the start
    // Registers of the query.
    input  wire [179:0] rotation,       // 9 x signed Q3.16, column-major: entry 3k + i at bit 20 (3k + i)
    input  wire [ 79:0] radius,         // 5 x unsigned Q8.8: the moving radii by radius code
    input  wire [ 15:0] pad,            // unsigned Q8.8
    // A pair.
    input  wire         valid_in,
    input  wire [ 59:0] fixed_centre,   // 3 x signed 20 bits, x lowest: the cube's centre
    input  wire [  4:0] fixed_level,    // 0 to 16
    input  wire [  7:0] fixed_mask,
    input  wire [ 95:0] moving_centre,  // 3 x signed Q23.8, x lowest: the cube's centre, moved
    input  wire [  4:0] moving_level,   // 0 to 16
    input  wire [  7:0] moving_mask,
    // Its answer.
    output wire         valid_out,
    output reg          hit,
    output reg  [ 32:0] reach           // Q.8: both radii and the pad; for tests
);
  // Stages: the number of edges to the answer, including the edge that takes the pair.
  localparam LATENCY = 10;

  reg [LATENCY-1:0] valid;
  always @(posedge clk) valid <= reset ? {LATENCY{1'b0}} : {valid[LATENCY-2:0], valid_in};
  assign valid_out = valid[LATENCY-1];

  // The number at the end of a name is the stage whose registers hold it.

  // ---- Step 1, stage 1: the table's words. A read takes a clock.
  wire [11:0] fixed_word_1, moving_word_1;
  ist_table_rom fixed_rom (.clk(clk), .mask(fixed_mask), .word(fixed_word_1));
  ist_table_rom moving_rom (.clk(clk), .mask(moving_mask), .word(moving_word_1));
  wire [2:0] fixed_radius_code_1 = fixed_word_1[11:9], moving_radius_code_1 = moving_word_1[11:9];

  reg [4:0] fixed_level_1, moving_level_1;
  always @(posedge clk) begin
    fixed_level_1  <= fixed_level;
    moving_level_1 <= moving_level;
  end

  // ---- Step 4: the reach, stages 2 to 4, beside the offsets of steps 2 and 3.
  function [11:0] fixed_radius(input [2:0] code);  // ceil(256 r), r^2 = 27, 54, 81, 96, 108; 0 for mask 0
    case (code)
      3'd0: fixed_radius = 12'd1331;
      3'd1: fixed_radius = 12'd1882;
      3'd2: fixed_radius = 12'd2304;
      3'd3: fixed_radius = 12'd2509;
      3'd4: fixed_radius = 12'd2661;
      default: fixed_radius = 12'd0;
    endcase
  endfunction

  reg [ 4:0] fixed_level_2, moving_level_2, moving_level_3;
  reg [11:0] fixed_radius_2;
  reg [15:0] moving_radius_2;
  reg [27:0] fixed_reach_3;
  reg [31:0] moving_reach_3;
  reg [32:0] reach_4;
  always @(posedge clk) begin
    fixed_level_2  <= fixed_level_1;
    moving_level_2 <= moving_level_1;
    moving_level_3 <= moving_level_2;
    fixed_radius_2 <= fixed_radius(fixed_radius_code_1);
    case (moving_radius_code_1)
      3'd0: moving_radius_2 <= radius[15:0];
      3'd1: moving_radius_2 <= radius[31:16];
      3'd2: moving_radius_2 <= radius[47:32];
      3'd3: moving_radius_2 <= radius[63:48];
      3'd4: moving_radius_2 <= radius[79:64];
      default: moving_radius_2 <= 16'd0;
    endcase
    fixed_reach_3  <= {16'd0, fixed_radius_2} << fixed_level_2;
    moving_reach_3 <= {16'd0, moving_radius_2} << moving_level_2;
    reach_4        <= {5'd0, fixed_reach_3} + {1'b0, moving_reach_3} + {17'd0, pad};
  end

  // ---- Step 6 for the reach: E at stage 5, then m = ceil(reach / 2^E) at stage 7.
  function [4:0] exponent(input [17:0] high);  // number of bits of the reach above the low 15
    integer i;
    begin
      exponent = 5'd0;
      for (i = 0; i < 18; i = i + 1) if (high[i]) exponent = i[4:0] + 5'd1;
    end
  endfunction

  reg [ 4:0] exponent_5, exponent_6;
  reg [32:0] reach_5, reach_6;
  reg [14:0] quotient_6;
  reg        remainder_6;  // whether it is not 0
  reg [15:0] bound_7;      // m
  wire [17:0] ones_5 = ~(18'h3ffff << exponent_5);
  wire [32:0] quotient_5 = reach_5 >> exponent_5;
  always @(posedge clk) begin
    reach_5     <= reach_4;
    exponent_5  <= exponent(reach_4[32:15]);
    reach_6     <= reach_5;
    exponent_6  <= exponent_5;
    quotient_6  <= quotient_5[14:0];
    remainder_6 <= |(reach_5[17:0] & ones_5);
    bound_7     <= {1'b0, quotient_6} + {15'd0, remainder_6};
  end

  // ---- Steps 2, 3, 5 and 6 for each axis.
  wire [ 2:0] beyond_7;   // |d_i| > reach
  wire [89:0] squares_8;  // 3 x n_i^2
  genvar axis;
  generate
    for (axis = 0; axis < 3; axis = axis + 1) begin : along
      // Step 3 in part, stage 1: from the fixed cube's centre to the moved one.
      wire signed [19:0] fixed  = fixed_centre[20*axis+:20];
      wire signed [31:0] moving = moving_centre[32*axis+:32];
      reg signed [32:0] between_1, between_2;
      always @(posedge clk) begin
        between_1 <= {moving[31], moving} - {{5{fixed[19]}}, fixed, 8'd0};
        between_2 <= between_1;
      end

      // Step 2, stages 2 to 4. The fixed ball's offset: 0, 2 or 3 with a sign, shifted by the level.
      wire [2:0] fixed_code_1 = fixed_word_1[3*axis+:3];
      reg signed [3:0] fixed_offset_2;
      reg signed [19:0] fixed_offset_3;
      always @(posedge clk) begin
        fixed_offset_2 <= fixed_code_1[2] ? -{2'd0, fixed_code_1[1:0]} : {2'd0, fixed_code_1[1:0]};
        fixed_offset_3 <= {{16{fixed_offset_2[3]}}, fixed_offset_2} <<< fixed_level_2;
      end

      // The moving ball's offset, rotated: three products with 0, 2 or 3. For a minus sign, a product's
      // bits are inverted, and the missing one (-p = ~p + 1) is added with the products.
      wire [65:0] products_1;
      wire [ 2:0] minus_1;
      function signed [23:0] extended(input [21:0] value);
        extended = {{2{value[21]}}, value};
      endfunction
      genvar k;
      for (k = 0; k < 3; k = k + 1) begin : product
        wire [2:0] code = moving_word_1[3*k+:3];
        wire signed [19:0] entry = rotation[20*(3*k+axis)+:20];
        wire signed [21:0] twice = {entry[19], entry, 1'b0};
        wire signed [21:0] thrice = twice + {{2{entry[19]}}, entry};
        assign products_1[22*k+:22] = (code[1] ? (code[0] ? thrice : twice) : 22'd0) ^ {22{code[2]}};
        assign minus_1[k] = code[2];
      end
      reg [65:0] products_2;
      reg [ 1:0] missing_2;                // number of missing ones
      reg signed [23:0] turned_3;          // Q.16, before the level
      reg signed [31:0] moving_offset_4;   // Q.8
      wire signed [39:0] shifted_3 = {{16{turned_3[23]}}, turned_3} <<< moving_level_3;
      always @(posedge clk) begin
        products_2 <= products_1;
        missing_2  <= {1'b0, minus_1[0]} + {1'b0, minus_1[1]} + {1'b0, minus_1[2]};
        turned_3   <= extended(products_2[21:0]) + extended(products_2[43:22]) + extended(products_2[65:44])
                      + {22'd0, missing_2};
        moving_offset_4 <= shifted_3[39:8];  // floor
      end

      // Step 3, stage 5: from the fixed ball's centre to the moving one's.
      reg signed [32:0] between_3, between_4, distance_5;
      always @(posedge clk) begin
        between_3  <= between_2;
        between_4  <= between_3 - {{5{fixed_offset_3[19]}}, fixed_offset_3, 8'd0};
        distance_5 <= between_4 + {moving_offset_4[31], moving_offset_4};
      end

      // Steps 5 and 6, stages 6 and 7: beyond the reach or not; if not, the quotient has 15 bits.
      reg [31:0] size_6;  // |d_i|
      reg        beyond;
      reg [14:0] quotient_7;
      // `keep`, because yosys 0.23 would join this register to two multipliers, and lose one.
      (* keep *) reg [29:0] square_8;
      wire [31:0] shifted_6 = size_6 >> exponent_6;
      always @(posedge clk) begin
        size_6     <= distance_5[32] ? -distance_5[31:0] : distance_5[31:0];
        beyond     <= {1'b0, size_6} > reach_6;
        quotient_7 <= shifted_6[14:0];
        // Step 7 in part, stage 8.
        square_8   <= quotient_7 * quotient_7;
      end
      assign beyond_7[axis] = beyond;
      assign squares_8[30*axis+:30] = square_8;
    end
  endgenerate

  // ---- Step 7, stages 8 to 10: no hit after step 5, or with a mask of 0.
  reg empty_2, empty_3, empty_4, empty_5, empty_6, empty_7;
  reg apart_8, apart_9;
  reg [15:0] bound_8;  // not squared yet: yosys 0.23 loses a multiplier with two registers behind it
  reg [30:0] bound_squared_9;
  reg [31:0] distance_squared_9;
  reg [32:0] reach_7, reach_8, reach_9;
  always @(posedge clk) begin
    empty_2 <= fixed_radius_code_1 == 3'd7 || moving_radius_code_1 == 3'd7;
    {empty_7, empty_6, empty_5, empty_4, empty_3} <= {empty_6, empty_5, empty_4, empty_3, empty_2};
    apart_8 <= empty_7 || beyond_7 != 3'd0;
    apart_9 <= apart_8;
    bound_8            <= bound_7;
    bound_squared_9    <= bound_8 * bound_8;
    distance_squared_9 <= {2'd0, squares_8[29:0]} + {2'd0, squares_8[59:30]} + {2'd0, squares_8[89:60]};
    hit     <= !apart_9 && distance_squared_9 <= {1'b0, bound_squared_9};
    reach_7 <= reach_6;
    reach_8 <= reach_7;
    reach_9 <= reach_8;
    reach   <= reach_9;
  end
endmodule
