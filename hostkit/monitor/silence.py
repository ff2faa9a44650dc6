"""Noticing that no samples come, and saying what comes instead."""

from hostkit.errors import DeviceError
from hostkit.link.clock import Clock
from hostkit.link.ports.transport import Transport
from hostkit.monitor.device_status import Watches
from hostkit.monitor.notices import Notices
from hostkit.monitor.receiver import Receiver

SILENCE_S = 5.0
"""How long a live port may stay without a sample before the session gives up."""


class SilenceWatch:
    """Follows how long no sample came.

    Parameters
    ----------
    patient
        Whether to wait on for a device that was heard once.

    Attributes
    ----------
    first_s
        When the first sample came; None while none has.
    """

    def __init__(
        self,
        transport: Transport,
        receiver: Receiver,
        watches: Watches,
        notices: Notices,
        clock: Clock,
        *,
        patient: bool,
    ) -> None:
        self._transport, self._receiver = transport, receiver
        self._watches, self._notices, self._clock = watches, notices, clock
        self._patient = patient
        self._last_s = clock.monotonic()
        self._silent = False
        self.first_s: float | None = None

    def begin(self) -> None:
        """Count from now on."""
        self._last_s = self._clock.monotonic()

    def look(self, *, heard: bool, samples: int) -> None:
        """Take note of whether samples came.

        Raises
        ------
        DeviceError
            If none came for 5 s and that is not waited for.
        """
        now_s = self._clock.monotonic()
        if heard:
            if self._silent:
                gap_s = now_s - self._last_s
                self._notices.add("info", f"samples come again after {gap_s:.1f} s")
            self._last_s, self._silent = now_s, False
            self.first_s = now_s if self.first_s is None else self.first_s
            return
        if self._is_excused():
            self._last_s = now_s
        elif now_s - self._last_s > SILENCE_S and not self._silent:
            text = self._explain(samples)
            if not self._patient or self.first_s is None:
                raise DeviceError(text)
            self._silent = True
            self._notices.add("warning", text)

    def _is_excused(self) -> bool:
        """Tell whether nothing can come: a file, a released port, or one that is waited for."""
        state = self._transport.state
        waited_for = state == "lost" and self._patient and self.first_s is not None
        return not self._transport.live or state == "released" or waited_for

    def _explain(self, samples: int) -> str:
        """Say what was heard instead of samples."""
        if samples:
            return f"the device stopped sending after {samples} samples"
        frames = self._receiver.statistics().frames
        if not frames:
            return self._receiver.explain_noise(SILENCE_S)
        text = self._watches.last_text
        said = f"; it says: {text!r}" if text else ""
        return f"{frames} MAVLink messages came in {SILENCE_S:g} s, but no TILT_SAMPLE{said}"
