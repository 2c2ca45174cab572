// The REST interface of the service, as far as the page uses it.

import { Problem } from "./problem.js";

export class Client {
  /** @param {string | URL} base address below which `v1/` lies */
  constructor(base) {
    this.base = base;
  }

  /** The full address of a path or link of the service. */
  address(path) {
    return new URL(path, this.base).href;
  }

  async #ask(path, options = {}) {
    let response;
    try {
      response = await fetch(this.address(path), { headers: { accept: "application/json" }, ...options });
    } catch (error) {
      if (error.name === "AbortError") throw error;
      throw new Problem({ detail: String(error.message ?? error) }, true);
    }
    if (!response.ok) throw await Problem.from(response);
    return response.status === 204 ? null : response.json();
  }

  async demonstrations() {
    return (await this.#ask("v1/demonstrations")).demonstrations;
  }

  /** Every mineral there is, shortly: the list comes in pages. */
  async minerals() {
    const found = [];
    for (let path = "v1/minerals?limit=500"; path; ) {
      const { minerals, links } = await this.#ask(path);
      found.push(...minerals);
      path = links.next;
    }
    return found;
  }

  /** A mineral's whole entry: its numbers with their sources, its indices at the D line. */
  mineral(id) {
    return this.#ask(`v1/minerals/${encodeURIComponent(id)}`);
  }

  /** Ask for a render; the answer is the job. */
  start(request) {
    return this.#ask("v1/renders", {
      method: "POST",
      headers: { accept: "application/json", "content-type": "application/json" },
      body: JSON.stringify(request),
    });
  }

  job(id, signal) {
    return this.#ask(`v1/renders/${encodeURIComponent(id)}`, { signal });
  }

  manifest(job, signal) {
    return this.#ask(job.links.manifest, { signal });
  }

  /** Give a job up; the request outlives the page that makes it. */
  dismiss(id) {
    return this.#ask(`v1/renders/${encodeURIComponent(id)}`, { method: "DELETE", keepalive: true });
  }
}
