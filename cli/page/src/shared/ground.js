// SPDX-License-Identifier: Apache-2.0
import * as THREE from 'three';
import {material} from './robot.js';

const kUnknown = -32768;
const kMostCells = 12000;  // that are drawn: software renderers draw them too
const kRaised = 0.003;     // m, so that it shows on the ground it was made from

// What `map.get` answers: {columns, rows, resolution, origin, scale, heights}. undefined: it has no heights.
export function decodeMap(map) {
  if (!map?.heights) return undefined;
  const text = atob(map.heights), bytes = Uint8Array.from(text, (one) => one.charCodeAt(0));
  const values = new Int16Array(bytes.buffer);
  return {...map, height: (i, j) => {
    const value = values[j * map.columns + i];
    return value === kUnknown || value === undefined ? NaN : map.scale * value;
  }};
}

// The ground as the robot knows it, between the centres of cells that it knows.
export class Ground {
  constructor() {
    this.mesh = new THREE.Mesh(new THREE.BufferGeometry(), material('#7fa878', 0.6));
    this.mesh.material.side = THREE.DoubleSide;
    this.mesh.frustumCulled = false;
    this.mesh.visible = false;
  }

  show(map) {
    const known = decodeMap(map);
    this.map = known;
    this.mesh.visible = Boolean(known);
    if (!known) return;
    const {columns, rows, resolution, origin: [x, y]} = known;
    const by = Math.max(1, Math.ceil(Math.sqrt(columns * rows / kMostCells)));
    const index = new Map(), points = [], faces = [];
    const vertex = (i, j) => {
      const key = j * columns + i;
      if (index.has(key)) return index.get(key);
      const z = i < columns && j < rows ? known.height(i, j) : NaN;
      const at = Number.isFinite(z) ? points.length / 3 : undefined;
      if (at !== undefined) points.push(x + resolution * (i + 0.5), y + resolution * (j + 0.5), z + kRaised);
      index.set(key, at);
      return at;
    };
    for (let j = 0; j < rows; j += by) {
      for (let i = 0; i < columns; i += by) {
        const [a, b, c, d] = [vertex(i, j), vertex(i + by, j), vertex(i + by, j + by), vertex(i, j + by)];
        if (a !== undefined && b !== undefined && c !== undefined) faces.push(a, b, c);
        if (a !== undefined && c !== undefined && d !== undefined) faces.push(a, c, d);
      }
    }
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(points), 3));
    geometry.setIndex(faces);
    geometry.computeVertexNormals();
    this.mesh.geometry.dispose();
    this.mesh.geometry = geometry;
  }
}
