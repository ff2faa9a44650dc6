# made by hostkit 0.1.0 from design 0099cab74159; do not edit; template spartan3adsp/ise/project.tcl.j2
# Makes a project for the Project Navigator of ISE 14.7: xtclsh project.tcl [BOARD]
set top hk_top
set board xc3sd3400a
if {$argc > 0} {
  set board [lindex $argv 0]
}
switch -- $board {
  xc3sd3400a {
    set device xc3sd3400a
    set package fg676
    set speed -4
  }
  xc3sd1800a {
    set device xc3sd1800a
    set package fg676
    set speed -4
  }
  default {
    puts stderr "no board is called $board"
    exit 2
  }
}

cd [file dirname [file normalize [info script]]]
project new $top.xise
project set family "Spartan-3A DSP"
project set device $device
project set package $package
project set speed $speed
project set top_level_module_type "HDL"
project set synthesis_tool "XST (VHDL/Verilog)"
project set "Preferred Language" "VHDL"

foreach source {
  ../hk_axi4lite.vhd
  ../hk_common_pkg.vhd
  ../hk_complementary_design_pkg.vhd
  ../hk_complementary_entry.vhd
  ../hk_event_counters.vhd
  ../hk_i2c_pkg.vhd
  ../hk_mavlink_pkg.vhd
  ../hk_mpu6050_pkg.vhd
  ../hk_multiplier.vhd
  ../hk_product.vhd
  ../hk_result_queue.vhd
  ../hk_root.vhd
  ../hk_root_pipelined.vhd
  ../hk_system_pkg.vhd
  ../hk_ticks.vhd
  ../hk_wishbone.vhd
  ../hk_delay.vhd
  ../hk_design_pkg.vhd
  ../hk_gate_pipelined.vhd
  ../hk_i2c_master.vhd
  ../hk_multiplier_pipelined.vhd
  ../hk_stopwatch.vhd
  ../hk_uart_rx.vhd
  ../hk_uart_tx.vhd
  ../hk_arctan.vhd
  ../hk_complementary_pkg.vhd
  ../hk_mavlink_tx.vhd
  ../hk_mpu6050.vhd
  ../hk_polar_pkg.vhd
  ../hk_arctan_pipelined.vhd
  ../hk_complementary_iterative.vhd
  ../hk_pipelined_pkg.vhd
  ../hk_polar_iterative.vhd
  ../hk_regs_pkg.vhd
  ../hk_arcsine_pipelined.vhd
  ../hk_complementary_loop.vhd
  ../hk_polar_pipelined.vhd
  ../hk_regs.vhd
  ../hk_polar.vhd
  ../hk_tilt_pipelined.vhd
  ../hk_complementary_pipelined.vhd
  ../hk_complementary.vhd
  ../hk_complementary_fixed.vhd
  ../hk_system.vhd
  ../hk_top.vhd
} {
  xfile add $source
}
xfile add $top.ucf
xfile add pins_$board.ucf
project set top "board" $top
project close
puts "$top.xise is made; open it, or: xtclsh, project open $top.xise, process run {Generate Programming File}"
