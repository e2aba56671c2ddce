// Makes ../assets/report.js of what is in src/, and ../assets/LICENCES.txt of what is bundled. `npm ci && npm run build`.

import { readFileSync, readdirSync, writeFileSync } from 'node:fs';

import { build } from 'esbuild';

const here = new URL('.', import.meta.url);
const file = (name) => new URL(name, here);
// FNV-1a of 64 bits over names and contents of all that the bundle is made of; the test `the_bundle_is_that_of_its_sources` does the same.
let hash = 0xcbf29ce484222325n;
const feed = (buffer) => { for (const byte of buffer) hash = BigInt.asUintN(64, (hash ^ BigInt(byte)) * 0x100000001b3n); };
for (const name of ['build.mjs', 'package-lock.json', 'package.json', ...readdirSync(file('src/')).sort().map((f) => `src/${f}`)]) {
  const text = readFileSync(file(name));
  feed(Buffer.from(`${name}\n${text.length}\n`));
  feed(text);
}
const sources = hash.toString(16).padStart(16, '0');
const { version: three } = JSON.parse(readFileSync(file('node_modules/three/package.json')));
const { version: uplot } = JSON.parse(readFileSync(file('node_modules/uplot/package.json')));
const out = await build({
  entryPoints: [file('src/main.js').pathname], bundle: true, minify: true, format: 'iife', target: 'es2022', loader: { '.css': 'text' }, charset: 'utf8', write: false, legalComments: 'none',
});
const [bundle] = out.outputFiles;
const head = `/* Made by crates/pipeline/web/build.mjs; do not edit. Sources ${sources}. With three ${three} and uPlot ${uplot} (MIT), see LICENCES.txt. */\n`;
writeFileSync(file('../assets/report.js'), head + bundle.text.replaceAll('</script', '<\\/script'));
const licence = (name, path) => `${name}\n\n${readFileSync(file(path), 'utf8').trim()}\n`;
writeFileSync(file('../assets/LICENCES.txt'), ['report.js holds, beside the code of this project:\n', licence(`three ${three}`, 'node_modules/three/LICENSE'), licence(`uPlot ${uplot}`, 'node_modules/uplot/LICENSE')].join('\n'));
console.log(`report.js ${(head.length + bundle.text.length) / 1000} kB, sources ${sources}`);
