// The registers answer a write in the next clock and a read in the one after. The master does
// what it likes, but holds address and direction while it asks.
module properties #(parameter BOUND = 0) (
  input clk, any_rst, any_ask, any_we, any_error, input [7:0] any_adr
);
  reg begun = 0;
  always @(posedge clk) begun <= 1;
  wire rst = any_rst || !begun;
  wire ack, err, read, write;
  wire [7:0] address;
  reg reading = 0, acknowledge = 0, error = 0;
  reg asking = 0, we_before;
  reg [7:0] adr_before;
  wire goes_on = asking && any_ask;
  wire [7:0] adr = goes_on ? adr_before : any_adr;
  wire we = goes_on ? we_before : any_we;

  hk_wishbone core (
    .clk(clk), .rst(rst), .wb_cyc(any_ask), .wb_stb(any_ask), .wb_we(we), .wb_adr(adr),
    .wb_ack(ack), .wb_err(err), .address(address), .write(write), .read(read),
    .acknowledge(acknowledge), .error(error)
  );

  reg has_asked = 0;   // this cycle has made its request
  reg [2:0] age = 0;
  always @(posedge clk) begin
    reading <= read && !rst;
    acknowledge <= (reading || write) && !rst;
    error <= any_error;
    asking <= any_ask && !ack && !err && !rst;
    adr_before <= adr;
    we_before <= we;
    has_asked <= any_ask && !ack && !err && !rst && (has_asked || read || write);
    age <= any_ask && !ack && !err && !rst ? age + 1 : 0;
  end

  always @* if (begun) begin
    assert (!(ack && err));
    assert (!(read && write));
    assert (!(read || write) || (any_ask && !has_asked && address == adr && write == we));
    assert (!(ack || err) || (has_asked && acknowledge && err == error));
    assert (!(acknowledge && has_asked && any_ask) || ack || err);
    assert (age <= BOUND);
  end
endmodule
