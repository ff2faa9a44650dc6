// Settings and counts are left open: they are free in every clock.
module properties #(parameter LATENCY = 0, CHANNEL = 1, IDLE = 0) (
  input clk, any_rst, in_valid, out_ready, input [CHANNEL-1:0] in_channel
);
  reg begun = 0;
  always @(posedge clk) begun <= 1;
  wire rst = any_rst || !begun;
  wire in_ready, out_valid, restarted, saturated, busy;
  wire [CHANNEL-1:0] out_channel;
  wire [31:0] angle_roll, angle_pitch, bias_roll, bias_pitch;
  hk_complementary core (
    .clk(clk), .rst(rst), .busy(busy),
    .in_valid(in_valid), .in_ready(in_ready), .in_channel(in_channel),
    .out_valid(out_valid), .out_ready(out_ready), .out_channel(out_channel),
    .angle_roll(angle_roll), .angle_pitch(angle_pitch),
    .bias_roll(bias_roll), .bias_pitch(bias_pitch),
    .restarted(restarted), .saturated(saturated)
  );
  stream_checker #(
    .PAYLOAD(130), .LATENCY(LATENCY), .CHANNEL(CHANNEL), .IDLE(IDLE)
  ) checker_of_core (
    .clk(clk), .rst(rst), .begun(begun), .in_valid(in_valid), .in_ready(in_ready),
    .in_channel(in_channel & SERVED), .out_valid(out_valid), .out_ready(out_ready),
    .out_channel(out_channel),
    .payload({angle_roll, angle_pitch, bias_roll, bias_pitch, restarted, saturated})
  );
  localparam [CHANNEL-1:0] SERVED = IDLE == 0 ? 0 : {CHANNEL{1'b1}};  // one channel has no number

  always @* if (begun) begin
    assert (busy || in_ready);
    assert (!busy || !in_ready);
  end
endmodule
