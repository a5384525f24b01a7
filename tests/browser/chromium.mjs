// Headless Chromium for the checks of pages, offline or with one server: speaks the DevTools protocol over a pipe; needs Node 18 or later, no packages.
// CHROMIUM names the browser if it is not on the PATH as `chromium` or `google-chrome`. Without one the process ends with exit code 2.

import { spawn, spawnSync } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";

const candidates = [process.env.CHROMIUM, "chromium", "chromium-browser", "google-chrome"].filter(Boolean);
const browser = candidates.find((name) => spawnSync(name, ["--version"]).status === 0);
if (!browser) {
  console.error(`no browser: none of ${candidates.join(", ")} can be started`);
  process.exit(2);
}

const profile = mkdtempSync(join(tmpdir(), "interplay-browser-"));
const flags = ["--headless", "--no-sandbox", "--disable-gpu", "--remote-debugging-pipe", `--user-data-dir=${profile}`];
const chromium = spawn(browser, [...flags, "about:blank"], { stdio: ["ignore", "ignore", "ignore", "pipe", "pipe"] });
const [, , , writer, reader] = chromium.stdio;

let last = 0;
const waiting = new Map();
let trouble = [];
let loaded = () => {};
/** What may be asked for; anything else is trouble. */
let allowed = /^(file|data):/;

/** Asks the browser and waits for its answer. */
function ask(method, params = {}, sessionId) {
  const id = ++last;
  writer.write(JSON.stringify({ id, method, params, sessionId }) + "\0");
  return new Promise((answer, refuse) => waiting.set(id, { answer, refuse }));
}

/** What the browser says of its own accord. */
function hear({ method, params }) {
  if (method === "Page.loadEventFired") loaded();
  if (method === "Runtime.exceptionThrown") trouble.push(`exception: ${params.exceptionDetails.text}`);
  if (method === "Runtime.consoleAPICalled" && ["error", "warning"].includes(params.type))
    trouble.push(`console ${params.type}: ${params.args.map((word) => word.value).join(" ")}`);
  if (method === "Log.entryAdded" && ["error", "warning"].includes(params.entry.level))
    trouble.push(`log ${params.entry.level}: ${params.entry.text} ${params.entry.url ?? ""}`.trim());
  if (method === "Network.loadingFailed" && !params.canceled) trouble.push(`not loaded: ${params.errorText}`);
  if (method === "Network.requestWillBeSent" && !allowed.test(params.request.url))
    trouble.push(`asks for ${params.request.url}`);
}

let heard = Buffer.alloc(0);
reader.on("data", (piece) => {
  heard = Buffer.concat([heard, piece]);
  for (let end = heard.indexOf(0); end >= 0; end = heard.indexOf(0)) {
    const message = JSON.parse(heard.subarray(0, end).toString());
    heard = heard.subarray(end + 1);
    const asked = waiting.get(message.id);
    waiting.delete(message.id);
    if (!asked) hear(message);
    else if (message.error) asked.refuse(new Error(message.error.message));
    else asked.answer(message.result);
  }
});

let session;

/** Begins a session in which nothing but files can be opened, or nothing but what is below an address on this machine. */
export async function begin(origin) {
  const { targetInfos } = await ask("Target.getTargets");
  const { targetId } = targetInfos.find(({ type }) => type === "page");
  session = (await ask("Target.attachToTarget", { targetId, flatten: true })).sessionId;
  for (const domain of ["Page", "Runtime", "Log", "Network"]) await ask(`${domain}.enable`, {}, session);
  if (origin) allowed = { test: (url) => url.startsWith(origin) || url.startsWith(origin.replace(/^http/, "ws")) };
  else await ask("Network.emulateNetworkConditions", { offline: true, latency: 0, downloadThroughput: 0, uploadThroughput: 0 }, session);
}

/** Opens a page and runs a function in it; returns its result, and what went wrong meanwhile. */
export async function inspectPage(file, inspect, ...words) {
  await open(pathToFileURL(resolve(file)).href);
  const found = await evaluate(inspect, ...words);
  return { found, trouble: [...trouble] };
}

/** Opens an address and waits until it is loaded. */
export async function open(url) {
  trouble = [];
  const done = new Promise((resolve) => (loaded = resolve));
  await ask("Page.navigate", { url }, session);
  await done;
}

/** Runs a function in the page and returns its result. */
export async function evaluate(inspect, ...words) {
  const expression = `(${inspect})(...${JSON.stringify(words)})`;
  const { result, exceptionDetails } = await ask("Runtime.evaluate", { expression, returnByValue: true, awaitPromise: true }, session);
  if (exceptionDetails) trouble.push(`exception: ${exceptionDetails.exception?.description ?? exceptionDetails.text}`);
  return result.value;
}

/** Sends a command of the DevTools protocol for the page. */
export const command = (method, params = {}) => ask(method, params, session);

/** What went wrong since the last page was opened. */
export const troubles = () => [...trouble];

/** Ends the browser and removes what it wrote. */
export async function end() {
  const ended = new Promise((resolve) => chromium.once("exit", resolve));
  chromium.kill();
  await ended;
  rmSync(profile, { recursive: true, force: true, maxRetries: 5 });
}
