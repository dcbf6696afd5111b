// Opens the page in Chromium without a screen and uses it: node browser.mjs FOLDER CHROMIUM ADDRESS [PICTURES].
// With a folder for PICTURES the poster is kept as it looks.

import { readFileSync } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";

import { attach, begins, folder, held, hold, look, mouse, opens, pause, problems, run, send, shut, until, value } from "./driver.mjs";

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

// A picture of the stage as it looks now, without its words.
async function stage() {
  await value("document.querySelectorAll('.stage p').forEach((words) => { words.style.visibility = 'hidden'; })");
  const clip = await value("(({ x, y, width, height }) => ({ x, y, width, height, scale: 0.25 }))(document.getElementById('hair').getBoundingClientRect())");
  const { data } = await send("Page.captureScreenshot", { format: "png", clip });
  await value("document.querySelectorAll('.stage p').forEach((words) => { words.style.visibility = ''; })");
  return data;
}

// Mean difference of two pictures of the stage, of 255.
const apart = (one, other) => value(`(async () => {
  const bytes = await Promise.all(["${one}", "${other}"].map(async (data) => {
    const blob = new Blob([Uint8Array.from(atob(data), (letter) => letter.charCodeAt(0))]);
    const bitmap = await createImageBitmap(blob);
    const own = new OffscreenCanvas(bitmap.width, bitmap.height).getContext("2d");
    own.drawImage(bitmap, 0, 0);
    return own.getImageData(0, 0, bitmap.width, bitmap.height).data;
  }));
  return bytes[0].reduce((sum, byte, index) => sum + Math.abs(byte - bytes[1][index]), 0) / bytes[0].length;
})()`);

// The poster, which shows while the module loads, gives way to hair that looks the same, and stays where nothing runs.
async function poster() {
  const release = hold("strandline_web_bg.wasm");
  await begins("");
  await until("document.getElementById('poster').complete && document.getElementById('poster').naturalWidth > 0");
  await until("document.getElementById('progress').textContent.includes('Loading')");
  held(await value("getComputedStyle(document.getElementById('poster')).opacity === '1'"), "a poster shows while the module loads");
  await look("poster");
  const still = await stage();
  release();
  await until("document.getElementById('progress').hidden");
  await value("document.getElementById('pause').click()");
  await until("seen.figures?.still");
  await until("getComputedStyle(document.getElementById('poster')).visibility === 'hidden'");
  const live = await stage();
  await value("document.querySelector('[value=pixie]').click()");
  await until("seen.given.join().includes('pixie')");
  await value("seen.figures = undefined");
  await until("seen.figures?.still");
  await pause(300);
  const [jump, other] = [await apart(still, live), await apart(still, await stage())];
  console.log(`the first pictures: ${jump.toFixed(2)} of 255 from the poster, other hair ${other.toFixed(2)}`);
  held(jump < 3 && other > 2 * jump, "hair takes the place of the poster without a jump");
  await opens("#style.style=bob&style.strand_count=64");
  held(await value("document.getElementById('poster').hidden"), "a link shows no poster of other hair");

  const { identifier } = await send("Page.addScriptToEvaluateOnNewDocument", { source: "delete globalThis.WebAssembly" });
  for (const file of ["", "how.html"]) {
    await begins("#style.style=bob", file);
    await until("!document.getElementById('problem').hidden && document.getElementById('problem').textContent.includes('WebAssembly')");
    await until("!document.getElementById('poster').hidden && document.getElementById('poster').naturalWidth > 0");
  }
  await look("unable");
  await send("Page.removeScriptToEvaluateOnNewDocument", { identifier });
  held(true, "a browser without WebAssembly shows the poster, and says so");
}

async function test() {
  const target = await attach();
  const size = (width, height) =>
    send("Emulation.setDeviceMetricsOverride", { width, height, deviceScaleFactor: 1, mobile: width < 500 });

  await size(900, 600);
  await poster();

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

  // A device that is tilted turns the head.
  await send("Emulation.setTouchEmulationEnabled", { enabled: true, maxTouchPoints: 1 });
  await opens("#style.style=bob&style.strand_count=64");
  await send("DeviceOrientation.setDeviceOrientationOverride", { alpha: 0, beta: 40, gamma: 0 });
  await value("document.getElementById('tilt').click()");
  await pause(300);
  await send("DeviceOrientation.setDeviceOrientationOverride", { alpha: 0, beta: 50, gamma: -20 });
  await until("decodeURIComponent(location.hash).includes('motion.rotation=[10.0,+-20.0,+0]')");
  held(await value("!document.getElementById('tilt').hidden"), "a device that is tilted turns the head");
  await send("DeviceOrientation.clearDeviceOrientationOverride");
  await send("Emulation.setTouchEmulationEnabled", { enabled: false });

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

  held(problems.length === 0, `nothing on the console: ${problems.join("; ")}`);
}

// The processor draws: a machine without a GPU.
run(test, ["--disable-gpu"], 190_000);
