// When to draw: at most fifteen times a second, and never while nobody looks.

const LEAST_MS = 1000 / 15 - 8; // a little less, so that a steady 15 per second is not halved

export class Painter {
  constructor(paint) {
    this.paint = paint;
    this.due = false;
    this.last = 0;
    document.addEventListener("visibilitychange", () => this.request());
  }

  request() {
    if (this.due || document.hidden) return;
    this.due = true;
    const wait = this.last + LEAST_MS - performance.now();
    if (wait > 0) setTimeout(() => this.frame(), wait);
    else this.frame();
  }

  frame() {
    requestAnimationFrame(() => {
      this.due = false;
      this.last = performance.now();
      this.paint();
    });
  }
}
