-- made by hostkit 0.1.0 from design f27a2d565bf0; do not edit; template system/hk_system_pkg.vhd.j2
-- What was chosen of the system beside its design.
package hk_system_pkg is

  constant clock_hz_c : positive := 50000000;
  constant baud_c     : positive := 115200;

end package hk_system_pkg;
