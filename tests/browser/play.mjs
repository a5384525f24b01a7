// Plays `interplay play` in headless Chromium by key events and fingers: a driver who yields, one who does not, and a phone.
//
//     node tests/browser/play.mjs target/release/interplay [folder for screenshots]
//
// `chromium.mjs` says what it needs. Exit code 0 if all is well, 1 if not, 2 (and "skipped") without a browser.

import { mkdirSync, mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { serve } from "./serve.mjs";

process.on("exit", (code) => code === 2 && console.log("skipped: the page of `interplay play` was not tested"));
const { begin, command, end, evaluate, open, troubles } = await import("./chromium.mjs");

/** Largest time from a key to motion on the screen, at the 95th percentile [ms]. */
const MAX_LATENCY_MS = 150;
const TAPS = 20;
const SCREENS = { wide: { width: 1280, height: 720, mobile: false }, phone: { width: 390, height: 844, mobile: true } };

const [binary, folder] = process.argv.slice(2);
if (!binary) {
  console.error("usage: node tests/browser/play.mjs BINARY [FOLDER]");
  process.exit(1);
}
if (folder) mkdirSync(folder, { recursive: true });

const wrong = [];
const check = (isWell, words) => {
  console.log(`${isWell ? "ok   " : "WRONG"} ${words}`);
  if (!isWell) wrong.push(words);
};
const pause = (ms) => new Promise((done) => setTimeout(done, ms));

const KEYS = { Enter: "\r", Space: " ", KeyM: "m", KeyR: "r" };
const key = (type, code) => command("Input.dispatchKeyEvent", { type, code, key: KEYS[code] ?? code.replace(/^Digit/, ""), ...(type === "keyDown" && KEYS[code] ? { text: KEYS[code] } : {}) });
async function press(code, ms = 40) {
  await key("keyDown", code);
  await pause(ms);
  await key("keyUp", code);
}

/** Waits until the page is in a phase. */
async function reach(wanted, ms = 30_000) {
  for (const until = Date.now() + ms; Date.now() < until; await pause(40)) if ((await evaluate(() => globalThis.interplayPlay?.phase())) === wanted) return;
  throw new Error(`the page did not reach “${wanted}”: ${await evaluate(() => globalThis.interplayPlay?.phase())}`);
}

/** Waits until a simulated time has come. */
async function drivenFor(time_s) {
  for (const until = Date.now() + 30_000; Date.now() < until; await pause(40)) if ((await evaluate(() => interplayPlay.frame()?.time_s ?? 0)) >= time_s) return;
  throw new Error(`the run did not come to ${time_s} s`);
}

async function shoot(name, screen) {
  const { data } = await command("Page.captureScreenshot", { format: "png" });
  const picture = Buffer.from(data, "base64");
  check(picture.length > 8000, `screenshot ${name} at ${SCREENS[screen].width} × ${SCREENS[screen].height} has something on it`);
  if (folder) writeFileSync(join(folder, `${name}-${screen}.png`), picture);
  const wide = await evaluate(() => document.documentElement.scrollWidth > window.innerWidth || document.getElementById("overlay").scrollWidth > window.innerWidth);
  check(!wide, `${name} is no wider than the window`);
}

async function show(screen) {
  const { width, height, mobile } = SCREENS[screen];
  await command("Emulation.setDeviceMetricsOverride", { width, height, mobile, deviceScaleFactor: mobile ? 2 : 1 });
  await command("Emulation.setTouchEmulationEnabled", { enabled: mobile });
}

/** How far a vehicle is ahead of another one along the road now [m]. */
const lead = async (one, other) => {
  const { x } = await evaluate((names) => {
    const rows = [...document.querySelectorAll("#legend b")].map(({ textContent }) => textContent);
    const { states } = interplayPlay.frame();
    return { x: names.map((name) => states[rows.indexOf(name)][0]) };
  }, [one, other]);
  return x[0] - x[1];
};

/** Lets time pass quickly until the score is there. */
async function finish() {
  await press("Digit8");
  await reach("score");
}

/** Times from a steering key to a turned car on the screen [ms], measured in the page. */
async function latencies() {
  const measured = [];
  for (let tap = 0; tap < TAPS; tap++) {
    const code = tap % 2 ? "ArrowRight" : "ArrowLeft";
    await evaluate(() => {
      const heading = () => interplayPlay.shown().states[interplayPlay.own()][2];
      globalThis.measured = new Promise((done) => addEventListener("keydown", (event) => {
        const before = heading();
        const look = () => requestAnimationFrame((now) => {
          const took = now - event.timeStamp;
          if (Math.abs(heading() - before) > 0.004 || took > 2000) done(Math.min(took, 2000));
          else look();
        });
        look();
      }, { once: true, capture: true }));
    });
    await pause(30 + 7 * tap);
    await key("keyDown", code);
    measured.push(await evaluate(() => globalThis.measured));
    await key("keyUp", code);
    await pause(150);
  }
  return measured.sort((one, other) => one - other);
}

const well = () => troubles().filter((words) => !/\b404\b.*\/pictures\/[\w-]+\.webp/.test(words));

async function playWide(address) {
  await show("wide");
  await open(address);
  await reach("ready");
  check((await evaluate(() => document.querySelector("#overlay h1").textContent.length)) > 3, "the goal is said before the start");
  await pause(400);
  await shoot("ready", "wide");

  // A driver who yields: the negotiator goes first.
  await press("Enter");
  await reach("driving");
  await press("ArrowDown", 550);
  await drivenFor(2.2);
  await shoot("driving", "wide");
  await drivenFor(5);
  const yielded = await lead("ego", "front");
  check(yielded > 0, `ego goes ahead of a front driver who yields (by ${yielded.toFixed(2)} m)`);
  await finish();
  await pause(2500);
  check((await evaluate(() => document.querySelectorAll(".score thead th").length)) >= 2, "the score has the planners beside the person");
  await shoot("score", "wide");

  // A driver who does not.
  await press("KeyR");
  await reach("held");
  await press("Digit5");
  await press("ArrowUp", 120);
  await reach("driving");
  await drivenFor(5);
  const kept = await lead("front", "ego");
  check(kept > 0, `ego stays behind a front driver who does not yield (by ${kept.toFixed(2)} m)`);
  await finish();

  // From a key to motion on the screen.
  await press("KeyR");
  await reach("held");
  await press("Digit5");
  await press("ArrowUp", 60);
  await reach("driving");
  await pause(300);
  const times = await latencies();
  const at = (share) => times[Math.min(times.length - 1, Math.ceil(share * times.length) - 1)].toFixed(0);
  console.log(`      from key to motion: median ${at(0.5)} ms, 95th percentile ${at(0.95)} ms of ${times.length}`);
  check(Number(at(0.95)) <= MAX_LATENCY_MS, `motion within ${MAX_LATENCY_MS} ms of a key`);

  // Hand over and back, a step back in time, a pause.
  await press("KeyP");
  await pause(400);
  check((await evaluate(() => interplayPlay.frame().driven_by)) !== "you", "a planner takes over");
  await press("KeyP");
  await pause(400);
  check((await evaluate(() => interplayPlay.frame().driven_by)) === "you", "and gives back");
  const before = await evaluate(() => interplayPlay.frame().time_s);
  await press("Backspace");
  await reach("held");
  await pause(300);
  check((await evaluate(() => interplayPlay.frame().time_s)) < before - 1, "a step back in time");
  await press("ArrowUp");
  await reach("driving");
  await press("Escape");
  await reach("paused");
  await press("KeyM");
  await reach("menu");
  await pause(600);
  check((await evaluate(() => document.querySelectorAll(".family").length)) >= 3, "the menu has the families");
  await shoot("menu", "wide");
  well().forEach((words) => check(false, words));
}

const touch = (type, point) => command("Input.dispatchTouchEvent", { type, touchPoints: point ? [point] : [] });
const middle = (selector) => evaluate((selector) => {
  const { left, top, width, height } = document.querySelector(selector).getBoundingClientRect();
  return { x: left + width / 2, y: top + height / 2 };
}, selector);
async function tap(selector, ms = 60) {
  await touch("touchStart", await middle(selector));
  await pause(ms);
  await touch("touchEnd");
}

async function playPhone(address) {
  await show("phone");
  await open(address);
  await reach("ready");
  await pause(400);
  await shoot("ready", "phone");
  await tap("#overlay .primary");
  await reach("driving");
  const speed = () => evaluate(() => interplayPlay.frame().states[interplayPlay.own()][3]);
  await pause(300);
  const before = await speed();
  await tap("#brake", 600);
  await drivenFor(1.5);
  check((await speed()) < before - 0.2, "a thumb on the brake slows down");
  await shoot("driving", "phone");
  await finish();
  await pause(2500);
  await shoot("score", "phone");
  await evaluate(() => [...document.querySelectorAll(".score button")].at(-1).click());
  await reach("menu");
  await pause(600);
  await shoot("menu", "phone");
  await tap(".family");
  await pause(400);
  check((await evaluate(() => document.querySelectorAll(".seats input").length)) >= 2, "a touch on a family shows its seats");
  await shoot("family", "phone");
  well().forEach((words) => check(false, words));
}

/** A person agrees, drives the runs of a plan, and sees nothing of who drives how. */
async function playStudy(address) {
  await show("wide");
  await open(address);
  await reach("trial");
  await pause(400);
  await shoot("consent", "wide");
  for (const done of [1, 2]) {
    await evaluate(() => document.querySelector("#overlay .primary").click());
    await reach("ready");
    await pause(400);
    if (done === 1) await shoot("trial", "wide");
    await press("Enter");
    await reach("driving");
    await press("KeyP");
    await press("ArrowUp", 300);
    check((await evaluate(() => document.getElementById("asked").textContent + document.getElementById("legend").textContent)).match(/negotiat|human|asks/i) === null, "the page does not say which planner drives which vehicle");
    await reach("trial");
    check((await evaluate(() => interplayPlay.frame())) === null, "the run is over");
  }
  check((await evaluate(() => document.querySelector("#overlay h1").textContent)) === "Thank you", "all runs of the study are done");
  await shoot("thanks", "wide");
  well().forEach((words) => check(false, words));
}

const PLAN = 'scenario = ["lane-change/front-nice"]\nplanner = ["negotiation", "conservative"]\nset = { duration_s = 3.0, expect = {} }\n';
const place = mkdtempSync(join(tmpdir(), "interplay-play-"));
writeFileSync(join(place, "people.toml"), PLAN);
const tests = [
  [["lane-change/front-nice", "--as", "front"], [playWide, playPhone]],
  [["--study", "people.toml", "--as", "front"], [playStudy]],
];
try {
  for (const [words, plays] of tests) {
    const { server, address } = await serve(binary, place, ...words);
    try {
      await begin(new URL(address).origin);
      for (const play of plays) await play(address);
    } finally {
      server.kill();
    }
  }
} catch (error) {
  check(false, error.message);
  well().forEach((words) => check(false, words));
} finally {
  await end();
  rmSync(place, { recursive: true, force: true, maxRetries: 5 });
}
console.log(wrong.length ? `${wrong.length} ${wrong.length === 1 ? "trouble" : "troubles"}` : "all is well");
process.exit(wrong.length ? 1 : 0);
