"""MAVLink 2 signatures on the host: who sent a frame, and that it is not an old one.

The secret appears in no text: not in the representation of a key, not in an error.
"""

import hashlib
import hmac
import os
import secrets
import string
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from hostkit.dialect import SIGNATURE_BYTES, python_module
from hostkit.errors import DeviceError
from hostkit.link.frames.framing import COMPONENT_AT, FLAGS_AT, SIGNED, SYSTEM_AT

SECRET_BYTES = 32
NO_SECRET = bytes(SECRET_BYTES)
"""What takes the secret of a device away."""

HASH_BYTES = 6
EPOCH_S = 1_420_070_400
"""2015-01-01, from which the timestamps of signatures count."""
UNITS_PER_S = 100_000
LATEST = 2**48 - 1
BEHIND = 60 * UNITS_PER_S
"""How far a sender that was not heard before may be behind our own timestamp."""
MOST_STREAMS = 64
LONGEST_FILE_BYTES = 4096

Now = Callable[[], float]
"""Seconds since 1970."""


def timestamp_of(time_s: float) -> int:
    """Return a time in seconds since 1970 as the timestamp of a signature, in units of 10 us."""
    return min(max(int((time_s - EPOCH_S) * UNITS_PER_S), 0), LATEST)


@dataclass(slots=True)
class SigningClock:
    """The newest timestamp that was used or heard; what is signed next is newer."""

    now: Now = time.time
    newest: int = 0

    def current(self) -> int:
        """Return the timestamp of this moment; never before one that was used or heard."""
        return max(self.newest, timestamp_of(self.now()))


@dataclass(frozen=True, slots=True, kw_only=True)
class SigningKey:
    """The secret that two ends of a link share, and the time that goes with it.

    Raises
    ------
    DeviceError
        If the secret is not of 32 bytes, or all of them are zero: that means no secret.
    """

    secret: bytes = field(repr=False)
    clock: SigningClock = field(default_factory=SigningClock, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Refuse a secret of another length."""
        if len(self.secret) != SECRET_BYTES:
            raise DeviceError(
                f"a signing key has {SECRET_BYTES} bytes; this one has {len(self.secret)}"
            )
        if self.secret == NO_SECRET:
            raise DeviceError(f"{SECRET_BYTES} zeros are no signing key; give random bytes")

    @classmethod
    def read(cls, path: Path, now: Now = time.time) -> "SigningKey":
        """Read a key: 32 bytes, 64 hexadecimal digits, or a line of text.

        A line of text is hashed by SHA-256, as MAVProxy does with its passphrase.

        Raises
        ------
        DeviceError
            If the file cannot be read, is empty or too long, or may be read by others.
        """
        return cls(secret=_secret(_read_private(path), path), clock=SigningClock(now))

    @classmethod
    def create(cls, path: Path, now: Now = time.time) -> "SigningKey":
        """Make a key of random bytes and write it to a new file that only its owner may read.

        The file is on the disk when this returns: whoever loses the key loses the device.

        Raises
        ------
        DeviceError
            If the file is there already, or cannot be written.
        """
        secret = secrets.token_bytes(SECRET_BYTES)
        try:
            with open(path, "xb", opener=_open_private) as file:
                file.write(secret)
                file.flush()
                os.fsync(file.fileno())
        except FileExistsError as error:
            raise DeviceError(f"{path} is there already; a new key goes to a new file") from error
        except OSError as error:
            raise DeviceError(f"{path} cannot be written: {error.strerror}") from error
        return cls(secret=secret, clock=SigningClock(now))

    @classmethod
    def of_passphrase(cls, passphrase: str, now: Now = time.time) -> "SigningKey":
        """Return the key that MAVProxy makes of a passphrase."""
        digest = hashlib.sha256(passphrase.encode()).digest()
        return cls(secret=digest, clock=SigningClock(now))

    def for_replay(self) -> "SigningKey":
        """Return the key with a clock that stands, for what was recorded at any time."""
        return SigningKey(secret=self.secret, clock=SigningClock(lambda: 0.0))

    def signature(self, head: bytes) -> bytes:
        """Return the last 6 bytes of a frame that is `head`, its timestamp included."""
        return hashlib.sha256(self.secret + head).digest()[:HASH_BYTES]


def _open_private(path: str, flags: int) -> int:
    return os.open(path, flags, 0o600)


def _read_private(path: Path) -> bytes:
    try:
        with path.open("rb") as file:
            mode = os.fstat(file.fileno()).st_mode
            content = file.read(LONGEST_FILE_BYTES + 1)
    except OSError as error:
        raise DeviceError(f"signing key {path} cannot be read: {error.strerror}") from error
    if os.name == "posix" and mode & 0o077:
        raise DeviceError(
            f"signing key {path} may be read or written by others (mode {mode & 0o777:03o}); "
            f"make it private: chmod 600 {path}"
        )
    if len(content) > LONGEST_FILE_BYTES:
        raise DeviceError(f"signing key {path} is longer than {LONGEST_FILE_BYTES} bytes")
    return content


def _secret(content: bytes, path: Path) -> bytes:
    if len(content) == SECRET_BYTES:
        return content
    line = content.strip()
    if len(line) == 2 * SECRET_BYTES and all(chr(byte) in string.hexdigits for byte in line):
        return bytes.fromhex(line.decode("ascii"))
    if not line or b"\n" in line:
        raise DeviceError(
            f"signing key {path} is neither {SECRET_BYTES} bytes nor {2 * SECRET_BYTES} "
            "hexadecimal digits nor one line of text"
        )
    return hashlib.sha256(line).digest()


@dataclass(slots=True)
class SignatureCheck:
    """Accepts frames that are signed with a key and newer than the last of their sender.

    Only senders that know the key are remembered, and at most 64 of them.
    """

    key: SigningKey
    _streams: dict[tuple[int, int, int], int] = field(default_factory=dict)

    def accepts(self, raw: bytes) -> bool:
        """Tell whether an intact frame is to be believed."""
        if not raw[FLAGS_AT] & SIGNED:
            return False
        stream = (raw[-SIGNATURE_BYTES], raw[SYSTEM_AT], raw[COMPONENT_AT])
        timestamp = int.from_bytes(raw[1 - SIGNATURE_BYTES : -HASH_BYTES], "little")
        if not self._is_new(stream, timestamp):
            return False
        if not hmac.compare_digest(self.key.signature(raw[:-HASH_BYTES]), raw[-HASH_BYTES:]):
            return False
        self._streams[stream] = timestamp
        self.key.clock.newest = max(self.key.clock.newest, timestamp)
        return True

    def _is_new(self, stream: tuple[int, int, int], timestamp: int) -> bool:
        last = self._streams.get(stream)
        if last is not None:
            return timestamp > last
        if len(self._streams) >= MOST_STREAMS:
            return False
        return timestamp + BEHIND >= self.key.clock.current()


class _Outgoing:
    """What pymavlink asks for when it signs; its timestamps follow the clock of the key."""

    sign_outgoing = True

    def __init__(self, key: SigningKey, link_id: int) -> None:
        self.link_id = link_id
        self._key = key

    @property
    def secret_key(self) -> bytes:
        return self._key.secret

    @property
    def timestamp(self) -> int:
        clock = self._key.clock
        return max(clock.newest + 1, clock.current())

    @timestamp.setter
    def timestamp(self, following: int) -> None:
        """Note that the timestamp before `following` is used up."""
        self._key.clock.newest = max(self._key.clock.newest, following - 1)


def sign_with(mav: Any, key: SigningKey, *, link_id: int = 0) -> None:
    """Let a pymavlink encoder sign everything that it packs.

    Its timestamps are the key's clock, each newer than the last, and newer than those that a
    :class:`SignatureCheck` of the same key has accepted.
    """
    mav.signing = _Outgoing(key, link_id)


def setup_signing_message(
    key: SigningKey | None, target_system: int, now_s: float, *, target_component: int = 1
) -> Any:
    """Return the message that brings a secret to a device; None takes its secret away.

    The secret stands in it in the clear: send it over a wire that nobody else listens to.
    """
    secret = NO_SECRET if key is None else key.secret
    return python_module().MAVLink_setup_signing_message(
        target_system, target_component, list(secret), timestamp_of(now_s)
    )
