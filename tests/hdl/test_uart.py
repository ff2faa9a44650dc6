import subprocess
from pathlib import Path

import pytest
from cocotb_run import run_bench
from designs import design

from hostkit.render import render_target, write
from hostkit.targets import TARGETS

RATES = {
    "4": (40_000_000, 10_000_000),
    "4.06": (40_600_000, 10_000_000),
    "4.34": (50_000_000, 11_520_000),
    "7.99": (79_900_000, 10_000_000),
    "8.68": (1_000_000, 115_200),
    "434.03": (50_000_000, 115_200),
    "5208.33": (50_000_000, 9_600),
}
BENCHES = Path(__file__).parent / "benches"


@pytest.fixture(scope="module")
def generated(tmp_path_factory: pytest.TempPathFactory, ghdl_installed: None) -> Path:
    folder = tmp_path_factory.mktemp("link")
    write(render_target(design(), TARGETS["spartan3adsp"]), folder)
    return folder


@pytest.mark.parametrize("ratio", RATES)
def test_bytes_come_through(generated: Path, tmp_path: Path, ratio: str) -> None:
    clock_hz, baud = RATES[ratio]
    parameters = {"CLOCK_HZ": clock_hz, "BAUD": baud}
    tests = run_bench(
        generated,
        "uart_pair",
        "uart_bench",
        build=tmp_path,
        parameters=parameters,
        more_sources=[BENCHES / "uart_pair.vhd"],
        environment={name: str(value) for name, value in parameters.items()},
    )
    assert tests == 7


@pytest.mark.parametrize(
    ("entity", "generics"),
    [
        ("hk_uart_tx", ("CLOCK_HZ=39999999", "BAUD=10000000")),
        ("hk_uart_rx", ("CLOCK_HZ=39999999", "BAUD=10000000")),
        ("hk_stopwatch", ("CLOCK_HZ=999999",)),
    ],
)
def test_impossible_rates_are_refused(
    generated: Path, tmp_path: Path, entity: str, generics: tuple[str, ...]
) -> None:
    work = ["--std=93c", f"--workdir={tmp_path}"]
    sources = [generated / "hk_ticks.vhd", generated / f"{entity}.vhd"]
    subprocess.run(["ghdl", "-a", *work, *sources], check=True, cwd=tmp_path, timeout=60)
    subprocess.run(["ghdl", "-e", *work, entity], check=True, cwd=tmp_path, timeout=60)
    options = [f"-g{generic}" for generic in generics]
    command = ["ghdl", "-r", *work, entity, *options, "--stop-time=1ns"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=60)
    assert done.returncode != 0
    assert "(assertion failure): hk_" in done.stdout + done.stderr
