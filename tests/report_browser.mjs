// SPDX-License-Identifier: Apache-2.0
// What the tests of the report page share: the browser, and how they fail.
import {createRequire} from 'node:module';

export function check(holds, what) {
  if (holds) return;
  console.error(`FAILED: ${what}`);
  process.exit(1);
}

// Chromium without a graphics card, by the playwright at the path `playwright`.
export function launch(playwright) {
  return createRequire(import.meta.url)(playwright).chromium.launch({
    timeout: 600e3,
    executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium',
    args: ['--no-sandbox', '--enable-unsafe-swiftshader'],
  });
}
