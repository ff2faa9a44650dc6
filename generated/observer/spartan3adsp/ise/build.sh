# made by hostkit 0.1.0 from design f27a2d565bf0; do not edit; template spartan3adsp/ise/build.sh.j2
# From VHDL to a bitstream with the command line tools of ISE 14.7, in ise/build-BOARD.
#
#   . /opt/Xilinx/14.7/ISE_DS/settings64.sh
#   sh build.sh            XtremeDSP Development Platform, Spartan-3A DSP 3400A Edition (UG498)
#   sh build.sh BOARD      BOARD is xc3sd3400a or xc3sd1800a
set -eu
cd "$(dirname "$0")"

board=${1:-xc3sd3400a}
case $board in
  xc3sd3400a) part=xc3sd3400a-4-fg676 ;;
  xc3sd1800a) part=xc3sd1800a-4-fg676 ;;
  *) echo "no board is called $board" >&2; exit 2 ;;
esac

if grep -n FILL_IN "pins_$board.ucf" | grep -v 'A line with'; then
  echo "fill in these pins of pins_$board.ucf first" >&2
  exit 1
fi

mkdir -p "build-$board/tmp" "build-$board/xst"
sed '/^#/d' hk_top.prj > "build-$board/hk_top.prj"
sed -e '/^#/d' -e "s/^-p PART\$/-p $part/" hk_top.xst > "build-$board/hk_top.xst"
cd "build-$board"

xst -intstyle xflow -ifn hk_top.xst -ofn hk_top.syr
ngdbuild -intstyle xflow -p "$part" -uc ../hk_top.ucf -uc "../pins_$board.ucf" hk_top.ngc hk_top.ngd
map -intstyle xflow -w -p "$part" -timing -ol high -o hk_top_map.ncd hk_top.ngd hk_top.pcf
par -intstyle xflow -w -ol high hk_top_map.ncd hk_top.ncd hk_top.pcf
trce -intstyle xflow -v 10 -o hk_top.twr hk_top.ncd hk_top.pcf
bitgen -intstyle xflow -w hk_top.ncd hk_top.bit hk_top.pcf

echo "build-$board/hk_top.bit; read the timing in hk_top.twr before you trust it"
