"""The Linux target: the program that would run on a single-board computer, on faked devices."""

import os
import signal
import subprocess
import threading
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from boards import (
    ACTIVE,
    Collector,
    assert_every_row_once,
    expected_counts,
    generated,
    hear,
    program_or_skip,
    require_or_skip,
    stimulus,
    with_faults,
)

from hostkit.dialect import python_module
from hostkit.emulation import linux_board
from hostkit.emulation.board import LinkInput, PlannedFault, Stimulus
from hostkit.emulation.fault import KINDS
from hostkit.emulation.make import make
from hostkit.emulation.playback import playback
from hostkit.errors import EmulationError

POLLED = ("--i2c", "/dev/hk-i2c")
ERASED = b"\xff" * 256
RETUNED = 4
WATCHDOG_S = 20.0


@pytest.fixture(scope="session")
def code(tmp_path_factory: pytest.TempPathFactory) -> Path:
    require_or_skip("gcc", "make")
    folder = generated("linux", tmp_path_factory.mktemp("linux"))
    linux_board.build(folder)
    return folder


def message(name: str, *fields: object) -> bytes:
    module = python_module()
    mav = module.MAVLink(None, srcSystem=255, srcComponent=190)
    return bytes(getattr(module, f"MAVLink_{name}_message")(*fields).pack(mav))


def tau(value: float) -> bytes:
    return message("param_set", 1, 1, b"FILT_TAU", value, 9)


def reboot() -> bytes:
    return message("command_long", 1, 1, 246, 0, *(1.0, 0, 0, 0, 0, 0, 0))


def says(feels: Stimulus, *pieces: tuple[float, bytes]) -> Stimulus:
    return replace(feels, received=tuple(LinkInput(time_s=t, data=data) for t, data in pieces))


@pytest.mark.parametrize("compiler", ["gcc", "clang"])
def test_strict_warnings_find_nothing(compiler: str, tmp_path: Path) -> None:
    require_or_skip("make", "gcc")
    program_or_skip(compiler)
    make(generated("linux", tmp_path), f"CC={compiler}", "WERROR=1")


def test_every_row_comes_back_once(code: Path) -> None:
    feels = stimulus(500)
    heard = hear(linux_board.run(code, feels))
    assert_every_row_once(heard, feels)
    assert heard.states[-1] == ACTIVE
    assert heard.of("STATUSTEXT") == []


def test_samples_have_the_time_at_which_the_line_rose(code: Path) -> None:
    times = np.array([s.time_usec for s in hear(linux_board.run(code, stimulus(100))).samples])
    np.testing.assert_array_equal(np.diff(times.astype(np.int64)), 10_000)


def test_without_a_line_the_sensor_is_polled(code: Path) -> None:
    feels = stimulus(300)
    heard = hear(linux_board.run(code, feels, devices=POLLED))
    counts = expected_counts(feels)
    table = {tuple(row): k for k, row in enumerate(np.hstack([counts.accel, counts.gyro]).tolist())}
    rows = [table[(*sample.accel, *sample.gyro)] for sample in heard.samples]
    assert rows == sorted(set(rows))
    assert len(rows) >= len(feels) - 3
    assert rows[-1] == len(feels) - 1
    assert "INT lost, polling" in heard.of("STATUSTEXT")[0].text


@pytest.mark.parametrize(
    ("faults", "errors"),
    [({"nack": 3}, 3), ({"hold_sda_clocks": 9}, 1), ({"hold_sda_clocks": 20}, 3)],
)
def test_errors_of_the_bus_are_tried_again(code: Path, faults, errors: int) -> None:
    feels = with_faults(stimulus(100), from_row=40, **faults)
    heard = hear(linux_board.run(code, feels))
    assert heard.samples[-1].i2c_errors == errors
    assert heard.samples[-1].sequence >= 99 - errors
    assert heard.states[-1] == ACTIVE


@pytest.mark.parametrize("name", ["nack-data", "torn-burst", "clock-stretch", "self-reset"])
def test_planned_faults_strike_and_are_survived(code: Path, name: str) -> None:
    kind = next(k for k in KINDS if k.name == name)
    fault = PlannedFault(code=kind.code, row=50, amount=kind.amount)
    run = linux_board.run(code, with_faults(stimulus(150), planned=(fault,)))
    assert dict(run.faults)["struck"] == 1
    heard = hear(run)
    assert heard.samples[-1].sequence >= 145
    assert heard.states[-1] == ACTIVE


def test_a_sensor_that_is_not_there_is_no_sample_and_no_hang(code: Path) -> None:
    run = linux_board.run(code, with_faults(stimulus(20), nack=2**31))
    assert dict(run.faults)["stalled"] == 1
    assert hear(run).samples == []
    assert "does not answer" in hear(run).of("STATUSTEXT")[0].text


def test_what_is_received_is_answered_and_kept(code: Path) -> None:
    run = linux_board.run(code, says(stimulus(800), (1.0, tau(3.0))))
    heard = hear(run)
    answer = heard.of("PARAM_VALUE")[-1]
    assert answer.param_id.rstrip("\0") == "FILT_TAU"
    assert answer.param_value == pytest.approx(3.0, rel=1e-3)
    assert run.store != ERASED
    assert not heard.samples[0].flags & RETUNED
    again = linux_board.run(code, replace(stimulus(100), store=run.store))
    assert all(sample.flags & RETUNED for sample in hear(again).samples)


def test_a_reboot_starts_over(code: Path) -> None:
    heard = hear(linux_board.run(code, says(stimulus(400), (1.5, reboot()))))
    sequence = [sample.sequence for sample in heard.samples]
    starts = [k for k, number in enumerate(sequence) if number == 0]
    assert len(starts) == 2
    assert sequence[-1] == len(sequence) - 1 - starts[1]
    assert heard.states[-1] == ACTIVE


def test_the_serial_port_is_raw_and_carries_every_byte(code: Path) -> None:
    master, slave = os.openpty()
    pieces: list[bytes] = []
    done = threading.Event()

    def drain() -> None:
        os.set_blocking(master, False)
        while True:
            ended = done.is_set()
            try:
                pieces.append(os.read(master, 65536))
            except BlockingIOError:
                if ended:
                    return
                time.sleep(0.005)

    reader = threading.Thread(target=drain)
    reader.start()
    feels = stimulus(200)
    try:
        devices = (*linux_board.DEVICES, "--serial", os.ttyname(slave))
        run = linux_board.run(code, feels, devices=devices)
    finally:
        done.set()
        reader.join(10.0)
        os.close(slave)
        os.close(master)
    assert run.stream == b""
    assert_every_row_once(hear(b"".join(pieces)), feels)


def test_served_it_keeps_going_and_hears(code: Path) -> None:
    request = iter([message("param_request_read", 1, 1, b"FILT_TAU", -1)] * 20)

    def enough(data: bytes) -> bool:
        heard = hear(data)
        return len(heard.samples) > 60 and bool(heard.of("PARAM_VALUE"))

    collector = Collector(enough)
    linux_board.serve(
        code, stimulus(30), collector.send, collector.stop, lambda: next(request, b"")
    )
    heard = hear(collector.data)
    assert [sample.sequence for sample in heard.samples[:60]] == list(range(60))


def test_the_watchdog_starts_the_program_over(code: Path, tmp_path: Path) -> None:
    """The alarm that a main loop which hangs would let come is sent by hand."""
    play = playback(replace(stimulus(30), loop=True), tmp_path)
    (tmp_path / "slots").mkdir()
    command = linux_board.command_of(code, play, tmp_path)
    program = subprocess.Popen(command, stdout=subprocess.PIPE)
    assert program.stdout is not None
    data, bites, deadline = b"", 0, time.monotonic() + WATCHDOG_S
    try:
        while bites < 2 or len(hear(data).samples) < 10:
            assert time.monotonic() < deadline, "the program did not come back"
            data += os.read(program.stdout.fileno(), 4096)
            if bites < 2 and len(hear(data).samples) > 3:
                program.send_signal(signal.SIGALRM)
                bites, data = bites + 1, b""
    finally:
        program.terminate()
        program.wait(10.0)
        program.stdout.close()
    assert "Restarted by the watchdog" in [text.text for text in hear(data).of("STATUSTEXT")]


@pytest.mark.parametrize(
    ("arguments", "exit_code", "what"),
    [
        (("--i2c", "/dev/no-such-bus"), 1, "/dev/no-such-bus"),
        (("--i2c", "/dev/null", "--int", "/dev/null:4"), 1, "/dev/null"),
        (("--i2c", "/dev/null", "--serial", "/dev/null"), 1, "/dev/null"),
        (("--i2c", "/dev/null", "--store", "/no/such/folder"), 1, "/no/such/folder"),
        (("--int", "/dev/gpiochip0"), 2, "needs CHIP:LINE"),
        (("--int", "/dev/gpiochip0:x"), 2, "needs CHIP:LINE"),
        (("--baud", "9600"), 2, "--baud is not an option"),
        (("--i2c",), 2, "needs a value"),
    ],
)
def test_what_cannot_be_used_is_named(code: Path, arguments, exit_code: int, what: str) -> None:
    done = subprocess.run(
        [code / "firmware", *arguments],
        capture_output=True,
        text=True,
        timeout=30,
        stdin=subprocess.DEVNULL,
        check=False,
    )
    assert done.returncode == exit_code
    assert what in done.stderr


def test_a_power_cut_is_refused(code: Path) -> None:
    with pytest.raises(EmulationError, match="renamed"):
        linux_board.run(code, replace(stimulus(20), power_cut_after=3))
