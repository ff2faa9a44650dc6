// hk_product for an ECP5: the inner registers are those of the multiplier block, which Yosys
// 0.23 does not use by itself. Takes the place of the converted module of the same name.
module hk_product (
  input             clk,
  input      [17:0] factor,
  input      [17:0] coefficient,
  output reg [35:0] product
);

  reg  [17:0] factor_1_r;
  reg  [17:0] coefficient_1_r;
  wire [35:0] product_r;

  always @(posedge clk) begin
    factor_1_r      <= factor;
    coefficient_1_r <= coefficient;
    product         <= product_r;
  end

  MULT18X18D #(
    .REG_INPUTA_CLK("CLK0"),
    .REG_INPUTB_CLK("CLK0"),
    .REG_OUTPUT_CLK("CLK0"),
    .GSR("DISABLED")
  ) block (
    .A0(factor_1_r[0]), .A1(factor_1_r[1]), .A2(factor_1_r[2]),
    .A3(factor_1_r[3]), .A4(factor_1_r[4]), .A5(factor_1_r[5]),
    .A6(factor_1_r[6]), .A7(factor_1_r[7]), .A8(factor_1_r[8]),
    .A9(factor_1_r[9]), .A10(factor_1_r[10]), .A11(factor_1_r[11]),
    .A12(factor_1_r[12]), .A13(factor_1_r[13]), .A14(factor_1_r[14]),
    .A15(factor_1_r[15]), .A16(factor_1_r[16]), .A17(factor_1_r[17]),
    .B0(coefficient_1_r[0]), .B1(coefficient_1_r[1]), .B2(coefficient_1_r[2]),
    .B3(coefficient_1_r[3]), .B4(coefficient_1_r[4]), .B5(coefficient_1_r[5]),
    .B6(coefficient_1_r[6]), .B7(coefficient_1_r[7]), .B8(coefficient_1_r[8]),
    .B9(coefficient_1_r[9]), .B10(coefficient_1_r[10]), .B11(coefficient_1_r[11]),
    .B12(coefficient_1_r[12]), .B13(coefficient_1_r[13]), .B14(coefficient_1_r[14]),
    .B15(coefficient_1_r[15]), .B16(coefficient_1_r[16]), .B17(coefficient_1_r[17]),
    .P0(product_r[0]), .P1(product_r[1]), .P2(product_r[2]),
    .P3(product_r[3]), .P4(product_r[4]), .P5(product_r[5]),
    .P6(product_r[6]), .P7(product_r[7]), .P8(product_r[8]),
    .P9(product_r[9]), .P10(product_r[10]), .P11(product_r[11]),
    .P12(product_r[12]), .P13(product_r[13]), .P14(product_r[14]),
    .P15(product_r[15]), .P16(product_r[16]), .P17(product_r[17]),
    .P18(product_r[18]), .P19(product_r[19]), .P20(product_r[20]),
    .P21(product_r[21]), .P22(product_r[22]), .P23(product_r[23]),
    .P24(product_r[24]), .P25(product_r[25]), .P26(product_r[26]),
    .P27(product_r[27]), .P28(product_r[28]), .P29(product_r[29]),
    .P30(product_r[30]), .P31(product_r[31]), .P32(product_r[32]),
    .P33(product_r[33]), .P34(product_r[34]), .P35(product_r[35]),
    .SIGNEDA(1'b1), .SIGNEDB(1'b1), .SOURCEA(1'b0), .SOURCEB(1'b0),
    .CLK0(clk), .CLK1(1'b0), .CLK2(1'b0), .CLK3(1'b0),
    .CE0(1'b1), .CE1(1'b1), .CE2(1'b1), .CE3(1'b1),
    .RST0(1'b0), .RST1(1'b0), .RST2(1'b0), .RST3(1'b0)
  );

endmodule
