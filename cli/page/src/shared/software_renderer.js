// SPDX-License-Identifier: Apache-2.0
import * as THREE from 'three';
import {kShades, Raster} from './raster.js';

const kNear = 0.05;  // m before the camera, nothing nearer is drawn

// As a pixel of Raster.
function pixel(color) {
  const [r, g, b] = color.clone().convertLinearToSRGB().toArray().map((value) => Math.round(255 * value));
  return 0xff << 24 | b << 16 | g << 8 | r;
}

// Draws a scene of three.js without WebGL: meshes of one Lambert or plain material each, lines, and
// one hemisphere light. In place of a WebGLRenderer where that has no graphics card.
export class SoftwareRenderer {
  constructor() {
    this.domElement = document.createElement('canvas');
    this.context = this.domElement.getContext('2d', {alpha: false});
    this.raster = new Raster();
    this.colors = new WeakMap();  // of a material, by shade
    this.ratio = 1;
    this.size = [1, 1];
    this.modelView = new THREE.Matrix4();
    this.normal = new THREE.Matrix3();
  }

  setPixelRatio(ratio) {
    this.ratio = ratio;
    this.setSize(...this.size);
  }

  setSize(width, height) {
    const canvas = this.domElement;
    this.size = [width, height];
    canvas.width = Math.max(1, Math.floor(width * this.ratio));
    canvas.height = Math.max(1, Math.floor(height * this.ratio));
    canvas.style.width = `${width}px`;
    canvas.style.height = `${height}px`;
    this.raster.resize(canvas.width, canvas.height);
  }

  render(scene, camera) {
    const began = performance.now();
    scene.updateMatrixWorld();
    camera.updateMatrixWorld();
    this.view = camera.matrixWorldInverse;
    this.focal = this.raster.height / 2 / Math.tan(THREE.MathUtils.degToRad(camera.fov / 2));
    this.raster.clear(pixel(scene.background));
    const drawn = [];
    scene.traverseVisible((object) => {
      if (object.isHemisphereLight) this.light = object;
      else if (object.geometry?.attributes.position) drawn.push(object);
    });
    const order = ({renderOrder, material}) => 2 * renderOrder + (material.transparent ? 1 : 0);
    drawn.sort((a, b) => order(a) - order(b));
    for (const object of drawn) {
      this.project(object);
      if (object.isMesh) this.drawFaces(object);
      else this.drawLines(object);
    }
    this.context.putImageData(this.raster.image, 0, 0);
    this.milliseconds = performance.now() - began;
  }

  // Vertices of an object as the camera sees them: m, z backwards. Then on the screen, with shades.
  project({geometry, matrixWorld, material}) {
    const {raster, light} = this;
    const {position, normal} = geometry.attributes;
    this.count = position.count;
    raster.reserve(this.count + 2);  // and those that clipping adds
    if (!(this.seen?.length >= 3 * (this.count + 2))) {
      this.seen = new Float64Array(6 * (this.count + 2));
    }
    const m = this.modelView.multiplyMatrices(this.view, matrixWorld).elements, from = position.array;
    for (let i = 0, k = 0; i < this.count; ++i, k += 3) {
      const x = from[k], y = from[k + 1], z = from[k + 2];
      this.seen[k] = m[0] * x + m[4] * y + m[8] * z + m[12];
      this.seen[k + 1] = m[1] * x + m[5] * y + m[9] * z + m[13];
      this.seen[k + 2] = m[2] * x + m[6] * y + m[10] * z + m[14];
      this.place(i);
    }
    if (!material.isMeshLambertMaterial || !normal) {
      raster.shade.fill(0, 0, this.count);
      return;
    }
    const n = this.normal.getNormalMatrix(matrixWorld).elements, of = normal.array;
    const {x: lx, y: ly, z: lz} = this.up ??= light.position.clone().normalize();
    for (let i = 0, k = 0; i < this.count; ++i, k += 3) {
      const x = n[0] * of[k] + n[3] * of[k + 1] + n[6] * of[k + 2];
      const y = n[1] * of[k] + n[4] * of[k + 1] + n[7] * of[k + 2];
      const z = n[2] * of[k] + n[5] * of[k + 1] + n[8] * of[k + 2];
      const share = (lx * x + ly * y + lz * z) / Math.sqrt(x * x + y * y + z * z);
      raster.shade[i] = (0.5 + 0.5 * share) * (kShades - 1);
    }
  }

  place(i) {
    const {raster, seen, focal} = this;
    const q = -1 / seen[3 * i + 2];
    raster.x[i] = raster.width / 2 + focal * q * seen[3 * i];
    raster.y[i] = raster.height / 2 - focal * q * seen[3 * i + 1];
    raster.q[i] = q;
  }

  ahead(i) { return this.seen[3 * i + 2] < -kNear; }

  // A vertex `to` between two others, where their edge comes nearer than kNear.
  cut(a, b, to) {
    const {seen, raster: {shade}} = this;
    const share = (-kNear - seen[3 * a + 2]) / (seen[3 * b + 2] - seen[3 * a + 2]);
    for (let axis = 0; axis < 3; ++axis) {
      seen[3 * to + axis] = seen[3 * a + axis] + share * (seen[3 * b + axis] - seen[3 * a + axis]);
    }
    shade[to] = shade[a] + share * (shade[b] - shade[a]);
    this.place(to);
    return to;
  }

  colorsOf(material) {
    let colors = this.colors.get(material);
    if (colors) return colors;
    const light = new THREE.Color();
    colors = Int32Array.from({length: kShades}, (_, shade) => {
      if (!material.isMeshLambertMaterial) return pixel(material.color);
      light.lerpColors(this.light.groundColor, this.light.color, shade / (kShades - 1));
      const lit = light.multiplyScalar(this.light.intensity / Math.PI).multiply(material.color);
      return pixel(lit.setRGB(...lit.toArray().map((value) => Math.min(1, value))));
    });
    this.colors.set(material, colors);
    return colors;
  }

  drawFaces({geometry, material}) {
    const {raster} = this, {x, y} = raster;
    const colors = this.colorsOf(material), alpha = material.transparent ? material.opacity : 1;
    const both = material.side === THREE.DoubleSide, tested = material.depthTest;
    const draw = (a, b, c) => {
      const turn = (x[b] - x[a]) * (y[c] - y[a]) - (x[c] - x[a]) * (y[b] - y[a]);
      if (both || turn < 0) raster.triangle(a, b, c, colors, alpha, tested);
    };
    const index = geometry.index?.array, size = index?.length ?? this.count;
    for (let i = 0; i < size; i += 3) {
      const a = index ? index[i] : i, b = index ? index[i + 1] : i + 1, c = index ? index[i + 2] : i + 2;
      const count = this.ahead(a) + this.ahead(b) + this.ahead(c);
      if (count === 3) draw(a, b, c);
      else if (count > 0) this.drawClipped([a, b, c], draw);
    }
  }

  drawClipped(corners, draw) {
    const kept = [];
    let next = this.count;
    corners.forEach((a, i) => {
      const b = corners[(i + 1) % 3];
      if (this.ahead(a)) kept.push(a);
      if (this.ahead(a) !== this.ahead(b)) kept.push(this.cut(a, b, next++));
    });
    for (let i = 2; i < kept.length; ++i) draw(kept[0], kept[i - 1], kept[i]);
  }

  drawLines(object) {
    const [color] = this.colorsOf(object.material);
    const step = object.isLineSegments ? 2 : 1;
    const ends = object.isLineLoop ? this.count : this.count - 1;
    for (let i = 0; i < ends; i += step) {
      let a = i, b = (i + 1) % this.count;
      if (!this.ahead(a) && !this.ahead(b)) continue;
      if (!this.ahead(a)) a = this.cut(a, b, this.count);
      else if (!this.ahead(b)) b = this.cut(a, b, this.count);
      this.raster.line(a, b, color);
    }
  }
}
