// Opens pages in headless Chromium, offline, and says whether every picture is there and nothing went wrong.
//
//     node tests/browser/check.mjs figures/index.html ...
//
// Needs Chromium (CHROMIUM names it if it is not on the PATH as `chromium` or `google-chrome`) and Node 18 or later; no
// packages. Speaks the DevTools protocol over a pipe. Exit code 0 if all is well, 1 if not, 2 without a browser.

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
    trouble.push(`log ${params.entry.level}: ${params.entry.text}`);
  if (method === "Network.loadingFailed") trouble.push(`not loaded: ${params.errorText}`);
  if (method === "Network.requestWillBeSent" && !/^(file|data):/.test(params.request.url))
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

/** Runs in the page: what there is to see, and what of it cannot be seen. */
function inspect() {
  const missing = [];
  for (const section of document.querySelectorAll("section")) {
    const broken = section.querySelector("h2 .broken");
    const pictures = [...section.querySelectorAll("svg, img")];
    if (!pictures.length && !broken) missing.push(`${section.id}: no picture`);
    pictures.forEach((picture, index) => {
      const { width, height } = picture.getBoundingClientRect();
      const drawn = picture.tagName === "IMG" ? picture.complete && picture.naturalWidth > 0 : picture.children.length > 4;
      if (width < 200 || height < 100 || !drawn) missing.push(`${section.id}: picture ${index + 1} is empty`);
    });
  }
  const wide = document.documentElement.scrollWidth > document.documentElement.clientWidth;
  if (wide) missing.push("the page is wider than the window");
  const sections = document.querySelectorAll("section").length;
  return { sections, pictures: document.querySelectorAll("section svg, section img").length, missing };
}

/** Opens a page; says what is wrong with it. */
async function check(file, session) {
  trouble = [];
  const done = new Promise((resolve) => (loaded = resolve));
  await ask("Page.navigate", { url: pathToFileURL(resolve(file)).href }, session);
  await done;
  const expression = `(${inspect})()`;
  const { result } = await ask("Runtime.evaluate", { expression, returnByValue: true }, session);
  const { sections, pictures, missing } = result.value;
  const wrong = [...missing, ...trouble];
  if (!sections || !pictures) wrong.push("there is nothing on the page");
  console.log(`${file}: ${sections} parts, ${pictures} pictures, ${wrong.length} troubles`);
  wrong.forEach((words) => console.log(`  ${words}`));
  return wrong.length === 0;
}

let well = true;
try {
  const { targetInfos } = await ask("Target.getTargets");
  const { targetId } = targetInfos.find(({ type }) => type === "page");
  const { sessionId } = await ask("Target.attachToTarget", { targetId, flatten: true });
  for (const domain of ["Page", "Runtime", "Log", "Network"]) await ask(`${domain}.enable`, {}, sessionId);
  await ask("Network.emulateNetworkConditions", { offline: true, latency: 0, downloadThroughput: 0, uploadThroughput: 0 }, sessionId);
  for (const file of process.argv.slice(2)) well = (await check(file, sessionId)) && well;
} finally {
  const ended = new Promise((resolve) => chromium.once("exit", resolve));
  chromium.kill();
  await ended;
  rmSync(profile, { recursive: true, force: true, maxRetries: 5 });
}
process.exit(well ? 0 : 1);
