// Single pictures at angles between the frames, each asked for once and kept.

import { Film } from "./film.js";
import { ended, follow } from "./follow.js";
import { Problem } from "./problem.js";
import { equal, firstAngle, lookKey } from "./request.js";

const KEPT = 48; // pictures; the oldest goes first

export class Stills {
  #client;
  #changed;
  #failed;
  #films = new Map();
  #present = null;

  constructor(client, changed, failed) {
    this.#client = client;
    this.#changed = changed;
    this.#failed = failed;
  }

  #key(request) {
    return `${lookKey(request)}@${firstAngle(request)}`;
  }

  picture(request) {
    return this.#films.get(this.#key(request))?.picture(0);
  }

  /** A picture of this scene at this angle, however it was drawn; the latest, if there are several. */
  anyOf(scene, angle) {
    return [...this.#films.values()]
      .reverse()
      .find((film) => film.scene === scene && film.angle(0) === angle)
      ?.picture(0);
  }

  /** Ask no further for what is still to come. */
  giveUp() {
    this.#present?.giveUp();
  }

  /** Whether the picture last asked for is still to come. */
  get waiting() {
    return this.#present !== null;
  }

  /** Ask for a one-frame request; the one before, if unfinished, is given up. */
  async ask(request) {
    if (this.picture(request) || equal(this.#present?.request, request)) return;
    this.giveUp();
    const stop = new AbortController();
    let job = null;
    const giveUp = () => {
      stop.abort();
      if (job && !ended(job)) this.#client.dismiss(job.id).catch(() => {}); // it may have ended meanwhile
    };
    const present = { request, giveUp };
    this.#present = present;
    try {
      job = await this.#client.start(request);
      if (stop.signal.aborted) return giveUp();
      const film = new Film(this.#client, request, job);
      if (!ended(job)) await follow(this.#client, job, (news) => (job = news), stop.signal);
      if (stop.signal.aborted) return;
      await film.take(job, () => this.#keep(film));
      if (job.status === "failed") throw new Problem(job.problem ?? {});
    } catch (error) {
      if (!stop.signal.aborted) this.#failed(error);
    } finally {
      if (this.#present === present) this.#present = null;
      this.#changed();
    }
  }

  #keep(film) {
    this.#films.set(this.#key(film.request), film);
    if (this.#films.size > KEPT) this.#films.delete(this.#films.keys().next().value);
  }
}
