// Cards over the road: before the start, in a pause, help, and without a connection.

import { button, element, keycap, swatch } from "./dom.js";

const KEYS = [
  [["↑", "W"], "faster"], [["↓", "S"], "slower"], [["←", "A"], "steer left"], [["→", "D"], "steer right"], [["Space"], "brake hard"],
  [["P"], "hand over to a planner and back"], [["R"], "start again"], [["Backspace"], "back 5 seconds"], [["Esc"], "pause"],
  [["Tab"], "drive another car"], [["N"], "next scenario"], [["M"], "menu"], [["1", "…", "9"], "slow motion to time-lapse (5: normal)"],
  [["V"], "show or hide plans and beliefs"], [["K"], "lane keeping on or off"], [["E"], "end the drive now"], [["?"], "this help"],
];

const keyList = (rows) => element("dl", { className: "keylist" }, rows.map(([caps, words]) => element("div", {}, element("dt", {}, caps.map((cap) => (cap === "…" ? " … " : keycap(cap)))), element("dd", { textContent: words }))));

const marks = (isTouch) => element("ul", { className: "marklist" },
  element("li", {}, element("span", { className: "mark you" }), "white outline, named “you”: your car"),
  element("li", {}, element("span", { className: "mark band" }), "band: where another driver plans to go"),
  element("li", {}, element("span", { className: "mark dots" }), "dots and dashed cars: where a driver asks you to be. You may do so or not"),
  isTouch ? null : element("li", {}, element("span", { className: "mark arrows" }), "arrows or a chequered line: your goal"));

const card = (label, ...children) => element("section", { className: "card", role: "dialog", aria: { label } }, children);

/** Before a drive: the goal, the car, the keys. */
export function readyView(world, isTouch, act) {
  const { study } = world;
  const own = world.vehicles.find(({ name }) => name === world.seat);
  const go = button({ words: "Start", key: isTouch ? undefined : "Enter", className: "primary" }, () => act("go"));
  const drive = isTouch
    ? element("p", {}, "Steer with your left thumb, ", element("b", { textContent: "Go" }), " and ", element("b", { textContent: "Brake" }), " with your right one. Without a pedal you keep your speed.")
    : element("div", {}, keyList(KEYS.slice(0, study ? 3 : 5)), element("p", { className: "quiet", textContent: "Without a key you keep your speed, and lane keeping helps you to steer (K switches it off). Game controllers work, too." }));
  const made = card("Before the start",
    element("p", { className: "quiet", textContent: study ? `Run ${study.done + 1} of ${study.of}` : world.title ?? "" }),
    element("h1", { textContent: world.goal?.text ?? "Drive" }),
    element("p", { className: "lead" }, "You drive ", swatch(own?.colour ?? ""), ` ${world.seat}. `, study ? "Drive as you would on a road." : world.help ?? ""),
    element("h2", { textContent: "How to drive" }), drive,
    study ? null : element("h2", { textContent: "What you see" }), study ? null : marks(isTouch),
    element("div", { className: "actions" }, go, element("span", { className: "quiet", textContent: isTouch ? "" : "or any driving key" })));
  return { made, first: go };
}

export function pauseView(isTouch, act) {
  const go = button({ words: "Go on", key: isTouch ? undefined : "Esc", className: "primary" }, () => act("go"));
  const rest = [["Start again", "R", "restart"], ["Back 5 seconds", "Backspace", "rewind"], ["Drive another car", undefined, "changeSeat"], ["End and see the score", "E", "end"], ["Menu", "M", "menu"]];
  const made = card("Paused", element("h1", { textContent: "Paused" }), element("div", { className: "actions column" }, go,
    rest.map(([words, key, name]) => button({ words, key: isTouch ? undefined : key }, () => act(name)))));
  return { made, first: go };
}

export function helpView(isTouch, act) {
  const close = button({ words: "Close", key: isTouch ? undefined : "Esc", className: "primary" }, () => act("help"));
  const pad = "Game controller: left stick steers, right trigger accelerates, left trigger brakes. Touch: stick on the left, pedals on the right.";
  const made = card("Help", element("h1", { textContent: "Help" }), keyList(KEYS), element("p", { className: "quiet", textContent: pad }),
    element("h2", { textContent: "What you see" }), marks(isTouch), element("div", { className: "actions" }, close));
  made.classList.add("wide");
  return { made, first: close };
}

/** Without a connection to the server. */
export function goneView(words, again) {
  const retry = button({ words: "Connect again", className: "primary" }, again);
  const made = card("No connection", element("h1", { textContent: "No connection" }), element("p", { textContent: words }),
    element("p", { className: "quiet" }, "Start the server with ", element("code", { textContent: "interplay play" }), " and open the address that it prints."),
    element("div", { className: "actions" }, retry));
  return { made, first: retry };
}
