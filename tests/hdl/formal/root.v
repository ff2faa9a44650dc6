module properties #(parameter LATENCY = 0) (input clk, any_rst, in_valid, out_ready);
  reg begun = 0;
  always @(posedge clk) begun <= 1;
  wire rst = any_rst || !begun;
  wire in_ready, out_valid;
  wire [22:0] root;
  hk_root core (
    .clk(clk), .rst(rst), .in_valid(in_valid), .in_ready(in_ready),
    .out_valid(out_valid), .out_ready(out_ready), .root(root)
  );
  stream_checker #(.PAYLOAD(23), .LATENCY(LATENCY)) checker_of_root (
    .clk(clk), .rst(rst), .begun(begun), .in_valid(in_valid), .in_ready(in_ready),
    .in_channel(1'b0), .out_valid(out_valid), .out_ready(out_ready), .out_channel(1'b0),
    .payload(root)
  );
endmodule
