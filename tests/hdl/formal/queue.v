// A pipeline in front takes something only while there is room and gives it after any time.
module properties #(parameter MOST = 0) (
  input clk, any_rst, any_taken, any_valid, any_mark, out_ready, input [1:0] in_data
);
  reg begun = 0;
  always @(posedge clk) begun <= 1;
  wire rst = any_rst || !begun;
  wire room, busy, out_valid;
  wire [1:0] out_data;
  reg [3:0] inside = 0;  // taken, not given
  reg [3:0] queued = 0;  // given, not handed over
  wire taken = any_taken && room;
  wire in_valid = any_valid && inside != 0;
  wire handed = out_valid && out_ready;
  hk_result_queue core (
    .clk(clk), .rst(rst), .taken(taken), .room(room), .busy(busy), .in_valid(in_valid),
    .in_data(in_data), .out_valid(out_valid), .out_ready(out_ready), .out_data(out_data)
  );

  // One result, any one, is followed through the queue.
  reg marked = 0;
  reg [3:0] ahead;
  reg [1:0] wanted, held;
  reg waiting = 0;
  always @(posedge clk) begin
    inside <= inside + taken - in_valid;
    queued <= queued + in_valid - handed;
    if (marked && handed) begin
      ahead <= ahead - 1;
      if (ahead == 0) marked <= 0;
    end else if (!marked && any_mark && in_valid) begin
      marked <= 1;
      ahead <= queued - handed;
      wanted <= in_data;
    end
    held <= out_data;
    waiting <= out_valid && !out_ready && !rst;
    if (rst) begin
      inside <= 0;
      queued <= 0;
      marked <= 0;
    end
  end

  always @* if (begun) begin
    assert (inside + queued <= MOST);
    assert (!out_valid || queued != 0);
    assert (busy == (inside + queued != 0));
    assert (!(marked && handed && ahead == 0) || out_data == wanted);
    assert (!waiting || (out_valid && out_data == held));
  end
endmodule
