// Makes the still pictures of the page in Chromium without a screen: node pictures.mjs FOLDER CHROMIUM ADDRESS PICTURES POSTER.
// The page as it looks goes into the folder for PICTURES; hair as it looks at first into POSTER, which the page shows while
// it loads.

import { writeFileSync } from "node:fs";
import { join } from "node:path";

import { attach, opens, pause, pictures, problems, run, send, until, value } from "./driver.mjs";

const poster = process.argv[6];
// Size of the poster [pixel], and the most bytes that it may have.
const [WIDTH, HEIGHT] = [1280, 640];
const MOST_BYTES = 60_000;
const QUALITIES = [0.85, 0.8, 0.7, 0.6, 0.5];

// The first picture of a visit without a link, by the module in the page itself, as large as the bytes allow.
const POSTER = `(async () => {
  const module = await import("./strandline_web.js");
  await module.default({ module_or_path: "strandline_web_bg.wasm" });
  const engine = new module.Engine(["style.style"], ["wavy"], ${WIDTH}, ${HEIGHT});
  const bytes = new Uint8ClampedArray(engine.picture());
  const canvas = new OffscreenCanvas(${WIDTH}, ${HEIGHT});
  canvas.getContext("2d").putImageData(new ImageData(bytes, ${WIDTH}, ${HEIGHT}), 0, 0);
  const column = (row) => [...bytes.subarray(4 * ${WIDTH} * row, 4 * ${WIDTH} * row + 3)];
  const stops = [0, 0.25, 0.5, 0.75, 1].map((share) => column(Math.round(share * ${HEIGHT - 1})));
  for (const quality of ${JSON.stringify(QUALITIES)}) {
    const file = await canvas.convertToBlob({ type: "image/webp", quality });
    if (file.size > ${MOST_BYTES}) continue;
    const text = [...new Uint8Array(await file.arrayBuffer())].map((byte) => String.fromCharCode(byte)).join("");
    return { data: btoa(text), quality, stops };
  }
  return undefined;
})()`;

async function keep(name) {
  const { data } = await send("Page.captureScreenshot", { format: "webp", quality: 85 });
  writeFileSync(join(pictures, `${name}.webp`), Buffer.from(data, "base64"));
}

async function make() {
  await attach();
  const size = (width, height, scale = 1) =>
    send("Emulation.setDeviceMetricsOverride", { width, height, deviceScaleFactor: scale, mobile: width < 500 });
  await size(1280, 800);
  await opens("#style.strand_count=64");
  const made = await value(POSTER);
  if (!made) throw new Error(`no poster of ${MOST_BYTES} bytes`);
  const file = Buffer.from(made.data, "base64");
  writeFileSync(poster, file);
  console.log(`the poster has ${file.length} bytes, quality ${made.quality}; its background from top to bottom is ${made.stops.map((color) => `rgb(${color})`).join(" ")}`);

  // Hair in motion, then stopped, so that it is drawn in full.
  const shown = async (name, hash, page, seconds) => {
    await opens(hash, page);
    await pause(1000 * seconds);
    await value("document.getElementById('pause').click()");
    await until("seen.figures?.still");
    await pause(500);
    await keep(name);
  };
  await shown("wide", "#style.style=wavy&style.strand_count=800&motion.name=shake", "", 6);
  await size(390, 844, 2);
  await shown("phone", "#style.style=curly&look.preset=red&style.strand_count=400", "", 4);
  await size(1280, 800);
  await opens("", "how.html");
  for (let stage = 2; stage <= 5; stage += 1) {
    await value("document.getElementById('next').click()");
    await pause(300);
  }
  await pause(5000);
  await value("document.getElementById('pause').click()");
  await until("seen.figures?.still");
  await value("document.querySelector('[data-stage=guides]').scrollIntoView({ block: 'center' })");
  await pause(500);
  await keep("how");
  if (problems.length > 0) throw new Error(`on the console: ${problems.join("; ")}`);
}

run(make, ["--disable-gpu"], 240_000);
