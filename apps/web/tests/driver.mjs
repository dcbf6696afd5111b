// Chromium without a screen, driven by its pipe (DevTools protocol), and the page behind a gate: while that is shut there is
// no network. A test gives its flags and the time that it may take, and runs.

import { spawn } from "node:child_process";
import { createServer, get } from "node:http";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

export const [folder, chromium, server, pictures] = process.argv.slice(2);
// Everything may take so many times as long, on a machine that is busy with other work.
const SLOWNESS = Number(process.env.STRANDLINE_SLOWNESS ?? 1);
// Milliseconds that a thing may take.
const PATIENCE = 60_000 * SLOWNESS;

// The server behind a gate: while it is shut there is no network.
let isShut = false;
// A file that is on its way until it is let through, and what lets it.
let delayed;
let through;
const gate = createServer(async (request, response) => {
  if (isShut) return request.socket.destroy();
  if (delayed && request.url.includes(delayed)) await through;
  get(server + request.url.slice(1), (answer) => {
    response.writeHead(answer.statusCode, answer.headers);
    answer.pipe(response);
  }).on("error", () => request.socket.destroy());
});
await new Promise((resolve) => { gate.listen(0, "127.0.0.1", resolve); });
const address = `http://127.0.0.1:${gate.address().port}/`;

export const shut = (on) => {
  isShut = on;
  if (on) gate.closeAllConnections();
};

// Holds a file back; the result lets it through.
export const hold = (file) => {
  let release;
  delayed = file;
  through = new Promise((resolve) => { release = resolve; });
  return () => {
    delayed = undefined;
    release();
  };
};

const profile = mkdtempSync(join(tmpdir(), "strandline-web-"));
let browser;
const end = (code) => {
  browser.kill("SIGKILL");
  browser.once("close", () => {
    rmSync(profile, { recursive: true, force: true, maxRetries: 5, retryDelay: 200 });
    process.exit(code);
  });
};

// Starts Chromium and runs a test, which may take so long [ms].
export function run(test, flags, most) {
  const all = [
    "--headless", "--no-sandbox", "--no-first-run", "--disable-extensions", "--remote-debugging-pipe",
    `--user-data-dir=${profile}`, "--window-size=1200,800", ...flags, "about:blank",
  ];
  browser = spawn(chromium, all, { stdio: ["ignore", "ignore", "ignore", "pipe", "pipe"] });
  browser.stdio[4].on("data", received);
  setTimeout(() => {
    console.error("the page takes too long");
    end(1);
  }, most * SLOWNESS).unref();
  test().then((code) => end(code ?? 0), (error) => {
    console.error(`failed: ${error.message}`);
    end(1);
  });
}

// Messages of the protocol, each ended by a zero.
let buffer = "";
let count = 0;
const answers = new Map();
export const problems = [];
function received(data) {
  buffer += data;
  const messages = buffer.split("\0");
  buffer = messages.pop();
  messages.map((message) => JSON.parse(message)).forEach(take);
}
function take(message) {
  const { id, method, params, result, error } = message;
  if (id !== undefined) {
    const { resolve, reject } = answers.get(id);
    answers.delete(id);
    return error ? reject(new Error(JSON.stringify(error))) : resolve(result);
  }
  if (method === "Runtime.consoleAPICalled" && params.type === "error") {
    problems.push(params.args.map((part) => part.value ?? part.description).join(" "));
  } else if (method === "Runtime.exceptionThrown") {
    problems.push(params.exceptionDetails.exception?.description ?? params.exceptionDetails.text);
  } else if (method === "Log.entryAdded" && params.entry.level === "error") {
    problems.push(`${params.entry.text} ${params.entry.url ?? ""}`);
  } else if (method === "Target.attachedToTarget") {
    // The worker of the page.
    const session = params.sessionId;
    send("Runtime.enable", {}, session);
    send("Log.enable", {}, session).catch(() => {});
    send("Runtime.runIfWaitingForDebugger", {}, session);
  }
}
export function send(method, params = {}, sessionId = page) {
  count += 1;
  browser.stdio[3].write(`${JSON.stringify({ id: count, method, params, sessionId })}\0`);
  return new Promise((resolve, reject) => answers.set(count, { resolve, reject }));
}

let page;
export const pause = (milliseconds) => new Promise((resolve) => { setTimeout(resolve, milliseconds); });
// The value of an expression in the page, `seen` of its script among its names.
export async function value(expression) {
  const whole = `import("./stage.js").then(({ seen }) => (${expression}))`;
  const { result, exceptionDetails } = await send("Runtime.evaluate", { expression: whole, awaitPromise: true, returnByValue: true });
  if (exceptionDetails) throw new Error(`${expression}: ${exceptionDetails.exception?.description}`);
  return result.value;
}
export async function until(expression) {
  const last = Date.now() + PATIENCE;
  while (Date.now() < last) {
    if (await value(expression)) return;
    await pause(50);
  }
  throw new Error(`never so: ${expression}; refused: ${await value("seen.refused.join()")}; ${problems.join("; ")}`);
}
export function held(condition, what) {
  if (!condition) throw new Error(what);
  console.log(`passed: ${what}`);
}
export const mouse = (type, x, y) => send("Input.dispatchMouseEvent", { type, x, y, button: "left", buttons: 1, clickCount: 1 });
export async function look(name) {
  if (!pictures) return;
  const { data } = await send("Page.captureScreenshot", { format: "png" });
  writeFileSync(join(pictures, `${name}.png`), Buffer.from(data, "base64"));
}
export async function begins(hash, file = "") {
  await send("Page.navigate", { url: "about:blank" });
  await send("Page.navigate", { url: `${address}${file}${hash}` });
  await pause(100);
}
export async function opens(hash, file = "") {
  const begin = Date.now();
  await begins(hash, file);
  await until("document.getElementById('progress').hidden");
  return (Date.now() - begin) / 1e3;
}

// Takes hold of the browser's page; its target.
export async function attach() {
  const { targetInfos } = await send("Target.getTargets", {}, undefined);
  const target = targetInfos.find(({ type }) => type === "page");
  ({ sessionId: page } = await send("Target.attachToTarget", { targetId: target.targetId, flatten: true }, undefined));
  await send("Page.enable");
  await send("Runtime.enable");
  await send("Log.enable");
  await send("Target.setAutoAttach", { autoAttach: true, waitForDebuggerOnStart: true, flatten: true });
  return target;
}
