"""A session without a device: what the page and its server are tried with.

Run as a program it serves the page: ``python tests/web/fake_session.py --rate 1000``.
"""

import argparse
import math
import tempfile
import threading
import time
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

import hostkit
from hostkit.errors import HostkitError
from hostkit.filters.complementary.run_time import tau_views
from hostkit.filters.filter import Fact
from hostkit.link.statistics import LinkStatistics, SourceStatistics, Spread, TimingStatistics
from hostkit.monitor.snapshot import (
    Batch,
    CommandState,
    DeviceStatus,
    ForwardState,
    Notice,
    ParameterState,
    RecordingState,
    ReplayState,
    SessionInfo,
    Snapshot,
)
from hostkit.records import ResidualStatistics, ValidationReport

TICK_S = 0.02
SNAPSHOT_S = 0.25
LENGTH_S = 120.0
NOW_S = 1.7e9


def batch(
    start: int, count: int, *, rate_hz: float = 100.0, epoch: int = 0, received_s: float = NOW_S
) -> Batch:
    """Return samples of a swinging device; every 500th is a mismatch."""
    number = np.arange(start, start + count)
    time_s = number / rate_hz
    model = np.stack([0.5 * np.sin(time_s), 0.3 * np.cos(0.7 * time_s)], axis=1)
    residual = 1e-4 * np.stack([np.sin(9.0 * time_s), np.cos(11.0 * time_s)], axis=1)
    return Batch(
        time_s=time_s,
        received_s=received_s,
        device_rad=model + residual,
        model_rad=model,
        residual_rad=residual,
        mismatch=number % 500 == 499,
        begins=number == 0,
        epoch=epoch,
    )


def info(*, rate_hz: float = 100.0, replayed: bool = False) -> SessionInfo:
    return SessionInfo(
        design_digest="0123456789ab",
        axes=("roll", "pitch"),
        rate_hz=rate_hz,
        filter="complementary filter",
        facts=(
            Fact(name="eta", label="eta", value=0.98),
            Fact(name="tau_s", label="tau", value=0.98 / rate_hz / 0.02, unit="s"),
        ),
        port="file:flight.tlog" if replayed else "/dev/ttyUSB0",
        replay=replayed,
        hostkit_version=hostkit.__version__,
    )


def report(samples: int = 0) -> ValidationReport:
    residual = tuple(
        ResidualStatistics(
            axis=axis,
            samples=samples,
            rms_rad=7.1e-5,
            max_rad=1e-4,
            mean_rad=1e-6,
            p50_rad=7e-5,
            p95_rad=9.9e-5,
            p99_rad=1e-4,
            lag_s=0.0004,
            drift_rad_s=1e-7,
        )
        for axis in ("roll", "pitch")
    )
    return ValidationReport(
        samples=samples,
        checked=samples,
        lost=samples // 1000,
        mismatches=0,
        rms_rad=7.1e-5,
        max_rad=1e-4,
        digest_ok=True,
        verdict="pass",
        residual=residual,
    )


def snapshot(**changes) -> Snapshot:
    """Return the state of a session at its beginning, with changes."""
    source = SourceStatistics(system=1, component=1, frames=3, lost=0)
    state = Snapshot(
        time_s=NOW_S,
        elapsed_s=0.0,
        epoch=0,
        port_state="connected",
        reconnects=0,
        frames_per_s=300.0,
        bytes_per_s=16000.0,
        samples_per_s=100.0,
        link=LinkStatistics(frames=3, sources=(source,)),
        timing=TimingStatistics(
            round_trip_ms=1.2,
            clock_ppm=-3.5,
            latency=Spread(median_ms=1.0, p95_ms=2.0, max_ms=4.0),
            jitter=Spread(median_ms=0.1, p95_ms=0.4, max_ms=1.5),
        ),
        device=DeviceStatus(system=1, component=1, state="ACTIVE", version="0.1.0", healthy=True),
        report=report(),
        parameters=parameters(),
        command=None,
        recording=None,
        replay=None,
        forwards=(
            ForwardState(
                address="udp:127.0.0.1:14550", sent_frames=3, dropped_frames=0, received_frames=0
            ),
        ),
        notices=(Notice(time_s=NOW_S, level="info", text="connected"),),
    )
    return replace(state, **changes)


def parameters(tau_s: float = 0.49) -> tuple[ParameterState, ...]:
    filter_ones = (
        ("FILT_TAU", "s", tau_s, 0.005, 300.0),
        ("GYRO_BIAS_ROLL", "rad/s", 0.0, -0.5, 0.5),
        ("GYRO_BIAS_PITCH", "rad/s", 0.0, -0.5, 0.5),
        ("TILT_OFS_ROLL", "rad", 0.0, -0.5, 0.5),
        ("TILT_OFS_PITCH", "rad", 0.0, -0.5, 0.5),
    )
    return (
        ParameterState(name="SYS_ID", value=1.0, unit="", lowest=1.0, highest=254.0),
        ParameterState(name="CAL_START", value=0.0, unit="", lowest=0.0, highest=1.0),
        *(
            ParameterState(
                name=name,
                value=value,
                unit=unit,
                design_value=value,
                lowest=low,
                highest=high,
                symbol="\N{GREEK SMALL LETTER TAU}" if name == "FILT_TAU" else "",
                views=tau_views(0.01) if name == "FILT_TAU" else (),
            )
            for name, unit, value, low, high in filter_ones
        ),
    )


class FakeReports:
    """Reports of a few bytes."""

    def html(self) -> bytes:
        return b"<!doctype html><title>report</title>"

    def json(self) -> bytes:
        return b'{"schema": "hostkit.monitor/1", "verdict": "pass"}'

    def xml(self) -> bytes:
        return b'<?xml version="1.0"?><testsuites/>'


@dataclass
class FakeControls:
    """Keeps what it was asked for, and the state a session would show then."""

    folder: Path
    rate_hz: float = 100.0
    replayed: bool = False
    calls: list[tuple] = field(default_factory=list)
    state: Snapshot = field(default_factory=snapshot)
    asked: list = field(default_factory=list)
    lock: threading.RLock = field(default_factory=threading.RLock)

    def __post_init__(self) -> None:
        self.change(parameters=parameters(self.info().facts[1].value))
        if self.replayed:
            replay = ReplayState(
                position_s=0.0, length_s=LENGTH_S, speed=1.0, paused=False, ended=False
            )
            self.change(replay=replay)

    def change(self, **changes) -> None:
        with self.lock:
            self.state = replace(self.state, **changes)

    def info(self) -> SessionInfo:
        return info(rate_hz=self.rate_hz, replayed=self.replayed)

    def snapshot(self) -> Snapshot:
        return self.state

    def _called(self, *call) -> None:
        with self.lock:
            self.calls.append(call)

    def set_parameter(self, name: str, value: float) -> None:
        known = {p.name: p for p in self.state.parameters}
        if name not in known:
            raise HostkitError(f"the device has no parameter {name}")
        self._called("set_parameter", name, value)
        entry = known[name]
        low, high = entry.lowest, entry.highest
        if (low is not None and value < low) or (high is not None and value > high):
            self._show(replace(entry, error=f"refused: outside [{low:g}, {high:g}]", wanted=None))
            return
        self._show(replace(entry, wanted=value, error=""))
        self.asked.append((time.monotonic() + 0.3, name, value))

    def _show(self, entry: ParameterState) -> None:
        self.change(
            parameters=tuple(entry if p.name == entry.name else p for p in self.state.parameters)
        )

    def apply(self, now_s: float) -> None:
        """Let the device answer what it was asked some time ago."""
        due = [ask for ask in self.asked if ask[0] <= now_s]
        self.asked = [ask for ask in self.asked if ask[0] > now_s]
        for _, name, value in due:
            if name == "command":
                self.change(command=CommandState(name=value, state="accepted"))
                continue
            entry = next(p for p in self.state.parameters if p.name == name)
            self._show(replace(entry, value=value, wanted=None))

    def revert_parameters(self) -> None:
        self._called("revert_parameters")
        for entry in self.state.parameters:
            if entry.design_value is not None:
                self._show(replace(entry, wanted=entry.design_value))
                self.asked.append((time.monotonic() + 0.3, entry.name, entry.design_value))

    def command(self, name: str) -> None:
        self._called("command", name)
        self.change(command=CommandState(name=name, state="waiting"))
        self.asked.append((time.monotonic() + 0.5, "command", name))

    def start_recording(self, name: str) -> None:
        self._called("start_recording", name)
        (self.folder / name).write_bytes(b"recorded")
        self.change(
            recording=RecordingState(name=name, active=True, frames=1, written_bytes=8),
        )

    def stop_recording(self) -> None:
        self._called("stop_recording")
        if self.state.recording is None:
            raise HostkitError("nothing is being recorded")
        self.change(recording=replace(self.state.recording, active=False))

    def release_port(self) -> None:
        self._called("release_port")
        self.change(port_state="released")

    def take_port(self) -> None:
        self._called("take_port")
        self.change(port_state="connected", reconnects=self.state.reconnects + 1)

    def restart_verdict(self) -> None:
        self._called("restart_verdict")
        self.change(report=report(0))

    def _replay(self) -> ReplayState:
        if self.state.replay is None:
            raise HostkitError("a live session cannot be wound")
        return self.state.replay

    def pause(self, paused: bool) -> None:
        state = self._replay()
        self._called("pause", paused)
        self.change(replay=replace(state, paused=paused))

    def seek(self, position_s: float) -> None:
        state = self._replay()
        if position_s > state.length_s:
            raise HostkitError(f"{position_s:g} s is beyond the end at {state.length_s:g} s")
        self._called("seek", position_s)
        self.change(
            replay=replace(state, position_s=position_s, ended=False), epoch=self.state.epoch + 1
        )

    def set_speed(self, speed: float | None) -> None:
        state = self._replay()
        self._called("set_speed", speed)
        self.change(replay=replace(state, speed=speed))


class Feed:
    """A thread that feeds views as a session would."""

    def __init__(self, controls: FakeControls, view) -> None:
        self._controls, self._view = controls, view
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)
        self.samples = 0

    def start(self) -> None:
        self._thread.start()

    def stop(self) -> None:
        self._stop.set()
        self._thread.join()

    def _run(self) -> None:
        begun_s = last_s = shown_s = time.monotonic()
        position, fraction = 0, 0.0
        epoch = self._controls.state.epoch
        while not self._stop.wait(TICK_S):
            now_s = time.monotonic()
            state = self._controls.state
            if state.epoch != epoch:
                epoch = state.epoch
                assert state.replay is not None
                position = int(state.replay.position_s * self._controls.rate_hz)
            fraction += (now_s - last_s) * self._controls.rate_hz * self._speed(state)
            last_s = now_s
            count, fraction = int(fraction), fraction % 1.0
            if count:
                self._view.take_batch(
                    batch(
                        position,
                        count,
                        rate_hz=self._controls.rate_hz,
                        epoch=epoch,
                        received_s=time.time(),
                    )
                )
                position += count
                self.samples += count
            if now_s - shown_s >= SNAPSHOT_S:
                shown_s = now_s
                self._show(now_s - begun_s, position)

    def _speed(self, state: Snapshot) -> float:
        if state.port_state != "connected":
            return 0.0
        if state.replay is None:
            return 1.0
        stopped = state.replay.paused or state.replay.ended
        return 0.0 if stopped else state.replay.speed or 20.0

    def _show(self, elapsed_s: float, position: int) -> None:
        controls = self._controls
        with controls.lock:
            controls.apply(time.monotonic())
            controls.change(
                time_s=time.time(),
                elapsed_s=elapsed_s,
                samples_per_s=controls.rate_hz,
                report=report(self.samples),
                link=LinkStatistics(
                    frames=3 * self.samples,
                    received_bytes=160 * self.samples,
                    sources=(SourceStatistics(system=1, component=1, frames=3 * self.samples),),
                ),
            )
            if controls.state.replay is not None:
                position_s = min(position / controls.rate_hz, LENGTH_S)
                controls.change(
                    replay=replace(
                        controls.state.replay,
                        position_s=position_s,
                        ended=position_s >= LENGTH_S,
                    )
                )
            state = controls.state
        self._view.take_snapshot(state)


def main() -> None:
    from hostkit.web.server import Server

    parser = argparse.ArgumentParser()
    parser.add_argument("--rate", type=float, default=100.0, help="samples per second")
    parser.add_argument("--port", type=int, default=0)
    parser.add_argument("--replay", action="store_true")
    parser.add_argument("--duration", type=float, default=math.inf, help="seconds")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        controls = FakeControls(
            folder=Path(folder), rate_hz=arguments.rate, replayed=arguments.replay
        )
        server = Server(controls, reports=FakeReports(), folder=Path(folder), port=arguments.port)
        feed = Feed(controls, server)
        print(server.start(), flush=True)
        feed.start()
        try:
            end_s = time.monotonic() + arguments.duration
            while time.monotonic() < end_s:
                time.sleep(0.2)
        except KeyboardInterrupt:
            pass
        print(f"{time.process_time():.2f} s of CPU, {feed.samples} samples", flush=True)
        feed.stop()
        server.stop()


if __name__ == "__main__":
    main()
