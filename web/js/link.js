// The address's hash: a link reproduces the view. `demonstration`, `frames`, `size`, `quality`, `seed` and `angle` are
// the page's own keys, every other key is a parameter of the demonstration; what stands at its default is left out.

import { OFFERED, equal } from "./request.js";
import { read, write } from "./schema.js";

/** @returns {string} the hash, without #; an angle of null is a stage that turns by itself */
export function writeLink({ request, angle, fields, first }) {
  const keys = new URLSearchParams();
  if (request) {
    keys.set("demonstration", request.demonstration);
    for (const field of fields) {
      const value = request.parameters[field.name];
      if (value !== undefined && !equal(value, field.default)) keys.set(field.name, write(value));
    }
    // The quality tells a view someone asked for from the first look, which no link needs to name.
    if (!first) {
      keys.set("quality", request.quality);
      keys.set("size", request.size.join("x"));
      if (request.frames !== OFFERED.frames) keys.set("frames", request.frames);
      if (request.seed !== OFFERED.seed) keys.set("seed", request.seed);
    }
  }
  if (angle !== null) keys.set("angle", angle);
  return keys.toString();
}

/**
 * @returns {{demonstration: string | null, parameters: object, settings: object | null, angle: number | null}}
 *   settings is null where the link asks for no particular picture, angle where it asks for no particular one
 */
export function readLink(hash, fieldsFor) {
  const keys = new URLSearchParams(hash.replace(/^#/, ""));
  const demonstration = keys.get("demonstration");
  const fields = new Map(fieldsFor(demonstration).map((field) => [field.name, field]));
  const parameters = {};
  const own = new Set(["demonstration", "frames", "size", "quality", "seed", "angle"]);
  for (const [key, text] of keys) {
    if (own.has(key)) continue;
    const field = fields.get(key);
    // A parameter nobody knows goes to the service all the same: it answers with a problem that names it.
    parameters[key] = field ? read(field, text) : text;
  }
  const settings = keys.has("quality")
    ? {
        frames: whole(keys.get("frames"), OFFERED.frames),
        size: keys.has("size")
          ? keys
              .get("size")
              .split("x")
              .map((side) => whole(side, side))
          : [...OFFERED.size],
        quality: keys.get("quality"),
        seed: whole(keys.get("seed"), OFFERED.seed),
      }
    : null;
  const angle = Number(keys.get("angle") ?? NaN);
  return { demonstration, parameters, settings, angle: Number.isFinite(angle) ? angle : null };
}

function whole(text, otherwise) {
  if (text === null || text === "") return otherwise;
  const number = Number(text);
  return Number.isFinite(number) ? number : text;
}
