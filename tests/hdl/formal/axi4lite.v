// The registers behind it are an environment: they answer a request after one or two clocks, with
// an error or not, and their data changes on the way to the answer of a read alone.
module properties #(parameter READ = 0, WRITE = 0) (
  input clk, any_rst, awvalid, wvalid, arvalid, bready, rready,
  input [7:0] awaddr, araddr, input [3:0] wdata, wstrb,
  input answers, any_error, input [3:0] any_data
);
  reg begun = 0;
  always @(posedge clk) begun <= 1;
  wire rst = any_rst || !begun;
  wire awready, wready, arready, bvalid, rvalid, read, write;
  wire [1:0] bresp, rresp;
  wire [31:0] rdata, write_data;
  wire [7:0] address;
  wire [3:0] strobes;
  reg [3:0] data;
  reg asked = 0, old = 0, was_read, error;
  wire acknowledge = asked && (old || answers);

  hk_axi4lite core (
    .clk(clk), .rst(rst),
    .s_axi_awaddr(awaddr), .s_axi_awvalid(awvalid), .s_axi_awready(awready),
    .s_axi_wdata({28'd0, wdata}), .s_axi_wstrb(wstrb), .s_axi_wvalid(wvalid),
    .s_axi_wready(wready), .s_axi_bresp(bresp), .s_axi_bvalid(bvalid), .s_axi_bready(bready),
    .s_axi_araddr(araddr), .s_axi_arvalid(arvalid), .s_axi_arready(arready),
    .s_axi_rdata(rdata), .s_axi_rresp(rresp), .s_axi_rvalid(rvalid), .s_axi_rready(rready),
    .address(address), .write(write), .read(read), .write_data(write_data),
    .write_strobes(strobes), .read_data({28'd0, data}), .acknowledge(acknowledge),
    .error(any_error)
  );

  always @(posedge clk) begin
    asked <= (read || write || (asked && !acknowledge)) && !rst;
    old <= asked && !acknowledge;
    if (read || write) was_read <= read;
    if (read || (asked && was_read && !acknowledge)) data <= any_data;
  end

  // What has been taken and not been answered; what was done about it.
  reg has_aw = 0, has_w = 0, has_ar = 0, wrote = 0, did_read = 0, wrote_end = 0, read_end = 0;
  reg wrote_bad, read_bad;
  reg [7:0] aw, ar;
  reg [3:0] w, strobe, answer;
  reg b_waits = 0, r_waits = 0;
  reg [4:0] write_age = 0, read_age = 0;
  always @(posedge clk) begin
    if (awvalid && awready) begin has_aw <= 1; aw <= awaddr; end
    if (wvalid && wready) begin has_w <= 1; w <= wdata; strobe <= wstrb; end
    if (arvalid && arready) begin has_ar <= 1; ar <= araddr; end
    if (write) wrote <= 1;
    if (read) did_read <= 1;
    if (acknowledge && !was_read) begin wrote_end <= 1; wrote_bad <= any_error; end
    if (acknowledge && was_read) begin read_end <= 1; read_bad <= any_error; answer <= data; end
    if (bvalid && bready) begin has_aw <= 0; has_w <= 0; wrote <= 0; wrote_end <= 0; end
    if (rvalid && rready) begin has_ar <= 0; did_read <= 0; read_end <= 0; end
    b_waits <= bvalid && !bready && !rst;
    r_waits <= rvalid && !rready && !rst;
    write_age <= has_aw && has_w && !rst && !(bvalid && bready) ? write_age + !bvalid : 0;
    read_age <= has_ar && !rst && !(rvalid && rready) ? read_age + !rvalid : 0;
    if (rst) begin
      has_aw <= 0; has_w <= 0; has_ar <= 0;
      wrote <= 0; did_read <= 0; wrote_end <= 0; read_end <= 0;
    end
  end

  always @* if (begun) begin
    assert (!(read && write));
    assert (!(read || write) || !asked);
    assert (!awready || !has_aw);
    assert (!wready || !has_w);
    assert (!arready || !has_ar);
    assert (!write || (has_aw && has_w && !wrote));
    assert (!write || (address == aw && write_data == w && strobes == strobe));
    assert (!read || (has_ar && !did_read && address == ar));
    assert (bvalid == wrote_end);
    assert (!bvalid || bresp == {wrote_bad, 1'b0});
    assert (rvalid == read_end);
    assert (!rvalid || (rresp == {read_bad, 1'b0} && rdata == answer));
    assert (!b_waits || bvalid);
    assert (!r_waits || rvalid);
    assert (write_age <= WRITE);
    assert (read_age <= READ);
  end
endmodule
