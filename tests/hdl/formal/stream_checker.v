// What every block with one stream in and one out keeps to, one item at a time.
//
// A result and its payload hold until they are taken; the block does not take an item while a
// result waits; a result belongs to an item that was taken, carries its channel, and is offered at
// most LATENCY clocks after it; a block that has nothing in work is ready after IDLE clocks.
module stream_checker #(
  parameter PAYLOAD = 1, LATENCY = 1, CHANNEL = 1, IDLE = 0
) (
  input clk, rst, begun,
  input in_valid, in_ready, input [CHANNEL-1:0] in_channel,
  input out_valid, out_ready, input [CHANNEL-1:0] out_channel,
  input [PAYLOAD-1:0] payload
);

  reg waiting = 0;
  reg [PAYLOAD-1:0] held;
  reg busy = 0;
  reg [CHANNEL-1:0] channel;
  reg [10:0] age = 0;
  reg [10:0] idle = 0;

  always @(posedge clk) begin
    waiting <= out_valid && !out_ready && !rst;
    held <= payload;
    idle <= busy || rst ? 0 : in_ready ? idle : idle + 1;
    if (rst) busy <= 0;
    else if (in_valid && in_ready) begin
      busy <= 1;
      age <= 1;
      channel <= in_channel;
    end else begin
      if (busy && !out_valid) age <= age + 1;
      if (out_valid && out_ready) busy <= 0;
    end
  end

  always @* if (begun) begin
    assert (!waiting || (out_valid && payload == held));
    assert (!(in_ready && out_valid));
    assert (!out_valid || busy);
    assert (!out_valid || out_channel == channel);
    assert (!busy || age <= LATENCY);
    assert (busy || in_ready || idle < IDLE);
  end

endmodule
