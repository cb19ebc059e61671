// SPDX-License-Identifier: Apache-2.0
import * as THREE from 'three';
import {SoftwareRenderer} from './software_renderer.js';

// On the graphics card, or undefined if there is none. `emulated`: even if WebGL is only emulated,
// which is slower than SoftwareRenderer.
function hardwareRenderer(emulated) {
  const canvas = document.createElement('canvas');
  const context = canvas.getContext('webgl2', {antialias: true});
  if (!context) return undefined;
  const info = context.getExtension('WEBGL_debug_renderer_info');
  const name = info ? context.getParameter(info.UNMASKED_RENDERER_WEBGL) : '';
  if (emulated || !/swiftshader|llvmpipe|software|basic render/i.test(name)) {
    return new THREE.WebGLRenderer({canvas, context});
  }
  context.getExtension('WEBGL_lose_context')?.loseContext();
  return undefined;
}

// What draws the scene; the page with #renderer=webgl or #renderer=software at the end of its address
// gets that.
export function chooseRenderer() {
  const wanted = new URLSearchParams(location.hash.slice(1)).get('renderer');
  const hardware = wanted === 'software' ? undefined : hardwareRenderer(wanted === 'webgl');
  return hardware ?? new SoftwareRenderer();
}
