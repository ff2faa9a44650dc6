"""Signatures on the host: pymavlink as the peer, then the real firmware."""

import hashlib
import itertools
import random
from dataclasses import replace
from pathlib import Path

import pytest
from boards import TARGET_TOOLS, hear, require_or_skip, stimulus
from designs import design
from ground import Ground, M, acks, values
from pymavlink.generator.mavcrc import x25crc

from hostkit.emulation import host_board
from hostkit.emulation.board import BoardRun
from hostkit.errors import DeviceError
from hostkit.link.frames.decoder import Decoder
from hostkit.link.frames.signing import (
    MOST_STREAMS,
    SECRET_BYTES,
    SigningClock,
    SigningKey,
    setup_signing_message,
    sign_with,
    timestamp_of,
)
from hostkit.render import generate, write
from hostkit.render.options import FirmwareOptions
from hostkit.targets import TARGETS

NOW_S = 1_790_000_000.0
"""Some time in 2026."""
SECRET = bytes(range(7, 39))
TUNED = 1.5
FORGED_S = 3600.0


def key_at(time_s: float = NOW_S, secret: bytes = SECRET) -> SigningKey:
    return SigningKey(secret=secret, clock=SigningClock(lambda: time_s))


def peer_frames(key: SigningKey, count: int, source: tuple[int, int] = (1, 1)) -> list[bytes]:
    """Return frames that pymavlink signs on its own."""
    mav = M.MAVLink(None, *source)
    mav.signing.secret_key, mav.signing.sign_outgoing = key.secret, True
    mav.signing.timestamp = timestamp_of(NOW_S)
    return signed_by(mav, count)


def signed_by(mav: object, count: int) -> list[bytes]:
    frames = []
    for k in range(count):
        message = M.MAVLink_attitude_message(k, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6)
        frames.append(bytes(message.pack(mav)))
        mav.seq = (mav.seq + 1) % 256
    return frames


FRAMES = peer_frames(key_at(), 50)


def taken(key: SigningKey | None, *frames: bytes) -> tuple[int, int]:
    decoder = Decoder(key)
    return len(decoder.feed(b"".join(frames))), decoder.statistics().bad_signatures


# --- The key ----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("content", "secret"),
    [
        (SECRET, SECRET),
        (SECRET.hex().encode() + b"\n", SECRET),
        (SECRET.hex().upper().encode(), SECRET),
        (b"correct horse\n", hashlib.sha256(b"correct horse").digest()),
        (b"x" * 64, hashlib.sha256(b"x" * 64).digest()),
    ],
    ids=["raw", "hex", "HEX", "passphrase", "long passphrase"],
)
def test_a_key_is_read(tmp_path: Path, content: bytes, secret: bytes) -> None:
    path = tmp_path / "key"
    path.write_bytes(content)
    path.chmod(0o600)
    assert SigningKey.read(path).secret == secret


def test_a_passphrase_makes_the_key_that_mavproxy_makes() -> None:
    assert SigningKey.of_passphrase("correct horse").secret == (
        hashlib.new("sha256", b"correct horse").digest()
    )


@pytest.mark.parametrize("content", [b"", b"\n", b"one\ntwo\n", b"a" * 5000])
def test_what_is_no_key_is_refused(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "key"
    path.write_bytes(content)
    path.chmod(0o600)
    with pytest.raises(DeviceError, match="signing key"):
        SigningKey.read(path)


@pytest.mark.parametrize("mode", [0o644, 0o640, 0o602])
def test_a_key_that_others_may_read_is_refused(tmp_path: Path, mode: int) -> None:
    path = tmp_path / "key"
    path.write_bytes(SECRET)
    path.chmod(mode)
    with pytest.raises(DeviceError, match="chmod 600"):
        SigningKey.read(path)


def test_a_key_that_is_not_there_is_said(tmp_path: Path) -> None:
    with pytest.raises(DeviceError, match="cannot be read"):
        SigningKey.read(tmp_path / "none")


def test_the_secret_is_in_no_text(tmp_path: Path) -> None:
    key = key_at()
    texts = [repr(key), str(key), repr(Decoder(key)), f"{key}"]
    for length in (0, 31, 33):
        with pytest.raises(DeviceError) as caught:
            SigningKey(secret=SECRET[:length] + SECRET[: max(0, length - SECRET_BYTES)])
        texts.append(str(caught.value))
    path = tmp_path / "key"
    path.write_bytes(b"se cret\nse cret")
    path.chmod(0o600)
    with pytest.raises(DeviceError) as caught:
        SigningKey.read(path)
    assert "se cret" not in str(caught.value)
    for text in texts:
        assert SECRET.hex() not in text
        assert repr(SECRET)[2:20] not in text
        assert str(list(SECRET))[:20] not in text


# --- What comes -------------------------------------------------------------------------------


def test_what_is_signed_right_is_taken() -> None:
    assert taken(key_at(), *FRAMES) == (50, 0)
    assert taken(None, *FRAMES) == (50, 0)


def test_another_key_refuses_everything() -> None:
    assert taken(key_at(secret=b"\1" * 32), *FRAMES) == (0, 50)


def test_unsigned_frames_are_refused() -> None:
    unsigned = signed_by(M.MAVLink(None, 1, 1), 10)
    assert taken(key_at(), *FRAMES[:10], *unsigned, *FRAMES[10:]) == (50, 10)


def test_a_replay_is_refused_and_does_not_touch_the_account() -> None:
    decoder = Decoder(key_at())
    decoder.feed(b"".join(FRAMES))
    assert decoder.feed(b"".join(FRAMES)) == []
    assert decoder.feed(FRAMES[20]) == []
    counted = decoder.statistics()
    assert (counted.frames, counted.bad_signatures) == (50, 51)
    assert counted.duplicated == counted.lost_frames == counted.bad == 0


def test_every_bit_counts() -> None:
    rng = random.Random(4)
    frame = FRAMES[3]
    decoder = Decoder(key_at())
    checksum = range(8 * (len(frame) - 15), 8 * (len(frame) - 13))
    bits = [bit for bit in range(8 * 2 + 1, 8 * len(frame)) if bit not in checksum]
    refused = 0
    for bit in rng.sample(bits, 150):
        spoilt = bytearray(frame)
        spoilt[bit // 8] ^= 1 << (bit % 8)
        assert decoder.feed(with_checksum(spoilt) + bytes(300)) == []
        refused += 1
    assert 120 <= decoder.bad_signatures <= refused, "a spoilt id or flag is no frame at all"
    assert len(decoder.feed(frame)) == 1


def with_checksum(frame: bytearray) -> bytes:
    """Let a forged frame pass the checksum; 39 is the extra byte of ATTITUDE."""
    if frame[7:10] == b"\x1e\0\0":
        crc = x25crc(bytes(frame[1:-15]) + bytes([39])).crc
        frame[-15:-13] = crc.to_bytes(2, "little")
    return bytes(frame)


def test_a_forged_timestamp_does_not_lock_the_device_out() -> None:
    """Only what is signed right moves the clock of its sender."""
    forged = bytearray(FRAMES[0])
    forged[-12:-6] = (2**48 - 1).to_bytes(6, "little")
    assert taken(key_at(), bytes(forged), *FRAMES) == (50, 1)


def test_a_new_sender_may_be_a_minute_behind_and_no_more() -> None:
    assert taken(key_at(NOW_S + 59), FRAMES[0]) == (1, 0)
    assert taken(key_at(NOW_S + 61), FRAMES[0]) == (0, 1)
    assert taken(key_at(NOW_S + 3600).for_replay(), *FRAMES) == (50, 0)


def test_the_number_of_senders_is_bounded() -> None:
    sources = [(system, 1) for system in range(1, MOST_STREAMS + 20)]
    frames = [peer_frames(key_at(), 1, source)[0] for source in sources]
    assert taken(key_at(), *frames) == (MOST_STREAMS, 19)


# --- What leaves ------------------------------------------------------------------------------


def test_each_frame_is_newer_than_the_last_and_than_what_was_heard() -> None:
    key = key_at()
    mav = M.MAVLink(None, 255, 190)
    sign_with(mav, key)
    first = signed_by(mav, 20)
    ahead = key_at(NOW_S + FORGED_S)
    stranger = M.MAVLink(None, 1, 1)
    sign_with(stranger, ahead)
    assert len(Decoder(key).feed(signed_by(stranger, 1)[0])) == 1
    later = signed_by(mav, 20)
    stamps = [int.from_bytes(frame[-12:-6], "little") for frame in first + later]
    assert all(b > a for a, b in itertools.pairwise(stamps))
    assert stamps[0] >= timestamp_of(NOW_S)
    assert stamps[20] > timestamp_of(NOW_S + FORGED_S)


def test_pymavlink_accepts_what_we_sign() -> None:
    mav, parser = M.MAVLink(None, 255, 190), M.MAVLink(None)
    sign_with(mav, key_at())
    parser.signing.secret_key = SECRET
    assert len(parser.parse_buffer(b"".join(signed_by(mav, 30)))) == 30
    assert parser.signing.goodsig_count == 30


def test_timestamps_stay_within_their_48_bits() -> None:
    assert timestamp_of(0.0) == 0
    assert timestamp_of(1e15) == 2**48 - 1


# --- The firmware -----------------------------------------------------------------------------


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    require_or_skip(*TARGET_TOOLS["host"])
    folder = tmp_path_factory.mktemp("signing-host")
    write(generate(design(), TARGETS["host"], FirmwareOptions(signing=True)), folder)
    host_board.build(folder)
    return folder


class Signing(Ground):
    """A ground station that brings a key and signs with it."""

    def use(self, key: SigningKey) -> None:
        sign_with(self._mav, key)


@pytest.fixture(scope="module")
def provisioned(folder: Path) -> BoardRun:
    ground = Signing()
    ground.send(1.0, setup_signing_message(key_at(), 1, NOW_S))
    return ground.board_run(folder, stimulus(300))


def test_a_device_that_was_brought_the_key_is_believed_from_then_on(provisioned: BoardRun) -> None:
    decoder = Decoder(key_at())
    got = decoder.feed(provisioned.stream)
    every = hear(provisioned).frames
    unsigned = sum(not frame.raw[2] & 1 for frame in every)
    assert 0 < unsigned < 200
    assert len(got) == len(every) - unsigned > 100
    counted = decoder.statistics()
    assert counted.bad_signatures == unsigned
    assert counted.lost_frames == counted.bad == 0


def test_a_locked_device_takes_what_we_sign_and_answers_so_that_we_believe_it(
    folder: Path, provisioned: BoardRun
) -> None:
    """A device that has restarted is hours ahead; hearing it once, we follow."""
    key = key_at(NOW_S + 30)
    stored = replace(stimulus(300), store=provisioned.store)
    Decoder(key).feed(host_board.run(folder, stored).stream)
    assert key.clock.newest > timestamp_of(NOW_S + 3 * 3600)
    ground = Signing()
    ground.set(0.4, "FILT_TAU", TUNED + 0.5)
    ground.use(key)
    ground.set(0.5, "FILT_TAU", TUNED)
    ground.command(0.7, 512, 148)
    run = ground.board_run(folder, stored)
    decoder = Decoder(key)
    heard = hear(run)
    believed = replace(heard, frames=decoder.feed(run.stream))
    assert values(believed) == [("FILT_TAU", pytest.approx(TUNED, rel=1e-3))]
    assert acks(believed) == [(512, 0)]
    assert len(believed.frames) == len(heard.frames)
    assert believed.of("SYS_STATUS")[-1].errors_comm == 1, "the unsigned one was refused"
