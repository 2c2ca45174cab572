// The few closed forms that the text under the picture quotes. The pictures themselves come from the service.

const RADIAN = Math.PI / 180;

/**
 * Walk-off of the extraordinary ray whose wave normal is the vertical (normal incidence on a horizontal face).
 *
 * Source: tan of the angle between ray and wave normal in a uniaxial crystal,
 * (n_o² − n_e²) sinθ cosθ / (n_e² cos²θ + n_o² sin²θ), θ between wave normal and optic axis: 0.109 for a cleavage
 * face of calcite. The ray leans away from the axis in a negative crystal, towards it in a
 * positive one; only the size is returned.
 *
 * @param {number} ordinary n_o
 * @param {number} extraordinary n_e
 * @param {number[]} axis direction of the optic axis [x, y, z]
 * @returns {{tangent: number, degrees: number, tilt: number}} size of the walk-off, and the axis' angle to the vertical
 */
export function walkOff(ordinary, extraordinary, axis) {
  const [x, y, z] = axis;
  const tilt = Math.atan2(Math.hypot(x, y), Math.abs(z));
  const s = Math.sin(tilt);
  const c = Math.cos(tilt);
  const top = (ordinary ** 2 - extraordinary ** 2) * s * c;
  const tangent = Math.abs(top / (extraordinary ** 2 * c * c + ordinary ** 2 * s * s));
  return { tangent, degrees: Math.atan(tangent) / RADIAN, tilt: tilt / RADIAN };
}

/** Azimuth of a direction in the picture of a vertical view, degrees counter-clockwise from +x. */
export function azimuth(axis) {
  return Math.atan2(axis[1], axis[0]) / RADIAN;
}
