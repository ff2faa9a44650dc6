// Everything but the blend at the widths of the core; the blend's own multiplication is narrower.
module properties #(parameter BITS = 17, LIMIT = 16384, DIFFERENCE_BITS = 12, BLEND_BITS = 8) (
  input clk,
  input signed [49:0] product, input signed [16:0] count, input signed [31:0] bias,
  input signed [DIFFERENCE_BITS-1:0] difference, input signed [BLEND_BITS+1:0] blend
);
  wire signed [31:0] rounded, kept, highest, correction;
  wire signed [16:0] inside;
  wire [15:0] size;
  functions core (
    .product(product), .rounded(rounded), .count(count), .inside(inside), .size(size),
    .bias(bias), .kept(kept), .highest(highest),
    .difference(difference), .blend(blend), .correction(correction)
  );

  // Halves upwards: what is left of the product lies in -half .. half - 1.
  wire signed [83:0] half = 84'sd1 <<< (BITS - 1);
  wire signed [83:0] wide = rounded;
  wire signed [83:0] left = product - (wide <<< BITS);
  wire signed [83:0] quotient = (product + half) >>> BITS;
  wire fits = quotient >= -84'sd2147483648 && quotient <= 84'sd2147483647;

  // A blend of 0 .. 1 never overshoots the measurement nor leaves it.
  wire is_blend = blend >= 0 && blend <= (1 <<< BLEND_BITS);

  always @* begin
    assert (rounded == quotient[31:0]);
    assert (!fits || (left >= -half && left < half));
    assert (inside <= LIMIT && inside >= -LIMIT);
    assert (inside == count || (count > LIMIT && inside == LIMIT)
            || (count < -LIMIT && inside == -LIMIT));
    assert (count == -17'sd65536 || size == (count < 0 ? -count : count));
    assert (kept <= highest && kept >= -highest);
    assert (kept == bias || (bias > highest && kept == highest)
            || (bias < -highest && kept == -highest));
    assert (!is_blend || difference < 0 || (correction >= 0 && correction <= difference));
    assert (!is_blend || difference > 0 || (correction <= 0 && correction >= difference));
  end
endmodule
