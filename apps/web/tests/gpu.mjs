// Opens the page on WebGPU in Chromium, in software where there is no GPU: node gpu.mjs FOLDER CHROMIUM ADDRESS PICTURES.
// Its two pictures, of the device and of the processor, are written into the folder for PICTURES. Ends with 3 where the
// browser has no adapter.

import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";

import { attach, folder, held, look, mouse, opens, pause, pictures, problems, run, send, until, value } from "./driver.mjs";

// Exit status where the browser has no adapter.
const NO_ADAPTER = 3;
// Small hair without what takes a processor long that plays a GPU: light that is scattered many times.
const SCENE = [
  ["style.strand_count", "32"], ["groom.bound", "0"], ["body.spacing", "0.01"], ["simulation.volume.cells", "[8, 8, 8]"],
  ["look.preset", "thesis"], ["look.follow_strands", "1"], ["look.hair_count", "0"], ["look.width_scale", "10"],
];
const [WIDTH, HEIGHT] = [64, 80];
// Farthest distance of a point after a frame from that of the processor [m]: rounding in other orders (3e-8 found).
const FARTHEST = 1e-6;

const keys = SCENE.map(([key]) => key);
const values = SCENE.map(([, text]) => text);

// A frame of two steps and a picture, by the module in the page itself; numbers come back as text.
const ON_DEVICE = `(async () => {
  const module = await import("./strandline_web.js");
  await module.default({ module_or_path: "strandline_web_bg.wasm" });
  const canvas = new OffscreenCanvas(16, 16);
  const device = await module.Device.request(canvas);
  const engine = module.Engine.on_device(device, ${JSON.stringify(keys)}, ${JSON.stringify(values)}, ${WIDTH}, ${HEIGHT});
  const found = async (look) => {
    for (;;) {
      const thing = look();
      if (thing) return thing;
      await new Promise((resolve) => { setTimeout(resolve, 5); });
    }
  };
  await found(() => engine.frame());
  const points = await found(() => engine.points());
  engine.draw(device);
  const own = new OffscreenCanvas(${WIDTH}, ${HEIGHT}).getContext("2d", { willReadFrequently: true });
  own.drawImage(canvas, 0, 0);
  const bytes = own.getImageData(0, 0, ${WIDTH}, ${HEIGHT}).data;
  await found(() => device.pending() === 0);
  return { points: [...points], bytes: [...bytes], isOnDevice: engine.is_on_device(), notes: engine.notes() };
})()`;

// Writes RGBA as a picture without alpha (PPM).
function write(name, bytes) {
  const colors = Buffer.from(bytes.filter((_, index) => index % 4 !== 3));
  writeFileSync(join(pictures, name), Buffer.concat([Buffer.from(`P6 ${WIDTH} ${HEIGHT} 255\n`), colors]));
}

async function test() {
  await attach();
  await send("Emulation.setDeviceMetricsOverride", { width: 300, height: 300, deviceScaleFactor: 1, mobile: true });
  await opens("#style.strand_count=32", "?backend=cpu");
  held((await value("seen.device")) === "asked for by the link", "a link asks for the processor");
  if (!(await value("navigator.gpu?.requestAdapter().then(Boolean)"))) return NO_ADAPTER;

  // By the module alone, held to the module in Node.
  const begin = Date.now();
  const shown = await value(ON_DEVICE);
  console.log(`a step, points and a picture on the device in ${(Date.now() - begin) / 1e3} s`);
  held(shown.isOnDevice, `the device has done it: ${shown.notes.join("; ")}`);
  const script = await import(pathToFileURL(join(folder, "strandline_web.js")));
  await script.default({ module_or_path: readFileSync(join(folder, "strandline_web_bg.wasm")) });
  const engine = new script.Engine(keys, values, WIDTH, HEIGHT);
  const rest = engine.points();
  engine.frame();
  const own = engine.points();
  const farthest = (one, other) => one.reduce((most, place, index) => Math.max(most, Math.abs(place - other[index])), 0);
  const apart = own.length === shown.points.length ? farthest(own, shown.points) : Infinity;
  console.log(`two steps: ${apart} m from the processor's, which moved by ${farthest(own, rest)} m`);
  held(apart < FARTHEST && farthest(own, rest) > 2 * FARTHEST, "two steps on the device are those of the processor");
  write("device.ppm", shown.bytes);
  write("processor.ppm", [...engine.picture()]);

  // In the page: shorter hair on a head that is turned from the beginning, a turn too fast to follow, a hand, and the device
  // lost. Nothing of it may wait for the device.
  const turned = [["motion.name", "still"], ["groom.length", "0.8"], ["motion.rotation", "[0, 40, 0]"]];
  const hash = `#${new URLSearchParams([...SCENE, ...turned])}`;
  await opens(hash, "?backend=gpu");
  await until("seen.device === 'gpu' && seen.figures?.gpu");
  await look("gpu");
  held(await value("document.getElementById('figures').textContent.includes('GPU')"), "the page moves and draws on the device");
  await value("import('./stage.js').then(({ set }) => set('motion.rotation', '[0, -40, 0]'))");
  await until("seen.given.join().includes('[0, -40, 0]')");
  await value("seen.figures = undefined");
  await until("seen.figures?.rate > 0");
  held(await value("seen.figures.gpu && seen.refused.length === 0"), "hair on the device is carried over a jump of the head");
  const box = await value("(({ x, y, width, height }) => ({ x, y, width, height }))(document.getElementById('hair').getBoundingClientRect())");
  const at = (x, y) => [box.x + x * box.width, box.y + y * box.height];
  // Wherever guides of so few lie.
  let taken = false;
  for (const place of [[0.55, 0.2], [0.45, 0.2], [0.5, 0.3], [0.4, 0.4], [0.6, 0.4]]) {
    await value("seen.grabbed = undefined");
    await mouse("mousePressed", ...at(...place));
    await until("seen.grabbed !== undefined");
    taken = await value("seen.grabbed");
    if (taken) {
      await mouse("mouseMoved", ...at(place[0] + 0.2, place[1]));
      await until("seen.figures?.still === false");
      break;
    }
    await mouse("mouseReleased", ...at(...place));
  }
  held(taken, "hair on the device is grabbed and pulled");
  await value("import('./stage.js').then(({ ask }) => ask('lose'))");
  await until("seen.device === 'the GPU was lost'");
  await value("seen.figures = undefined");
  await until("seen.figures && !seen.figures.gpu && seen.figures.rate > 0");
  await mouse("mouseReleased", ...at(0.8, 0.3));
  await pause(300);
  held((await value("seen.refused.join()")) === "", "the device is lost, and the hair goes on on the processor");
  await look("lost");
  held(problems.length === 0, `nothing on the console: ${problems.join("; ")}`);
  return 0;
}

// Software, as far as the machine has no GPU.
const flags = [
  "--enable-unsafe-webgpu", "--ignore-gpu-blocklist", "--enable-gpu", "--enable-features=Vulkan", "--use-vulkan=swiftshader",
  "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
];
run(test, flags, 110_000);
