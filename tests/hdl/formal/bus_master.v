// Both lines are free in every clock, as if slaves and other masters did whatever they like.
//
// The time of a command is bounded by a number that falls with every clock: `left` is the clocks
// that remain at most. It reads registers of the block by their names.
module properties #(
  parameter PHASE = 1, HIGH = 1, MARK = 1,  // clocks
  parameter PATIENCE = 1,                   // bits of the number of phases with SCL low
  parameter BOUND = 0
) (
  input clk, any_rst, command_valid, reply_ready, scl_in, sda_in,
  input [2:0] command, input [7:0] write_data
);
  reg begun = 0;
  always @(posedge clk) begun <= 1;
  wire rst = any_rst || !begun;
  wire command_ready, reply_valid, nack, timed_out, arbitration_lost, stuck, scl_low, sda_low;
  wire [7:0] read_data;
  hk_i2c_master core (
    .clk(clk), .rst(rst), .command_valid(command_valid), .command_ready(command_ready),
    .command(command), .write_data(write_data), .reply_valid(reply_valid),
    .reply_ready(reply_ready), .read_data(read_data), .nack(nack), .timed_out(timed_out),
    .arbitration_lost(arbitration_lost), .stuck(stuck),
    .scl_in(scl_in), .sda_in(sda_in), .scl_low(scl_low), .sda_low(sda_low)
  );
  localparam TIMER = $clog2(MARK + 1);
  (* hierconn *) wire [2:0] \core.state_r ;
  (* hierconn *) wire [2:0] \core.command_r ;
  (* hierconn *) wire [3:0] \core.left_r ;
  (* hierconn *) wire [TIMER-1:0] \core.timer_r ;
  (* hierconn *) wire [PATIENCE:0] \core.patience_r ;
  wire [2:0] state = \core.state_r ;
  wire [3:0] bits = \core.left_r ;
  wire [TIMER-1:0] timer = \core.timer_r ;
  wire [PATIENCE:0] patience = \core.patience_r ;
  localparam HOLDING = 1, SETTING = 2, RISING = 3, AT_HIGH = 4, MARKING = 5;

  wire [15:0] later = ((1 << PATIENCE) - patience) * PHASE + bits * (3 * PHASE + HIGH + MARK)
    + (state == HOLDING ? 2 * PHASE + HIGH + MARK
       : state == SETTING ? PHASE + HIGH + MARK
       : state == RISING ? HIGH + MARK
       : state == AT_HIGH ? MARK : 0);
  wire in_work = state >= HOLDING && state <= MARKING;
  wire [15:0] left = in_work ? later + timer + 1 : 0;

  wire [11:0] reply = {read_data, nack, timed_out, arbitration_lost, stuck};
  wire failed = timed_out || arbitration_lost;
  reg [11:0] held;
  reg waiting = 0;
  reg let_go = 0;  // an error was told a clock ago
  reg busy = 0;
  reg [2:0] asked;
  reg [15:0] age = 0;  // clocks since the command was taken
  always @(posedge clk) begin
    held <= reply;
    waiting <= reply_valid && !reply_ready && !rst;
    let_go <= reply_valid && failed && !rst;
    if (command_valid && command_ready) begin
      busy <= 1;
      asked <= command;
      age <= 1;
    end else begin
      if (!reply_valid) age <= age + 1;
      if (reply_valid && reply_ready) busy <= 0;
    end
    if (rst) busy <= 0;
  end

  always @* if (begun) begin
    assert (command_ready == !busy);
    assert (reply_valid == (busy && !in_work));
    assert (!in_work || patience <= 1 << PATIENCE);
    assert (!busy || age + left <= BOUND);
    assert (!busy || \core.command_r == asked);
    assert (!waiting || (reply_valid && reply == held));
    assert (!reply_valid || !nack || asked == 3'b010);
    assert (!reply_valid || stuck == (failed && asked == 3'b011));
    assert (!let_go || (!scl_low && !sda_low));
  end
endmodule
