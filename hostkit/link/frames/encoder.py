"""From messages to bytes for the device."""

from typing import Any

from hostkit.dialect import python_module
from hostkit.link.device.exchange import STATION
from hostkit.link.frames.signing import SigningKey, sign_with


class Encoder:
    """Packs messages as MAVLink 2 frames with gapless numbers, signed where there is a key.

    Parameters
    ----------
    signing
        Key that the device knows, too; None sends unsigned frames.
    system_id, component_id
        Who speaks: by default a ground station.
    """

    def __init__(
        self,
        signing: SigningKey | None = None,
        *,
        system_id: int = STATION[0],
        component_id: int = STATION[1],
    ) -> None:
        self._mav = python_module().MAVLink(None, srcSystem=system_id, srcComponent=component_id)
        if signing is not None:
            sign_with(self._mav, signing)

    def pack(self, message: Any) -> bytes:
        """Return the frame of a message of the dialect."""
        frame = bytes(message.pack(self._mav))
        self._mav.seq = (self._mav.seq + 1) % 256
        return frame
