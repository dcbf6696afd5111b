// "How it works": a switch for each stage, and a button that switches the next one on.

import { ask, find, on, open, pause, set } from "./stage.js";

const stages = [...document.querySelectorAll("[data-stage]")];
const box = (stage) => stage.querySelector("input");
const settings = (stage) => {
  const text = box(stage).checked ? stage.dataset.on : stage.dataset.off;
  return text.split(";").map((setting) => setting.split("="));
};

// The head of all stages: hair of the thesis, without detail by distance, so that a switch alone decides.
const BASE = [
  ["style.style", "long"],
  ["look.preset", "thesis"],
  ["groom.bound", "0"],
  ["level_of_detail.by_pixel", "false"],
  ["simulation.strands.method", "constrain"],
  ["simulation.volume.cells", "[16, 16, 16]"],
  ["motion.name", "turn"],
];

function next() {
  const stage = stages.find((one) => !box(one).checked);
  if (!stage) return;
  box(stage).checked = true;
  changed(stage);
  stage.scrollIntoView({ block: "nearest" });
  box(stage).focus();
}
function changed(stage) {
  settings(stage).forEach(([key, value]) => set(key, value));
  ask("wake");
  find("next").disabled = stages.every((one) => box(one).checked);
}
for (const stage of stages) {
  box(stage).addEventListener("change", () => changed(stage));
}
find("stages").addEventListener("submit", (event) => event.preventDefault());
find("next").addEventListener("click", next);
find("pause").addEventListener("click", pause);

// The first stage is there from the beginning.
box(stages[0]).checked = true;
on("ready", () => find("next").focus());
open([...BASE, ...stages.flatMap(settings)], BASE);
