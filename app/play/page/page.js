// The page: its phases, the messages to and from the server, and the loop that draws at the screen's rate.
//
// Phases: connecting, menu (with a list of families or one of them), ready (a card before the start; the run is paused),
// held (the same without a card, after a restart or a step back), driving, paused, score, gone; in a study also trial, between
// two runs.

import { steadySteering } from "./bicycle.js";
import { goneView, helpView, pauseView, readyView } from "./cards.js";
import { Hud } from "./hud.js";
import { KeyDriver, listenToKeys } from "./keys.js";
import { familyView, menuView } from "./menu.js";
import { Motion } from "./motion.js";
import { PadDriver } from "./pad.js";
import { scoreView } from "./score.js";
import { BARRED, studyView } from "./study.js";
import { TouchDriver } from "./touch.js";
import { WorldView } from "./world.js";

/** Longest time between two inputs while driving, and between two measurements of the connection [s]. */
const INPUT_S = 0.09;
const ECHO_S = 2;
/** A higher latency of the connection is reported [ms]. */
const SLOW_MS = 120;
const REWIND_S = 5;
/** Smaller changes of a share are not sent at once. */
const SHARE_STEP = 0.004;

const overlay = document.getElementById("overlay");
const hudPlace = document.getElementById("hud");
const seconds = () => performance.now() / 1000;

const keys = new KeyDriver();
const pad = new PadDriver();
const touch = new TouchDriver(document.getElementById("touch"), act);
const hud = new Hud(act);
const view = new WorldView(document.getElementById("world"));

let socket, phase, families = [], family, world, motion, score, isHelping = false;
let seq = 0, sentAt = 0, echoAt = 0, drawnAt = 0, assist = true;
let input = { acceleration: 0, steering: 0, assist };
let lastSent = null;
/** Set after a requested restart: the next world needs no card. */
let isAgain = false;

const send = (message) => socket?.readyState === WebSocket.OPEN && socket.send(JSON.stringify(message));

/** Enters a phase; an overlay covers the road where there is one. */
function enter(next, shown = null) {
  phase = next;
  document.body.dataset.phase = next;
  isHelping = false;
  cover(shown);
  hudPlace.hidden = !["ready", "held", "driving", "paused", "score"].includes(next);
  if (next === "held") hud.notice("held", touch.isShown ? "Ready – touch a pedal to go" : "Ready – press a driving key to go", seconds(), "strong", Infinity);
  else hud.unnotice("held", seconds());
  if (next !== "driving") {
    keys.clear();
    lastSent = null;
  }
}

function cover(shown) {
  overlay.hidden = !shown;
  hudPlace.inert = Boolean(shown);
  overlay.replaceChildren(...(shown ? [shown.made] : []));
  overlay.scrollTop = 0;
  if (shown) shown.first.focus({ preventScroll: shown.first.type !== "radio" });
  else document.getElementById("world").focus({ preventScroll: true });
}

const showMenu = () => enter("menu", menuView(families, (chosen) => showFamily(chosen)));

function showFamily(chosen) {
  family = chosen;
  enter("menu", familyView(chosen, (scenario, seat) => send({ type: "start", scenario, seat }), leaveFamily, { scenario: world?.scenario, seat: world?.seat }));
}

function leaveFamily() {
  const name = family?.family;
  family = null;
  showMenu();
  [...overlay.querySelectorAll(".family")].find(({ dataset }) => dataset.family === name)?.focus();
}

function hold(kind) {
  send({ type: "pause", paused: true });
  enter(kind, kind === "ready" ? readyView(world, touch.isShown, act) : null);
}

function go() {
  send({ type: "pause", paused: false });
  enter("driving");
}

/** Actions of keys, buttons, touches and controllers; each returns whether it was possible. */
function act(name, number) {
  if (world?.study && phase !== "trial" && BARRED.includes(name)) return false;
  if (isHelping) {
    if (["help", "pause", "go"].includes(name)) cover(phase === "paused" ? pauseView(touch.isShown, act) : phase === "ready" ? readyView(world, touch.isShown, act) : null);
    else return false;
    isHelping = false;
    return true;
  }
  const isHeld = ["ready", "held", "paused"].includes(phase);
  const isOn = isHeld || phase === "driving";
  const isRun = isOn || phase === "score";
  const now = seconds();
  switch (name) {
    case "drive": return isHeld && phase !== "paused" && (go(), true);
    case "go":
      if (isHeld) go();
      else if (phase !== "driving") document.activeElement?.click?.();
      else return false;
      return true;
    case "pause":
      if (phase === "driving") pause();
      else if (phase === "paused" || phase === "held") go();
      else if (phase === "menu" && family) leaveFamily();
      else if (phase === "score" || phase === "ready") act("menu");
      else return false;
      return true;
    case "help":
      if (!isOn) return false;
      if (phase === "driving") pause();
      cover(helpView(touch.isShown, act));
      return (isHelping = true);
    case "restart":
      if (!isRun) return false;
      isAgain = true;
      send({ type: "restart" });
      hold("held");
      return true;
    case "rewind":
      if (!isRun || !motion?.last) return false;
      send({ type: "rewind", seconds: REWIND_S });
      hold("held");
      return true;
    case "handOver": {
      if (!isOn || !motion?.last) return false;
      send({ type: "hand_over", to: motion.last.driven_by === "you" ? world.co_driver : null });
      if (isHeld) go();
      return true;
    }
    case "changeSeat": {
      // While a card is open, the key moves between its buttons.
      if (!isOn || world.seats.length < 2 || (!overlay.hidden && document.activeElement?.tagName !== "BUTTON")) return false;
      send({ type: "seat", seat: world.seats[(world.seats.indexOf(world.seat) + 1) % world.seats.length] });
      return true;
    }
    case "rate":
      if (!isOn) return false;
      send({ type: "rate", ratio: number });
      hud.notice("rate", number === 1 ? "Normal speed" : `Time runs at ×${number}`, now);
      return true;
    case "showPlans":
      if (!isOn) return false;
      view.showsPlans = !view.showsPlans;
      hud.notice("plans", `Plans and beliefs are ${view.showsPlans ? "shown" : "hidden"}`, now);
      return true;
    case "assist":
      if (!isOn) return false;
      assist = !assist;
      hud.notice("assist", `Lane keeping is ${assist ? "on" : "off"}`, now);
      return true;
    case "next": return isRun && (send({ type: "next" }), true);
    case "end": return isOn && (send({ type: "end" }), true);
    case "menu":
      if (!isRun) return false;
      send({ type: "pause", paused: true });
      send({ type: "menu" });
      family = null;
      showMenu();
      return true;
    default: return false;
  }
}

function pause() {
  send({ type: "pause", paused: true });
  enter("paused", pauseView(touch.isShown, act));
}

const receive = {
  menu(message) {
    families = message.families ?? [];
    if (!message.chosen) showMenu();
  },
  study(place) {
    world = motion = null;
    enter("trial", studyView(place, (type) => send({ type })));
  },
  world(message) {
    const isSame = isAgain && world?.scenario === message.scenario && world?.seat === message.seat;
    isAgain = false;
    world = message;
    motion = new Motion(world);
    score = null;
    view.begin(world);
    hud.begin(world);
    if (world.study) view.showsPlans = false;
    hold(isSame ? "held" : "ready");
  },
  frame(message) {
    if (!world || message.seat !== world.seat) return;
    motion.take(message, seconds());
    hud.take(message, seconds());
  },
  score(message) {
    // The rows of the planners may come after the person continued: the same drive is not scored again.
    const isFirst = JSON.stringify(score?.you) !== JSON.stringify(message.you);
    if (phase === "menu" || (!isFirst && phase !== "score")) return;
    const scrolled = overlay.scrollTop;
    score = message;
    enter("score", scoreView(world, score, act));
    if (!isFirst) overlay.scrollTop = scrolled;
  },
  refused: ({ text }) => hud.notice("refused", text, seconds(), "warning"),
  bye: ({ text }) => enter("gone", goneView(text, connect)),
  echo({ at }) {
    const took = performance.now() - at;
    if (took > SLOW_MS) hud.notice("slow", `Slow connection: ${Math.round(took)} ms`, seconds(), "warning", ECHO_S);
  },
};

function connect() {
  const address = new URL("socket", document.baseURI);
  address.search = location.search;
  address.protocol = address.protocol === "https:" ? "wss:" : "ws:";
  phase = document.body.dataset.phase = "connecting";
  const opened = (socket = new WebSocket(address));
  socket.addEventListener("message", ({ data }) => {
    const message = JSON.parse(data);
    if (Object.hasOwn(receive, message.type)) receive[message.type](message);
  });
  socket.addEventListener("close", () => {
    if (opened === socket && phase !== "gone") enter("gone", goneView("The connection to the server has ended. The server has saved the drive.", connect));
  });
}

/** The present input: of touch or a controller if they are used, otherwise of keys. */
function readInput(elapsed) {
  const own = world.vehicles[motion.own];
  const speed = motion.last?.states[motion.own]?.[3] ?? 0;
  const most = own ? steadySteering(own.body, own.limits, speed) : 1;
  const byKeys = keys.advance(elapsed, most);
  const others = [touch.isShown ? touch.read(most) : null, pad.read(act)];
  const used = byKeys.isUsed ? byKeys : others.find((read) => read?.isUsed) ?? byKeys;
  return { acceleration: used.acceleration, steering: used.steering, assist };
}

function sendInput(now) {
  const isNew = !lastSent || ["acceleration", "steering"].some((part) => Math.abs(input[part] - lastSent[part]) > SHARE_STEP) || input.assist !== lastSent.assist;
  // The final value of a movement is always sent.
  const isOff = lastSent && ["acceleration", "steering"].some((part) => input[part] !== lastSent[part] && [0, 1, -1].includes(input[part]));
  if (!isNew && !isOff && now - sentAt < INPUT_S) return;
  lastSent = input;
  sentAt = now;
  seq += 1;
  send({ type: "input", seq, ...input });
  motion.note(seq, input, now);
}

function draw() {
  requestAnimationFrame(draw);
  const now = seconds();
  const elapsed = Math.min(now - drawnAt, 0.1);
  drawnAt = now;
  if (now - echoAt > ECHO_S) {
    echoAt = now;
    send({ type: "echo", at: performance.now() });
  }
  if (!world || hudPlace.hidden) {
    if (phase === "menu") pad.read(act);
    view.clear();
    return;
  }
  input = phase === "driving" ? readInput(elapsed) : { acceleration: 0, steering: 0, assist };
  if (phase === "driving") sendInput(now);
  else pad.read(act);
  const shown = motion.shown(now);
  if (!shown) return view.clear();
  const frame = motion.last;
  if (motion.drives() && phase === "driving") shown.brakes = { [motion.own]: input.acceleration < -0.05 };
  view.draw(shown, frame, hud.freeArea(), now, elapsed);
  const [acceleration, angle] = frame.inputs[motion.own] ?? [0, 0];
  const limits = world.vehicles[motion.own]?.limits;
  const share = limits && { acceleration: acceleration / (acceleration < 0 ? -limits.acceleration_min_mps2 : limits.acceleration_max_mps2), steering: angle / limits.steering_max_rad, assist };
  hud.draw(now, shown.states[motion.own], motion.drives() ? input : share ?? input);
}

listenToKeys(keys, () => ["ready", "held", "driving"].includes(phase) && !isHelping, act);
document.addEventListener("visibilitychange", () => document.hidden && phase === "driving" && pause());
/** For tests of the page: its phase, and the drawn state. */
globalThis.interplayPlay = { phase: () => phase, shown: () => motion?.shown(seconds()) ?? null, own: () => motion?.own ?? -1, frame: () => motion?.last ?? null };
connect();
requestAnimationFrame(draw);
