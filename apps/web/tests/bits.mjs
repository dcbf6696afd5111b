// Prints the bits of scenes in the module, and the seconds that each took: node bits.mjs FOLDER.
// Fails where the module, or all that a visitor loads, is too large.

import { readdirSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { brotliCompressSync } from "node:zlib";

// Of the module with both backends, and of all that a visitor loads, by brotli [byte].
const MOST_BYTES = 1.45e6;
const MOST_BYTES_IN_ALL = 2e6;

const folder = process.argv[2];
const bytes = readFileSync(join(folder, "strandline_web_bg.wasm"));
const script = await import(pathToFileURL(join(folder, "strandline_web.js")));
await script.default({ module_or_path: bytes });
for (const name of script.bits_names()) {
  const begin = performance.now();
  console.log(script.bits_line(name));
  console.error(`${name} ${((performance.now() - begin) / 1e3).toFixed(3)} s in the module`);
}
const size = (bytes) => brotliCompressSync(bytes).length;
const packed = size(bytes);
const all = readdirSync(folder).map((name) => size(readFileSync(join(folder, name))));
const inAll = all.reduce((sum, bytes) => sum + bytes, 0);
console.error(`module: ${(bytes.length / 1e6).toFixed(2)} MB, ${(packed / 1e6).toFixed(2)} MB by brotli; all files ${(inAll / 1e6).toFixed(2)} MB`);
if (packed > MOST_BYTES || inAll > MOST_BYTES_IN_ALL) {
  console.error(`expected ${MOST_BYTES / 1e6} MB by brotli at most, and ${MOST_BYTES_IN_ALL / 1e6} MB in all`);
  process.exit(1);
}
