// The pictures at hand, and which of them to show at an angle.

import { apart, normalise, same } from "./angle.js";
import { nearestFrame, still } from "./request.js";

export class Gallery {
  /** @param {import("./stills.js").Stills} stills */
  constructor(stills) {
    this.stills = stills;
    this.film = null; // what was asked for last
    this.under = null; // an earlier film of the same scene: it stands in for frames that are still to come
    this.stale = null; // the last picture of the scene before, until the first of this one is there
  }

  /** Put another film on, with the stage at an angle; ask for a still where the film will be slow or silent. */
  mount(film, angle) {
    const before = this.film;
    const fresh = before?.scene !== film.scene;
    if (fresh) {
      this.stale = this.view(angle)?.picture ?? null;
      this.under = null;
    } else if (before.loaded > 0) {
      this.under = before;
    }
    this.film = film;
    const index = nearestFrame(film.request, angle);
    if (!same(film.angle(index), angle)) {
      this.stills.ask(still(film.request, angle)); // no frame of the film will ever stand there
    } else if (fresh && index !== 0) {
      // The frames come in their own order: one coarse picture of where the stage stands comes before them.
      this.stills.ask(still(film.request, angle, "draft"));
    }
  }

  /** The film is whole: nothing need stand in for its frames. */
  settle() {
    this.under = null;
    this.stale = null;
  }

  /** The picture of exactly this angle, the best there is: the film's own, a still, the earlier film's. */
  exact(angle) {
    const { film } = this;
    if (!film) return undefined;
    return (
      at(film, angle) ??
      this.stills.picture(still(film.request, angle)) ??
      at(this.under, angle) ??
      this.stills.anyOf(film.scene, normalise(angle))
    );
  }

  /**
   * What to put on the stage.
   *
   * @returns {{picture: Picture, state: "exact" | "waiting" | "stale"} | null}
   *   "waiting": of this scene, but of another angle; "stale": of the scene before
   */
  view(angle) {
    const exact = this.exact(angle);
    if (exact) return { picture: exact, state: "exact" };
    const near = [this.film, this.under]
      .map((film) => film?.nearest(nearestFrame(film.request, angle)))
      .filter(Boolean)
      .sort((a, b) => apart(a.angle, angle) - apart(b.angle, angle))[0];
    if (near) return { picture: near, state: "waiting" };
    return this.stale ? { picture: this.stale, state: "stale" } : null;
  }
}

function at(film, angle) {
  if (!film) return undefined;
  const index = nearestFrame(film.request, angle);
  return same(film.angle(index), angle) ? film.picture(index) : undefined;
}
