// Checks ist_pair_test against a file of vectors from `ist table --vectors N --seed S`: one pair a
// clock, with gaps now and then and another query for each pair. Hit, reach and their clock must be
// right.
//
//   +vectors=FILE    the vectors; their number is in the file's header
//
// Ends by $fatal if an answer differs, or if there are fewer vectors than the header says, or more,
// or none. Define IST_NETLIST to check a synthesised circuit, which has no port for its reach.
`timescale 1ns / 1ps
module ist_pair_test_tb;
  localparam LATENCY = 10;
  localparam HEADER_LINES = 8;
  localparam COUNT_LINE = 3;  // "# count N"
  localparam FIELDS = 27;
  localparam SHOWN = 10;  // printed mismatches; all are counted

  reg clk = 1'b0;
  always #5 clk = ~clk;

  // The fields of one line.
  reg [19:0] fixed_x, fixed_y, fixed_z;
  reg [31:0] moving_x, moving_y, moving_z;
  reg [ 7:0] fixed_level, fixed_mask, moving_level, moving_mask;
  reg [19:0] r0, r1, r2, r3, r4, r5, r6, r7, r8;
  reg [15:0] radius0, radius1, radius2, radius3, radius4, pad;
  reg [39:0] reach;
  reg [ 3:0] hit;

  // The circuit reads rotation and radius one clock after the pair, pad three clocks after.
  reg          reset = 1'b1, valid_in = 1'b0;
  reg  [ 59:0] fixed_centre;
  reg  [ 95:0] moving_centre;
  reg  [ 12:0] fixed_node, moving_node;  // level and mask
  reg  [179:0] rotation, rotation_1;
  reg  [ 79:0] radius, radius_1;
  reg  [ 15:0] pad_now, pad_1, pad_2, pad_3;
  wire         valid_out, circuit_hit;
  wire [ 32:0] circuit_reach;
  ist_pair_test circuit (
      .clk(clk), .reset(reset), .rotation(rotation_1), .radius(radius_1), .pad(pad_3),
      .valid_in(valid_in), .fixed_centre(fixed_centre), .fixed_level(fixed_node[12:8]),
      .fixed_mask(fixed_node[7:0]), .moving_centre(moving_centre), .moving_level(moving_node[12:8]),
      .moving_mask(moving_node[7:0]),
`ifndef IST_NETLIST
      .reach(circuit_reach),
`endif
      .valid_out(valid_out), .hit(circuit_hit));
`ifdef IST_NETLIST
  assign circuit_reach = due_reach[slot];
`endif

  // The expected outputs of the next clocks, in a ring: the answer due now is at `slot`.
  reg         due[0:LATENCY-1];
  reg         due_hit[0:LATENCY-1];
  reg  [32:0] due_reach[0:LATENCY-1];
  integer     due_line[0:LATENCY-1];
  integer     slot;

  integer file, count, fed, checked, hits, mismatches, waited, got, line, i, seed;
  reg [8*255-1:0] name;

  // Between two rising edges: checks the outputs of the last, and sets the inputs of the next.
  task clock(input feed);
    begin
      @(negedge clk);
      if (due[slot] && valid_out === 1'b1) begin
        checked = checked + 1;
        if (circuit_hit === 1'b1) hits = hits + 1;
      end
      if (valid_out !== due[slot]
          || (due[slot] && (circuit_hit !== due_hit[slot] || circuit_reach !== due_reach[slot]))) begin
        mismatches = mismatches + 1;
        if (mismatches <= SHOWN)
          $display("line %0d: valid %b, hit %b, reach %h; should be valid %b, hit %b, reach %h", due_line[slot],
                   valid_out, circuit_hit, circuit_reach, due[slot], due_hit[slot], due_reach[slot]);
      end
      due[slot] = feed;
      due_hit[slot] = hit[0];
      due_reach[slot] = reach[32:0];
      due_line[slot] = line;
      slot = slot == LATENCY - 1 ? 0 : slot + 1;
      valid_in = feed;
      fixed_centre = {fixed_z, fixed_y, fixed_x};
      moving_centre = {moving_z, moving_y, moving_x};
      fixed_node = {fixed_level[4:0], fixed_mask};
      moving_node = {moving_level[4:0], moving_mask};
      rotation_1 = rotation;
      radius_1 = radius;
      rotation = {r8, r7, r6, r5, r4, r3, r2, r1, r0};
      radius = {radius4, radius3, radius2, radius1, radius0};
      pad_3 = pad_2;
      pad_2 = pad_1;
      pad_1 = pad_now;
      pad_now = pad;
    end
  endtask

  initial begin
    if (!$value$plusargs("vectors=%s", name)) $fatal(1, "no file: give +vectors=FILE");
    file = $fopen(name, "r");
    if (file == 0) $fatal(1, "cannot read %0s", name);
    count = 0;
    for (line = 1; line <= HEADER_LINES; line = line + 1) begin
      if (line == COUNT_LINE && $fscanf(file, "# count %d", count) != 1)
        $fatal(1, "%0s: line %0d does not say how many vectors follow", name, COUNT_LINE);
      for (got = $fgetc(file); got != "\n"; got = $fgetc(file))
        if (got == -1) $fatal(1, "%0s ends in its header", name);
    end
    if (count < 1) $fatal(1, "%0s has no vectors", name);

    {checked, hits, mismatches, slot, line} = 0;
    seed = 1;
    for (i = 0; i < LATENCY; i = i + 1) due[i] = 1'b0;
    repeat (2) @(negedge clk);
    reset = 1'b0;
    repeat (LATENCY) @(negedge clk);
    for (fed = 0; fed < count; fed = fed + 1) begin
      got = $fscanf(file, "%h %h %h %h %h %h %h %h %h %h %h %h %h %h %h %h %h %h %h %h %h %h %h %h %h %h %h",
                    fixed_x, fixed_y, fixed_z, fixed_level, fixed_mask, moving_x, moving_y, moving_z,
                    moving_level, moving_mask, r0, r1, r2, r3, r4, r5, r6, r7, r8, radius0, radius1, radius2,
                    radius3, radius4, pad, reach, hit);
      if (got != FIELDS)
        $fatal(1, "%0s: vector %0d of %0d has %0d of %0d fields", name, fed + 1, count, got, FIELDS);
      line = HEADER_LINES + fed + 1;
      // A number with more bits than its format would be cut off, and might then agree.
      if (fixed_level[7:5] != 3'd0 || moving_level[7:5] != 3'd0 || reach[39:33] != 7'd0 || hit[3:1] != 3'd0)
        $fatal(1, "%0s: a number in line %0d does not fit", name, line);
      waited = $random(seed);
      if (waited[4:2] == 3'd0) repeat (waited[1:0]) clock(1'b0);
      clock(1'b1);
    end
    repeat (LATENCY + 1) clock(1'b0);
    if ($fscanf(file, "%h", r0) == 1) $fatal(1, "%0s has more than %0d vectors", name, count);
    $display("%0d vectors, %0d answers, %0d hits, %0d mismatches", count, checked, hits, mismatches);
    if (mismatches != 0 || checked != count) $fatal(1, "the circuit differs from the model");
    $finish;
  end
endmodule
