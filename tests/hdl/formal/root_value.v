// The root is the floor: root**2 <= radicand * 4**FRACTION_BITS < (root + 1)**2.
module properties (input clk, any_rst, in_valid, out_ready, input [5:0] radicand);
  reg begun = 0;
  always @(posedge clk) begun <= 1;
  wire rst = any_rst || !begun;
  wire in_ready, out_valid;
  wire [4:0] root;
  hk_root core (
    .clk(clk), .rst(rst), .in_valid(in_valid), .in_ready(in_ready), .radicand(radicand),
    .out_valid(out_valid), .out_ready(out_ready), .root(root)
  );
  reg [5:0] taken;
  always @(posedge clk) if (in_valid && in_ready) taken <= radicand;
  wire [11:0] wanted = {2'b0, taken, 4'b0};
  wire [11:0] square = root * root;
  always @* if (begun && out_valid) begin
    assert (square <= wanted);
    assert (wanted <= square + 2 * root);
  end
endmodule
