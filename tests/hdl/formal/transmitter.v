// Four clocks a bit: a byte that is taken stands on the line, bit after bit, and nothing else does.
module properties #(parameter BUSY = 0) (input clk, any_rst, in_valid, input [7:0] in_data);
  reg begun = 0;
  always @(posedge clk) begun <= 1;
  wire rst = any_rst || !begun;
  wire in_ready, tx;
  hk_uart_tx core (
    .clk(clk), .rst(rst), .in_valid(in_valid), .in_ready(in_ready), .in_data(in_data), .tx(tx)
  );

  reg waits = 0;      // a byte that is not on the line yet
  reg [9:0] frame;    // of the byte that was taken last; its start bit is lowest
  reg sending = 0;
  reg [5:0] place;    // clocks since the start bit began
  reg [9:0] sent;     // the frame on the line
  reg [6:0] busy = 0; // clocks since it was taken
  wire starts = waits && !tx && (!sending || place == 40);

  always @(posedge clk) begin
    busy <= in_ready ? 0 : busy + 1;
    if (starts) begin
      waits <= 0;
      sent <= frame;
      sending <= 1;
      place <= 1;
    end else if (sending) begin
      if (place == 40) sending <= 0;
      else place <= place + 1;
    end
    if (in_valid && in_ready) begin
      waits <= 1;
      frame <= {1'b1, in_data, 1'b0};
    end
    if (rst) begin
      waits <= 0;
      sending <= 0;
      busy <= 0;
    end
  end

  always @* if (begun) begin
    assert (starts || (sending && place < 40) || tx);
    assert (!sending || place == 40 || tx == sent[place[5:2]]);
    assert (busy <= BUSY);
  end
endmodule
