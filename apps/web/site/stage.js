// Hair on a page: the worker that moves and draws it, its canvas, the pointer and the keys. Nothing here waits for the worker.

export const find = (id) => document.getElementById(id);
const canvas = find("hair");

// Radius of the hand [m], of one that keys lead more; degrees of a turn by a key and across the canvas; farthest turns [degrees].
const HAND = 0.025;
const KEY_HAND = 0.05;
const KEY_TURN = 6;
const DRAG_TURN = 160;
const FARTHEST = { pitch: 35, yaw: 80 };
// Way of a hand by a key, of the canvas; place where it begins.
const KEY_WAY = 0.03;
const KEY_PLACE = { x: 0.5, y: 0.3 };
// Pixels of the picture at most, by what draws it.
const MOST_PIXELS = { processor: 720 * 900, gpu: 1200 * 1200 };

const worker = new Worker("worker.js", { type: "module" });
export const ask = (type, content = {}, moved = []) => worker.postMessage({ type, ...content }, moved);
export const set = (key, value) => ask("set", { key, value: String(value) });

export const state = { held: undefined, dragging: undefined, hand: undefined, turn: { pitch: 0, yaw: 0 }, ready: false, gpu: false };

// What tests look at, and nothing else.
export const seen = { refused: [], figures: undefined, grabbed: undefined, opened: undefined, saved: undefined, given: [], device: undefined };

function size() {
  const box = canvas.getBoundingClientRect();
  const wanted = Math.max(box.width * box.height, 1) * devicePixelRatio ** 2;
  const factor = devicePixelRatio * Math.min(1, Math.sqrt(MOST_PIXELS[state.gpu ? "gpu" : "processor"] / wanted));
  return { width: Math.max(16, Math.round(box.width * factor)), height: Math.max(16, Math.round(box.height * factor)) };
}

export function turn(pitch, yaw) {
  const within = (angle, most) => Math.max(-most, Math.min(most, angle));
  const next = { pitch: within(pitch, FARTHEST.pitch), yaw: within(yaw, FARTHEST.yaw) };
  if (next.pitch === state.turn.pitch && next.yaw === state.turn.yaw) return;
  state.turn = next;
  set("motion.rotation", `[${state.turn.pitch.toFixed(1)}, ${state.turn.yaw.toFixed(1)}, 0]`);
}

let quiet;
export function problem(message) {
  seen.refused.push(message);
  find("problem").textContent = message;
  find("problem").hidden = false;
  clearTimeout(quiet);
  quiet = setTimeout(() => { find("problem").hidden = true; }, 12_000);
}

// A program that does not run here: words that stay, over a still picture where no hair has been shown.
export function stop(message) {
  problem(message);
  clearTimeout(quiet);
  find("progress").hidden = true;
  if (state.ready) return;
  find("poster").hidden = false;
  find("hint").textContent = "A still picture: the hair does not move here.";
}

const HINT = find("hint").textContent;
const hint = () => {
  find("hint").textContent = state.hand ? "Arrow keys pull the hair, Enter lets it go." : HINT;
};

const told = {
  progress: ({ text }) => { find("progress").textContent = text; },
  ready() {
    state.ready = true;
    find("progress").hidden = true;
    find("poster").classList.add("gone");
    if (state.gpu) ask("resize", size());
  },
  // Without a word why not, a GPU simulates and draws.
  device({ why }) {
    seen.device = why ?? "gpu";
    state.gpu = why === undefined;
    if (state.ready) ask("resize", size());
  },
  given: ({ given }) => { seen.given = given; },
  refused: ({ message }) => problem(message),
  gone: ({ message }) => stop(`The program has stopped: ${message}. Load the page again.`),
  unable: ({ message }) => stop(`The program does not run in this browser: ${message}`),
  grabbed({ held }) {
    seen.grabbed = held;
    if (state.hand) {
      if (!held) {
        state.hand = undefined;
        problem("There is no hair in the middle: turn the head with the arrow keys first.");
      }
      return hint();
    }
    // The pointer may be up by now.
    if (!state.dragging) return held ? ask("release") : undefined;
    state.held = held;
  },
  opened({ name }) { seen.opened = name; },
  notes() {},
  figures(figures) {
    seen.figures = figures;
    const { rate, picture, step, still, paused, strands, width, height, gpu, name, why } = figures;
    const pace = paused ? "paused" : still ? "at rest" : `${rate.toFixed(0)} frames/s`;
    const moving = still || gpu ? "" : `, step ${step.toFixed(0)} ms, picture ${picture.toFixed(0)} ms`;
    const place = gpu ? `GPU ${name}`.trim() : `Processor (${why})`;
    find("figures").textContent = `${place}, ${strands} guides, ${width} × ${height}: ${pace}${moving}`;
  },
  saved({ file }) { seen.saved = file; },
};
worker.onmessage = ({ data }) => told[data.type](data);
worker.onerror = () => stop("The program does not start: this page needs a browser of 2023 or newer, and a server.");

// Adds to what the page does with a message of the worker.
export function on(type, act) {
  const before = told[type];
  told[type] = (content) => {
    before(content);
    act(content);
  };
}

// Pointer: hair where there is some, else the head.
const place = (event) => {
  const box = canvas.getBoundingClientRect();
  return { x: (event.clientX - box.left) / box.width, y: (event.clientY - box.top) / box.height };
};
canvas.addEventListener("pointerdown", (event) => {
  if (!event.isPrimary || event.button !== 0) return;
  if (state.hand) openHand();
  canvas.setPointerCapture(event.pointerId);
  state.dragging = { ...place(event), ...state.turn };
  state.held = undefined;
  canvas.classList.add("holding");
  ask("grab", { ...place(event), radius: HAND });
});
let moved;
canvas.addEventListener("pointermove", (event) => {
  if (!state.dragging || state.held === undefined) return;
  // One message for each frame that the screen shows.
  moved ??= requestAnimationFrame(() => {
    moved = undefined;
    if (!state.dragging) return;
    const { x, y } = place(event);
    const from = state.dragging;
    if (state.held) ask("drag", { x, y });
    else turn(from.pitch + (y - from.y) * DRAG_TURN, from.yaw + (x - from.x) * DRAG_TURN);
  });
});
const letGo = () => {
  if (!state.dragging) return;
  if (state.held) ask("release");
  state.dragging = undefined;
  canvas.classList.remove("holding");
};
canvas.addEventListener("pointerup", letGo);
canvas.addEventListener("pointercancel", letGo);

export const pause = () => {
  const on = find("pause").getAttribute("aria-pressed") !== "true";
  find("pause").setAttribute("aria-pressed", String(on));
  ask("pause", { on });
};

// Keys: arrows turn the head, or pull the hair that Enter has taken.
function openHand() {
  state.hand = undefined;
  ask("release");
  hint();
}
function closeHand() {
  if (state.hand) return openHand();
  state.hand = { ...KEY_PLACE };
  ask("grab", { ...state.hand, radius: KEY_HAND });
}
function arrow(right, down) {
  if (!state.hand) return turn(state.turn.pitch + down * KEY_TURN, state.turn.yaw + right * KEY_TURN);
  state.hand = { x: state.hand.x + right * KEY_WAY, y: state.hand.y + down * KEY_WAY };
  ask("drag", state.hand);
}
const keys = {
  ArrowLeft: () => arrow(-1, 0),
  ArrowRight: () => arrow(1, 0),
  ArrowUp: () => arrow(0, -1),
  ArrowDown: () => arrow(0, 1),
  Enter: closeHand,
  Escape: () => state.hand && openHand(),
  " ": pause,
};
canvas.addEventListener("keydown", (event) => {
  if (!keys[event.key] || event.ctrlKey || event.altKey || event.metaKey) return;
  event.preventDefault();
  keys[event.key]();
});
canvas.addEventListener("blur", () => state.hand && openHand());

// Time does not pass while nobody sees it.
document.addEventListener("visibilitychange", () => ask("visible", { on: !document.hidden }));

// The canvas is drawn by the worker; its size follows the window. Settings that are refused give way to `plain` ones.
export function open(settings, plain) {
  if (typeof WebAssembly !== "object") return stop("This browser has no WebAssembly, without which the program does not run.");
  if (!canvas.transferControlToOffscreen) return stop("This browser draws in no worker: one of 2023 or newer does.");
  find("progress").textContent = "Loading the program";
  const { width, height } = size();
  const offscreen = canvas.transferControlToOffscreen();
  // `?backend=cpu` and `?backend=gpu` choose in place of the page.
  const backend = new URLSearchParams(location.search).get("backend");
  ask("open", { canvas: offscreen, settings, plain, width, height, backend }, [offscreen]);
  let resized;
  new ResizeObserver(() => {
    clearTimeout(resized);
    resized = setTimeout(() => state.ready && ask("resize", size()), 150);
  }).observe(canvas);
  // Everything is kept for a visit without a network; a browser that keeps nothing loses that alone.
  navigator.serviceWorker?.register("offline.js").catch(() => {});
}
