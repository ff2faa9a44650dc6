// Server-sent events, and their return after a loss.

const RETRY_MS = 1500;

/**
 * Listen to the session.
 *
 * `handlers` has samples(event, live), snapshot(event), info(event), state("open" | "lost" |
 * "ended"). `live` is false for the samples of the past that come first on every connection.
 */
export class Stream {
  constructor(handlers) {
    this.handlers = handlers;
    this.ended = false;
    this.open();
  }

  open() {
    const source = new EventSource("/stream");
    this.source = source;
    this.live = false;
    source.onopen = () => {
      this.live = false;
      this.handlers.state("open");
    };
    source.onerror = () => this.lost(source);
    source.addEventListener("samples", (event) => {
      this.handlers.samples(JSON.parse(event.data), this.live);
    });
    source.addEventListener("snapshot", (event) => {
      this.live = true; // the first snapshot follows the samples of the past
      this.handlers.snapshot(JSON.parse(event.data));
    });
    source.addEventListener("info", (event) => this.handlers.info(JSON.parse(event.data)));
    source.addEventListener("end", () => {
      this.ended = true;
      source.close();
      this.handlers.state("ended");
    });
  }

  lost(source) {
    if (this.ended) return;
    this.handlers.state("lost");
    // A refused answer closes an EventSource for good; an interrupted one comes back by itself.
    if (source.readyState === EventSource.CLOSED) setTimeout(() => this.open(), RETRY_MS);
  }
}
