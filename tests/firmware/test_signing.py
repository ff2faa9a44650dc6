"""Signed messages: pymavlink as the ground station, the firmware as the device."""

import ctypes
import hashlib
import itertools
import random
import subprocess
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import pytest
from boards import TARGET_TOOLS, Heard, hear, require_or_skip, stimulus
from designs import design
from ground import ACCEPTED, GROUND, REAL32, Ground, M, acks, resting, values
from pymavlink.generator.mavcrc import x25crc

from hostkit.emulation import avr_board, host_board
from hostkit.emulation.board import BoardRun, LinkInput
from hostkit.render import generate, write
from hostkit.render.options import FirmwareOptions
from hostkit.targets import TARGETS

SECRET = bytes(range(7, 39))
OTHER = bytes(range(100, 132))
NONE = bytes(32)
TODAY = 37_500_000_000_000
"""Units of 10 us since 2015-01-01: some time in 2026."""
MINUTE = 6_000_000
DAY = 1440 * MINUTE
SIGNED = 0x01
SIGNATURE_BYTES = 13
STORE, RESET = 245, 2
TUNED = 1.5


def with_signing(target: str, folder: Path) -> Path:
    write(generate(design(), TARGETS[target], FirmwareOptions(signing=True)), folder)
    return folder


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The host firmware with signing, built with sanitizers."""
    require_or_skip(*TARGET_TOOLS["host"])
    code = with_signing("host", tmp_path_factory.mktemp("signing"))
    host_board.build(code, sanitize=True)
    return code


class Signer(Ground):
    """A ground station that signs, if it has a secret."""

    def __init__(
        self, secret: bytes | None = None, timestamp: int = TODAY + MINUTE, link: int = 0
    ) -> None:
        super().__init__()
        self.use(secret, timestamp, link)

    def use(self, secret: bytes | None, timestamp: int, link: int = 0) -> None:
        signing = self._mav.signing
        signing.secret_key, signing.sign_outgoing = secret, secret is not None
        signing.timestamp, signing.link_id = timestamp, link

    def setup(
        self, time_s: float, secret: bytes, timestamp: int = TODAY, to: tuple[int, int] = (1, 1)
    ) -> None:
        self.send(time_s, M.MAVLink_setup_signing_message(*to, list(secret), timestamp))

    def set_frame(self, value: float = TUNED) -> bytes:
        return self.frame(M.MAVLink_param_set_message(1, 1, b"FILT_TAU", value, REAL32))


@pytest.fixture(scope="module")
def locked(folder: Path) -> bytes:
    """What the memory holds when the secret has been set."""
    ground = Signer()
    ground.setup(0.5, SECRET)
    return ground.board_run(folder, stimulus(200)).store


def signed_of(heard: Heard) -> list[bool]:
    return [bool(frame.raw[2] & SIGNED) for frame in heard.frames]


def timestamps(heard: Heard) -> list[int]:
    return [
        int.from_bytes(frame.raw[-12:-6], "little") for frame in heard.frames if frame.raw[2] & 1
    ]


def verified(run: BoardRun, secret: bytes) -> SimpleNamespace:
    """Let pymavlink check every signature of what a board has sent."""
    parser = M.MAVLink(None)
    parser.robust_parsing = True
    parser.signing.secret_key = secret
    messages = parser.parse_buffer(run.stream)
    return SimpleNamespace(
        good=parser.signing.goodsig_count,
        bad=parser.signing.badsig_count,
        refused=sum(m.get_type() == "BAD_DATA" for m in messages),
    )


def is_signed(raw: bytes, secret: bytes) -> bool:
    """Tell whether a signature is right, however old it is."""
    return hashlib.sha256(secret + raw[:-6]).digest()[:6] == raw[-6:]


def taken(heard: Heard) -> bool:
    """Whether the device uses the value that was to be set."""
    return ("FILT_TAU", pytest.approx(TUNED, rel=1e-3)) in values(heard)


def refused(heard: Heard) -> int:
    return heard.of("SYS_STATUS")[-1].errors_comm


# --- The hash ---------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def sha(folder: Path, tmp_path_factory: pytest.TempPathFactory) -> ctypes.CDLL:
    library = tmp_path_factory.mktemp("sha") / "sha.so"
    command = ["gcc", "-std=c99", "-O1", "-shared", "-fPIC", "-Wall", "-Werror"]
    command += ["-fsanitize=undefined", "-fno-sanitize-recover=all", "-o", str(library)]
    subprocess.run([*command, str(folder / "hk_sha256.c")], check=True, timeout=60)
    return ctypes.CDLL(str(library))


def hashed(sha: ctypes.CDLL, *pieces: bytes) -> bytes:
    state, found = ctypes.create_string_buffer(256), ctypes.create_string_buffer(32)
    sha.hk_sha256_init(state)
    for piece in pieces:
        sha.hk_sha256_add(state, piece, ctypes.c_uint16(len(piece)))
    sha.hk_sha256_end(state, found)
    return found.raw


def test_the_hash_is_sha_256_at_every_length_around_its_blocks(sha: ctypes.CDLL) -> None:
    rng = random.Random(1)
    for length in [*range(200), *(rng.randrange(60_000) for _ in range(30))]:
        data = rng.randbytes(length)
        assert hashed(sha, data) == hashlib.sha256(data).digest(), length


def test_the_hash_does_not_depend_on_the_pieces(sha: ctypes.CDLL) -> None:
    rng = random.Random(2)
    for _ in range(200):
        pieces = [rng.randbytes(rng.randrange(100)) for _ in range(rng.randrange(8))]
        assert hashed(sha, *pieces) == hashlib.sha256(b"".join(pieces)).digest()


# --- What leaves ------------------------------------------------------------------------------


def test_without_a_secret_the_link_is_open(folder: Path) -> None:
    ground = Signer()
    ground.set(0.5, "FILT_TAU", TUNED)
    run = ground.board_run(folder, stimulus(200))
    heard = hear(run)
    assert not any(signed_of(heard))
    assert taken(heard)
    assert heard.decoder.bad == heard.decoder.lost_frames == 0
    assert run.store == b"\xff" * 256, "nothing is written for a secret that is not there"


def test_a_signed_message_is_taken_by_a_device_without_a_secret(folder: Path) -> None:
    ground = Signer(SECRET)
    ground.set(0.5, "FILT_TAU", TUNED)
    assert taken(ground.run(folder, stimulus(200)))


def test_from_the_secret_on_every_message_is_signed(folder: Path) -> None:
    ground = Signer()
    ground.setup(1.0, SECRET)
    run = ground.board_run(folder, stimulus(300))
    heard = hear(run)
    signed = signed_of(heard)
    first = signed.index(True)
    assert 0 < first < len(signed) - 200
    assert all(signed[first:])
    checked = verified(run, SECRET)
    assert (checked.good, checked.bad) == (len(signed) - first, 0)
    assert checked.refused == first, "pymavlink refuses what is not signed"
    assert [s.sequence for s in heard.samples] == list(range(300))
    assert heard.decoder.bad == heard.decoder.lost_frames == 0
    stamps = timestamps(heard)
    assert stamps[0] >= TODAY
    assert all(b > a for a, b in itertools.pairwise(stamps))
    samples = [f for f in heard.frames if f.name == "TILT_SAMPLE" and f.raw[2] & SIGNED]
    stamped = timestamps(Heard(frames=[samples[0], samples[-1]], decoder=heard.decoder))
    passed_us = samples[-1].message.time_usec - samples[0].message.time_usec
    assert 10 * (stamped[1] - stamped[0]) == pytest.approx(passed_us, abs=2_000)


def test_another_secret_verifies_nothing(folder: Path, locked: bytes) -> None:
    run = Signer().board_run(folder, stimulus(100), store=locked)
    assert verified(run, OTHER).good == 0
    assert verified(run, SECRET).good == len(hear(run).frames) > 100


def test_the_secret_survives_a_restart_and_time_does_not_go_back(
    folder: Path, locked: bytes
) -> None:
    last = TODAY
    store = locked
    for _ in range(3):
        run = Signer().board_run(folder, stimulus(200), store=store)
        heard = hear(run)
        checked = verified(run, SECRET)
        assert (checked.good, checked.bad) == (len(heard.frames), 0)
        stamps = timestamps(heard)
        assert stamps[0] > last
        assert stamps[-1] < last + DAY
        last, before, store = stamps[-1], store, run.store
        assert store != before, "a start goes on from a time that is stored anew"


# --- What comes -------------------------------------------------------------------------------


def test_what_is_signed_right_is_taken(folder: Path, locked: bytes) -> None:
    ground = Signer(SECRET, TODAY + DAY)
    ground.set(0.5, "FILT_TAU", TUNED)
    ground.command(0.7, 512, 148)
    ground.read(0.8, "SYS_ID")
    heard = ground.run(folder, stimulus(300), store=locked)
    assert taken(heard)
    assert acks(heard) == [(512, ACCEPTED)]
    assert ("SYS_ID", 1.0) in values(heard)
    assert refused(heard) == 0
    assert timestamps(heard)[-1] > TODAY + DAY, "it follows the ground station's clock"


@pytest.mark.parametrize(
    ("secret", "timestamp"),
    [(None, TODAY + DAY), (OTHER, TODAY + DAY), (SECRET, TODAY), (SECRET, 0)],
    ids=["unsigned", "wrong-secret", "old", "zero"],
)
def test_what_is_not_signed_right_is_refused(
    folder: Path, locked: bytes, secret: bytes | None, timestamp: int
) -> None:
    ground = Signer(secret, timestamp)
    ground.set(0.5, "FILT_TAU", TUNED)
    ground.command(0.6, 246, 1)
    ground.read(0.7, "SYS_ID")
    ground.list(0.8)
    ground.send(0.9, M.MAVLink_ping_message(1, 2, 0, 0))
    ground.setup(1.0, OTHER, TODAY + 2 * DAY)
    run = ground.board_run(folder, stimulus(400), store=locked)
    heard = hear(run)
    for answer in ("PARAM_VALUE", "COMMAND_ACK", "PING"):
        assert heard.of(answer) == []
    assert refused(heard) == 6
    assert "resets" not in dict(run.faults)
    assert verified(run, SECRET).good == len(heard.frames)
    assert not any(s.flags & 4 for s in heard.samples)


def test_a_replay_is_refused(folder: Path, locked: bytes) -> None:
    ground = Signer(SECRET, TODAY + DAY)
    frame = ground.set_frame()
    for time_s in (0.5, 0.7, 0.9):
        ground.raw(time_s, frame)
    heard = ground.run(folder, stimulus(300), store=locked)
    assert len(values(heard)) == 1
    assert refused(heard) == 2


def test_a_replay_after_a_restart_is_refused(folder: Path, locked: bytes) -> None:
    ground = Signer(SECRET, TODAY + DAY)
    frame = ground.set_frame()
    ground.raw(0.5, frame)
    first = ground.board_run(folder, stimulus(300), store=locked)
    assert taken(hear(first))
    again = Signer()
    again.raw(0.5, frame)
    second = again.run(folder, stimulus(300), store=first.store)
    assert values(second) == []
    assert refused(second) == 1


def test_every_bit_of_a_signed_message_counts(folder: Path, locked: bytes) -> None:
    """One message, each time with one bit changed; at last as it is."""
    ground = Signer(SECRET, TODAY + DAY)
    frame = ground.set_frame()
    rng = random.Random(5)
    behind_header = 8 * 10
    bits = rng.sample(range(behind_header, 8 * len(frame)), 120)
    for i, bit in enumerate(bits):
        spoilt = bytearray(frame)
        spoilt[bit // 8] ^= 1 << (bit % 8)
        if bit < 8 * (len(frame) - SIGNATURE_BYTES - 2):
            end = len(frame) - SIGNATURE_BYTES - 2
            crc = x25crc(bytes(spoilt[1:end]) + bytes([168])).crc
            spoilt[end : end + 2] = crc.to_bytes(2, "little")
        ground.raw(0.5 + 0.01 * i, bytes(spoilt))
    ground.raw(2.5, frame)
    heard = ground.run(folder, stimulus(450), store=locked)
    assert values(heard) == [("FILT_TAU", pytest.approx(TUNED, rel=1e-3))]
    assert heard.of("PARAM_VALUE")[0].param_value
    assert len(bits) - 15 <= refused(heard) <= len(bits), "a spoilt checksum may hide a frame"


def test_every_sender_has_a_time_of_its_own(folder: Path, locked: bytes) -> None:
    ground = Signer(SECRET, TODAY + DAY)
    ground.send(0.5, M.MAVLink_ping_message(1, 1, 0, 0))
    ground.use(SECRET, TODAY + DAY - MINUTE // 2, link=1)  # half a minute behind
    ground.send(0.6, M.MAVLink_ping_message(1, 2, 0, 0))
    ground.use(SECRET, TODAY + DAY - 2 * MINUTE, link=2)
    ground.send(0.7, M.MAVLink_ping_message(1, 3, 0, 0))
    heard = ground.run(folder, stimulus(300), store=locked)
    assert [m.seq for m in heard.of("PING")] == [1, 2]


def test_four_senders_are_known(folder: Path, locked: bytes) -> None:
    ground = Signer()
    for link in range(6):
        ground.use(SECRET, TODAY + DAY, link)
        ground.send(0.5 + 0.1 * link, M.MAVLink_ping_message(1, link, 0, 0))
    heard = ground.run(folder, stimulus(300), store=locked)
    assert [m.seq for m in heard.of("PING")] == [0, 1, 2, 3]
    assert refused(heard) == 2


def test_a_signed_message_that_is_too_long_to_be_checked_is_refused(
    folder: Path, locked: bytes
) -> None:
    stamp = bytes([0]) + (TODAY + DAY).to_bytes(6, "little")
    payload = bytes(range(1, 201))
    body = bytes([len(payload), SIGNED, 0, 0, *GROUND, 23, 0, 0]) + payload
    whole = b"\xfd" + body + x25crc(body + bytes([168])).crc.to_bytes(2, "little") + stamp
    ground = Signer(SECRET, TODAY + DAY + 1)
    ground.raw(0.5, whole + hashlib.sha256(SECRET + whole).digest()[:6])
    ground.set(0.7, "FILT_TAU", TUNED)
    heard = ground.run(folder, stimulus(300), store=locked)
    assert refused(heard) == 1
    assert taken(heard)


def test_noise_that_looks_signed_breaks_nothing(folder: Path, locked: bytes) -> None:
    rng = random.Random(9)
    ground = Signer(SECRET, TODAY + DAY)
    for i in range(100):
        length = rng.randrange(256)
        ids = rng.choice((4, 20, 21, 23, 76, 111, 256)).to_bytes(3, "little")
        noise = bytes([0xFD, length, 1, 0, 0, 255, 190]) + ids + rng.randbytes(length + 15)
        ground.raw(0.3 + 0.01 * i, noise)
    ground.raw(1.6, bytes(300))
    ground.set(2.0, "FILT_TAU", TUNED)
    heard = ground.run(folder, stimulus(350), store=locked)
    assert [s.sequence for s in heard.samples] == list(range(350))
    assert taken(heard)


# --- The secret -------------------------------------------------------------------------------


def test_the_secret_is_changed_only_by_those_who_know_it(folder: Path, locked: bytes) -> None:
    ground = Signer(SECRET, TODAY + DAY)
    ground.setup(0.5, OTHER, TODAY + DAY)
    run = ground.board_run(folder, stimulus(300), store=locked)
    heard = hear(run)
    assert verified(run, SECRET).good + verified(run, OTHER).good == len(heard.frames)
    later = Signer(OTHER, TODAY + 2 * DAY)
    later.set(0.5, "FILT_TAU", TUNED)
    again = later.board_run(folder, stimulus(200), store=run.store)
    assert taken(hear(again))
    assert verified(again, OTHER).good == len(hear(again).frames)


def test_zeros_take_the_secret_away_for_good(folder: Path, locked: bytes) -> None:
    ground = Signer(SECRET, TODAY + DAY)
    ground.setup(0.5, NONE, 0)
    run = ground.board_run(folder, stimulus(300), store=locked)
    assert not signed_of(hear(run))[-1]
    later = Signer()
    later.set(0.5, "FILT_TAU", TUNED)
    again = later.run(folder, stimulus(200), store=run.store)
    assert taken(again)
    assert not any(signed_of(again))


def test_a_secret_for_another_is_passed_over(folder: Path) -> None:
    ground = Signer()
    ground.setup(0.5, SECRET, to=(7, 1))
    assert not any(signed_of(ground.run(folder, stimulus(150))))


def test_a_new_secret_does_not_take_time_back(folder: Path, locked: bytes) -> None:
    ground = Signer(SECRET, TODAY + DAY)
    ground.setup(0.5, OTHER, 5)
    stamps = timestamps(ground.run(folder, stimulus(200), store=locked))
    assert all(b > a for a, b in itertools.pairwise(stamps))


def test_the_way_back_to_the_design_leaves_the_secret(folder: Path, locked: bytes) -> None:
    ground = Signer(SECRET, TODAY + DAY)
    ground.set(0.5, "FILT_TAU", TUNED)
    ground.command(0.7, STORE, RESET)
    run = ground.board_run(folder, stimulus(600), store=locked)
    assert (STORE, ACCEPTED) in acks(hear(run))
    again = Signer().board_run(folder, stimulus(100), store=run.store)
    assert verified(again, SECRET).good == len(hear(again).frames)


def test_parameters_and_secret_share_a_record(folder: Path, locked: bytes) -> None:
    ground = Signer(SECRET, TODAY + DAY)
    ground.set(0.5, "FILT_TAU", TUNED)
    run = ground.board_run(folder, stimulus(600), store=locked)
    later = Signer(SECRET, TODAY + 2 * DAY)
    later.read(0.5, "FILT_TAU")
    again = later.board_run(folder, stimulus(200), store=run.store)
    assert taken(hear(again))
    assert verified(again, SECRET).good == len(hear(again).frames)


@pytest.mark.parametrize("after", [0, 1, 12, 40, 60, 79])
def test_a_power_cut_while_the_secret_is_stored_leaves_the_old_one(
    folder: Path, locked: bytes, after: int
) -> None:
    """A start with a secret writes a record too: there the secret is kept, and signs on."""
    ground = Signer()
    ground.setup(0.5, SECRET)
    run = ground.board_run(folder, resting(400), power_cut_after=after)
    assert dict(run.faults)["resets"] == 1
    assert not signed_of(hear(run))[-1]
    at_start = Signer().board_run(folder, resting(400), store=locked, power_cut_after=after)
    assert dict(at_start.faults)["resets"] == 1
    assert all(is_signed(frame.raw, SECRET) for frame in hear(at_start).frames)


def test_the_memory_of_a_firmware_without_signing_is_not_taken_for_a_secret(
    folder: Path, host_folder: Path
) -> None:
    ground = Ground()
    ground.set(0.5, "FILT_TAU", TUNED)
    store = ground.board_run(host_folder, resting(500)).store
    assert not any(signed_of(Signer().run(folder, stimulus(100), store=store)))


# --- On the board -----------------------------------------------------------------------------


@pytest.fixture(scope="module")
def signing_avr(tmp_path_factory: pytest.TempPathFactory) -> Path:
    require_or_skip(*TARGET_TOOLS["atmega328p"])
    return with_signing("atmega328p", tmp_path_factory.mktemp("avr-signing"))


def test_the_small_board_signs_every_message_and_loses_no_sample(
    signing_avr: Path, locked: bytes
) -> None:
    built = avr_board.build(signing_avr)
    assert built.flash_bytes is not None
    assert built.ram_bytes is not None
    assert built.flash_bytes <= 32768 - 512, "what the boot loader leaves"
    run = avr_board.run(signing_avr, replace(stimulus(150), store=locked))
    heard = hear(run)
    assert verified(run, SECRET).good == len(heard.frames)
    assert [s.sequence for s in heard.samples] == list(range(150))
    assert len(heard.of("ATTITUDE")) == 75
    assert run.stack_bytes is not None
    assert built.ram_bytes + run.stack_bytes < 2048


def test_a_message_that_is_checked_costs_the_small_board_a_sample_at_most(
    signing_avr: Path, locked: bytes
) -> None:
    avr_board.build(signing_avr)
    ground = Signer(SECRET, TODAY + DAY)
    sent = tuple(
        LinkInput(time_s=0.6 + 0.2 * i, data=ground.set_frame(TUNED + 0.1 * i)) for i in range(3)
    )
    run = avr_board.run(signing_avr, replace(stimulus(150), store=locked, received=sent))
    heard = hear(run)
    assert verified(run, SECRET).good == len(heard.frames)
    assert len(heard.samples) >= 150 - len(sent)
    assert [v for _, v in values(heard)] == [pytest.approx(v, rel=1e-2) for v in (1.5, 1.6, 1.7)]


def test_without_the_option_nothing_of_it_is_compiled(avr_folder: Path) -> None:
    for name in ("hk_sha256", "hk_signing"):
        listed = subprocess.run(
            ["avr-nm", str(avr_folder / "build" / f"{name}.o")],
            capture_output=True,
            text=True,
            check=True,
            timeout=20,
        ).stdout.split()
        assert [symbol for symbol in listed if "hk" in symbol or "take" in symbol] == []
