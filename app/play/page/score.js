// The score: the person and the planners from the same start, the events, and the path of the saved drive.

import { button, element } from "./dom.js";

const number = (value, digits) => (Number.isFinite(value) ? value.toFixed(digits) : "–");

/** The rows of the comparison; a star marks the best of those that have `best`. */
const METRICS = [
  { words: "Goal reached after [s]", of: ({ has_task, reached_s }) => (Number.isFinite(reached_s) && has_task ? reached_s.toFixed(1) : has_task ? "never" : "–"), value: ({ has_task, reached_s }) => (has_task && reached_s) || Infinity, best: Math.min },
  { words: "Smallest gap [m]", of: ({ smallest_gap_m }) => number(smallest_gap_m, 2), value: ({ smallest_gap_m }) => smallest_gap_m ?? -Infinity, best: Math.max },
  { words: "Hardest braking [m/s²]", of: ({ hardest_braking_mps2 }) => number(hardest_braking_mps2, 1), value: ({ hardest_braking_mps2 }) => hardest_braking_mps2 ?? Infinity, best: Math.min },
  { words: "Largest jerk [m/s³]", of: ({ largest_jerk_mps3 }) => number(largest_jerk_mps3, 1), value: ({ largest_jerk_mps3 }) => largest_jerk_mps3 ?? Infinity, best: Math.min },
  { words: "Rules broken", of: ({ rules_broken }) => `${rules_broken ?? "–"}`, value: ({ rules_broken }) => rules_broken ?? Infinity, best: Math.min },
  { words: "Contact", of: ({ contact }) => (contact ? "⚠ yes" : "none"), isBad: ({ contact }) => contact },
  { words: "Left the road", of: ({ off_road }) => (off_road ? "⚠ yes" : "no"), isBad: ({ off_road }) => off_road },
];

/** The headline in one line. */
function verdict({ contact, off_road, has_task, reached_s, rules_broken }) {
  if (contact) return "You crashed";
  if (off_road) return "You left the road";
  if (!has_task) return rules_broken ? `You drove to the end, with ${rules_broken} ${rules_broken === 1 ? "rule" : "rules"} broken` : "You drove to the end without contact";
  if (!Number.isFinite(reached_s)) return "You did not reach the goal";
  const broken = rules_broken ? `, with ${rules_broken} ${rules_broken === 1 ? "rule" : "rules"} broken` : "";
  return `You reached the goal after ${reached_s.toFixed(1)}\u00a0s${broken}`;
}

function table(rows) {
  const isComparable = rows.length > 1;
  const head = element("tr", {}, element("td", {}), rows.map(({ name }) => element("th", { scope: "col", textContent: name, className: name === "you" ? "you" : "" })));
  const lines = METRICS.map(({ words, of, value, best, isBad }) => {
    const values = best ? rows.map(value) : [];
    const top = best ? best(...values) : NaN;
    const cells = rows.map((row, index) => {
      // Values that are displayed alike are equally good.
      const isBest = isComparable && best && Number.isFinite(top) && of(row) === of(rows[values.indexOf(top)]) && rows.some((other) => of(other) !== of(row));
      const text = `${of(row)}${isBest ? " ★" : ""}`;
      return element("td", { textContent: text, className: [isBad?.(row) ? "bad" : "", row.name === "you" ? "you" : ""].join(" ").trim(), title: isBest ? "the best" : "" });
    });
    return element("tr", {}, element("th", { scope: "row", textContent: words }), cells);
  });
  return element("table", {}, element("thead", {}, head), element("tbody", {}, lines));
}

/** The overlay with a score; `act(name)` carries out the action of a button. */
export function scoreView(world, score, act) {
  const { you, others = [], story = [], saved, animation } = score;
  const rows = [{ ...you, name: "you" }, ...others];
  const parts = [
    element("p", { className: "quiet", textContent: world ? `${world.title} – as ${world.seat}` : "" }),
    element("h1", { textContent: verdict(you) }),
    element("div", { className: "scroll", tabIndex: 0, role: "region", aria: { label: "Comparison" } }, table(rows)),
    element("p", { className: "quiet", textContent: others.length ? `${others.length > 1 ? "Planners" : "A planner"} drove your car from the same start. ★ marks the best.` : "The planners drive from the same start now …" }),
  ];
  const below = [];
  if (story.length) below.push(element("div", {}, element("h2", { textContent: "What happened" }), element("ol", { className: "story" }, story.map((line) => element("li", { textContent: line })))));
  // Only content of the server is loaded.
  if (typeof animation === "string" && animation.startsWith("/") && !animation.startsWith("//"))
    below.push(element("figure", {}, element("img", { src: animation, alt: "Animation of your drive" }), element("figcaption", {}, element("a", { href: animation, download: "", textContent: "Save the animation" }))));
  if (below.length) parts.push(element("div", { className: "both" }, below));
  if (saved) parts.push(element("p", { className: "saved" }, "Your drive is saved. Replay it with ", element("code", { textContent: `interplay run ${saved}` })));
  const buttons = element("div", { className: "actions" },
    button({ words: "Again", key: "R", className: "primary" }, () => act("restart")),
    button({ words: "Next scenario", key: "N" }, () => act("next")),
    button({ words: "Menu", key: "M" }, () => act("menu")));
  const made = element("section", { className: "card wide score", role: "dialog", aria: { label: "Score" } }, parts, buttons);
  return { made, first: buttons.firstElementChild };
}
