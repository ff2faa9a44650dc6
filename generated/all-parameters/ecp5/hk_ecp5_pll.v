// made by hostkit 0.1.0 from design 0099cab74159; do not edit; template ecp5/hk_ecp5_pll.v.j2
// 25.000000 MHz * 1 / 1 = 25.000000 MHz. The output is fed back, so its divisor only
// sets the frequency of the oscillator inside.
module hk_ecp5_pll (
  input  wire clk_in,
  output wire clk,
  output wire locked
);

  (* FREQUENCY_PIN_CLKI = "25.000000", FREQUENCY_PIN_CLKOP = "25.000000" *)
  EHXPLLL #(
    .CLKI_DIV(32'd1),
    .CLKFB_DIV(32'd1),
    .CLKOP_DIV(32'd24),
    .CLKOP_ENABLE("ENABLED"),
    .FEEDBK_PATH("CLKOP"),
    .PLLRST_ENA("DISABLED"),
    .STDBY_ENABLE("DISABLED"),
    .DPHASE_SOURCE("DISABLED")
  ) pll (
    .CLKI(clk_in),
    .CLKFB(clk),
    .CLKOP(clk),
    .LOCK(locked),
    .RST(1'b0),
    .STDBY(1'b0),
    .ENCLKOP(1'b0),
    .PHASESEL0(1'b0),
    .PHASESEL1(1'b0),
    .PHASEDIR(1'b0),
    .PHASESTEP(1'b0),
    .PHASELOADREG(1'b0),
    .PLLWAKESYNC(1'b0)
  );

endmodule
