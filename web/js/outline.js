// The outline of a convex body seen from above.

/** Twice the signed area of a triangle; positive for a left turn. */
const turn = (a, b, c) => (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);

/**
 * Convex hull in the plane (Andrew's monotone chain).
 *
 * @param {number[][]} points [x, y, …]
 * @returns {number[][]} the corners [x, y], counter-clockwise
 */
export function outline(points) {
  const sorted = points.map(([x, y]) => [x, y]).sort((a, b) => a[0] - b[0] || a[1] - b[1]);
  const half = (list) => {
    const chain = [];
    for (const point of list) {
      while (chain.length > 1 && turn(chain.at(-2), chain.at(-1), point) <= 1e-9) chain.pop();
      chain.push(point);
    }
    return chain.slice(0, -1);
  };
  return [...half(sorted), ...half(sorted.reverse())];
}
