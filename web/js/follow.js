// Following a job to its end: by server-sent events while the stream holds, else by asking again and again.

import { Problem } from "./problem.js";

const ENDED = new Set(["successful", "failed", "dismissed"]);
const TOLD = ["open", "status", "progress", "frame", "message"];
const PAUSE_MS = 700; // between two questions when there is no stream
const REST_MS = 120; // the least time between two questions that events set off

export function ended(job) {
  return ENDED.has(job.status);
}

/**
 * Call `tell(job)` whenever the job has moved on, until it has ended or the signal aborts.
 *
 * An event only says that something happened; what happened is read from the job itself, so a lost or doubled event
 * does no harm. A service that is away for a moment is asked again, `patience` times in a row.
 */
export async function follow(client, job, tell, signal, patience = 8) {
  let wake = () => {};
  let happened = false;
  const ring = () => {
    happened = true;
    wake();
  };
  let stream = new EventSource(client.address(job.links.events));
  for (const name of TOLD) stream.addEventListener(name, ring);
  stream.onerror = () => {
    // The browser would try again for ever; the job's own address says as much, and says when the job has ended.
    stream?.close();
    stream = null;
    ring();
  };
  signal.addEventListener("abort", ring);
  try {
    let failures = 0;
    for (let now = job; !signal.aborted; ) {
      if (!happened) await sleep(stream ? 10 * PAUSE_MS : PAUSE_MS, (cut) => (wake = cut));
      happened = false;
      if (signal.aborted) return;
      try {
        now = await client.job(job.id, signal);
        failures = 0;
      } catch (error) {
        if (error.name === "AbortError") return;
        failures += 1;
        if (!(error instanceof Problem && error.unreachable) || failures > patience) throw error;
        await sleep(PAUSE_MS * failures, (cut) => (wake = cut));
        continue;
      }
      if (signal.aborted) return;
      tell(now);
      if (ended(now)) return;
      await sleep(REST_MS, () => {});
    }
  } finally {
    signal.removeEventListener("abort", ring);
    stream?.close();
  }
}

function sleep(ms, offerCut) {
  return new Promise((resolve) => {
    const timer = setTimeout(resolve, ms);
    offerCut(() => {
      clearTimeout(timer);
      resolve();
    });
  });
}
