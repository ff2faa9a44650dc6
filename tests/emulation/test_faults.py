import json
import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from boards import changed, copied
from designs import design

from hostkit.cli.main import run as run_command
from hostkit.design_file import save_design
from hostkit.emulation import host_board
from hostkit.emulation.fault import KINDS, LIMIT, parse_fault
from hostkit.emulation.fault_report import rows_of
from hostkit.emulation.run import EmulationResult, emulate
from hostkit.errors import EmulationError
from hostkit.recordings import Recording, save
from hostkit.sensors.counts import Counts
from hostkit.targets import TARGETS

ROWS = 200
SAYS = "MPU-6050: "
DEAD = "MPU-6050 does not answer: I2C bus fault"


@dataclass(frozen=True)
class Promise:
    """What docs/firmware.md says of a fault."""

    fault: str
    texts: tuple[str, ...] = ()
    restarts: int = 0
    missing: int = 0  # at most
    errors: tuple[int, int] = (0, 0)  # from, to
    repeated: int = 0
    spoilt: tuple[int, int] = (0, 0)  # from, to

    def __str__(self) -> str:
        return self.fault


PROMISES = (
    Promise("nack-address=3@0.5", errors=(3, 3)),
    Promise("nack-data=2@0.5", errors=(2, 2)),
    Promise("nack-address=13@0.5", (f"{SAYS}bus failed, restart #1",), 1, 4, (12, 13)),
    Promise("torn-burst=0@0.5", (f"{SAYS}torn burst #1",), errors=(1, 1)),
    Promise("torn-burst=6@0.5", (f"{SAYS}torn burst #1",), errors=(1, 1)),
    Promise("torn-burst=15@0.5", (f"{SAYS}torn burst #1",), errors=(1, 1)),
    Promise("stuck-sda=9@0", errors=(0, 1)),
    Promise("stuck-sda=9@0.5", errors=(1, 1)),
    Promise("stuck-sda=120@0.5", (f"{SAYS}bus failed, restart #1",), 1, 6, (11, 16)),
    Promise("clock-stretch=300@0.5"),
    Promise("clock-stretch=3000@0.5", errors=(1, 4)),
    Promise(
        "register-upset=0x1B10@0.5", (f"{SAYS}restart, register 0x1B was 0x18 #1",), 1, 1, (1, 1)
    ),
    Promise(
        "register-upset=0x1908@0.5", (f"{SAYS}restart, register 0x19 was 0x01 #1",), 1, 2, (1, 1)
    ),
    Promise(
        "register-upset=0x3801@0.5", (f"{SAYS}restart, register 0x38 was 0x00 #1",), 1, 0, (1, 1)
    ),
    Promise(
        "register-upset=0x6B40@0.5", (f"{SAYS}restart, register 0x6B was 0x41 #1",), 1, 1, (1, 1)
    ),
    Promise(
        "register-upset=0x6C20@0.5",
        (f"{SAYS}restart, register 0x6C was 0x20 #1",),
        1,
        1,
        (1, 1),
        spoilt=(1, 11),
    ),
    Promise("self-reset@0", (f"{SAYS}had reset itself, restart #1",), errors=(1, 1)),
    Promise("self-reset@0.5", (f"{SAYS}had reset itself, restart #1",), 1, 0, (1, 1)),
    Promise("frozen-data@0.5", (f"{SAYS}frozen, restart #1",), 1, 50, (1, 1), 49),
    Promise("lost-data-ready=50@0.5", (f"{SAYS}INT lost, polling #1",), 0, 3, (1, 1)),
    Promise("lost-data-ready=9999@0.5", (f"{SAYS}INT lost, polling #1",), 0, 3, (1, 1)),
    Promise("brown-out-write=0@0"),  # that write is the reset itself
    Promise("brown-out-write=0@0.5"),
    Promise("stuck-value=0x3200@0.5", spoilt=(50, 50)),
    Promise("stuck-value=0x3205@0.5", spoilt=(50, 50)),
    Promise("saturated-axis=0x0A01@0.5", spoilt=(10, 10)),
    Promise("fifo-overflow=80@0.5"),
    Promise("torn-count=0x6A@0.5"),
    Promise("misaligned=1@0.5"),
    Promise("weak-response=50@0.5"),
    Promise("no-trim@0.5"),
    Promise("wrong-identity=0x70", (f"{SAYS}WHO_AM_I 0x70 taken for MPU-6500",)),
    Promise("wrong-identity=0x98", (f"{SAYS}WHO_AM_I 0x98 taken for ICM-20689",)),
    Promise("wrong-identity=0x72", (f"{SAYS}WHO_AM_I 0x72 taken for unknown clone",)),
)


def recording(rows: int = ROWS) -> Recording:
    rng = np.random.default_rng(5)
    return Recording(
        name="wild",
        time_s=np.arange(rows) / 100.0,
        rate_hz=100.0,
        angular_rate_rad_s=rng.normal(0.0, 3.0, (rows, 3)),
        specific_force_m_s2=rng.normal(0.0, 8.0, (rows, 3)),
        valid=np.ones(rows, dtype=np.bool_),
    )


def run(folder: Path, target: str, *faults: str, rows: int = ROWS) -> EmulationResult:
    planned = tuple(parse_fault(text) for text in faults)
    return emulate(folder, TARGETS[target], design(), recording(rows), faults=planned)


def folder_of(request: pytest.FixtureRequest, target: str) -> Path:
    names = {"host": "host", "atmega328p": "avr", "rp2040": "pico", "stm32f103": "stm32"}
    folder: Path = request.getfixturevalue(f"{names[target]}_folder")
    return folder


def assert_kept(result: EmulationResult, promise: Promise) -> None:
    report = result.fault_report
    assert report is not None
    assert report.struck == 1
    assert report.recovered
    assert report.texts == promise.texts
    assert report.restarts == promise.restarts
    assert report.repeated == promise.repeated
    assert promise.spoilt[0] <= report.spoilt <= promise.spoilt[1]
    assert promise.errors[0] <= report.errors <= promise.errors[1]
    assert result.mismatches == 0
    assert result.missing <= promise.missing
    assert result.passed


@pytest.mark.parametrize("promise", PROMISES, ids=str)
def test_host_keeps_the_promise(host_folder: Path, promise: Promise) -> None:
    assert_kept(run(host_folder, "host", promise.fault), promise)


@pytest.mark.parametrize("promise", PROMISES, ids=str)
def test_avr_keeps_the_promise(avr_folder: Path, promise: Promise) -> None:
    assert_kept(run(avr_folder, "atmega328p", promise.fault), promise)


@pytest.mark.parametrize("promise", PROMISES, ids=str)
def test_pico_keeps_the_promise(pico_folder: Path, promise: Promise) -> None:
    assert_kept(run(pico_folder, "rp2040", promise.fault), promise)


@pytest.mark.parametrize("promise", PROMISES, ids=str)
def test_blue_pill_keeps_the_promise(stm32_folder: Path, promise: Promise) -> None:
    assert_kept(run(stm32_folder, "stm32f103", promise.fault), promise)


@pytest.mark.parametrize("target", ["host", "atmega328p", "rp2040", "stm32f103"])
@pytest.mark.parametrize("writes", [5, 12])
def test_a_dip_of_the_supply_while_it_is_set_up(
    request: pytest.FixtureRequest, target: str, writes: int
) -> None:
    """How fast a board tries again decides whether it sees a dead bus or a reset sensor."""
    folder = folder_of(request, target)
    result = run(folder, target, f"brown-out-write={writes}@0")
    report = result.fault_report
    assert report is not None
    assert len(report.texts) == 1
    assert report.texts[0] in {
        f"{SAYS}bus failed, restart #1",
        f"{SAYS}had reset itself, restart #1",
    }
    assert result.passed
    assert result.missing == 0


@pytest.mark.parametrize("target", ["host", "atmega328p", "rp2040", "stm32f103"])
def test_a_foreign_part_is_refused_and_does_not_recover(
    request: pytest.FixtureRequest, target: str
) -> None:
    folder = folder_of(request, target)
    result = run(folder, target, "wrong-identity=0x12")
    assert result.fault_report is not None
    assert result.fault_report.texts == ("MPU-6050 refused: WHO_AM_I is 0x12",)
    assert not result.fault_report.recovered
    assert result.samples == 0
    assert not result.passed


def test_a_bus_that_stays_dead_for_long_is_said_and_survived(host_folder: Path) -> None:
    result = run(host_folder, "host", "clock-stretch=60000@0.5")
    assert result.fault_report is not None
    assert result.fault_report.texts == (f"{SAYS}bus failed, restart #1", DEAD)
    assert result.fault_report.recovered
    assert result.mismatches == 0


def test_faults_one_after_the_other(host_folder: Path) -> None:
    result = run(host_folder, "host", "self-reset@0.3", "self-reset@0.9", "torn-burst@1.5")
    report = result.fault_report
    assert report is not None
    assert report.struck == 3
    assert report.restarts == 2
    assert report.texts == tuple(
        SAYS + text
        for text in (
            "had reset itself, restart #1",
            "had reset itself, restart #2",
            "torn burst #1",
        )
    )
    assert result.passed


def test_a_driver_that_does_not_look_at_its_registers_is_found_out(
    host_folder: Path, tmp_path: Path
) -> None:
    """Without the check the counts of the wrong range would pass for the recording's."""
    folder = copied(host_folder, tmp_path / "code")
    changed(
        folder / "hk_mpu6050_burst.c",
        "    sensor->owed = true;\n    return hk_mpu6050_registers_hold(sensor, now_us);",
        "    sensor->owed = true;\n    return true;",
    )
    host_board.build(folder)
    result = run(folder, "host", "register-upset=0x1B10@0.5")
    assert result.mismatches > 100
    assert not result.passed


def test_a_gap_of_more_than_four_periods_restarts_the_filter(
    host_folder: Path, tmp_path: Path
) -> None:
    """Six announcements pass before the driver, slowed down, looks without one."""
    folder = copied(host_folder, tmp_path / "code")
    changed(
        folder / "hk_mpu6050_parts.h",
        "#define HK_OVERDUE_US  (HK_PERIOD_US + HK_PERIOD_US / 2U)",
        "#define HK_OVERDUE_US  (6U * HK_PERIOD_US)",
    )
    host_board.build(folder)
    result = run(folder, "host", "lost-data-ready=6@0.5")
    assert result.fault_report is not None
    assert result.fault_report.restarts == 1
    assert result.mismatches == 0
    assert result.missing == 5


def test_codes_are_those_of_the_virtual_sensor(host_folder: Path) -> None:
    header = (host_folder / "hk_virtual_mpu6050.h").read_text(encoding="ascii")
    names = re.findall(r"^    HK_FAULT_(\w+)", header, re.MULTILINE)
    assert [*(k.name.upper().replace("-", "_") for k in KINDS), "KINDS"] == names
    assert f"#define HK_PLANNED_FAULTS {LIMIT}" in header


@pytest.mark.parametrize(
    ("text", "amount", "time_s"),
    [("self-reset", 0, 0.0), ("stuck-sda=7@1.25", 7, 1.25), ("wrong-identity=0x70@2", 0x70, 2.0)],
)
def test_a_fault_is_read(text: str, amount: int, time_s: float) -> None:
    fault = parse_fault(text)
    assert (fault.amount, fault.time_s) == (amount, time_s)
    assert text.startswith(fault.kind.name)
    assert parse_fault(str(fault)) == fault


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("rust", "no fault; it is .*self-reset"),
        ("self-reset@", "no fault"),
        ("self-reset@1.2.3", "no number"),
        ("stuck-sda=many", "no number"),
        ("stuck-sda=4294967296", "from 0 to 4294967295"),
    ],
)
def test_what_is_no_fault_is_refused(text: str, message: str) -> None:
    with pytest.raises(EmulationError, match=message):
        parse_fault(text)


def test_a_fault_must_lie_in_the_recording(host_folder: Path) -> None:
    with pytest.raises(EmulationError, match=r"after the end of the recording, 1\.99 s"):
        run(host_folder, "host", "self-reset@2")
    with pytest.raises(EmulationError, match="17 faults are asked for; a run has 16 at most"):
        run(host_folder, "host", *["self-reset@1"] * 17)


def test_rows_are_found_in_order_and_within_the_time() -> None:
    table = np.arange(60).reshape(20, 3)
    wanted = Counts(accel=table, gyro=table)
    order = np.array([0, 1, 1, 4, 3, 19])
    sent = Counts(accel=table[order], gyro=table[order])
    rows, spoilt = rows_of(sent, wanted, np.ones(6, dtype=np.int64))
    assert rows.tolist() == [0, 1, -1, 4, -1, -1]
    assert not spoilt.any()
    far = np.array([1, 1, 1, 3, 1, 12])
    assert rows_of(sent, wanted, far)[0].tolist() == [0, 1, -1, 4, -1, 19]


def test_rows_with_a_spoilt_axis_are_found_if_wanted() -> None:
    table = np.arange(15).reshape(5, 3)
    wanted = Counts(accel=table, gyro=table)
    accel = table.copy()
    accel[2, 1], accel[3, :2] = 99, 99
    sent = Counts(accel=accel, gyro=table)
    steps = np.ones(5, dtype=np.int64)
    rows, spoilt = rows_of(sent, wanted, steps, spoilt_axes=1)
    assert rows.tolist() == [0, 1, 2, -1, 4]
    assert spoilt.tolist() == [False, False, True, False, False]
    assert rows_of(sent, wanted, steps)[0].tolist() == [0, 1, -1, -1, 4]


def test_the_command_reports_faults_as_json(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    design_file, recording_file = str(tmp_path / "design.json"), str(tmp_path / "wild.csv")
    save_design(design(), Path(design_file))
    save(recording(), Path(recording_file))
    command = ["emulate", design_file, "--target", "host", "--recording", recording_file]
    assert run_command([*command, "--fault", "self-reset@1", "--json"]) == 0
    faults = json.loads(capfd.readouterr().out)["faults"]
    assert faults["injected"] == ["self-reset=0@1"]
    assert faults["reported"] == {
        "errors": 1,
        "restarts": 1,
        "texts": [f"{SAYS}had reset itself, restart #1"],
    }
    assert faults["recovered"] is True
    assert run_command([*command, "--fault", "wrong-identity"]) == 3
    heard = capfd.readouterr()
    assert "not recovered; the firmware says: MPU-6050 refused: WHO_AM_I is 0x12" in heard.out
    assert "host did not recover" in heard.err
    assert run_command([*command, "--fault", "self-reset", "--pty"]) == 2
