// Elements made by code. Text from the server is set as text only, colours only if they are hexadecimal.

/** An element with properties and children. `dataset` and `aria` are objects; strings become text. */
export function element(tag, { aria = {}, dataset = {}, ...properties } = {}, ...children) {
  const made = document.createElement(tag);
  Object.assign(made, properties);
  Object.assign(made.dataset, dataset);
  for (const [name, value] of Object.entries(aria)) made.setAttribute(`aria-${name}`, value);
  made.append(...children.flat().filter((child) => child !== null && child !== undefined));
  return made;
}

const SVG = "http://www.w3.org/2000/svg";

/** An icon of lines in a square of 24 by 24. */
function signOf(lines) {
  const picture = document.createElementNS(SVG, "svg");
  picture.setAttribute("viewBox", "0 0 24 24");
  picture.setAttribute("class", "sign");
  picture.setAttribute("aria-hidden", "true");
  const path = document.createElementNS(SVG, "path");
  path.setAttribute("d", lines);
  picture.append(path);
  return picture;
}

/** A button with words, or with an icon (lines) whose words are its label and tooltip. */
export function button({ words, sign, key, ...properties }, act) {
  const made = element("button", { type: "button", ...properties });
  if (sign) {
    made.append(signOf(sign));
    made.setAttribute("aria-label", words);
    made.title = key ? `${words} (${key})` : words;
  } else {
    made.append(words);
    if (key) made.append(" ", element("kbd", { textContent: key, aria: { hidden: "true" } }));
  }
  made.addEventListener("click", act);
  return made;
}

/** A valid colour, otherwise grey. */
export function safeColour(colour) {
  return /^#[0-9a-f]{6}$/i.test(colour) ? colour : "#9A9EA4";
}

/** A darker shade, as `palette.rs` computes it. */
export function darker(colour) {
  const parts = [1, 3, 5].map((at) => Math.trunc(0.55 * parseInt(safeColour(colour).slice(at, at + 2), 16)));
  return `rgb(${parts.join(" ")})`;
}

/** A translucent colour. */
export function veiled(colour, opacity) {
  const parts = [1, 3, 5].map((at) => parseInt(safeColour(colour).slice(at, at + 2), 16));
  return `rgb(${parts.join(" ")} / ${opacity})`;
}

/** A small square in the colour of a vehicle. */
export function swatch(colour) {
  const made = element("span", { className: "swatch", aria: { hidden: "true" } });
  made.style.backgroundColor = safeColour(colour);
  return made;
}

/** The label of a key on keyboards. */
export function keycap(words) {
  return element("kbd", { textContent: words });
}

/** A sentence of the server in which the person's own vehicle is an object: its name becomes "you". */
export function asYou(text, seat) {
  const name = seat.replace(/[.*+?^${}()|[\]\\]/g, "\\$&");
  return text.replace(new RegExp(`(?<![\\w-])${name}(?![\\w-])`, "gu"), "you");
}
