// The engine beside the page: takes messages of the page, moves the hair and draws it into the page's canvas.

import start, { Engine } from "./strandline_web.js";

// Seconds of a frame of the engine, and the most of them at once: on a slow machine time slows down.
const FRAME = 1 / 60;
const MOST_FRAMES = 2;
// Milliseconds that a moving picture may take before it becomes coarser, and below which it becomes finer.
const SLOW = 70;
const FAST = 24;
// Coarsest picture of the engine; beyond it the sides shrink by SHRINK, down to LEAST of the canvas.
const COARSEST = 3;
const SHRINK = 0.8;
const LEAST = 0.7;
// Hair rests when no coordinate has moved by more than this in a frame [m], for so many frames.
const REST = 2e-5;
const REST_FRAMES = 20;

let engine;
let canvas;
let context;
let small;
let paused = false;
let last;
let owed = 0;
// Detail: coarseness of the engine's moving pictures, and the share of the canvas that a full picture takes.
let coarseness = 2;
let share = 1;
let smooth = { picture: 40, step: 10, between: 33 };
let places;
let rested = 0;
let still = false;
let told = 0;

const tell = (type, content = {}) => postMessage({ type, ...content });

function paint() {
  const moving = !still;
  const begin = performance.now();
  const bytes = engine.picture(moving ? coarseness : undefined);
  const took = performance.now() - begin;
  const { width, height } = engine;
  if (small?.width !== width || small?.height !== height) {
    small = new OffscreenCanvas(width, height);
  }
  small.getContext("2d").putImageData(new ImageData(new Uint8ClampedArray(bytes.buffer), width, height), 0, 0);
  context.imageSmoothingQuality = "high";
  context.drawImage(small, 0, 0, canvas.width, canvas.height);
  if (moving) {
    smooth.picture += 0.2 * (took - smooth.picture);
    adapt();
  }
}

function adapt() {
  const took = smooth.picture;
  if (took > SLOW && coarseness < COARSEST) {
    coarseness += 1;
  } else if (took > SLOW && share > LEAST) {
    share = Math.max(share * SHRINK, LEAST);
    fit();
  } else if (took < FAST && share < 1) {
    share = Math.min(share / SHRINK, 1);
    fit();
  } else if (took < FAST && coarseness > 0) {
    coarseness -= 1;
  } else {
    return;
  }
  smooth.picture = (SLOW + FAST) / 2;
}

// Full pictures have the size of the canvas, moving ones the present share of it.
function fit() {
  const factor = still ? 1 : share;
  engine.resize(Math.round(canvas.width * factor), Math.round(canvas.height * factor));
}

function step(frames) {
  const begin = performance.now();
  for (let frame = 0; frame < frames; frame += 1) {
    engine.frame();
  }
  smooth.step += 0.2 * ((performance.now() - begin) / frames - smooth.step);
  const now = engine.points();
  const moved = !places || now.length !== places.length || now.some((place, index) => Math.abs(place - places[index]) > REST);
  places = now;
  rested = moved ? 0 : rested + frames;
}

function wake() {
  if (still) {
    still = false;
    fit();
  }
  rested = 0;
}

function tick(now) {
  requestAnimationFrame(tick);
  if (!engine) return;
  try {
    const between = last === undefined ? FRAME * 1e3 : now - last;
    last = now;
    owed = Math.min(owed + between / 1e3 / FRAME, MOST_FRAMES);
    const frames = Math.floor(owed);
    if (still || (frames === 0 && !paused)) return;
    owed -= frames;
    if (!paused) step(frames);
    if (paused || rested > REST_FRAMES) {
      still = true;
      fit();
    }
    paint();
    smooth.between += 0.1 * (Math.min(between, 1e3) - smooth.between);
    if (now - told > 500 || still) {
      told = now;
      tell("figures", {
        rate: 1e3 / smooth.between, picture: smooth.picture, step: smooth.step, still, paused,
        strands: engine.strand_count(), width: engine.width, height: engine.height,
      });
    }
    const notes = engine.notes();
    if (notes.length > 0) tell("notes", { notes });
  } catch (error) {
    fail(error);
  }
}

// A refusal leaves the engine as it was; after a panic the module is of no use.
function fail(error) {
  if (error instanceof WebAssembly.RuntimeError) {
    engine = undefined;
    tell("gone", { message: String(error.message) });
  } else {
    tell("refused", { message: String(error.message ?? error) });
  }
}

const acts = {
  async open({ canvas: given, settings, width, height }) {
    canvas = given;
    context = canvas.getContext("2d", { alpha: false });
    [canvas.width, canvas.height] = [width, height];
    await start({ module_or_path: new URL("strandline_web_bg.wasm", import.meta.url) });
    tell("progress", { text: "Growing hair" });
    try {
      engine = new Engine(settings.map(([key]) => key), settings.map(([, value]) => value), width, height);
    } catch (error) {
      tell("refused", { message: String(error.message) });
      engine = new Engine([], [], width, height);
    }
    paint();
    tell("ready", { seconds: performance.now() / 1e3 });
    requestAnimationFrame(tick);
  },
  set({ key, value }) {
    engine.set(key, value);
    fit();
    tell("given", { given: engine.given() });
  },
  resize({ width, height }) {
    [canvas.width, canvas.height] = [width, height];
    fit();
    paint();
  },
  grab: ({ x, y, radius }) => tell("grabbed", { held: engine.grab(x, y, radius) }),
  drag: ({ x, y }) => engine.drag(x, y),
  release: () => engine.release(),
  reset: () => engine.reset(),
  // Nothing but the waking that follows each message.
  wake() {},
  // A page that is seen again goes on from where it was: the time between is nobody's.
  visible() {
    [last, owed] = [undefined, 0];
  },
  pause({ on }) {
    paused = on;
  },
  file({ name, bytes }) {
    engine.drop_file(name, bytes);
    fit();
    tell("opened", { name });
  },
  // A full picture as a file.
  async save() {
    const [was, before] = [still, share];
    [still, share] = [true, 1];
    fit();
    paint();
    [still, share] = [was, before];
    fit();
    tell("saved", { file: await canvas.convertToBlob({ type: "image/png" }) });
  },
};

onmessage = async ({ data }) => {
  if (data.type !== "open" && !engine) return;
  try {
    await acts[data.type](data);
    if (!["open", "save", "visible"].includes(data.type) && engine) wake();
  } catch (error) {
    fail(error);
  }
};
