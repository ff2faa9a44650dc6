import json
from pathlib import Path

import pytest
from click.testing import CliRunner
from designs import all_parameters, design

from hostkit.cli.main import cli
from hostkit.design_file import save_design
from hostkit.errors import HostkitError, RenderError
from hostkit.filters.complementary import lower
from hostkit.filters.complementary.core import clocks
from hostkit.render import (
    FirmwareOptions,
    FpgaOptions,
    MessageRate,
    generate,
    read_manifest,
    stale_files,
    write,
)
from hostkit.render.context import render_context
from hostkit.render.fpga_context import FpgaContext
from hostkit.render.fpga_options import DEFAULT_FPGA_OPTIONS
from hostkit.render.fpga_report import CellCounts
from hostkit.targets import TARGETS

SPARTAN, ECP5 = TARGETS["spartan3adsp"], TARGETS["ecp5"]
ALL = FpgaOptions(
    bus="wishbone",
    channels=16,
    pipelined=True,
    clock_hz=40_000_000,
    oscillator_hz=100_000_000,
    baud=921_600,
    profile="component",
    system_id=9,
    top_name="tilt_board",
)
CELLS = (
    CellCounts(entity="hk_system", lut=9, flip_flops=8, dsp=7, block_ram=6, tool="Yosys 0.23"),
)


def context(options: FpgaOptions = DEFAULT_FPGA_OPTIONS, rate_hz: float = 100.0) -> FpgaContext:
    found = render_context(design(rate_hz=rate_hz, low_pass_setting=1), SPARTAN, options).fpga
    assert found is not None
    return found


BAD = [
    (lambda: FpgaOptions(bus="apb"), r"bus = 'apb'; it must be one of: none, axi4lite, wishbone"),
    (lambda: FpgaOptions(channels=0), r"channels = 0; it must be 1 to 1024"),
    (lambda: FpgaOptions(channels=1025), r"channels = 1025; it must be 1 to 1024"),
    (lambda: FpgaOptions(clock_hz=0), r"clock_hz = 0; it must be above 0"),
    (lambda: FpgaOptions(oscillator_hz=-1), r"oscillator_hz = -1; it must be above 0"),
    (lambda: FpgaOptions(baud=300), r"baud = 300; it must be 1200 to 4000000"),
    (lambda: FpgaOptions(system_id=255), r"255 is the ground station's"),
    (lambda: FpgaOptions(profile="uav"), r"'uav'; it must be one of: gcs, component"),
    (lambda: FpgaOptions(top_name="3d"), r"top_name = '3d' is no identifier"),
    (lambda: FpgaOptions(top_name="a__b"), r"'a__b' is no identifier"),
    (lambda: FpgaOptions(top_name="Signal"), r"'Signal' is a reserved word of VHDL"),
    (lambda: FpgaOptions(top_name="logic"), r"'logic' is a reserved word of SystemVerilog"),
    (lambda: FpgaOptions(top_name="HK_System"), r"'HK_System'; names .* begin with hk_"),
    (lambda: FpgaOptions(top_name="hk_system"), r"'hk_system'; names .* begin with hk_"),
    (lambda: FpgaOptions(top_name="DCM_SP"), r"'DCM_SP' is the name of a primitive"),
]


@pytest.mark.parametrize(("make", "says"), BAD, ids=[says for _, says in BAD])
def test_what_no_fpga_can_be_is_refused(make, says: str) -> None:
    with pytest.raises(RenderError, match=says):
        make()


UNFIT = [
    (
        FpgaOptions(clock_hz=48_000_000),
        r"not make it of 125000000 Hz; the nearest is 48076923",
    ),
    (FpgaOptions(clock_hz=9_999_999), r"it must be 10000000 Hz, for the sensor's bus at 400 kHz"),
    (FpgaOptions(clock_hz=250_000_001), r"to 250000000 Hz, for the DCM_SP"),
    (FpgaOptions(oscillator_hz=100_000), r"oscillator_hz = 100000; the DCM_SP .* 200000 to"),
    (
        FpgaOptions(baud=57600),
        r"1000 samples a second need 55021 .* carries 4608 .*; 921600",
    ),
    (
        FpgaOptions(baud=3_000_000, clock_hz=20_000_000),
        r"baud = 3000000; at 20000000 Hz the limit is 2500000, 8 clocks a bit",
    ),
    (
        FpgaOptions(channels=910),
        r"channels = 910; at 50000000 Hz, 55 clocks a sample and 1000 .* the limit is 909",
    ),
]


@pytest.mark.parametrize(("options", "says"), UNFIT, ids=[says for _, says in UNFIT])
def test_what_does_not_fit_target_and_design_is_refused(options: FpgaOptions, says: str) -> None:
    with pytest.raises(RenderError, match=says):
        context(options, rate_hz=1000.0)


@pytest.mark.parametrize(("fast", "most"), [(False, 909), (True, 1024)])
def test_what_is_said_to_be_the_limit_of_the_channels_fits(fast: bool, most: int) -> None:
    assert context(FpgaOptions(channels=most, pipelined=fast), rate_hz=1000.0).channels == most


def test_the_clock_is_made_exactly_and_the_nearest_one_is_made() -> None:
    clock = context(FpgaOptions(clock_hz=48_076_923)).clock
    assert clock.output_hz == 48_076_923
    assert (clock.multiply, clock.divide) == (5, 13)
    assert context().clock.output_mhz == "50.000000"
    assert context().clock.input_period_ns == "8.000"


@pytest.mark.parametrize("clock_hz", [25_000_000, 50_000_000, 62_500_000, 100_000_000])
def test_the_pll_keeps_its_oscillator_in_range(clock_hz: int) -> None:
    found = render_context(design(), ECP5, FpgaOptions(clock_hz=clock_hz)).fpga
    assert found is not None
    assert found.clock.output_hz == clock_hz
    assert 400e6 <= clock_hz * found.clock.output_divide <= 800e6
    assert found.clock.input_hz / found.clock.divide >= 10e6


@pytest.mark.parametrize(("rate_hz", "baud"), [(20.0, 115200), (250.0, 230400), (1000.0, 921600)])
def test_the_line_is_as_fast_as_the_samples_need(rate_hz: float, baud: int) -> None:
    assert context(rate_hz=rate_hz).baud == baud


def test_the_clocks_of_a_filter() -> None:
    assert clocks(lower(design())).latency == 54
    assert clocks(lower(design(axes="roll"))).latency == 30
    assert clocks(lower(design(tilt="arcsin"))).interval == 83
    assert clocks(lower(all_parameters())).latency == 55
    assert clocks(lower(all_parameters(tilt="arcsin"))).latency == 83
    fast = clocks(lower(design()), pipelined=True)
    assert (fast.latency, fast.interval, fast.channel_interval) == (70, 1, 9)
    assert fast.most_channels(50_000_000, 1000.0) == 50_000


def test_the_manifest_keeps_options_and_resources(tmp_path: Path) -> None:
    write(generate(design(), SPARTAN, ALL, cells=CELLS), tmp_path)
    assert read_manifest(tmp_path).options == ALL
    assert read_manifest(tmp_path).cells == CELLS
    assert "| `hk_system` | 9 | 8 | 7 | 6 | Yosys 0.23 |" in (tmp_path / "README.md").read_text()


def test_neither_kind_of_target_takes_the_options_of_the_other() -> None:
    with pytest.raises(RenderError, match=r"spartan3adsp runs no firmware.*: signing$"):
        generate(design(), SPARTAN, FirmwareOptions(signing=True))
    message = MessageRate(name="ATTITUDE", rate_hz=0.0)
    with pytest.raises(RenderError, match=r"ecp5 runs no firmware.*: baud, message_rates$"):
        generate(design(), ECP5, FirmwareOptions(baud=9600, message_rates=(message,)))
    with pytest.raises(RenderError, match=r"host is no FPGA.*: bus, channels$"):
        generate(design(), TARGETS["host"], FpgaOptions(bus="axi4lite", channels=2))


def test_a_rate_gain_that_fits_no_coefficient_is_refused_with_numbers() -> None:
    fits = design(rate_hz=20.0, gyro_full_scale_deg_s=2000, low_pass_setting=6)
    assert generate(fits, SPARTAN)
    too_slow = design(rate_hz=4.0, gyro_full_scale_deg_s=2000, low_pass_setting=6)
    with pytest.raises(HostkitError, match=r"up to 500 deg per sample; the limit is 180 deg"):
        generate(too_slow, SPARTAN)


def hostkit(*arguments: object) -> tuple[int, str]:
    result = CliRunner().invoke(cli, [str(argument) for argument in arguments])
    return result.exit_code, result.output + str(result.exception or "")


@pytest.fixture
def design_file(tmp_path: Path) -> Path:
    save_design(design(), tmp_path / "design.json")
    return tmp_path / "design.json"


def test_options_on_the_command_line(design_file: Path, tmp_path: Path) -> None:
    out = tmp_path / "fpga"
    chosen = ["--bus", "wishbone", "--channels", 16, "--pipelined", "--clock-hz", 40_000_000]
    chosen += ["--oscillator-hz", 100_000_000, "--baud", 921_600, "--profile", "component"]
    chosen += ["--system-id", 9, "--top-name", "tilt_board"]
    command = ["generate", design_file, "--target", "spartan3adsp", "--out", out]
    code, output = hostkit(*command, *chosen, "--json")
    assert code == 0, output
    assert (
        json.loads(output)["options"] == json.loads((out / "manifest.json").read_text())["options"]
    )
    assert read_manifest(out).options == ALL
    assert hostkit(*command, "--check")[0] == 0
    assert hostkit(*command, "--check", "--bus", "none")[0] == 1
    assert stale_files(generate(design(), SPARTAN, ALL), out) == ()


REFUSED = [
    (("host", "--bus", "axi4lite"), "host is no FPGA; it takes no --bus"),
    (("host", "--synthesise"), "host is no FPGA; it takes no --synthesise"),
    (("ecp5", "--signing", "--arithmetic", "float"), "ecp5 runs no firmware; it takes no --"),
    (("ecp5", "--channels", "0"), "channels = 0; it must be 1 to 1024"),
    (("ecp5", "--top-name", "begin"), "reserved word of VHDL"),
]


@pytest.mark.parametrize(("arguments", "says"), REFUSED, ids=[says for _, says in REFUSED])
def test_wrong_use_is_refused_by_name(
    arguments: tuple[str, ...], says: str, design_file: Path, tmp_path: Path
) -> None:
    target, *options = arguments
    code, output = hostkit(
        "generate", design_file, "--target", target, "--out", tmp_path / "out", *options
    )
    assert code == 2
    assert says in output
    assert not (tmp_path / "out").exists()
