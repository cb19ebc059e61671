// SPDX-License-Identifier: Apache-2.0
import {defineConfig} from 'vite';

// Everything into the one HTML file: it is opened from a disk, without any network.
function inline() {
  return {
    name: 'inline',
    enforce: 'post',
    generateBundle(_, bundle) {
      const page = bundle['index.html'];
      for (const [name, part] of Object.entries(bundle)) {
        if (part === page) continue;
        const isScript = part.type === 'chunk';
        const text = isScript ? part.code.replaceAll('</script', '<\\/script') : String(part.source);
        const tag = isScript ? /<script[^>]*src="[^"]*"[^>]*><\/script>/ : /<link[^>]*stylesheet[^>]*>/;
        const with_ = isScript ? '' : `<style>${text}</style>`;
        page.source = page.source.replace(tag, () => with_);
        // After the data, which it reads.
        if (isScript) {
          page.source = page.source.replace(
              '</body>', () => `<script type="module">${text}</script></body>`);
        }
        delete bundle[name];
      }
    },
  };
}

export default defineConfig({
  base: './',
  build: {assetsInlineLimit: 1e8, cssCodeSplit: false, modulePreload: false, outDir: 'dist'},
  plugins: [inline()],
});
