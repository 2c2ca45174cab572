// What is asked of the service: demonstration, parameters, frames, size, quality, seed.

import { normalise } from "./angle.js";

/** The turning picture that a visitor sees before having asked for anything. */
export const FIRST_LOOK = Object.freeze({ frames: 36, size: [384, 384], quality: "draft", seed: 0 });

/** What the form offers to begin with (the service's own defaults). */
export const OFFERED = Object.freeze({ frames: 36, size: [512, 512], quality: "standard", seed: 0 });

export const QUALITIES = ["draft", "standard", "fine"];

/** Whether two values are the same JSON. */
export function equal(a, b) {
  return JSON.stringify(a) === JSON.stringify(b);
}

/** What is in the scene, wherever the stage stands: two requests of one scene show the same thing at one angle. */
export function sceneKey(request) {
  const { first_angle_deg: _, ...parameters } = request.parameters;
  return JSON.stringify([request.demonstration, Object.entries(parameters).sort(([a], [b]) => (a < b ? -1 : 1))]);
}

/** The scene and how it is drawn: pictures of one look are interchangeable. */
export function lookKey(request) {
  return JSON.stringify([sceneKey(request), request.size, request.quality, request.seed]);
}

export function firstAngle(request) {
  return Number(request.parameters.first_angle_deg ?? 0);
}

/** The stage's angle in frame i. */
export function frameAngle(request, index) {
  return normalise(firstAngle(request) + (360 * index) / request.frames);
}

/** The frame that stands nearest to an angle. */
export function nearestFrame(request, angle) {
  const step = 360 / request.frames;
  return Math.round(normalise(angle - firstAngle(request)) / step) % request.frames;
}

/** The same scene with the stage at one exact angle. */
export function still(request, angle, quality = request.quality) {
  const parameters = { ...request.parameters, first_angle_deg: normalise(angle) };
  return { ...request, parameters, frames: 1, quality };
}
