// The road from its data: surfaces, lines, lights, and the mark of the goal. Drawn in metres of the world.

import { safeColour } from "./dom.js";

const TYRE = "#17181A";
const PAINT = "#ECECE6";

function pathOf(points, isClosed) {
  const path = new Path2D();
  points.forEach(([x, y], index) => (index ? path.lineTo(x, y) : path.moveTo(x, y)));
  if (isClosed) path.closePath();
  return path;
}

export class RoadShape {
  constructor({ road, lights = [], goal, car_m }) {
    this.marks = road.map(({ kind, ring, points, width_m = 0, colour }) => ({
      kind, width_m, colour: safeColour(colour), path: pathOf(ring ?? points ?? [], kind !== "line"),
    }));
    this.lights = lights;
    this.goal = goal;
    this.car_m = car_m;
  }

  /** Draws the road; `pixel` is the size of a pixel in metres. */
  draw(context, pixel) {
    context.lineCap = "butt";
    context.lineJoin = "round";
    for (const { kind, path, width_m, colour } of this.marks) {
      if (kind === "fill") {
        context.fillStyle = colour;
        context.fill(path);
        continue;
      }
      context.strokeStyle = colour;
      context.lineWidth = Math.max(width_m, 1.3 * pixel);
      context.stroke(path);
    }
  }

  /** Marks the goal: a chequered line to cross, or arrows along the lane to reach. */
  drawGoal(context, own, pixel) {
    const { line, lane } = this.goal ?? {};
    if (line) this.drawFinish(context, line);
    if (!lane || lane.length < 2) return;
    const spacing = 1.1 * this.car_m;
    const size = [0.13 * this.car_m, 0.22 * this.car_m];
    context.lineWidth = Math.max(0.045 * this.car_m, 1.5 * pixel);
    context.lineCap = "round";
    context.strokeStyle = "rgb(255 255 255 / 0.6)";
    let left = 0;
    for (let index = 1; index < lane.length; index++) {
      const [from, to] = [lane[index - 1], lane[index]];
      const length = Math.hypot(to[0] - from[0], to[1] - from[1]);
      if (length < 1e-9) continue;
      const [cos, sin] = [(to[0] - from[0]) / length, (to[1] - from[1]) / length];
      // Long lanes are drawn near the own car only.
      const reach = 24 * this.car_m;
      const along = (own[0] - from[0]) * cos + (own[1] - from[1]) * sin;
      const skipped = Math.max(left, left + spacing * Math.ceil((along - reach - left) / spacing));
      let at = skipped;
      for (; at < Math.min(length, along + reach); at += spacing) {
        const place = (forward, across) => [from[0] + cos * (at + forward) - sin * across, from[1] + sin * (at + forward) + cos * across];
        context.beginPath();
        context.moveTo(...place(-size[0], size[1]));
        context.lineTo(...place(0, 0));
        context.lineTo(...place(-size[0], -size[1]));
        context.stroke();
      }
      left = (spacing - ((length - left) % spacing)) % spacing;
    }
  }

  drawFinish(context, [from, to]) {
    const length = Math.hypot(to[0] - from[0], to[1] - from[1]);
    if (length < 1e-9) return;
    const [along, across] = [[(to[0] - from[0]) / length, (to[1] - from[1]) / length], [-(to[1] - from[1]) / length, (to[0] - from[0]) / length]];
    const count = Math.max(4, 2 * Math.round(length / (0.26 * this.car_m)));
    const size = length / count;
    for (let row = 0; row < 2; row++)
      for (let column = 0; column < count; column++) {
        const corner = (right, up) => [0, 1].map((axis) => from[axis] + along[axis] * size * (column + right) + across[axis] * size * (row - 1 + up));
        context.fillStyle = (row + column) % 2 ? TYRE : PAINT;
        context.fill(pathOf([corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)], true));
      }
  }

  /** Draws the traffic lights at a time, with three lamps beside the bar so that position also tells the colour. */
  drawLights(context, time_s, pixel, place) {
    const bars = [];
    for (const { bar, colours = [], cycle_s } of this.lights) {
      const within = ((time_s % cycle_s) + cycle_s) % cycle_s;
      const colour = safeColour((colours.find(([, until]) => within < until) ?? colours.at(-1) ?? ["#9A9EA4"])[0]);
      context.lineCap = "round";
      const width = Math.max(0.13 * this.car_m, 4 * pixel);
      for (const [more, ink] of [[2 * pixel, TYRE], [0, colour]]) {
        context.strokeStyle = ink;
        context.lineWidth = width + more;
        context.stroke(pathOf(bar, false));
      }
      bars.push({ at: place(bar[1]), colour });
    }
    return bars;
  }
}

/** The three lamps of traffic lights, red above and green below, in pixels of the screen. */
export function drawLamps(context, bars) {
  for (const { at: [x, y], colour } of bars) {
    const [red, green] = [1, 3].map((from) => parseInt(colour.slice(from, from + 2), 16));
    const lit = red > 1.8 * green ? 0 : green > red ? 2 : 1;
    context.fillStyle = TYRE;
    context.beginPath();
    context.roundRect(x + 6, y - 20, 14, 40, 4);
    context.fill();
    for (let lamp = 0; lamp < 3; lamp++) {
      context.fillStyle = lamp === lit ? colour : "#3A3E44";
      context.beginPath();
      context.arc(x + 13, y - 12 + 12 * lamp, 4.5, 0, 2 * Math.PI);
      context.fill();
    }
  }
}
