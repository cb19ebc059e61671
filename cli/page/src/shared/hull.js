// SPDX-License-Identifier: Apache-2.0

// The part of a convex polygon, a list of [x, y], within back <= x <= front and right <= y <= left
// (Sutherland and Hodgman).
export function clip(polygon, {back, front, right, left}) {
  let inside = polygon;
  for (const [axis, sign, bound] of [[0, -1, -back], [0, 1, front], [1, -1, -right], [1, 1, left]]) {
    const over = (p) => sign * p[axis] - bound;
    inside = inside.flatMap((b, i) => {
      const a = inside.at(i - 1), from = over(a), to = over(b);
      const cut = from > 0 !== to > 0 ?
          [a.map((value, k) => value + from / (from - to) * (b[k] - value))] : [];
      return to > 0 ? cut : [...cut, b];
    });
  }
  return inside;
}

// Convex hull in x and y, counter-clockwise (Andrew's monotone chain). The points keep their z.
export function hull(points) {
  const sorted = [...points].sort((a, b) => a.x - b.x || a.y - b.y);
  const half = (ordered) => {
    const chain = [];
    for (const p of ordered) {
      while (chain.length > 1) {
        const [a, b] = chain.slice(-2);
        if ((b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x) > 0) break;
        chain.pop();
      }
      chain.push(p);
    }
    return chain.slice(0, -1);
  };
  return [...half(sorted), ...half(sorted.reverse())];
}
