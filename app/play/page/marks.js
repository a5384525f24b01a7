// Marks in pixels of the screen: bands of plans, dots of proposals, names with what drivers believe, arrows at the edge.

import { safeColour, veiled } from "./dom.js";

const WORDS = "#F2F2EE";
const BAR = "rgb(35 38 43 / 0.88)";
const FONT = 'system-ui, "DejaVu Sans", sans-serif';
/** Shorter plans, in lengths of the vehicle, are knots and not drawn. */
const MIN_PLAN_LENGTHS = 1.5;
const BAND_OPACITY = 0.42;
const BAND_LINE_PX = 2;

const distance = (from, to) => Math.hypot(to[0] - from[0], to[1] - from[1]);

/** Whether a plan is long enough to be drawn. */
export function leadsAway(points, length_m) {
  return points.length > 1 && points.some((point) => distance(points[0], point) > MIN_PLAN_LENGTHS * length_m);
}

function trace(context, points) {
  context.beginPath();
  points.forEach(([x, y], index) => (index ? context.lineTo(x, y) : context.moveTo(x, y)));
}

/** Points beside a line [px]. */
function beside(points, away) {
  return points.map(([x, y], index) => {
    const [before, after] = [points[Math.max(index - 1, 0)], points[Math.min(index + 1, points.length - 1)]];
    const length = Math.max(distance(before, after), 1e-9);
    return [x - (away * (after[1] - before[1])) / length, y + (away * (after[0] - before[0])) / length];
  });
}

/** A band along a plan: a translucent area between two lines in the colour of the vehicle. */
export function drawBand(context, points, width, colour) {
  context.lineCap = "round";
  context.lineJoin = "round";
  context.strokeStyle = veiled(colour, BAND_OPACITY);
  context.lineWidth = width;
  trace(context, points);
  context.stroke();
  context.strokeStyle = safeColour(colour);
  context.lineWidth = BAND_LINE_PX;
  for (const side of [-0.5, 0.5]) {
    trace(context, beside(points, side * (width - BAND_LINE_PX)));
    context.stroke();
  }
}

/** Dots along a proposal, in the colour of its sender; larger if it is for the person. */
export function drawDots(context, points, colour, isMine) {
  const [spacing, rim, size] = isMine ? [15, 6, 4.2] : [11, 3.6, 2.6];
  let left = spacing;
  for (let index = 1; index < points.length; index++) {
    const [from, to] = [points[index - 1], points[index]];
    const length = distance(from, to);
    for (; left < length; left += spacing) {
      const at = from.map((value, axis) => value + ((to[axis] - value) * left) / length);
      for (const [radius, ink] of [[rim, "#FFFFFF"], [size, safeColour(colour)]]) {
        context.fillStyle = ink;
        context.beginPath();
        context.arc(...at, radius, 0, 2 * Math.PI);
        context.fill();
      }
    }
    left -= length;
  }
}

const overlaps = (one, other) => one.left < other.right && other.left < one.right && one.top < other.bottom && other.top < one.bottom;

/** Places labels without overlaps. */
export class Labels {
  constructor(context, area, taken) {
    this.context = context;
    this.area = area;
    this.taken = taken;
  }

  /** Lines of words beside a rectangle: `{text, share}`; a share is drawn as a bar. */
  draw(lines, around, { colour, isStrong = false }) {
    const { context } = this;
    context.textBaseline = "middle";
    context.textAlign = "left";
    const isNarrow = this.area.right - this.area.left < 500;
    const bar = isNarrow ? 24 : 38;
    const size = (index) => (index === 0 ? 14 : isNarrow ? 12 : 12.5);
    const font = (index) => `${index === 0 && isStrong ? "700" : "500"} ${size(index)}px ${FONT}`;
    const widths = lines.map(({ text, share }, index) => {
      context.font = font(index);
      return context.measureText(text).width + (share === undefined ? 0 : bar + 8);
    });
    const [width, height] = [Math.max(...widths) + (isNarrow ? 15 : 18), 19 * lines.length + 5];
    const [x, y] = [0.5 * (around.left + around.right), 0.5 * (around.top + around.bottom)];
    const places = [
      [around.right + 6, y - 0.5 * height], [around.left - 6 - width, y - 0.5 * height],
      [x - 0.5 * width, around.top - 6 - height], [x - 0.5 * width, around.bottom + 6],
      [around.right + 6, y - height - 8], [around.left - 6 - width, y - height - 8],
      [around.right + 6, y + 8], [around.left - 6 - width, y + 8],
      [around.right + 40, y - 0.5 * height], [around.left - 40 - width, y - 0.5 * height],
    ];
    const boxes = places.map(([left, top]) => ({ left, top, right: left + width, bottom: top + height }));
    const inside = ({ left, top, right, bottom }) => left >= this.area.left && right <= this.area.right && top >= this.area.top && bottom <= this.area.bottom;
    const isFree = (box) => !this.taken.some((other) => overlaps(box, other));
    const box = boxes.find((box) => inside(box) && isFree(box));
    if (!box) return false;
    this.taken.push(box);
    context.fillStyle = BAR;
    context.beginPath();
    context.roundRect(box.left, box.top, width, height, 5);
    context.fill();
    context.fillStyle = safeColour(colour);
    context.fillRect(box.left, box.top + 4, 4, height - 8);
    lines.forEach(({ text, share }, index) => {
      const middle = box.top + 12.5 + 19 * index;
      context.font = font(index);
      context.fillStyle = WORDS;
      context.fillText(text, box.left + 10, middle);
      if (share === undefined) return;
      const left = box.right - bar - 6;
      context.fillStyle = "rgb(255 255 255 / 0.25)";
      context.fillRect(left, middle - 4, bar, 8);
      context.fillStyle = safeColour(colour);
      context.fillRect(left, middle - 4, bar * Math.min(Math.max(share, 0), 1), 8);
      context.strokeStyle = WORDS;
      context.lineWidth = 1;
      context.strokeRect(left, middle - 4, bar, 8);
    });
    return true;
  }

  /** An arrow at the edge that points to a vehicle out of view. */
  edge([x, y], words, colour) {
    const { context, area } = this;
    const inset = 16;
    const at = [Math.min(Math.max(x, area.left + inset), area.right - inset), Math.min(Math.max(y, area.top + inset), area.bottom - inset)];
    const angle = Math.atan2(y - at[1], x - at[0]);
    context.save();
    context.translate(...at);
    context.rotate(angle);
    context.beginPath();
    context.moveTo(12, 0);
    context.lineTo(-7, 9);
    context.lineTo(-7, -9);
    context.closePath();
    context.fillStyle = safeColour(colour);
    context.strokeStyle = "#17181A";
    context.lineWidth = 2;
    context.stroke();
    context.fill();
    context.restore();
    const around = { left: at[0] - 12, right: at[0] + 12, top: at[1] - 12, bottom: at[1] + 12 };
    this.taken.push(around);
    this.draw([{ text: words }], around, { colour });
  }
}
