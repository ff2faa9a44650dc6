// The block memory of the Spartan-3A DSP as far as mapped cores use it: both ports at any width,
// byte writes, no output register. Yosys ships the cell without a model. Reading what the other
// port writes gives unknown bits unless that port reads first.
module RAMB16BWER #(
  parameter DATA_WIDTH_A = 0, DATA_WIDTH_B = 0, DOA_REG = 0, DOB_REG = 0,
  parameter EN_RSTRAM_A = "TRUE", EN_RSTRAM_B = "TRUE",
  parameter RST_PRIORITY_A = "CE", RST_PRIORITY_B = "CE", RSTTYPE = "SYNC",
  parameter WRITE_MODE_A = "WRITE_FIRST", WRITE_MODE_B = "WRITE_FIRST",
  parameter INIT_FILE = "NONE", SIM_DEVICE = "SPARTAN3ADSP", SIM_COLLISION_CHECK = "ALL",
  parameter [35:0] INIT_A = 0, INIT_B = 0, SRVAL_A = 0, SRVAL_B = 0,
  parameter [255:0]
    INIT_00 = 0, INIT_01 = 0, INIT_02 = 0, INIT_03 = 0, INIT_04 = 0, INIT_05 = 0,
    INIT_06 = 0, INIT_07 = 0, INIT_08 = 0, INIT_09 = 0, INIT_0A = 0, INIT_0B = 0,
    INIT_0C = 0, INIT_0D = 0, INIT_0E = 0, INIT_0F = 0, INIT_10 = 0, INIT_11 = 0,
    INIT_12 = 0, INIT_13 = 0, INIT_14 = 0, INIT_15 = 0, INIT_16 = 0, INIT_17 = 0,
    INIT_18 = 0, INIT_19 = 0, INIT_1A = 0, INIT_1B = 0, INIT_1C = 0, INIT_1D = 0,
    INIT_1E = 0, INIT_1F = 0, INIT_20 = 0, INIT_21 = 0, INIT_22 = 0, INIT_23 = 0,
    INIT_24 = 0, INIT_25 = 0, INIT_26 = 0, INIT_27 = 0, INIT_28 = 0, INIT_29 = 0,
    INIT_2A = 0, INIT_2B = 0, INIT_2C = 0, INIT_2D = 0, INIT_2E = 0, INIT_2F = 0,
    INIT_30 = 0, INIT_31 = 0, INIT_32 = 0, INIT_33 = 0, INIT_34 = 0, INIT_35 = 0,
    INIT_36 = 0, INIT_37 = 0, INIT_38 = 0, INIT_39 = 0, INIT_3A = 0, INIT_3B = 0,
    INIT_3C = 0, INIT_3D = 0, INIT_3E = 0, INIT_3F = 0,
    INITP_00 = 0, INITP_01 = 0, INITP_02 = 0, INITP_03 = 0, INITP_04 = 0, INITP_05 = 0,
    INITP_06 = 0, INITP_07 = 0
) (
  output reg [31:0] DOA, DOB, output reg [3:0] DOPA, DOPB,
  input [13:0] ADDRA, ADDRB, input CLKA, CLKB, input [31:0] DIA, DIB, input [3:0] DIPA, DIPB,
  input ENA, ENB, REGCEA, REGCEB, RSTA, RSTB, input [3:0] WEA, WEB
);

  reg [16383:0] data = {
    INIT_3F, INIT_3E, INIT_3D, INIT_3C, INIT_3B, INIT_3A, INIT_39, INIT_38,
    INIT_37, INIT_36, INIT_35, INIT_34, INIT_33, INIT_32, INIT_31, INIT_30,
    INIT_2F, INIT_2E, INIT_2D, INIT_2C, INIT_2B, INIT_2A, INIT_29, INIT_28,
    INIT_27, INIT_26, INIT_25, INIT_24, INIT_23, INIT_22, INIT_21, INIT_20,
    INIT_1F, INIT_1E, INIT_1D, INIT_1C, INIT_1B, INIT_1A, INIT_19, INIT_18,
    INIT_17, INIT_16, INIT_15, INIT_14, INIT_13, INIT_12, INIT_11, INIT_10,
    INIT_0F, INIT_0E, INIT_0D, INIT_0C, INIT_0B, INIT_0A, INIT_09, INIT_08,
    INIT_07, INIT_06, INIT_05, INIT_04, INIT_03, INIT_02, INIT_01, INIT_00
  };
  reg [2047:0] parity = {
    INITP_07, INITP_06, INITP_05, INITP_04, INITP_03, INITP_02, INITP_01, INITP_00
  };

  // Data bits of a port of so many bits in all; a port of 9, 18 or 36 has a parity bit a byte.
  function integer data_bits(input integer width);
    data_bits = width == 9 ? 8 : width == 18 ? 16 : width == 36 ? 32 : width;
  endfunction

  localparam BITS_A = data_bits(DATA_WIDTH_A);
  localparam BITS_B = data_bits(DATA_WIDTH_B);

  wire [13:0] from_a = ADDRA & ~(BITS_A - 1);
  wire [13:0] from_b = ADDRB & ~(BITS_B - 1);
  wire writes_a = DATA_WIDTH_A != 0 && ENA && |WEA;
  wire writes_b = DATA_WIDTH_B != 0 && ENB && |WEB;
  wire overlap = from_a < from_b + BITS_B && from_b < from_a + BITS_A;

  integer i, j;

  always @(posedge CLKA) if (DATA_WIDTH_A != 0 && ENA === 1'b1) begin
    for (i = 0; i < BITS_A; i = i + 1) begin
      if (WEA[i / 8]) data[from_a + i] <= DIA[i];
      if (!WEA[i / 8] || WRITE_MODE_A == "READ_FIRST") DOA[i] <= data[from_a + i];
      else if (WRITE_MODE_A == "WRITE_FIRST") DOA[i] <= DIA[i];
    end
    if (DATA_WIDTH_A > BITS_A) for (i = 0; i < BITS_A / 8; i = i + 1) begin
      if (WEA[i]) parity[from_a / 8 + i] <= DIPA[i];
      if (!WEA[i] || WRITE_MODE_A == "READ_FIRST") DOPA[i] <= parity[from_a / 8 + i];
      else if (WRITE_MODE_A == "WRITE_FIRST") DOPA[i] <= DIPA[i];
    end
    if (writes_b && overlap && WRITE_MODE_B != "READ_FIRST") {DOPA, DOA} <= 36'bx;
    if (RSTA) {DOPA, DOA} <= SRVAL_A;
  end

  always @(posedge CLKB) if (DATA_WIDTH_B != 0 && ENB === 1'b1) begin
    for (j = 0; j < BITS_B; j = j + 1) begin
      if (WEB[j / 8]) data[from_b + j] <= DIB[j];
      if (!WEB[j / 8] || WRITE_MODE_B == "READ_FIRST") DOB[j] <= data[from_b + j];
      else if (WRITE_MODE_B == "WRITE_FIRST") DOB[j] <= DIB[j];
    end
    if (DATA_WIDTH_B > BITS_B) for (j = 0; j < BITS_B / 8; j = j + 1) begin
      if (WEB[j]) parity[from_b / 8 + j] <= DIPB[j];
      if (!WEB[j] || WRITE_MODE_B == "READ_FIRST") DOPB[j] <= parity[from_b / 8 + j];
      else if (WRITE_MODE_B == "WRITE_FIRST") DOPB[j] <= DIPB[j];
    end
    if (writes_a && overlap && WRITE_MODE_A != "READ_FIRST") {DOPB, DOB} <= 36'bx;
    if (RSTB) {DOPB, DOB} <= SRVAL_B;
  end

endmodule
