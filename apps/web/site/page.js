// The page: controls, pointer, files and link. The engine runs in a worker; nothing here waits for it.

const find = (id) => document.getElementById(id);
const canvas = find("hair");
const stage = canvas.parentElement;
const controls = find("controls");

// Radius of the hand [m]; degrees of a turn by a key and across the canvas; farthest turns [degrees].
const HAND = 0.025;
const KEY_TURN = 6;
const DRAG_TURN = 160;
const FARTHEST = { pitch: 35, yaw: 80 };
// Pixels of the picture at most: the processor draws it.
const MOST_PIXELS = 720 * 900;

const worker = new Worker("worker.js", { type: "module" });
const ask = (type, content = {}, moved = []) => worker.postMessage({ type, ...content }, moved);

const state = { given: [], held: false, dragging: undefined, turn: { pitch: 0, yaw: 0 }, ready: false };

// What tests look at, and nothing else.
export const seen = { refused: [], figures: undefined, grabbed: undefined, opened: undefined, saved: undefined };

function size() {
  const box = canvas.getBoundingClientRect();
  const wanted = Math.max(box.width * box.height, 1) * devicePixelRatio ** 2;
  const factor = devicePixelRatio * Math.min(1, Math.sqrt(MOST_PIXELS / wanted));
  return { width: Math.max(16, Math.round(box.width * factor)), height: Math.max(16, Math.round(box.height * factor)) };
}

// Settings of the link: keys of scenes, as `#style.style=wavy&look.preset=red`.
const linked = () => [...new URLSearchParams(location.hash.slice(1))];

function carry(given) {
  state.given = [];
  for (let index = 0; index < given.length; index += 2) state.given.push([given[index], given[index + 1]]);
  history.replaceState(null, "", `#${new URLSearchParams(state.given)}`);
}

// Shows in the controls what a link has set.
function show(settings) {
  for (const [key, value] of settings) {
    const control = controls.querySelector(`[data-key="${CSS.escape(key)}"]`);
    if (control?.matches("input, select")) control.value = value;
    const choice = control?.querySelector(`input[value="${CSS.escape(value)}"]`);
    if (choice) choice.checked = true;
    if (key === "wind.velocity") find("wind").value = value.replace("[", "").split(",")[0];
    if (key === "motion.rotation") {
      const [pitch, yaw] = value.replace("[", "").split(",").map(Number);
      state.turn = { pitch: pitch || 0, yaw: yaw || 0 };
    }
  }
}

const set = (key, value) => ask("set", { key, value: String(value) });

function turn(pitch, yaw) {
  const within = (angle, most) => Math.max(-most, Math.min(most, angle));
  state.turn = { pitch: within(pitch, FARTHEST.pitch), yaw: within(yaw, FARTHEST.yaw) };
  set("motion.rotation", `[${state.turn.pitch.toFixed(1)}, ${state.turn.yaw.toFixed(1)}, 0]`);
}

let quiet;
function problem(message) {
  seen.refused.push(message);
  find("problem").textContent = message;
  find("problem").hidden = false;
  clearTimeout(quiet);
  quiet = setTimeout(() => { find("problem").hidden = true; }, 12_000);
}

const told = {
  progress: ({ text }) => { find("progress").textContent = text; },
  ready() {
    state.ready = true;
    find("progress").hidden = true;
  },
  given: ({ given }) => carry(given),
  refused: ({ message }) => problem(message),
  gone({ message }) {
    problem(`The program has stopped: ${message}. Load the page again.`);
    find("progress").textContent = "Stopped";
    find("progress").hidden = false;
  },
  grabbed({ held }) {
    seen.grabbed = held;
    // The pointer may be up by now.
    if (!state.dragging) return held ? ask("release") : undefined;
    state.held = held;
  },
  opened({ name }) {
    seen.opened = name;
    controls.querySelectorAll('[name="style"]').forEach((choice) => { choice.checked = false; });
  },
  notes({ notes }) {
    const items = notes.map((note) => Object.assign(document.createElement("li"), { textContent: note }));
    find("notes").prepend(...items);
    [...find("notes").children].slice(40).forEach((item) => item.remove());
  },
  figures(figures) {
    seen.figures = figures;
    const { rate, picture, step, still, paused, strands, width, height } = figures;
    const pace = paused ? "paused" : still ? "at rest" : `${rate.toFixed(0)} frames/s`;
    const moving = still ? "" : `, step ${step.toFixed(0)} ms, picture ${picture.toFixed(0)} ms`;
    find("figures").textContent = `Processor, ${strands} guides, ${width} × ${height}: ${pace}${moving}`;
  },
  saved({ file }) {
    seen.saved = file;
    const link = Object.assign(document.createElement("a"), { href: URL.createObjectURL(file), download: "strandline.png" });
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
  },
};
worker.onmessage = ({ data }) => told[data.type](data);
worker.onerror = () => problem("The program does not start: this page needs a browser of 2023 or newer, and a server.");

// Pointer: hair where there is some, else the head.
const place = (event) => {
  const box = canvas.getBoundingClientRect();
  return { x: (event.clientX - box.left) / box.width, y: (event.clientY - box.top) / box.height };
};
canvas.addEventListener("pointerdown", (event) => {
  if (!event.isPrimary || event.button !== 0) return;
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

const pause = () => {
  const on = find("pause").getAttribute("aria-pressed") !== "true";
  find("pause").setAttribute("aria-pressed", String(on));
  ask("pause", { on });
};
const keys = {
  ArrowLeft: () => turn(state.turn.pitch, state.turn.yaw - KEY_TURN),
  ArrowRight: () => turn(state.turn.pitch, state.turn.yaw + KEY_TURN),
  ArrowUp: () => turn(state.turn.pitch - KEY_TURN, state.turn.yaw),
  ArrowDown: () => turn(state.turn.pitch + KEY_TURN, state.turn.yaw),
  " ": pause,
};
canvas.addEventListener("keydown", (event) => {
  if (!keys[event.key] || event.ctrlKey || event.altKey || event.metaKey) return;
  event.preventDefault();
  keys[event.key]();
});

// Controls.
controls.addEventListener("submit", (event) => event.preventDefault());
const changed = (event) => {
  const control = event.target;
  const key = control.dataset.key ?? control.closest("[data-key]")?.dataset.key;
  if (key) set(key, control.value);
};
controls.addEventListener("change", (event) => {
  if (!event.target.matches("input[type=range], input[type=color]")) changed(event);
});
controls.addEventListener("input", (event) => {
  if (event.target.matches("input[type=range], input[type=color]")) changed(event);
});
find("wind").addEventListener("input", ({ target }) => set("wind.velocity", `[${target.value}, 0, ${-target.value / 4}]`));
find("own-color").addEventListener("input", ({ target }) => {
  set("look.root_color", target.value);
  set("look.tip_color", target.value);
  controls.querySelectorAll('[name="preset"]').forEach((choice) => { choice.checked = false; });
});
find("pause").addEventListener("click", pause);
find("reset").addEventListener("click", () => ask("reset"));
find("save").addEventListener("click", () => ask("save"));
find("link").addEventListener("click", async ({ target }) => {
  try {
    await navigator.clipboard.writeText(location.href);
    target.textContent = "Copied";
  } catch {
    target.textContent = "It is in the address";
  }
  setTimeout(() => { target.textContent = "Copy link"; }, 2000);
});

// Files.
async function read(file) {
  if (file.size > 64 << 20) return problem(`${file.name}: larger than 64 MiB`);
  const bytes = new Uint8Array(await file.arrayBuffer());
  ask("file", { name: file.name, bytes }, [bytes.buffer]);
}
find("file").addEventListener("change", ({ target }) => {
  if (target.files[0]) read(target.files[0]);
  target.value = "";
});
addEventListener("dragover", (event) => {
  event.preventDefault();
  stage.classList.add("dropping");
});
addEventListener("dragleave", (event) => {
  if (!event.relatedTarget) stage.classList.remove("dropping");
});
addEventListener("drop", (event) => {
  event.preventDefault();
  stage.classList.remove("dropping");
  if (event.dataTransfer.files[0]) read(event.dataTransfer.files[0]);
});

// The canvas is drawn by the worker; its size follows the window.
const { width, height } = size();
const offscreen = canvas.transferControlToOffscreen();
state.given = linked();
show(state.given);
ask("open", { canvas: offscreen, settings: state.given, width, height }, [offscreen]);
let resized;
new ResizeObserver(() => {
  clearTimeout(resized);
  resized = setTimeout(() => state.ready && ask("resize", size()), 150);
}).observe(canvas);
