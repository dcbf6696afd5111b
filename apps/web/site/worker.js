// The engine beside the page: takes messages of the page, moves the hair and draws it into the page's canvas.

import start, { Device, Engine } from "./strandline_web.js";

// Seconds of a frame of the engine, and the most of them at once: on a slow machine time slows down.
const FRAME = 1 / 60;
const MOST_FRAMES = 2;
// Milliseconds that a moving picture may take before it becomes coarser, and below which it becomes finer: on the processor,
// and between two pictures of a GPU.
const PACE = { processor: { slow: 70, fast: 24 }, gpu: { slow: 40, fast: 20 } };
// Pictures that a GPU may have before it, and the time that its first one may take [ms].
const MOST_PENDING = 2;
const PATIENCE = 20_000;
// The number of guides fits the machine after so long [ms]: what a step on the processor and a frame of a GPU may cost [ms].
const TRIAL = 1000;
const STEP_COST = 8;
const FRAME_COST = 17.5;
// Coarsest picture of the engine; beyond it the sides shrink by SHRINK, down to LEAST of the canvas.
const COARSEST = 3;
const SHRINK = 0.8;
const LEAST = 0.7;
// Hair rests when no coordinate has moved by more than this in a frame [m], for so many frames.
const REST = 2e-5;
const REST_FRAMES = 20;

let engine;
// Device of the browser with the canvas that it draws; a word why there is none.
let device;
let drawn;
let why;
// What the browser tells of the GPU.
let name = "";
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
let painted;
// Beginning of the trial; false once the machine, a person or a link has chosen.
let trial;
// A hand that a device was asked for.
let asked = false;

const tell = (type, content = {}) => postMessage({ type, ...content });
const place = () => (device ? "gpu" : "processor");

// A device of the browser, unless the link or the browser has none to give.
async function choose(wanted) {
  if (wanted === "cpu") return "asked for by the link";
  if (!navigator.gpu) return "this browser has no WebGPU";
  const adapter = await navigator.gpu.requestAdapter().catch(() => null);
  if (!adapter) return "WebGPU has no adapter here";
  if (wanted !== "gpu" && adapter.info?.isFallbackAdapter) return "WebGPU runs on the processor here";
  name = [adapter.info?.vendor, adapter.info?.architecture].filter(Boolean).join(" ");
  tell("progress", { text: "Asking for the GPU" });
  drawn = new OffscreenCanvas(16, 16);
  try {
    device = await Device.request(drawn);
  } catch (error) {
    return `WebGPU gives no device: ${error.message}`;
  }
  return undefined;
}

// The hair has gone on to the processor, or the GPU is given up.
function lost(reason) {
  [device, why, share] = [undefined, reason, 1];
  fit();
  tell("device", { why });
}

function paintOnDevice() {
  if (!engine.draw(device)) return lost("the GPU was lost");
  context.drawImage(drawn, 0, 0, canvas.width, canvas.height);
}

function paint() {
  if (device && !engine.is_on_device()) lost("the GPU was lost");
  if (device) paintOnDevice();
  if (!device) paintOnProcessor();
}

function paintOnProcessor() {
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

// A GPU draws in full, in fewer pixels where it is slow.
function adapt() {
  const { slow, fast } = PACE[place()];
  const took = smooth.picture;
  if (took > slow && coarseness < COARSEST && !device) {
    coarseness += 1;
  } else if (took > slow && share > LEAST) {
    share = Math.max(share * SHRINK, LEAST);
    fit();
  } else if (took < fast && share < 1) {
    share = Math.min(share / SHRINK, 1);
    fit();
  } else if (took < fast && coarseness > 0 && !device) {
    coarseness -= 1;
  } else {
    return;
  }
  smooth.picture = (slow + fast) / 2;
}

// Chooses the number of guides once by what the first second has cost.
function fitMachine(now) {
  trial ??= now;
  if (trial === false || now - trial < TRIAL) return;
  trial = false;
  // On the processor a step costs as much as it has strands; a GPU keeps up with the screen or does not.
  const keepsUp = smooth.between < FRAME_COST ? Infinity : 0;
  const most = device ? keepsUp : (engine.strand_count() * STEP_COST) / smooth.step;
  const choices = device ? [400, 1600] : [200, 400, 800];
  engine.set_strands(choices.findLast((count) => count <= most) ?? choices[0]);
  places = undefined;
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
  if (!now) return;
  const moved = !places || now.length !== places.length || now.some((place, index) => Math.abs(place - places[index]) > REST);
  places = now;
  rested = moved ? 0 : rested + frames;
}

// What a hand holds, as soon as that is known.
function answer() {
  const held = engine.grabbed();
  asked = held === undefined;
  if (!asked) tell("grabbed", { held });
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
    if (asked) answer();
    const frames = Math.floor(owed);
    if (still || (frames === 0 && !paused) || device?.pending() >= MOST_PENDING) return;
    owed -= frames;
    if (!paused) step(frames);
    if (paused || rested > REST_FRAMES) {
      still = true;
      fit();
    }
    paint();
    if (painted !== undefined) smooth.between += 0.1 * (Math.min(now - painted, 1e3) - smooth.between);
    painted = still ? undefined : now;
    if (device && !still) {
      smooth.picture += 0.1 * (smooth.between - smooth.picture);
      adapt();
    }
    if (!paused) fitMachine(now);
    if (now - told > 500 || still) {
      told = now;
      tell("figures", {
        rate: 1e3 / smooth.between, picture: smooth.picture, step: smooth.step, still, paused, gpu: Boolean(device), name, why,
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
    tell(engine ? "refused" : "unable", { message: String(error.message ?? error) });
  }
}

function grow(keys, values, width, height) {
  if (device) {
    try {
      return Engine.on_device(device, keys, values, width, height);
    } catch (error) {
      // What a setting refuses the processor refuses too.
      const other = new Engine(keys, values, width, height);
      [device, why] = [undefined, `the GPU refuses: ${error.message}`];
      return other;
    }
  }
  return new Engine(keys, values, width, height);
}

// The first step and picture: the GPU compiles what it needs.
async function warm(wanted) {
  tell("progress", { text: "Compiling for the GPU" });
  engine.frame();
  paint();
  const end = performance.now() + PATIENCE;
  while (device?.pending() > 0 && (wanted === "gpu" || performance.now() < end)) {
    await new Promise((resolve) => { setTimeout(resolve, 10); });
  }
  if (device?.pending() > 0) {
    engine.to_processor("its first picture took too long");
    lost("the GPU was too slow");
    paint();
  } else if (device) {
    // What came meanwhile is drawn with the next frame.
    paint();
  }
}

const acts = {
  async open({ canvas: given, settings, plain, width, height, backend }) {
    canvas = given;
    context = canvas.getContext("2d", { alpha: false });
    [canvas.width, canvas.height] = [width, height];
    await start({ module_or_path: new URL("strandline_web_bg.wasm", import.meta.url) });
    why = await choose(backend);
    tell("progress", { text: "Growing hair" });
    const keys = settings.map(([key]) => key);
    const values = settings.map(([, value]) => value);
    try {
      engine = grow(keys, values, width, height);
    } catch (error) {
      tell("refused", { message: String(error.message) });
      engine = grow(plain.map(([key]) => key), plain.map(([, value]) => value), width, height);
    }
    if (keys.includes("style.strand_count")) trial = false;
    if (device) await warm(backend);
    else paint();
    tell("device", { why });
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
  grab({ x, y, radius }) {
    engine.grab(x, y, radius);
    answer();
  },
  drag: ({ x, y }) => engine.drag(x, y),
  release: () => engine.release(),
  reset: () => engine.reset(),
  // Nothing but the waking that follows each message.
  wake() {},
  // Loses the device, as tests do.
  lose: () => device?.lose(),
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
    if (["set", "file", "grab"].includes(data.type)) trial = false;
    if (!["open", "save", "visible"].includes(data.type) && engine) wake();
  } catch (error) {
    fail(error);
  }
};
