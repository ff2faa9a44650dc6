"""Giving a device the secret of its signatures, and taking it away.

The device does not answer the message that does so. What it sends afterwards tells, and a list of
its parameters, which only comes if it believes us.
"""

import time
from collections.abc import Callable
from typing import Final

from hostkit.errors import DeviceError
from hostkit.link.device.device_link import DeviceLink
from hostkit.link.frames.signing import Now, SigningKey, setup_signing_message

TRIES: Final = 3
HEAR_S: Final = 2.5
"""How long to wait for what the device then says: a heartbeat comes once a second."""


def give_secret(
    link: DeviceLink, key: SigningKey, present: SigningKey | None = None, now: Now = time.time
) -> bool:
    """Give a device a secret and check that both ends then believe each other.

    Parameters
    ----------
    link
        A link without a key, on which the device was found.
    present
        The secret that the device has; None if it has none.

    Returns
    -------
    bool
        False if the device had this secret already.

    Raises
    ------
    DeviceError
        If the device has another secret than `present`, or does not sign then.
    """
    if not link.signed:
        present = None
    elif _speaks_with(link, key):
        link.fetch()
        return False
    elif present is None or not _speaks_with(link, present):
        raise DeviceError(
            "the device has another secret; only whoever has that can set a new one: give it "
            "with --signing-key"
        )
    if not _set_up(link, key, present, now, lambda: link.heard):
        raise DeviceError(
            f"the device was sent a secret {TRIES} times and does not sign with it; only firmware "
            "that was generated with --signing knows signatures"
        )
    link.fetch()
    return True


def remove_secret(link: DeviceLink, key: SigningKey, now: Now = time.time) -> bool:
    """Take the secret of a device away and check that it then speaks with anybody.

    Parameters
    ----------
    link
        A link without a key, on which the device was found.
    key
        The secret that the device has.

    Returns
    -------
    bool
        False if the device had no secret.

    Raises
    ------
    DeviceError
        If the device has another secret, or goes on signing.
    """
    if not link.signed:
        return False
    if not _speaks_with(link, key):
        raise DeviceError("the device has another secret; only whoever has that can remove it")
    if not _set_up(link, None, key, now, lambda: link.heard and not link.signed):
        raise DeviceError(f"the device was told {TRIES} times to forget its secret and signs on")
    link.fetch()
    return True


def _speaks_with(link: DeviceLink, key: SigningKey) -> bool:
    """Speak with a key and tell whether the device signs with it."""
    link.use_key(key)
    return link.wait(lambda: link.heard, HEAR_S)


def _set_up(
    link: DeviceLink,
    key: SigningKey | None,
    present: SigningKey | None,
    now: Now,
    done: Callable[[], bool],
) -> bool:
    """Send a secret, or None, under the present one until `done`; speak with the new one then."""
    target = link.parameters.target
    assert target is not None
    for _ in range(TRIES):
        link.use_key(present)
        link.send(setup_signing_message(key, target[0], now(), target_component=target[1]))
        link.use_key(key)
        if link.wait(done, HEAR_S):
            return True
    return False
