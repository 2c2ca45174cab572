// Playing: steps from frame to frame at an even pace, waiting where a frame is not there yet.

/** One turn of the stage in so many seconds. */
export const PACES = [24, 12, 6, 3];

export class Player {
  #timer = 0;
  #stepped = 0; // when the stage last moved, ms

  /**
   * @param {() => number} count frames in a turn, 0 when there is nothing to play
   * @param {() => boolean} step go one frame on; false when the next one is not there yet
   */
  constructor(count, step) {
    this.count = count;
    this.step = step;
    this.pace = 12;
    this.playing = false;
  }

  play() {
    if (this.playing) return;
    this.playing = true;
    this.#stepped = performance.now();
    this.#timer = requestAnimationFrame((now) => this.#tick(now));
  }

  pause() {
    this.playing = false;
    cancelAnimationFrame(this.#timer);
  }

  #tick(now) {
    if (!this.playing) return;
    const every = (this.pace * 1000) / Math.max(this.count(), 1);
    if (now - this.#stepped >= every && this.step()) {
      // Even steps; but a page that waited or was hidden goes on where it stood instead of catching up.
      this.#stepped = now - this.#stepped < 2 * every ? this.#stepped + every : now;
    }
    this.#timer = requestAnimationFrame((later) => this.#tick(later));
  }
}
