// Following a job to its end: by server-sent events while the stream holds, else by asking again and again.

import { Problem } from "./problem.js";

const ENDED = new Set(["successful", "failed", "dismissed"]);
const PAUSE_MS = 700; // between two questions when there is no stream

export function ended(job) {
  return ENDED.has(job.status);
}

/**
 * Call `tell(job)` whenever the job has moved on, until it has ended or the signal aborts.
 *
 * The last word is the job's own, read from its address. A service that is away for a moment is asked again,
 * `patience` times in a row.
 */
export async function follow(client, job, tell, signal, patience = 8) {
  const heard = await listen(client, job, tell, signal);
  let failures = 0;
  for (let first = heard; !signal.aborted; first = false) {
    if (!first) await sleep(PAUSE_MS * (1 + failures), signal);
    if (signal.aborted) return;
    try {
      const now = await client.job(job.id, signal);
      failures = 0;
      if (signal.aborted) return;
      tell(now);
      if (ended(now)) return;
    } catch (error) {
      if (error.name === "AbortError") return;
      failures += 1;
      if (!(error instanceof Problem && error.unreachable) || failures > patience) throw error;
    }
  }
}

/** Take the job's news from its stream; resolves to true when it has told the end, to false when it broke. */
function listen(client, job, tell, signal) {
  const now = { ...job, frames: [...job.frames] };
  const stream = new EventSource(client.address(job.links.events));
  return new Promise((resolve) => {
    const close = (whole) => {
      stream.close();
      resolve(whole);
    };
    const on = (name, take) =>
      stream.addEventListener(name, (event) => {
        take(JSON.parse(event.data));
        tell({ ...now, frames: [...now.frames] });
      });
    signal.addEventListener("abort", () => close(false), { once: true });
    // The browser would try again for ever; the job's own address says as much, and says when the job has ended.
    stream.onerror = () => close(false);
    on("progress", (progress) => (now.progress = progress));
    on("frame", (frame) => {
      // A stream that is taken up again may repeat itself.
      if (!now.frames.some((known) => known.index === frame.index)) now.frames.push(frame);
    });
    on("status", ({ status }) => {
      if (ENDED.has(status)) close(true);
      else now.status = status;
    });
  });
}

function sleep(ms, signal) {
  return new Promise((resolve) => {
    const wake = () => {
      clearTimeout(timer);
      signal.removeEventListener("abort", wake);
      resolve();
    };
    const timer = setTimeout(wake, ms);
    signal.addEventListener("abort", wake);
  });
}
