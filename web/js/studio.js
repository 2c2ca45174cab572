// What the page is doing: the form's values, the film on the stage, where the stage stands, what went wrong.

import { normalise, same } from "./angle.js";
import { Film } from "./film.js";
import { Gallery } from "./gallery.js";
import { Player } from "./player.js";
import { FIRST_LOOK, OFFERED, equal, nearestFrame, still } from "./request.js";
import { defaultsOf, fieldsOf } from "./schema.js";
import { ended, follow } from "./follow.js";
import { Problem } from "./problem.js";
import { Stills } from "./stills.js";

export class Studio extends EventTarget {
  #following = new AbortController();
  #opening = null;
  #turn = 0; // counts what has been asked for

  constructor(client) {
    super();
    this.client = client;
    this.demonstrations = [];
    this.minerals = [];
    this.entries = new Map(); // whole entries of minerals that were looked at, by id
    this.demonstration = null;
    this.fields = [];
    this.values = {};
    this.settings = structuredClone(OFFERED);
    this.asking = false; // a request is on its way to the service
    this.angle = 0;
    this.problem = null;
    this.stills = new Stills(
      client,
      () => this.changed(),
      (error) => this.fail(error),
    );
    this.gallery = new Gallery(this.stills);
    this.player = new Player(
      () => this.film?.count ?? 0,
      () => this.#advance(),
    );
  }

  /** What was asked for last, null before anything was. */
  get film() {
    return this.gallery.film;
  }

  /** Tell the page to look again. */
  changed() {
    this.dispatchEvent(new Event("change"));
  }

  /** What can be chosen; then the view that a link asks for, else the first look. */
  async open(view) {
    this.#opening = view;
    this.problem = null;
    [this.demonstrations, this.minerals] = await Promise.all([this.client.demonstrations(), this.client.minerals()]);
    await this.show(view(this));
  }

  /** The fields of a demonstration, by name; of the first where the name is not known. */
  fieldsFor(name) {
    const found = this.demonstrations.find((d) => d.name === name) ?? this.demonstrations[0];
    return found ? fieldsOf(found.parameters) : [];
  }

  choose(name) {
    this.demonstration = this.demonstrations.find((d) => d.name === name) ?? this.demonstrations[0] ?? null;
    this.fields = this.fieldsFor(this.demonstration?.name);
    this.values = defaultsOf(this.fields);
    this.changed();
  }

  /** Set the form and the stage as a link says, and render that. */
  async show({ demonstration, parameters, settings, angle }) {
    this.choose(demonstration ?? this.demonstration?.name);
    Object.assign(this.values, parameters);
    this.#lookUp();
    this.settings = settings ?? structuredClone(OFFERED);
    this.angle = normalise(angle ?? 0);
    await this.render(settings ?? FIRST_LOOK);
  }

  set(name, value) {
    this.values = { ...this.values, [name]: value };
    this.#lookUp();
    this.changed();
  }

  /** Fetch the entry of the chosen mineral, once. */
  async #lookUp() {
    const id = this.values.mineral;
    if (this.entries.has(id) || !this.minerals.some((m) => m.id === id)) return;
    this.entries.set(id, null);
    try {
      this.entries.set(id, await this.client.mineral(id));
    } catch (error) {
      this.entries.delete(id);
      this.fail(error);
    }
    this.changed();
  }

  setPicture(name, value) {
    this.settings = { ...this.settings, [name]: value };
    this.changed();
  }

  /** What the Render button would ask for. */
  get wanted() {
    return this.#request(this.values, this.settings);
  }

  /** Whether the form says something else than what stands on the stage. */
  get differs() {
    return this.film !== null && !equal(this.wanted, this.film.request);
  }

  #request(values, settings) {
    return {
      demonstration: this.demonstration.name,
      parameters: structuredClone(values),
      ...structuredClone(settings),
    };
  }

  /** Render what the form says. */
  async press() {
    // The service was away when the page came: begin again.
    if (!this.demonstration) return this.open(this.#opening).catch((error) => this.fail(error));
    await this.render(this.settings);
  }

  /** Render the present scene anew with another analyser, everything else as it stands on the stage. */
  async analyse(degrees) {
    this.set("analyser_deg", degrees);
    const request = this.film?.request;
    if (!request) return this.render(FIRST_LOOK);
    return this.#begin({ ...request, parameters: { ...request.parameters, analyser_deg: degrees } }, this.film.first);
  }

  async render(settings) {
    await this.#begin(this.#request(this.values, settings), settings === FIRST_LOOK);
  }

  async #begin(request, first) {
    const turn = (this.#turn += 1);
    this.problem = null;
    this.asking = true;
    this.changed();
    let film = null;
    try {
      const job = await this.client.start(request);
      film = new Film(this.client, request, job, first);
    } catch (error) {
      if (turn === this.#turn) this.fail(error);
    }
    if (turn !== this.#turn) return film ? this.#letGo(film) : undefined; // something else has been asked for meanwhile
    this.asking = false;
    // What is being rendered goes on where the new request was refused, and is let go where it was accepted.
    if (film) await this.#take(film);
    else this.changed();
  }

  async #take(film) {
    this.#following.abort();
    this.#following = new AbortController();
    const { signal } = this.#following;
    const before = this.film;
    this.gallery.mount(film, this.angle);
    this.changed();
    this.dispatchEvent(new Event("mount"));
    try {
      await Promise.all([this.#letGo(before), this.#describe(film), this.#watch(film, signal)]);
    } catch (error) {
      if (!signal.aborted) this.fail(error);
    }
    this.changed();
  }

  /** A film that nobody looks forward to any more need not be finished. */
  async #letGo(film) {
    if (!film || ended(film.job)) return;
    film.job = { ...film.job, status: "dismissed" };
    await this.client.dismiss(film.job.id).catch(() => {}); // it may have ended by itself; nobody waits for it
  }

  async #watch(film, signal) {
    const take = async (job) => {
      try {
        await film.take(job, () => this.changed());
      } catch (error) {
        if (!signal.aborted) this.fail(error);
      }
      if (ended(job) && !signal.aborted) this.#finish(film, job);
      this.changed();
    };
    const taking = [take(film.job)];
    if (!ended(film.job)) await follow(this.client, film.job, (job) => taking.push(take(job)), signal);
    await Promise.all(taking);
  }

  /** The manifest tells of the scene from the beginning. */
  async #describe(film) {
    film.manifest = await this.client.manifest(film.job);
    this.changed();
  }

  #finish(film, job) {
    film.lasted ??= (performance.now() - film.began) / 1000;
    if (job.status === "failed") this.fail(new Problem(job.problem ?? {}));
    if (job.status === "successful" && film === this.film) this.gallery.settle();
  }

  async cancel() {
    this.#following.abort();
    const gone = this.#letGo(this.film);
    this.changed();
    await gone;
  }

  /** The visitor goes: what nobody asked for need not be finished. A render that was asked for goes on. */
  leave() {
    this.stills.giveUp();
    if (this.film?.first) this.cancel();
  }

  fail(error) {
    this.problem = error;
    this.changed();
  }

  get running() {
    return this.asking || (this.film !== null && !ended(this.film.job));
  }

  // ---- the stage

  /** Turn the stage to an angle; where no frame stands exactly there, ask for that one picture. */
  turn(angle) {
    this.angle = normalise(angle);
    const film = this.film;
    if (film && !same(film.angle(nearestFrame(film.request, this.angle)), this.angle)) {
      this.stills.ask(still(film.request, this.angle));
    }
    this.changed();
  }

  /** Turn the stage to frame i of the film. */
  turnToFrame(index) {
    if (!this.film) return;
    const { count } = this.film;
    this.turn(this.film.angle(((index % count) + count) % count));
  }

  /** Turn the stage to the frame that stands nearest to an angle. */
  turnNear(angle) {
    if (this.film) this.turnToFrame(nearestFrame(this.film.request, angle));
  }

  /** Turn the stage to the first or the last frame. */
  toEnd(last) {
    this.pause();
    this.turnToFrame(last ? -1 : 0);
  }

  get frame() {
    return this.film ? nearestFrame(this.film.request, this.angle) : 0;
  }

  step(by) {
    this.pause();
    this.turnToFrame(this.frame + by);
  }

  play() {
    this.player.play();
    this.changed();
  }

  pause() {
    if (!this.player.playing) return;
    this.player.pause();
    this.changed();
  }

  #advance() {
    const film = this.film;
    if (!film || film.count < 2) return false;
    for (let on = 1; on <= film.count; on += 1) {
      const index = (this.frame + on) % film.count;
      if (this.gallery.exact(film.angle(index))) {
        this.angle = film.angle(index);
        this.changed();
        return true;
      }
      if (!ended(film.job)) return this.#catchUp(); // it is on its way
    }
    return false;
  }

  /** While frames are coming and the next one is not there: go to the one that came last. */
  #catchUp() {
    const { newest } = this.film;
    if (newest === null || newest === this.frame) return false;
    this.angle = this.film.angle(newest);
    this.changed();
    return true;
  }

  /** What to put on the stage now. */
  get view() {
    return this.gallery.view(this.angle);
  }

  /** What the manifest says of the scene on the stage, null until it is there. */
  get scene() {
    return this.film?.manifest?.scene ?? null;
  }
}
