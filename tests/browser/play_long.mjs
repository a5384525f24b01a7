// Ten minutes of `interplay play` with four vehicles in real time: ticks that are late, and memory of the server.
//
//     node tests/browser/play_long.mjs target/release/interplay [seconds]
//
// `chromium.mjs` says what it needs. Exit code 0 if all is well, 1 if not, 2 (and "skipped") without a browser.

import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { serve } from "./serve.mjs";

process.on("exit", (code) => code === 2 && console.log("skipped: ten minutes of `interplay play` were not measured"));
const { begin, end, evaluate, open, troubles } = await import("./chromium.mjs");

/** A tick that comes this much after its time is late [ms], and the largest share of late ticks. */
const LATE_MS = 20;
const MOST_LATE = 0.001;
/** Memory at the end beside that of the first tenth. */
const MOST_GROWTH = 1.1;
const [binary, duration = "600"] = process.argv.slice(2);
const STEP_MS = 100;
const vehicle = (name, x_m, lane, speed_mps, driver) => `[[vehicle]]
name = "${name}"
start = { x_m = ${x_m}, y_m = ${lane ? 0.555 : 0.185}, speed_mps = ${speed_mps} }
goal = { lane = 1, speed_mps = ${speed_mps} }
driver = ${driver}
`;
const NICE = '{ kind = "human", style = "nice" }';
const SCENARIO = `title = "Four vehicles"
shows = "A person and three others for ten minutes"
duration_s = ${duration}.0
step_s = 0.1
horizon_steps = 30

[road]
kind = "lanes"
lane_count = 2
lane_width_m = 0.37

${vehicle("ego", "0.0", 0, "1.0", '{ kind = "negotiation" }')}
${vehicle("front", "-0.35", 1, "1.25", NICE)}
${vehicle("rear", "-1.65", 1, "1.25", NICE)}
${vehicle("last", "-3.5", 1, "1.25", NICE)}`;

const pause = (ms) => new Promise((done) => setTimeout(done, ms));
const place = mkdtempSync(join(tmpdir(), "interplay-long-"));
writeFileSync(join(place, "four.toml"), SCENARIO);
const { server, address } = await serve(binary, place, "four.toml", "--as", "front");
const resident = () => Number(/VmRSS:\s+(\d+)/.exec(readFileSync(`/proc/${server.pid}/status`, "utf8"))[1]) / 1024;
let isWell = false;
try {
  await begin(new URL(address).origin);
  await open(address);
  while ((await evaluate(() => globalThis.interplayPlay?.phase())) !== "ready") await pause(50);
  // A second socket of the same page notes when ticks come.
  await evaluate(() => {
    globalThis.came = [];
    const socket = new WebSocket(new URL("socket", document.baseURI).href.replace("http", "ws"));
    socket.addEventListener("message", ({ data }) => {
      const message = JSON.parse(data);
      if (message.type === "frame" && !message.paused && message.tick !== globalThis.came.at(-1)?.[0]) globalThis.came.push([message.tick, performance.now()]);
    });
  });
  await pause(300);
  await evaluate(() => document.querySelector("#overlay .primary").click());
  const memory = [];
  while (!["score", "gone"].includes(await evaluate(() => interplayPlay.phase()))) {
    memory.push(resident());
    await pause(2000);
  }
  const came = await evaluate(() => globalThis.came);
  const gaps = came.slice(1).map(([tick, at], index) => at - came[index][1] - STEP_MS * (tick - came[index][0]));
  const late = gaps.filter((gap) => gap > LATE_MS).length / gaps.length;
  const sorted = gaps.toSorted((one, other) => one - other);
  const early = memory[Math.max(1, Math.floor(memory.length / 10))];
  const growth = memory.at(-1) / early;
  console.log(`memory by tenths of the time [MiB]: ${Array.from({ length: 11 }, (_, at) => memory[Math.min(memory.length - 1, Math.floor((at * memory.length) / 10))].toFixed(0)).join(" ")}`);
  console.log(`${came.length} ticks: ${(100 * late).toFixed(3)} % late by more than ${LATE_MS} ms, at most ${sorted.at(-1).toFixed(1)} ms; memory ${early.toFixed(0)} -> ${memory.at(-1).toFixed(0)} MiB`);
  troubles().forEach((words) => console.log(`WRONG ${words}`));
  isWell = came.length > Number(duration) * 9.9 && late < MOST_LATE && growth <= MOST_GROWTH && !troubles().length;
} finally {
  await end();
  server.kill();
  rmSync(place, { recursive: true, force: true, maxRetries: 5 });
}
console.log(isWell ? "all is well" : "not as wanted");
process.exit(isWell ? 0 : 1);
