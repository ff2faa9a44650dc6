// Plays a vector file on a converted or mapped core and writes what comes out.
//
// A vector is a line of hex words: channel, accel x y z, gyro x y z. A result is a line: channel,
// roll, pitch, the hidden words, the flags restarted and saturated, and the latency in clocks.
// The first line of the results is the design digest.
//
// CORE is the module. HIDDEN_PORTS connects its ports of hidden words to parts of `hidden`; with
// STATE_WORDS the words come one by one through state_index and state_word instead.
`timescale 1ns / 1ps

module hk_gate_tb;

  parameter CHANNEL_BITS = 1;
  parameter STALLS       = 0;      // gaps on both sides, unknown inputs in the gaps
  parameter READY_CLOCKS = 10000;  // the longest wait for anything

`ifdef STATE_WORDS
  localparam HAS_NO_STATE = 0;
`else
  localparam HAS_NO_STATE = 1;
`endif

  reg clk = 0;
  reg rst = 1;
  reg in_valid = 0;
  reg [CHANNEL_BITS-1:0] in_channel;
  reg signed [15:0] accel_x, accel_y, accel_z, gyro_x, gyro_y, gyro_z;
  reg out_ready = 0;
  wire in_ready, out_valid, restarted, saturated;
  wire [CHANNEL_BITS-1:0] out_channel;
  wire [31:0] angle_roll, angle_pitch;
`ifdef STATE_WORDS
  localparam HIDDEN_WORDS = `STATE_WORDS;
  reg [32*HIDDEN_WORDS-1:0] hidden;
  reg [4:0] state_index = 0;
  wire [31:0] state_word;
  reg [5:0] read = 0;          // words that have been read
  reg [1:0] index_clocks = 0;  // since state_index has stood
  wire is_read = read == HIDDEN_WORDS;
`else
  localparam HIDDEN_WORDS = `HIDDEN_WORDS;
  wire [32*HIDDEN_WORDS-1:0] hidden;
  wire is_read = 1;
`endif
  wire [47:0] design_digest;

  `CORE core (
    .clk(clk), .rst(rst),
    .in_valid(in_valid), .in_ready(in_ready), .in_channel(in_channel),
    .accel_x(accel_x), .accel_y(accel_y), .accel_z(accel_z),
    .gyro_x(gyro_x), .gyro_y(gyro_y), .gyro_z(gyro_z),
    .out_valid(out_valid), .out_ready(out_ready), .out_channel(out_channel),
    .angle_roll(angle_roll), .angle_pitch(angle_pitch),
`ifdef STATE_WORDS
    .state_index(state_index), .state_word(state_word),
`else
    `HIDDEN_PORTS
`endif
    .restarted(restarted), .saturated(saturated), .design_digest(design_digest)
  );

  always #5 clk = !clk;

  integer vectors, results, found, word;
  integer sent = 0, taken = 0, clock = 0, last = 0, latency = 0;
  reg offered = 0;
  integer sent_at [0:255];  // clocks at which the samples in work were taken
  reg [15:0] noise = 16'hACE1;
  reg [15:0] ch, ax, ay, az, gx, gy, gz;
  reg all_sent = 0;

  always @(posedge clk) noise <= {noise[14:0], noise[15] ^ noise[13] ^ noise[12] ^ noise[10]};

  task forget;
    begin
      in_valid <= 0;
      in_channel <= {CHANNEL_BITS{1'bx}};
      {accel_x, accel_y, accel_z, gyro_x, gyro_y, gyro_z} <= 96'bx;
    end
  endtask

  // Everything is driven just after an edge and looked at on the next one.
  initial begin
    vectors = $fopen("vectors.txt", "r");
    results = $fopen("results.txt", "w");
    forget;
    repeat (3) @(posedge clk);
    #1 rst = 0;
    $fdisplay(results, "%h", design_digest);
    while (!all_sent) begin
      found = $fscanf(vectors, "%h %h %h %h %h %h %h", ch, ax, ay, az, gx, gy, gz);
      if (found != 7) all_sent = 1;
      else begin
        if (STALLS && noise[0]) repeat (noise[5:1]) @(posedge clk);
        #1;
        in_valid = 1;
        in_channel = ch;
        accel_x = ax; accel_y = ay; accel_z = az;
        gyro_x = gx; gyro_y = gy; gyro_z = gz;
        @(posedge clk);
        while (in_ready !== 1'b1) @(posedge clk);
        #1 forget;
      end
    end
  end

  always @(posedge clk) begin
    clock = clock + 1;
    if (!rst) begin
      if (in_valid && in_ready === 1'b1) begin
        sent_at[sent % 256] = clock;
        sent = sent + 1;
      end
      if (out_valid === 1'b1 && !offered) begin
        offered = 1;
        latency = clock - sent_at[taken % 256];
      end
      if (out_valid === 1'b1 && taken == sent) begin
        $display("error: a result without a sample");
        $finish;
      end else if (out_valid === 1'b1 && out_ready) begin
        $fwrite(results, "%h %h %h ", out_channel, angle_roll, angle_pitch);
        for (word = 0; word < HIDDEN_WORDS; word = word + 1)
          $fwrite(results, "%h ", hidden[32*word +: 32]);
        $fdisplay(results, "%b %b %0d", restarted, saturated, latency);
        taken = taken + 1;
        offered = 0;
`ifdef STATE_WORDS
        read = 0;
        index_clocks = 0;
        state_index <= #1 noise;  // it must not matter now
`endif
        last = clock;
      end
      if (all_sent && taken == sent) begin
        $fdisplay(results, "end");
        $finish;
      end
      if (clock - last > READY_CLOCKS) begin
        $display("error: nothing has come out for %0d clocks", READY_CLOCKS);
        $finish;
      end
    end
`ifdef STATE_WORDS
    if (!rst && offered && !is_read) begin
      if (index_clocks == 3) begin
        hidden[32*read +: 32] = state_word;
        read = read + 1;
        index_clocks = 0;
      end
      if (index_clocks == 0) state_index <= #1 read;
      index_clocks = index_clocks + 1;
    end
`endif
    out_ready <= #1 (STALLS ? noise[0] : 1'b1) && is_read && (HAS_NO_STATE || offered);
  end

endmodule
