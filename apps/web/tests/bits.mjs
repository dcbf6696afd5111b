// Prints the bits of scenes in the module, and the seconds that each took: node bits.mjs FOLDER.
// Fails where the module is too large to load.

import { readFileSync } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { brotliCompressSync } from "node:zlib";

// Of the module with both backends, by brotli [byte]: all that a visitor loads has 2 MB at most.
const MOST_BYTES = 1.55e6;

const folder = process.argv[2];
const bytes = readFileSync(join(folder, "strandline_web_bg.wasm"));
const script = await import(pathToFileURL(join(folder, "strandline_web.js")));
await script.default({ module_or_path: bytes });
for (const name of script.bits_names()) {
  const begin = performance.now();
  console.log(script.bits_line(name));
  console.error(`${name} ${((performance.now() - begin) / 1e3).toFixed(3)} s in the module`);
}
const packed = brotliCompressSync(bytes).length;
console.error(`module: ${(bytes.length / 1e6).toFixed(2)} MB, ${(packed / 1e6).toFixed(2)} MB by brotli`);
if (packed > MOST_BYTES) {
  console.error(`expected ${MOST_BYTES / 1e6} MB by brotli at most`);
  process.exit(1);
}
