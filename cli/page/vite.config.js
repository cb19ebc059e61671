// SPDX-License-Identifier: Apache-2.0
import {defineConfig} from 'vite';

// Everything into the one HTML file: it is opened from a disk, without any network, or comes from a
// server that has nothing else.
function inline() {
  return {
    name: 'inline',
    enforce: 'post',
    generateBundle(_, bundle) {
      const page = Object.values(bundle).find(({fileName}) => fileName.endsWith('.html'));
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

// One page for each build: `--mode report` or `--mode view` is the name of its HTML file. Together they
// would share chunks, and none could be one file.
export default defineConfig(({mode}) => ({
  base: './',
  build: {assetsInlineLimit: 1e8, cssCodeSplit: false, modulePreload: false, outDir: 'dist', emptyOutDir: false,
          rollupOptions: {input: `${mode}.html`}},
  plugins: [inline()],
}));
