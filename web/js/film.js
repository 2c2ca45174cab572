// The frames of one render, arriving one by one.

import { ended } from "./follow.js";
import { frameAngle, lookKey, sceneKey } from "./request.js";

/** Load a picture whole, decoded and ready to be drawn. */
export async function loadPicture(url) {
  const image = new Image();
  image.src = url;
  await image.decode();
  return image;
}

/**
 * @typedef {object} Picture
 * @property {HTMLImageElement} image
 * @property {number} angle of the stage, degrees
 * @property {number | null} error RMS in linear sRGB as the renderer estimates it
 * @property {string} quality
 * @property {string} png address of the lossless file
 */

export class Film {
  #client;
  #asked = new Set();
  #pictures = new Map();

  /** @param {boolean} first whether this is the first look, which nobody asked for */
  constructor(client, request, job, first = false) {
    this.#client = client;
    this.request = request;
    this.job = job;
    this.scene = sceneKey(request);
    this.look = lookKey(request);
    this.began = performance.now();
    this.lasted = null;
    this.manifest = null;
    this.first = first;
    this.newest = null; // index of the picture that arrived last
  }

  get count() {
    return this.request.frames;
  }

  get loaded() {
    return this.#pictures.size;
  }

  /** The job's status, but "running" until the pictures of an ended job are here too. */
  get status() {
    return ended(this.job) && this.loaded < this.job.frames.length ? "running" : this.job.status;
  }

  angle(index) {
    return frameAngle(this.request, index);
  }

  /** @returns {Picture | undefined} */
  picture(index) {
    return this.#pictures.get(index);
  }

  /** The picture that stands nearest to frame `index`, counted around the turn. */
  nearest(index) {
    for (let away = 0; away <= this.count / 2; away += 1) {
      const found =
        this.#pictures.get((index + away) % this.count) ?? this.#pictures.get((index - away + this.count) % this.count);
      if (found) return found;
    }
    return undefined;
  }

  /** Take in the job's news: load what is new, then call `arrived(index)` for each picture. A picture that does not load throws. */
  take(job, arrived) {
    this.job = job;
    const fresh = job.frames.filter((frame) => !this.#asked.has(frame.index));
    return Promise.all(fresh.map((frame) => this.#load(frame, arrived)));
  }

  async #load(frame, arrived) {
    this.#asked.add(frame.index);
    const image = await loadPicture(this.#client.address(frame.links.webp));
    this.#pictures.set(frame.index, {
      image,
      angle: this.angle(frame.index),
      error: frame.error_estimate ?? null,
      quality: this.request.quality,
      png: this.#client.address(frame.links.png),
    });
    this.newest = frame.index;
    arrived(frame.index);
  }
}
