// SPDX-License-Identifier: Apache-2.0

// Triangles and lines into an image, with a depth per pixel: what a graphics card does, in the
// processor. Faster than WebGL where that is emulated, because nothing is copied between processes.
//
// Vertices are numbers of entries in `x`, `y` (pixels, y down), `q` (1 / distance, m^-1) and `shade`
// (0 to kShades - 1, position in a table of colours). All of them are linear over the screen. Colours
// are 0xAABBGGRR.
export const kShades = 64;

export class Raster {
  constructor() {
    this.reserve(1024);
    this.resize(1, 1);
  }

  reserve(count) {
    if (this.x?.length >= count) return;
    for (const name of ['x', 'y', 'q', 'shade']) this[name] = new Float64Array(2 * count);
  }

  resize(width, height) {
    this.width = width;
    this.height = height;
    this.image = new ImageData(width, height);
    this.pixels = new Int32Array(this.image.data.buffer);
    this.depth = new Float32Array(width * height);
  }

  clear(color) {
    this.pixels.fill(color);
    this.depth.fill(0);
  }

  // `colors`: Int32Array of kShades. `alpha` < 1 mixes them with what is there and leaves the depth
  // alone. `tested` false: in front of everything.
  triangle(a, b, c, colors, alpha, tested) {
    const {x, y, q, shade, width} = this;
    let t;
    if (y[b] < y[a]) { t = a; a = b; b = t; }
    if (y[c] < y[a]) { t = a; a = c; c = t; }
    if (y[c] < y[b]) { t = b; b = c; c = t; }
    const xa = x[a], ya = y[a], ux = x[b] - xa, uy = y[b] - ya, vx = x[c] - xa, vy = y[c] - ya;
    const area = ux * vy - vx * uy;
    if (area === 0) return;
    const uq = q[b] - q[a], vq = q[c] - q[a], us = shade[b] - shade[a], vs = shade[c] - shade[a];
    const qx = (uq * vy - vq * uy) / area, qy = (vq * ux - uq * vx) / area;
    const sx = (us * vy - vs * uy) / area, sy = (vs * ux - us * vx) / area;
    const long = vx / vy, upper = ux / uy, lower = (vx - ux) / (vy - uy);
    const last = Math.min(this.height, Math.ceil(y[c] - 0.5));
    for (let row = Math.max(0, Math.ceil(ya - 0.5)); row < last; ++row) {
      const down = row + 0.5 - ya;
      const one = xa + long * down;
      const other = down < uy ? xa + upper * down : x[b] + lower * (down - uy);
      const from = Math.max(0, Math.ceil(Math.min(one, other) - 0.5));
      const to = Math.min(width, Math.ceil(Math.max(one, other) - 0.5));
      if (from >= to) continue;
      const right = from + 0.5 - xa;
      const near = q[a] + qx * right + qy * down;
      const s = shade[a] + sx * right + sy * down;
      const begin = row * width + from, end = row * width + to;
      if (alpha < 1 || !tested) this.fillOver(begin, end, near, qx, colors[bounded(s)], alpha, tested);
      else if (us === 0 && vs === 0) this.fillPlain(begin, end, near, qx, colors[bounded(s)]);
      else this.fillShaded(begin, end, near, qx, s, sx, colors);
    }
  }

  fillPlain(i, end, near, step, color) {
    const {pixels, depth} = this;
    for (; i < end; ++i, near += step) {
      if (near <= depth[i]) continue;
      pixels[i] = color;
      depth[i] = near;
    }
  }

  fillShaded(i, end, near, step, s, shadeStep, colors) {
    const {pixels, depth} = this;
    for (; i < end; ++i, near += step, s += shadeStep) {
      if (near <= depth[i]) continue;
      pixels[i] = colors[bounded(s)];
      depth[i] = near;
    }
  }

  fillOver(i, end, near, step, color, alpha, tested) {
    const {pixels, depth} = this;
    for (; i < end; ++i, near += step) {
      if (!tested || near > depth[i]) pixels[i] = alpha < 1 ? mix(pixels[i], color, alpha) : color;
    }
  }

  // One pixel wide, a little in front of the faces that it lies on.
  line(a, b, color) {
    const {x, y, q, width, height, pixels, depth} = this;
    const dx = x[b] - x[a], dy = y[b] - y[a];
    const steps = Math.ceil(Math.max(Math.abs(dx), Math.abs(dy)));
    if (!(steps > 0 && steps < 20000)) return;
    for (let i = 0; i <= steps; ++i) {
      const share = i / steps;
      const column = Math.floor(x[a] + share * dx), row = Math.floor(y[a] + share * dy);
      if (column < 0 || column >= width || row < 0 || row >= height) continue;
      const near = 1.002 * (q[a] + share * (q[b] - q[a]));
      const at = row * width + column;
      if (near <= depth[at]) continue;
      pixels[at] = color;
      depth[at] = near;
    }
  }
}

// At the rim of a face the shade may lie a little outside.
function bounded(shade) {
  const whole = (shade + 0.5) | 0;
  return whole < 0 ? 0 : whole < kShades ? whole : kShades - 1;
}

function mix(below, above, alpha) {
  let color = 0xff << 24;
  for (let shift = 0; shift < 24; shift += 8) {
    const from = below >> shift & 255, to = above >> shift & 255;
    color |= Math.round(from + alpha * (to - from)) << shift;
  }
  return color;
}
