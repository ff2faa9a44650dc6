"""Server-sent events, read back."""

import json
import threading
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field

import httpx

WAIT_S = 30.0


@dataclass(frozen=True)
class Event:
    kind: str
    data: dict


def events(lines: Iterable[str]) -> Iterator[Event]:
    """Give the events of a stream, without comments and `retry`."""
    kind = ""
    for line in lines:
        name, _, value = line.partition(": ")
        if name == "event":
            kind = value
        elif name == "data":
            yield Event(kind, json.loads(value))


def of_text(text: bytes | None) -> list[Event]:
    assert text is not None
    return list(events(text.decode().splitlines()))


def times(found: Iterable[Event]) -> list[float]:
    return [t for event in found if event.kind == "samples" for t in event.data["t"]]


@dataclass
class Listener:
    """Reads a stream in a thread until it ends or is left."""

    client: httpx.Client
    events: list[Event] = field(default_factory=list)
    status: int = 0

    def __post_init__(self) -> None:
        self._changed = threading.Condition()
        self._left = False
        self._thread = threading.Thread(target=self._read, daemon=True)

    def __enter__(self) -> "Listener":
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._left = True
        self._thread.join(WAIT_S)

    def _read(self) -> None:
        with self.client.stream("GET", "/stream") as response:
            self.status = response.status_code
            for event in events(response.iter_lines()):
                with self._changed:
                    self.events.append(event)
                    self._changed.notify_all()
                if self._left:
                    return

    def wait(self, enough: Callable[[list[Event]], bool]) -> None:
        """Return once the events suffice."""
        with self._changed:
            assert self._changed.wait_for(lambda: enough(self.events), WAIT_S)

    def ended(self) -> bool:
        self._thread.join(WAIT_S)
        return not self._thread.is_alive()
