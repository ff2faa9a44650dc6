"""Other programs that get what a session receives: ground stations and plotters."""

from collections.abc import Sequence
from dataclasses import dataclass, field

from hostkit.link.forward import Forwarder
from hostkit.link.frames.decoder import Frame
from hostkit.link.json_udp import JsonUdp
from hostkit.monitor.snapshot import Batch, ForwardState


@dataclass(slots=True, kw_only=True)
class Outlets:
    """Where frames and samples go besides the views."""

    forwarders: Sequence[Forwarder] = field(default=())
    plotters: Sequence[JsonUdp] = field(default=())

    def send(self, frames: Sequence[Frame]) -> None:
        """Pass frames on."""
        for forwarder in self.forwarders:
            for frame in frames:
                forwarder.send(frame.raw)

    def take_batch(self, batch: Batch) -> None:
        """Pass samples on."""
        for plotter in self.plotters:
            plotter.send(batch)

    def receive(self) -> list[bytes]:
        """Return the frames of ground stations that are for the device."""
        return [raw for forwarder in self.forwarders for raw in forwarder.receive()]

    def states(self) -> tuple[ForwardState, ...]:
        """Return what went where."""
        frames = [forwarder.state() for forwarder in self.forwarders]
        samples = [plotter.state() for plotter in self.plotters]
        return (
            *(
                ForwardState(
                    address=counts.address,
                    sent_frames=counts.sent_frames,
                    dropped_frames=counts.dropped_frames,
                    received_frames=counts.received_frames,
                )
                for counts in frames
            ),
            *(
                ForwardState(
                    address=f"json-{counts.address}",
                    sent_frames=counts.sent,
                    dropped_frames=counts.dropped,
                    received_frames=0,
                )
                for counts in samples
            ),
        )

    def close(self) -> None:
        """Close all sockets."""
        for forwarder in self.forwarders:
            forwarder.close()
        for plotter in self.plotters:
            plotter.close()
