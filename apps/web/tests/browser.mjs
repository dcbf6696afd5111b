// Opens the page in Chromium without a screen and uses it: node browser.mjs FOLDER CHROMIUM ADDRESS [PICTURES].
// With a folder for PICTURES the page is kept as it looks.

import { readFileSync } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";

import { attach, folder, held, look, mouse, opens, pause, pictures, problems, run, send, shut, until, value } from "./driver.mjs";

// Mean difference of the canvas from a picture of the module in Node, of 255.
async function difference(bytes, width, height) {
  const wanted = Buffer.from(bytes).toString("base64");
  return value(`(async () => {
    const bitmap = await createImageBitmap(seen.saved);
    const own = new OffscreenCanvas(bitmap.width, bitmap.height).getContext("2d");
    own.drawImage(bitmap, 0, 0);
    const found = own.getImageData(0, 0, bitmap.width, bitmap.height).data;
    const wanted = Uint8Array.from(atob("${wanted}"), (letter) => letter.charCodeAt(0));
    if (bitmap.width !== ${width} || bitmap.height !== ${height}) return 255;
    return found.reduce((sum, byte, index) => sum + Math.abs(byte - wanted[index]), 0) / found.length;
  })()`);
}

async function test() {
  const target = await attach();
  const size = (width, height) =>
    send("Emulation.setDeviceMetricsOverride", { width, height, deviceScaleFactor: 1, mobile: width < 500 });

  // A small canvas: a quarter of the window is the panel's.
  await size(480, 640);
  console.log(`ready in ${await opens("")} s`);
  await until("seen.figures?.strands === 400");
  held(true, "the page opens and moves 400 guides");
  await until("seen.figures.rate > 0");

  // Rest, so that a picture can be compared.
  const hash = "#motion.name=still&style.style=bob&style.strand_count=64";
  await opens(hash);
  await until("seen.figures?.still");
  await value("document.getElementById('save').click()");
  await until("seen.saved");
  const [width, height, frames] = await value("[seen.figures.width, seen.figures.height, 0]");
  const script = await import(pathToFileURL(join(folder, "strandline_web.js")));
  await script.default({ module_or_path: readFileSync(join(folder, "strandline_web_bg.wasm")) });
  const settings = [...new URLSearchParams(hash.slice(1))];
  const engine = new script.Engine(settings.map(([key]) => key), settings.map(([, text]) => text), width, height);
  for (let frame = 0; frame < 30 + frames; frame += 1) engine.frame();
  const own = await difference(engine.picture(), width, height);
  console.log(`mean difference from the picture in Node: ${own.toFixed(3)} of 255`);
  held(own < 0.5, "the picture is that of the module in Node");
  engine.set("look.preset", "blonde");
  held((await difference(engine.picture(), width, height)) > 1, "a picture of other hair is seen as another");

  // A hand on the hair, where guides of so few lie close.
  const box = await value("(({ x, y, width, height }) => ({ x, y, width, height }))(document.getElementById('hair').getBoundingClientRect())");
  const at = (x, y) => [box.x + x * box.width, box.y + y * box.height];
  await mouse("mousePressed", ...at(0.55, 0.2));
  await until("seen.grabbed === true");
  for (let step = 1; step <= 6; step += 1) {
    await mouse("mouseMoved", ...at(0.55 + 0.05 * step, 0.2));
    await pause(60);
  }
  await until("seen.figures.still === false");
  await look("grab");
  await mouse("mouseReleased", ...at(0.85, 0.2));
  held(true, "hair is grabbed and pulled");
  await until("seen.figures.still");
  await mouse("mousePressed", ...at(0.02, 0.02));
  await until("seen.grabbed === false");
  await mouse("mouseReleased", ...at(0.02, 0.02));

  // Keys, and settings that the link carries.
  const key = (name) => send("Input.dispatchKeyEvent", { type: "keyDown", key: name, code: name });
  await value("document.getElementById('hair').focus()");
  await value("seen.grabbed = undefined");
  await key("Enter");
  await until("seen.grabbed === true");
  for (let step = 0; step < 5; step += 1) await key("ArrowRight");
  await until("seen.figures.still === false");
  await key("Enter");
  await until("document.getElementById('hint').textContent.includes('Drag')");
  held(!(await value("location.hash")).includes("motion.rotation"), "Enter takes hair, and arrow keys pull it");
  await key("ArrowRight");
  await until("location.hash.includes('motion.rotation')");
  held(true, "an arrow key turns the head");
  await value("document.querySelector('[value=red]').click()");
  await until("location.hash.includes('look.preset=red')");
  held(true, "the link carries a colour");

  // Files.
  const drop = (name, content) => value(`(() => {
    const data = new DataTransfer();
    data.items.add(new File([${content}], "${name}"));
    dispatchEvent(new DragEvent("drop", { dataTransfer: data, cancelable: true }));
  })()`);
  await drop("cat.jpg", "'JFIF'");
  await until("seen.refused.some((text) => text.includes('cat.jpg'))");
  await drop("broken.hair", "'PK'");
  await until("seen.refused.length === 2");
  held(await value("!document.getElementById('problem').hidden"), "a wrong file is refused by name");
  await drop("cut.obj", "Array.from({ length: 40 }, (_, strand) => Array.from({ length: 8 }, (_, point) => `v ${0.004 * strand - 0.08} ${0.12 - 0.03 * point} 0.1\\n`).join('') + `l ${Array.from({ length: 8 }, (_, point) => 8 * strand + point + 1).join(' ')}\\n`).join('')");
  await until("seen.opened === 'cut.obj' || seen.refused.length > 2");
  held(await value("seen.opened === 'cut.obj'"), `a groom is opened: ${await value("seen.refused.slice(2).join()")}`);

  // A tab that is hidden for a while.
  await opens("#motion.name=shake&style.strand_count=64");
  await until("seen.figures?.rate > 0");
  const { targetId: other } = await send("Target.createTarget", { url: "about:blank" }, undefined);
  await send("Target.activateTarget", { targetId: other }, undefined);
  await send("Page.setWebLifecycleState", { state: "frozen" });
  await pause(3000);
  await send("Page.setWebLifecycleState", { state: "active" });
  await send("Target.activateTarget", { targetId: target.targetId }, undefined);
  await send("Target.closeTarget", { targetId: other }, undefined);
  await value("document.dispatchEvent(new Event('visibilitychange'))");
  await value("seen.figures = undefined");
  await until("seen.figures?.rate > 0 && !seen.figures.still");
  held((await value("seen.refused.length")) === 0, "a tab that was hidden goes on");

  // "How it works".
  await opens("", "how.html");
  for (let stage = 2; stage <= 8; stage += 1) {
    await value("document.getElementById('next').click()");
    await pause(100);
  }
  await until("seen.given.join().includes('simulation.volume.enabled,true')");
  await until("seen.figures?.strands === 240");
  held((await value("document.getElementById('next').disabled && seen.refused.join()")) === "", "each stage is switched on");
  await look("how");

  // Without a network.
  await value("navigator.serviceWorker.ready.then(() => true)");
  shut(true);
  for (const file of ["", "index.html", "how.html"]) await opens("#style.style=bob&style.strand_count=64", file);
  await until("seen.figures?.rate > 0");
  shut(false);
  held(true, "the page opens without a network after its first visit");

  // Links that are wrong.
  await opens("#style.strand_count=1000000");
  await until("seen.refused.some((text) => text.includes('20000 at most'))");
  await until("seen.figures?.strands === 400");
  held(true, "a link that asks for a million strands is refused with a message, and the page opens");
  await opens("#style.stile=bob");
  await until("seen.refused.some((text) => text.includes('style.stile'))");
  held(true, "a wrong link is refused by its key, and the page opens");

  if (pictures) {
    await size(1200, 800);
    await opens("#style.style=wavy&look.preset=red");
    await pause(6000);
    await look("desktop");
    await value("document.getElementById('pause').click()");
    await until("seen.figures.still");
    await look("still");
    await size(390, 844);
    await opens("#style.style=curly");
    await pause(6000);
    await look("phone");
  }
  held(problems.length === 0, `nothing on the console: ${problems.join("; ")}`);
}

// The processor draws: a machine without a GPU.
run(test, ["--disable-gpu"], 190_000);
