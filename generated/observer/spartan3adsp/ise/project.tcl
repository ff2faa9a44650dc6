# made by hostkit 0.1.0 from design f27a2d565bf0; do not edit; template spartan3adsp/ise/project.tcl.j2
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
  ../hk_event_counters.vhd
  ../hk_i2c_pkg.vhd
  ../hk_mavlink_pkg.vhd
  ../hk_mpu6050_pkg.vhd
  ../hk_multiplier.vhd
  ../hk_observer_design_pkg.vhd
  ../hk_root.vhd
  ../hk_sequence_pkg.vhd
  ../hk_system_pkg.vhd
  ../hk_ticks.vhd
  ../hk_wishbone.vhd
  ../hk_design_pkg.vhd
  ../hk_i2c_master.vhd
  ../hk_observer_pkg.vhd
  ../hk_observer_words_pkg.vhd
  ../hk_stopwatch.vhd
  ../hk_uart_rx.vhd
  ../hk_uart_tx.vhd
  ../hk_arctan.vhd
  ../hk_mavlink_tx.vhd
  ../hk_memory.vhd
  ../hk_mpu6050.vhd
  ../hk_observer_parts_pkg.vhd
  ../hk_regs_pkg.vhd
  ../hk_observer_program_pkg.vhd
  ../hk_regs.vhd
  ../hk_sequencer.vhd
  ../hk_observer.vhd
  ../hk_observer_fixed.vhd
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
