// The start menu: families with pictures, their scenarios, and the seat.

import { button, element } from "./dom.js";

const NAMES = /^[a-z0-9-]+$/i;

function picture({ family, picture }) {
  const place = element("span", { className: "picture", aria: { hidden: "true" } });
  if (picture === false || !NAMES.test(family)) return place;
  const image = element("img", { alt: "", loading: "lazy", src: `pictures/${family}.webp` });
  image.addEventListener("error", () => image.remove());
  place.append(image);
  return place;
}

/** Arrow keys move among the elements that `all()` lists, as many as fit in a row at once. */
function moveByArrows(place, all) {
  place.addEventListener("keydown", (event) => {
    const items = all();
    const at = items.indexOf(document.activeElement);
    if (at < 0) return;
    const top = items[0].offsetTop;
    const columns = Math.max(1, items.findIndex(({ offsetTop }) => offsetTop > top) + 1 ? items.findIndex(({ offsetTop }) => offsetTop > top) : items.length);
    const move = { ArrowRight: 1, ArrowLeft: -1, ArrowDown: columns, ArrowUp: -columns, Home: -at, End: items.length - 1 - at }[event.code];
    if (move === undefined) return;
    event.preventDefault();
    items[Math.min(Math.max(at + move, 0), items.length - 1)].focus();
  });
}

/** The overlay with all families; `choose(family)` opens one. */
export function menuView(families, choose) {
  const cards = families.map((family) => {
    const count = family.scenarios.length;
    const made = element("button", { type: "button", className: "family", dataset: { family: family.family } },
      picture(family),
      element("strong", { textContent: family.title }),
      element("span", { className: "quiet", textContent: `${count} ${count === 1 ? "scenario" : "scenarios"}` }));
    made.addEventListener("click", () => choose(family));
    return made;
  });
  const list = element("div", { className: "families" }, cards);
  moveByArrows(list, () => cards);
  const made = element("section", { className: "page menu" },
    element("h1", { textContent: "Drive among drivers who negotiate" }),
    element("p", { className: "lead", textContent: "Take one of the cars. The others plan, ask each other for room and answer – with you among them. You see what they plan, what they ask you for, and what they think of you." }),
    element("h2", { textContent: "Choose a situation" }),
    cards.length ? list : element("p", { textContent: "The server has no scenarios." }));
  return { made, first: cards[0] ?? made };
}

/** The overlay with the scenarios of a family; `start(scenario, seat)` begins one, `back()` returns. */
export function familyView(family, start, back, wanted = {}) {
  let scenario = family.scenarios.find(({ name }) => name === wanted.scenario) ?? family.scenarios.find(({ name }) => /[-/]nice$/.test(name)) ?? family.scenarios[0];
  let seat = wanted.seat;
  const seats = element("div", { className: "seats", role: "radiogroup", aria: { label: "Which vehicle do you drive?" } });
  const shows = element("p", { className: "shows" });
  const radio = (group, value, words, isChecked, chosen) => {
    const input = element("input", { type: "radio", name: group, value, checked: isChecked });
    input.addEventListener("change", () => chosen(value));
    return element("label", { className: "choice" }, input, element("span", {}, words));
  };
  const draw = () => {
    if (!scenario.seats.includes(seat)) seat = scenario.seats.includes("ego") ? "ego" : scenario.seats[0];
    shows.textContent = scenario.shows ?? "";
    seats.replaceChildren(...scenario.seats.map((name) => radio("seat", name, name, name === seat, (value) => (seat = value))));
  };
  const list = element("div", { className: "scenarios", role: "radiogroup", aria: { label: "Scenario" } }, family.scenarios.map(({ name, title }) =>
    radio("scenario", name, [element("strong", { textContent: title }), element("small", { textContent: name })], name === scenario.name, (value) => {
      scenario = family.scenarios.find(({ name }) => name === value);
      draw();
    })));
  draw();
  const go = button({ words: "Drive", key: "Enter", className: "primary" }, () => start(scenario.name, seat));
  const made = element("section", { className: "page family-page" },
    button({ words: "‹ All situations", key: "Esc", className: "plain" }, back),
    element("h1", { textContent: family.title }),
    element("div", { className: "two" },
      element("div", {}, element("h2", { textContent: "Scenario" }), list),
      element("div", { className: "side" }, picture(family), element("h2", { textContent: "What it shows" }), shows, element("h2", { textContent: "Which vehicle do you drive?" }), seats, go)));
  made.addEventListener("keydown", (event) => {
    if (event.code !== "Enter" || event.target.tagName === "BUTTON") return;
    event.preventDefault();
    start(scenario.name, seat);
  });
  return { made, first: list.querySelector("input:checked") ?? go };
}
