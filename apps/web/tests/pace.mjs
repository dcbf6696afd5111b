// Prints the time of a frame of 2,000 guides in the module, two steps, and its memory: node pace.mjs FOLDER.
// The native program's time: the example `web_pace`.

import { readFileSync } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";

const folder = process.argv[2];
const script = await import(pathToFileURL(join(folder, "strandline_web.js")));
const { memory } = await script.default({ module_or_path: readFileSync(join(folder, "strandline_web_bg.wasm")) });
const mebibytes = () => (memory.buffer.byteLength / 2 ** 20).toFixed(0);

const begin = performance.now();
const settings = [["style.strand_count", "2000"], ["groom.bound", "0"], ["motion.name", "shake"]];
const engine = new script.Engine(settings.map(([key]) => key), settings.map(([, value]) => value), 160, 200);
console.log(`grown in ${((performance.now() - begin) / 1e3).toFixed(2)} s`);
const turns = [];
for (let turn = 0; turn < 5; turn += 1) {
  const from = performance.now();
  for (let frame = 0; frame < 20; frame += 1) engine.frame();
  turns.push((performance.now() - from) / 20);
}
console.log(`${Math.min(...turns).toFixed(1)} ms a frame at least, [${turns.map((turn) => turn.toFixed(1)).join(", ")}]`);
const from = performance.now();
engine.picture();
console.log(`a picture of 160 x 200 in ${((performance.now() - from) / 1e3).toFixed(2)} s; ${mebibytes()} MiB`);
