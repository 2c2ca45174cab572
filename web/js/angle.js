// Angles of the stage, in degrees, counter-clockwise as seen in the picture.

/** The same direction in [0, 360), freed of the last digits' noise. */
export function normalise(degrees) {
  const turned = ((degrees % 360) + 360) % 360;
  const rounded = Math.round(turned * 1e9) / 1e9;
  return rounded === 360 ? 0 : rounded;
}

/** The smaller angle between two directions, in [0, 180]. */
export function apart(a, b) {
  const d = Math.abs(normalise(a) - normalise(b));
  return Math.min(d, 360 - d);
}

/** Whether two angles are one and the same position of the stage. */
export function same(a, b) {
  return apart(a, b) < 1e-6;
}

/** How many decimals (at most 4) tell an angle exactly. */
export function decimals(degrees) {
  for (let n = 0; n < 4; n += 1) {
    if (Math.abs(degrees * 10 ** n - Math.round(degrees * 10 ** n)) < 1e-6) return n;
  }
  return 4;
}
