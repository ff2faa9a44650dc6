"""Samples and snapshots to every page that listens, each with a bounded queue of its own."""

import asyncio
import threading
from collections import deque
from dataclasses import replace
from itertools import groupby

from hostkit.monitor.snapshot import Batch, SessionInfo, Snapshot
from hostkit.web.history import History, broken, joined
from hostkit.web.wire import encode, encode_samples, encode_snapshot

RATE_HZ = 15.0
MOST_CLIENTS = 16
QUEUE_EVENTS = 64
"""Of samples; some four seconds."""

PENDING_SAMPLES = 8192
"""Most samples of one event; of a replay that is faster the oldest are left out and counted."""

ALIVE_S = 5.0
"""After so long a silence a comment is sent, so that a dead connection is noticed."""


def event(kind: str, data: bytes) -> bytes:
    """Return one server-sent event."""
    return b"event: " + kind.encode("ascii") + b"\ndata: " + data + b"\n\n"


class SamplesEvent:
    """Samples that are encoded once for all clients."""

    def __init__(self, batch: Batch, text: bytes) -> None:
        self.batch = batch
        self.text = text


class Client:
    """What one page still has to be sent. Lives in the thread of the event loop."""

    def __init__(self, info: SessionInfo) -> None:
        self.missed = 0
        self._info = info
        self._samples: deque[SamplesEvent] = deque()
        self._snapshot = b""
        self._ended = False
        self._gap = False
        self._wake = asyncio.Event()

    def offer(self, samples: SamplesEvent) -> None:
        """Queue samples; when the queue is full, the oldest go."""
        if len(self._samples) >= QUEUE_EVENTS:
            self._samples.popleft()
            self.missed += 1
            self._gap = True
        self._samples.append(samples)
        self._wake.set()

    def tell(self, snapshot: bytes, missed: int) -> None:
        """Queue a snapshot in place of one that was not sent yet."""
        self._snapshot = snapshot + b',"missed_batches":%d}' % (missed + self.missed)
        self._wake.set()

    def end(self) -> None:
        """Let the stream end once what is queued was sent."""
        self._ended = True
        self._wake.set()

    async def next(self) -> bytes | None:
        """Wait for something to send; None at the end."""
        try:
            await asyncio.wait_for(self._wake.wait(), ALIVE_S)
        except asyncio.TimeoutError:
            return b": alive\n\n"
        text = self._queued()
        if text:
            return text
        return None if self._ended else b": alive\n\n"

    def _queued(self) -> bytes:
        if not self._ended:
            self._wake.clear()
        texts = [self._text_of(samples) for samples in self._samples]
        self._samples.clear()
        if self._snapshot:
            texts.append(event("snapshot", self._snapshot))
            self._snapshot = b""
        return b"".join(texts)

    def _text_of(self, samples: SamplesEvent) -> bytes:
        if not self._gap:
            return samples.text
        self._gap = False
        return event("samples", encode_samples(broken(samples.batch), self._info.axes))


class Hub:
    """Takes what a session shows, and hands it to the clients some times a second.

    `take_batch` and `take_snapshot` may be called from any thread and never wait for a client; the
    rest belongs to the thread of the event loop.
    """

    def __init__(self, info: SessionInfo, snapshot: Snapshot) -> None:
        self.history = History()
        self.info = info
        self.info_text = encode(info)
        self._lock = threading.Lock()
        self._pending: deque[Batch] = deque()
        self._pending_samples = 0
        self._gap = False
        self._missed = 0
        self._snapshot = snapshot
        self._new_snapshot = True
        self._snapshot_text = b""
        self._clients: set[Client] = set()
        self._ended = False

    def take_batch(self, batch: Batch) -> None:
        """Keep samples until the next flush."""
        if not len(batch):
            return
        with self._lock:
            if batch.epoch < self._snapshot.epoch:
                batch = replace(batch, epoch=self._snapshot.epoch)
            self._pending.append(batch)
            self._pending_samples += len(batch)
            while self._pending_samples > PENDING_SAMPLES and len(self._pending) > 1:
                self._pending_samples -= len(self._pending.popleft())
                self._missed += 1
                self._gap = True

    def take_snapshot(self, snapshot: Snapshot) -> None:
        """Keep the state until the next flush, in place of the one before."""
        with self._lock:
            self._snapshot = snapshot
            self._new_snapshot = True

    def join(self) -> Client | None:
        """Return a new client, None where there are too many. `history` is what it missed."""
        if len(self._clients) >= MOST_CLIENTS:
            return None
        self.flush()
        client = Client(self.info)
        client.tell(self._snapshot_text, self._missed + self._snapshot.missed_batches)
        if self._ended:
            client.end()
        self._clients.add(client)
        return client

    def leave(self, client: Client) -> None:
        """Forget a client."""
        self._clients.discard(client)

    async def run(self) -> None:
        """Flush at a steady rate until cancelled."""
        loop = asyncio.get_running_loop()
        due_s = loop.time()
        while True:
            self.flush()
            due_s = max(due_s + 1.0 / RATE_HZ, loop.time())
            await asyncio.sleep(due_s - loop.time())

    def flush(self) -> None:
        """Give the clients what came since the last time."""
        with self._lock:
            pending, self._pending = self._pending, deque()
            self._pending_samples = 0
            gap, self._gap = self._gap, False
            snapshot, new = self._snapshot, self._new_snapshot
            self._new_snapshot = False
        if gap and pending:
            pending[0] = broken(pending[0])
        for _, batches in groupby(pending, key=lambda batch: batch.epoch):
            self._give(joined(list(batches)))
        if new:
            self._tell(snapshot)

    def _give(self, batch: Batch) -> None:
        self.history.add(batch)
        if self._clients:
            text = event("samples", encode_samples(batch, self.info.axes))
            samples = SamplesEvent(batch, text)
            for client in self._clients:
                client.offer(samples)

    def _tell(self, snapshot: Snapshot) -> None:
        self._snapshot_text = encode_snapshot(snapshot)
        for client in self._clients:
            client.tell(self._snapshot_text, self._missed + snapshot.missed_batches)
        if snapshot.ended:
            self.end()

    def end(self) -> None:
        """End every stream, and those that are opened from now on, after what is queued."""
        self._ended = True
        for client in self._clients:
            client.end()
