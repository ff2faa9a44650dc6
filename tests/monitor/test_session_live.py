"""What a session does beside judging: views, controls, lost ports, other devices, replay."""

import threading
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
import pytest
from designs import design
from device import Device

from hostkit.errors import DeviceError, HostkitError
from hostkit.link.frames.decoder import Decoder
from hostkit.link.logs.replay import ReplayTransport
from hostkit.link.logs.tlog import STAMP, TlogWriter, read_tlog
from hostkit.monitor import Session, SessionOptions
from hostkit.monitor.snapshot import Batch, Snapshot
from hostkit.validation import Thresholds

D = design()
READ_S = 0.125
LIMIT_S = 30.0
OPTIONS = SessionOptions(port="fake", patient=True)


@dataclass
class FakeClock:
    now: float = 0.0

    def monotonic(self) -> float:
        return self.now

    def time(self) -> float:
        return 1.7e9 + self.now

    def sleep(self, duration_s: float) -> None:
        self.now += duration_s


@dataclass
class Act:
    """What happens to the port before a read."""

    data: bytes = b""
    state: str = "connected"
    anew: bool = False
    do: object = None


@dataclass
class FakePort:
    clock: FakeClock
    acts: list[Act]
    live: bool = True
    state: str = "connected"
    epoch: int = 0
    overrun_bytes: int = 0
    sent: bytes = b""

    def read(self, timeout_s: float) -> bytes | None:
        self.clock.now += READ_S
        if not self.acts:
            return b""
        act = self.acts.pop(0)
        self.state, self.epoch = act.state, self.epoch + act.anew
        if callable(act.do):
            act.do()
        return act.data

    def write(self, data: bytes) -> None:
        self.sent += data

    def release(self) -> None:
        self.state = "released"

    def take(self) -> None:
        self.state = "connected"

    def close(self) -> None:
        pass


@dataclass
class Sight:
    """A view that remembers."""

    batches: list[Batch] = field(default_factory=list)
    snapshots: list[Snapshot] = field(default_factory=list)
    order: list[object] = field(default_factory=list)

    def take_batch(self, batch: Batch) -> None:
        self.batches.append(batch)
        self.order.append(batch)

    def take_snapshot(self, snapshot: Snapshot) -> None:
        self.snapshots.append(snapshot)
        self.order.append(snapshot)

    def texts(self) -> list[str]:
        return [notice.text for notice in self.snapshots[-1].notices]


def acts(frames: list[bytes], *, per_read: int = 10) -> list[Act]:
    return [Act(b"".join(frames[k : k + per_read])) for k in range(0, len(frames), per_read)]


def run(steps: list[Act], *, duration_s: float | None = None, options=OPTIONS, **more):
    clock = FakeClock()
    port = FakePort(clock, steps)
    sight = Sight()
    session = Session(
        design=D,
        transport=port,
        thresholds=Thresholds(),
        clock=clock,
        duration_s=duration_s,
        options=options,
        views=[sight],
        **more,
    )
    steps.append(Act(do=session.stop))
    return session.run(), sight, port, session


def test_views_see_every_sample_once_beside_its_model() -> None:
    result, sight, _, _ = run(acts(Device(D).frames(200)))
    assert sum(len(batch) for batch in sight.batches) == result.report.samples == 200
    time_s = np.concatenate([batch.time_s for batch in sight.batches])
    np.testing.assert_allclose(time_s, np.arange(200) / 100.0, atol=1e-9)
    assert all(np.abs(b.residual_rad).max() < 1e-4 for b in sight.batches)
    final = sight.snapshots[-1]
    assert (final.ended, final.report.samples, final.link.frames) == (True, 200, 201)
    assert 3.0 < len(sight.snapshots) / (final.elapsed_s + READ_S) <= 6.0
    assert final.device.state == "ACTIVE"
    assert result.overlay is not None
    assert len(result.overlay.time_s) == 200


def test_a_lost_port_is_waited_for_and_nothing_counts_as_lost() -> None:
    device = Device(D)
    frames = device.frames(300)
    steps = acts(frames[:101])
    steps += [Act(state="lost")] * 100
    steps += [Act(b"".join(frames[201:211]), anew=True), *acts(frames[211:])]
    result, sight, _, _ = run(steps)
    assert (result.report.verdict, result.report.samples, result.report.lost) == ("pass", 200, 0)
    assert result.reconnects == 1
    texts = sight.texts()
    assert "port lost" in texts
    assert "port is back after 12.5 s" in texts
    epochs = [s.epoch for s in sight.snapshots]
    assert (epochs[0], epochs[-1]) == (0, 1)
    begun = next(k for k, x in enumerate(sight.order) if isinstance(x, Snapshot) and x.epoch == 1)
    first = next(x for x in sight.order[begun:] if isinstance(x, Batch))
    assert first.time_s[0] > 12.0
    assert first.begins[0]


def test_a_silent_device_is_waited_for_once_it_was_heard() -> None:
    frames = Device(D).frames(200)
    steps = [*acts(frames[:101]), *[Act()] * 80, *acts(frames[101:])]
    result, sight, _, _ = run(steps)
    assert result.report.samples == 200
    assert "the device stopped sending after 100 samples" in sight.texts()
    assert any(text.startswith("samples come again after 1") for text in sight.texts())


def test_without_patience_silence_is_an_error() -> None:
    with pytest.raises(DeviceError, match="stopped sending after 100"):
        run([*acts(Device(D).frames(100)), *[Act()] * 80], options=SessionOptions())
    with pytest.raises(DeviceError, match="nothing was received"):
        run([Act()] * 80)


def test_a_reset_of_the_device_is_an_epoch_and_a_notice() -> None:
    frames = Device(D).frames(150) + Device(D, seed=2).frames(150)
    result, sight, _, _ = run(acts(frames))
    assert (result.report.samples, result.report.lost, result.report.verdict) == (300, 0, "pass")
    assert "the device has started anew" in sight.texts()
    assert sight.snapshots[-1].epoch == 1
    time_s = np.concatenate([batch.time_s for batch in sight.batches])
    assert (np.diff(time_s) > 0.0).all()


def other_device(system: int) -> Device:
    device = Device(D, seed=5)
    device.mav.srcSystem = system
    return device


def mixed() -> list[Act]:
    ours, theirs = Device(D).frames(100), other_device(7).frames(100)
    return acts([frame for pair in zip(ours, theirs, strict=True) for frame in pair])


def test_the_first_of_two_devices_is_ours() -> None:
    result, sight, _, _ = run(mixed())
    assert (result.report.samples, result.report.verdict) == (100, "pass")
    assert [t for t in sight.texts() if "system 7" in t and "--system 7" in t]
    assert sight.snapshots[-1].device.system == 1


def test_another_one_can_be_chosen() -> None:
    result, sight, _, _ = run(mixed(), options=replace(OPTIONS, system=7))
    assert (result.report.samples, result.report.verdict) == (100, "pass")
    assert sight.snapshots[-1].device.system == 7


def test_a_page_stays_after_a_refusal_and_a_new_epoch_is_judged_again() -> None:
    other = acts(Device(design(eta=0.99)).frames(50))
    good = acts(Device(D).frames(50))
    good[0].anew = True
    seen = []
    steps = [*other]
    session_options = replace(OPTIONS, stays=True)
    result, sight, _, _ = run([*steps, *good], options=session_options)
    seen = [s.report.verdict for s in sight.snapshots]
    assert "refused" in seen
    assert (result.report.verdict, result.report.samples) == ("pass", 50)
    assert any("runs design" in text for text in sight.texts())


def test_the_session_says_who_it_is_and_asks_unless_it_is_passive() -> None:
    _, _, port, _ = run(acts(Device(D).frames(300)))
    names = [frame.name for frame in Decoder().feed(port.sent)]
    assert {"HEARTBEAT", "TIMESYNC", "PARAM_REQUEST_LIST", "COMMAND_LONG"} <= set(names)
    assert 3 <= names.count("HEARTBEAT") <= 6
    _, _, port, _ = run(acts(Device(D).frames(300)), options=replace(OPTIONS, passive=True))
    assert port.sent == b""


def told(device: Device, name: str, value: float) -> bytes:
    message = device.module.MAVLink_param_value_message(name.encode(), value, 9, 7, 2)
    return device._pack(message)


def test_parameters_are_shown_checked_and_set() -> None:
    device = Device(D)
    frames = device.frames(100)
    frames.append(told(device, "FILT_TAU", 2.5))
    frames += device.frames(10)
    controls = {}
    errors = []

    def ask() -> None:
        session = controls["session"]
        for name, value in (("NO_SUCH", 1.0), ("FILT_TAU", float("nan")), ("FILT_TAU", -1.0)):
            with pytest.raises(HostkitError) as error:
                session.controls.set_parameter(name, value)
            errors.append(str(error.value))
        session.controls.set_parameter("FILT_TAU", 1.5)
        with pytest.raises(HostkitError, match="no command"):
            session.controls.command("explode")
        with pytest.raises(HostkitError, match="replay"):
            session.controls.seek(1.0)

    steps = [*acts(frames), Act(), Act(), Act(do=ask), Act(), Act()]
    clock = FakeClock()
    port = FakePort(clock, steps)
    sight = Sight()
    session = Session(
        design=D,
        transport=port,
        thresholds=Thresholds(),
        clock=clock,
        options=OPTIONS,
        views=[sight],
    )
    controls["session"] = session
    steps.append(Act(do=session.stop))
    session.run()
    assert "FILT_TAU" in errors[0]
    assert "finite" in errors[1]
    shown = next(p for p in sight.snapshots[-1].parameters if p.name == "FILT_TAU")
    assert (shown.value, shown.wanted, shown.unit) == (2.5, 1.5, "s")
    eta = D.parameter("eta")
    assert shown.design_value == pytest.approx(eta / (1.0 - eta) / 100.0, rel=1e-4)
    sets = [f.message for f in Decoder().feed(port.sent) if f.name == "PARAM_SET"]
    assert [(m.param_id, m.param_value) for m in sets][:1] == [("FILT_TAU", 1.5)]


def test_requests_from_other_threads_are_carried_out() -> None:
    frames = Device(D).frames(200)
    ready, done = threading.Event(), threading.Event()
    box = {}

    def other_thread() -> None:
        ready.wait(LIMIT_S)
        box["session"].controls.restart_verdict()
        done.set()

    def meet() -> None:
        ready.set()
        assert done.wait(LIMIT_S)

    steps = acts(frames)
    steps[10].do = meet
    clock = FakeClock()
    session = Session(
        design=D,
        transport=FakePort(clock, steps),
        thresholds=Thresholds(),
        clock=clock,
        options=OPTIONS,
    )
    box["session"] = session
    steps.append(Act(do=session.stop))
    thread = threading.Thread(target=other_thread)
    thread.start()
    result = session.run()
    thread.join()
    assert result.report.samples == 200 - 109
    assert result.report.verdict == "pass"
    assert [session.ask_result() for _ in range(200)] == [result] * 200


def test_a_recording_on_request_holds_what_came_meanwhile(tmp_path: Path) -> None:
    frames = Device(D).frames(300)
    box = {}
    steps = acts(frames)
    steps[4].do = lambda: box["session"].controls.start_recording("a.tlog")
    steps[20].do = lambda: box["session"].controls.stop_recording()
    clock = FakeClock()
    sight = Sight()
    session = Session(
        design=D,
        transport=FakePort(clock, steps),
        thresholds=Thresholds(),
        clock=clock,
        options=replace(OPTIONS, folder=tmp_path),
        views=[sight],
    )
    box["session"] = session
    steps.append(Act(do=session.stop))
    session.run()
    assert list(read_tlog(tmp_path / "a.tlog")) == frames[50:210]
    state = sight.snapshots[-1].recording
    assert state is not None
    assert (state.name, state.active, state.frames, state.error) == ("a.tlog", False, 160, "")


def test_the_port_can_be_released_and_taken() -> None:
    box = {}
    steps = acts(Device(D).frames(100))
    steps[3].do = lambda: box["session"].controls.release_port()
    steps[5].do = lambda: box["session"].controls.take_port()
    clock = FakeClock()
    port = FakePort(clock, steps)
    session = Session(
        design=D, transport=port, thresholds=Thresholds(), clock=clock, options=OPTIONS
    )
    states = []
    port.release = lambda: states.append("released")
    port.take = lambda: states.append("taken")
    box["session"] = session
    steps.append(Act(do=session.stop))
    session.run()
    assert states == ["released", "taken"]


def recorded(path: Path, frames: list[bytes]) -> Path:
    stamped = (STAMP.pack(10**15 + k * 10_000) + frame for k, frame in enumerate(frames))
    path.write_bytes(b"".join(stamped))
    return path


def test_a_replay_runs_through_the_same_path_and_can_be_moved(tmp_path: Path) -> None:
    clock = FakeClock()
    path = recorded(tmp_path / "a.tlog", Device(D).frames(500))
    replay = ReplayTransport(path, 1.0, clock)
    sight = Sight()
    session = Session(
        design=D,
        transport=replay,
        thresholds=Thresholds(),
        clock=clock,
        options=replace(OPTIONS, stays=True),
        views=[sight],
    )
    moves = iter((1.0, None))

    class Mover(Sight):
        def take_snapshot(self, snapshot: Snapshot) -> None:
            if snapshot.replay is None or not snapshot.replay.ended or snapshot.ended:
                return
            to_s = next(moves)
            session.stop() if to_s is None else session.controls.seek(to_s)

    session.views.append(Mover())
    with pytest.raises(HostkitError, match="no device"):
        session.controls.command("reboot")
    result = session.run()
    assert result.report.verdict == "pass"
    assert result.report.samples == 500 + 401
    assert sight.snapshots[-1].epoch == 1
    after = [b for b in sight.batches if b.time_s[0] >= 0.99][-1]
    assert after.time_s[-1] == pytest.approx(5.0, abs=0.05)
    assert clock.now == pytest.approx(9.0, abs=1.5)


def test_parameters_told_before_a_place_hold_after_a_seek(tmp_path: Path) -> None:
    """A device that was retuned early in a recording is followed from the middle, too."""
    path = recorded(tmp_path / "a.tlog", retuned_frames())
    whole = Session(design=D, transport=ReplayTransport(path), thresholds=Thresholds()).run()
    assert (whole.report.verdict, whole.report.unjudged) == ("pass", 0)
    replay = ReplayTransport(path)
    replay.seek(2.0)
    part = Session(design=D, transport=replay, thresholds=Thresholds()).run()
    assert (part.report.verdict, part.report.unjudged) == ("pass", 0)
    assert 0 < part.report.samples < whole.report.samples


def retuned_frames() -> list[bytes]:
    tuned = Device(design(eta=0.99))
    tuned.digest = Device(D).digest
    eta = 0.99
    names = ("GYRO_BIAS_ROLL", "TILT_OFS_ROLL", "GYRO_BIAS_PITCH", "TILT_OFS_PITCH")
    frames = tuned.frames(400, flags=tuned.module.HOSTKIT_SAMPLE_RETUNED)
    head = frames[:1]
    head.append(told(tuned, "FILT_TAU", eta / (1 - eta) / 100.0))
    head += [told(tuned, name, 0.0) for name in names]
    return [*head, *frames[1:]]


def test_hostile_frames_neither_crash_nor_fill_it() -> None:
    rng = np.random.default_rng(3)
    device = Device(D)
    m = device.module
    frames = device.frames(50)
    for k in range(300):
        device.mav.srcSystem = int(rng.integers(1, 250))
        number = float(rng.choice([np.nan, np.inf, -np.inf, 3e38]))
        messages = [
            m.MAVLink_param_value_message(b"X%d" % k, number, 9, 65535, k),
            m.MAVLink_statustext_message(0, b"\x1b[2J\x07\xff bad" + bytes([k % 256])),
            m.MAVLink_command_ack_message(65535, 200),
            m.MAVLink_timesync_message(-(2**63), 2**63 - 1),
            m.MAVLink_sys_status_message(2**32 - 1, 0, 0, 65535, *[0] * 9),
        ]
        frames += [device._pack(message) for message in messages]
    frames += [rng.bytes(3000)]
    result, sight, _, _ = run(acts(frames, per_read=50))
    assert result.report.samples == 50
    final = sight.snapshots[-1]
    assert all(text.isprintable() for text in (*final.device.texts, *sight.texts()))
    assert len(final.notices) <= 50


def test_what_was_recorded_is_judged_the_same(tmp_path: Path) -> None:
    recorder = TlogWriter(tmp_path / "a.tlog")
    first, _, _, _ = run(acts(Device(D).frames(200)), recorders=(recorder,))
    replay = ReplayTransport(tmp_path / "a.tlog")
    again = Session(design=D, transport=replay, thresholds=Thresholds()).run()
    assert again.report.samples == first.report.samples
    assert (again.report.verdict, again.report.checked) == ("pass", first.report.checked)
