// The page: controls, files and link.

import { ask, find, on, open, pause, problem, set, state, turn } from "./stage.js";

const stage = find("hair").parentElement;
const controls = find("controls");

// Settings of the link: keys of scenes, as `#style.style=wavy&look.preset=red`.
const linked = () => [...new URLSearchParams(location.hash.slice(1))];
// Hair of a visit without a link: what the poster shows.
const PLAIN = [["style.style", "wavy"]];

on("given", ({ given: settings }) => {
  const given = [];
  for (let index = 0; index < settings.length; index += 2) given.push([settings[index], settings[index + 1]]);
  history.replaceState(null, "", `#${new URLSearchParams(given)}`);
});

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

// The machine chooses the number of guides where nobody has.
const guides = controls.querySelector('[data-key="style.strand_count"]');
on("figures", ({ strands }) => {
  if (guides !== document.activeElement) guides.value = String(strands);
});
on("opened", () => controls.querySelectorAll('[name="style"]').forEach((choice) => { choice.checked = false; }));
on("notes", ({ notes }) => {
  const items = notes.map((note) => Object.assign(document.createElement("li"), { textContent: note }));
  find("notes").prepend(...items);
  [...find("notes").children].slice(40).forEach((item) => item.remove());
});
on("saved", ({ file }) => {
  const link = Object.assign(document.createElement("a"), { href: URL.createObjectURL(file), download: "strandline.png" });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
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

// A device in the hand turns the head: by as much as it is tilted from where it was held at first.
const LEAST_TILT = 0.5;
let level;
let tilted;
function tilt({ beta, gamma }) {
  if (beta === null || gamma === null) return;
  level ??= { beta, gamma, ...state.turn };
  const next = { pitch: level.pitch + beta - level.beta, yaw: level.yaw + gamma - level.gamma };
  const way = Math.max(Math.abs(next.pitch - state.turn.pitch), Math.abs(next.yaw - state.turn.yaw));
  if (way < LEAST_TILT) return;
  // One message for each frame that the screen shows.
  tilted ??= requestAnimationFrame(() => {
    tilted = undefined;
    if (level) turn(next.pitch, next.yaw);
  });
}
find("tilt").hidden = !globalThis.DeviceOrientationEvent || navigator.maxTouchPoints === 0;
find("tilt").addEventListener("click", async ({ target }) => {
  const isOn = target.getAttribute("aria-pressed") === "true";
  removeEventListener("deviceorientation", tilt);
  level = undefined;
  // Some systems ask the person first.
  const answer = isOn ? "granted" : await DeviceOrientationEvent.requestPermission?.().catch(() => "denied");
  if ((answer ?? "granted") !== "granted") return problem("The device does not tell how it is held.");
  target.setAttribute("aria-pressed", String(!isOn));
  if (!isOn) addEventListener("deviceorientation", tilt);
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

const given = linked();
const isGiven = (key) => given.some(([known]) => known === key);
// Other hair than the poster's does not begin as the poster.
find("poster").hidden = given.length > 0;
show(given);
open([...PLAIN.filter(([key]) => !isGiven(key)), ...given], PLAIN);
