import dataclasses
import json
import math
from pathlib import Path

import pytest
from designs import design

from hostkit.dialect import payload_bytes
from hostkit.errors import RenderError
from hostkit.render import FirmwareOptions, MessageRate, generate, read_manifest, write
from hostkit.render.link_plan import link_plan
from hostkit.render.options import STREAMED_MESSAGES
from hostkit.targets import TARGETS

AVR = TARGETS["atmega328p"]


def rates(**hz: float) -> FirmwareOptions:
    chosen = tuple(MessageRate(name=name, rate_hz=rate) for name, rate in hz.items())
    return FirmwareOptions(message_rates=chosen)


def header(options: FirmwareOptions, target: str = "atmega328p") -> str:
    files = generate(design(), TARGETS[target], options)
    return next(file.content for file in files if file.path == "hk_design.h")


def test_defaults_send_every_sample_and_half_of_the_attitudes() -> None:
    plan = link_plan(100.0, AVR)
    assert {m.name: m.interval_us for m in plan.messages} == {
        "TILT_SAMPLE": 10_000,
        "ATTITUDE": 20_000,
        "SCALED_IMU": 0,
        "RAW_IMU": 0,
        "HIGHRES_IMU": 0,
        "SYS_STATUS": 1_000_000,
        "HEARTBEAT": 1_000_000,
    }
    assert [m.name for m in plan.messages] == [n for n in STREAMED_MESSAGES if n != "TILT_STATE"]


@pytest.mark.parametrize("words", [3, 17, 24])
def test_a_long_state_goes_out_once_a_second_behind_a_sample(words: int) -> None:
    plan = link_plan(100.0, AVR, hidden_words=words)
    sample, state, *_ = plan.messages
    assert tuple(m.name for m in plan.messages) == STREAMED_MESSAGES
    assert (state.every, state.interval_us) == (100, 1_000_000)
    assert sample.frame_bytes == 43 + 12
    assert state.frame_bytes == 4 + 4 * words + 12
    assert plan.state_words == words
    assert plan.bytes_per_s == link_plan(100.0, AVR).bytes_per_s + state.frame_bytes


@pytest.mark.parametrize(("words", "told"), [(0, 0), (2, 0), (3, 3)])
def test_a_state_that_a_sample_has_room_for_has_no_message(words: int, told: int) -> None:
    plan = link_plan(100.0, AVR, hidden_words=words)
    assert plan.state_words == told
    assert ("TILT_STATE" in [m.name for m in plan.messages]) == bool(told)
    assert plan.every("TILT_STATE") == (100 if told else 0)


@pytest.mark.parametrize(
    ("sample_hz", "state_hz", "every"),
    [(25.0, None, 100), (100.0 / 7, None, 98), (25.0, 100.0, 4), (0.0, None, 0), (100.0, 0.0, 0)],
)
def test_a_state_keeps_to_the_samples_that_go_out(
    sample_hz: float, state_hz: float | None, every: int
) -> None:
    chosen = {"TILT_SAMPLE": sample_hz} | ({} if state_hz is None else {"TILT_STATE": state_hz})
    plan = link_plan(100.0, AVR, rates(**chosen), hidden_words=17)
    assert plan.every("TILT_STATE") == every


def test_a_state_without_samples_is_refused_and_so_is_one_that_there_is_not() -> None:
    with pytest.raises(RenderError, match="TILT_STATE = 1 Hz, but TILT_SAMPLE is off"):
        link_plan(100.0, AVR, rates(TILT_SAMPLE=0.0, TILT_STATE=1.0), hidden_words=17)
    with pytest.raises(RenderError, match="has no TILT_STATE: each TILT_SAMPLE tells"):
        link_plan(100.0, AVR, rates(TILT_STATE=1.0), hidden_words=2)


def test_the_link_must_carry_the_states_too() -> None:
    slow = rates(TILT_SAMPLE=25.0, ATTITUDE=0.0, TILT_STATE=25.0)
    options = dataclasses.replace(slow, baud=31_250)
    assert link_plan(100.0, AVR, dataclasses.replace(options, baud=62_500), hidden_words=17)
    with pytest.raises(RenderError, match=r"TILT_STATE 2100,"):
        link_plan(100.0, AVR, options, hidden_words=17)


def test_every_message_costs_its_frame_and_signing_13_bytes_more() -> None:
    plain, signed = link_plan(100.0, AVR), link_plan(100.0, AVR, FirmwareOptions(signing=True))
    for a, b in zip(plain.messages, signed.messages, strict=True):
        assert b.frame_bytes == a.frame_bytes + 13
        if a.name != "TILT_SAMPLE":
            assert a.frame_bytes == payload_bytes(a.name) + 12
    assert signed.bytes_per_s == plain.bytes_per_s + 13 * (100 + 50 + 1 + 1)


@pytest.mark.parametrize(
    ("name", "hz", "every"),
    [("TILT_SAMPLE", 25.0, 4), ("TILT_SAMPLE", 33.333, 3), ("RAW_IMU", 30.0, 4), ("RAW_IMU", 0, 0)],
)
def test_a_message_goes_out_with_every_so_many_th_sample(name: str, hz: float, every: int) -> None:
    plan = link_plan(100.0, AVR, rates(**{name: hz}))
    assert plan.every(name) == every
    message = next(m for m in plan.messages if m.name == name)
    assert message.interval_us == every * 10_000


def test_the_plan_stands_in_the_header() -> None:
    text = header(dataclasses.replace(rates(RAW_IMU=10.0, ATTITUDE=0.0), baud=250_000))
    assert "X(TILT_SAMPLE, UINT32_C(10000), 55U) \\\n" in text
    assert "X(ATTITUDE, UINT32_C(0), 40U) \\\n" in text
    assert "X(RAW_IMU, UINT32_C(100000), 41U) \\\n" in text
    assert "X(HEARTBEAT, UINT32_C(1000000), 21U)\n" in text
    assert "#define HK_LINK_BAUD           250000\n" in text
    assert "#define HK_LINK_USABLE_BYTES_S 20000\n" in text
    assert f"{100 * 55 + 10 * 41 + 55 + 21} bytes/s" in text


@pytest.mark.parametrize(
    ("profile", "component", "kind", "autopilot"), [("gcs", 1, 0, 0), ("component", 200, 40, 8)]
)
def test_the_profile_says_who_the_device_is(profile, component, kind, autopilot) -> None:
    text = header(FirmwareOptions(profile=profile, system_id=42))
    assert "#define HK_DEFAULT_SYSTEM_ID 42U" in text
    assert f"#define HK_COMPONENT_ID      {component}U" in text
    assert f"#define HK_VEHICLE_TYPE      {kind}U" in text
    assert f"#define HK_AUTOPILOT         {autopilot}U" in text


@pytest.mark.parametrize(
    ("options", "macro"),
    [
        ({"arithmetic": "float"}, "HK_FLOAT"),
        ({"acquisition": "fifo"}, "HK_FIFO"),
        ({"calibrate_at_start": True}, "HK_CALIBRATE_AT_START"),
        ({"signing": True}, "HK_SIGNING"),
    ],
)
def test_a_choice_is_a_macro_that_is_0_or_1(options, macro: str) -> None:
    lines = [" ".join(line.split()) for line in header(FirmwareOptions(**options)).splitlines()]
    default = [" ".join(line.split()) for line in header(FirmwareOptions()).splitlines()]
    assert any(line.startswith(f"#define {macro} 1 ") for line in lines)
    assert any(line.startswith(f"#define {macro} 0 ") for line in default)


BAD = [
    (lambda: FirmwareOptions(system_id=255), r"255 is the ground station's.* 1 to 254"),
    (lambda: FirmwareOptions(system_id=250), r"250 is a companion's"),
    (lambda: FirmwareOptions(system_id=0), r"system_id = 0; it must be 1 to 254"),
    (lambda: FirmwareOptions(baud=300), r"baud = 300; it must be 1200 to 4000000"),
    (lambda: FirmwareOptions(profile="uav"), r"'uav'; it must be one of: gcs, component"),
    (lambda: FirmwareOptions(arithmetic="double"), r"'double'; it must be one of: fixed, float"),
    (lambda: FirmwareOptions(acquisition="dma"), r"'dma'; it must be one of: burst, fifo"),
    (lambda: rates(GPS=1.0), r"'GPS' is no streamed message; there are: TILT_SAMPLE"),
    (lambda: rates(ATTITUDE=-1.0), r"ATTITUDE = -1.0 Hz; it must be 0"),
    (lambda: rates(ATTITUDE=float("nan")), r"ATTITUDE = nan Hz"),
    (lambda: rates(SYS_STATUS=50.0), r"SYS_STATUS = 50 Hz; the limit is 10"),
    (lambda: rates(HEARTBEAT=0.0), r"HEARTBEAT = 0 Hz; it must be 0.5 to 10 Hz"),
    (
        lambda: FirmwareOptions(message_rates=(MessageRate(name="RAW_IMU", rate_hz=1.0),) * 2),
        r"RAW_IMU is given 2 times",
    ),
]


@pytest.mark.parametrize(("make", "says"), BAD, ids=[says for _, says in BAD])
def test_what_no_firmware_can_be_is_refused(make, says: str) -> None:
    with pytest.raises(RenderError, match=says):
        make()


def test_samples_at_a_rate_that_is_no_divisor_are_refused_with_the_nearest() -> None:
    with pytest.raises(RenderError, match=r"no integer divisor of 100 Hz.* 25 and 33\.3333 Hz"):
        link_plan(100.0, AVR, rates(TILT_SAMPLE=30.0))
    with pytest.raises(RenderError, match=r"ATTITUDE = 200 Hz, but there are 100 samples"):
        link_plan(100.0, AVR, rates(ATTITUDE=200.0))


@pytest.mark.parametrize(
    ("target", "baud", "says"),
    [
        ("atmega328p", 230400, r"makes 222222 of 230400 baud, -3\.5 %.* 250000, 500000"),
        ("atmega328p", 921600, r"makes 1000000 of 921600 baud, \+8\.5 %.* 1000000"),
        ("stm32f103", 4_000_000, None),
        ("rp2040", 921600, None),
        ("atmega328p", 115200, None),
        ("host", 123456, None),
        ("linux", 460800, None),
        ("linux", 250000, r"makes 230400 of 250000 baud.* 230400, 460800"),
    ],
)
def test_baud_that_the_target_cannot_make_is_refused(target: str, baud: int, says) -> None:
    options = FirmwareOptions(baud=baud)
    if says is None:
        assert link_plan(50.0, TARGETS[target], options).baud == baud
        return
    with pytest.raises(RenderError, match=says):
        link_plan(50.0, TARGETS[target], options)


def test_what_is_said_to_fit_does_fit_and_the_next_more_does_not() -> None:
    with pytest.raises(RenderError) as refused:
        link_plan(1000.0, AVR)
    assert "--message TILT_SAMPLE=500, or --baud 1000000" in str(refused.value)
    assert link_plan(1000.0, AVR, rates(TILT_SAMPLE=500.0)).bytes_per_s <= 40_000
    assert link_plan(1000.0, AVR, FirmwareOptions(baud=1_000_000)).bytes_per_s <= 80_000


@pytest.mark.parametrize("spare", [0, 1])
def test_the_budget_is_80_percent_and_not_a_byte_more(spare: int) -> None:
    needed = link_plan(100.0, TARGETS["host"]).bytes_per_s
    baud = 10 * math.ceil((needed - spare) * 100 / 80)
    assert baud // 10 * 80 // 100 == needed - spare
    if spare == 0:
        assert link_plan(100.0, TARGETS["host"], FirmwareOptions(baud=baud)).baud == baud
        return
    with pytest.raises(RenderError, match=f"needs {needed} bytes/s"):
        link_plan(100.0, TARGETS["host"], FirmwareOptions(baud=baud))


def test_the_manifest_keeps_the_options(tmp_path: Path) -> None:
    options = FirmwareOptions(
        profile="component",
        system_id=9,
        baud=250_000,
        message_rates=(MessageRate(name="RAW_IMU", rate_hz=50.0),),
        arithmetic="float",
        acquisition="fifo",
        calibrate_at_start=True,
        signing=True,
    )
    write(generate(design(), AVR, options), tmp_path)
    assert read_manifest(tmp_path).options == options


def test_a_manifest_without_options_has_the_defaults(tmp_path: Path) -> None:
    write(generate(design(), AVR), tmp_path)
    path = tmp_path / "manifest.json"
    document = json.loads(path.read_text())
    del document["options"]
    path.write_text(json.dumps(document))
    assert read_manifest(tmp_path).options == FirmwareOptions()


def test_a_core_has_no_options_of_a_firmware() -> None:
    with pytest.raises(RenderError, match="runs no firmware"):
        generate(design(), TARGETS["spartan3adsp"], FirmwareOptions(signing=True))
