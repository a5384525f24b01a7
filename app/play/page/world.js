// Draws the world on a canvas at the screen's rate.

import { Camera } from "./camera.js";
import { asYou, safeColour } from "./dom.js";
import { drawBand, drawDots, Labels, leadsAway } from "./marks.js";
import { drawLamps, RoadShape } from "./roads.js";
import { enterBody, VehicleShape } from "./vehicles.js";

const GRASS = "#B9CBA4";
/** Times at which the own car is outlined on a requested plan, as shares of the plan. */
const ASKED_AT = [0.4, 0.8];

export class WorldView {
  constructor(canvas) {
    this.canvas = canvas;
    this.context = canvas.getContext("2d");
    this.world = null;
    this.showsPlans = true;
    this.isStill = matchMedia("(prefers-reduced-motion: reduce)").matches;
    new ResizeObserver(() => this.resize()).observe(canvas);
    this.resize();
  }

  resize() {
    const ratio = Math.min(window.devicePixelRatio || 1, 3);
    const { clientWidth, clientHeight } = this.canvas;
    this.ratio = ratio;
    this.size = [clientWidth, clientHeight];
    this.canvas.width = Math.max(1, Math.round(ratio * clientWidth));
    this.canvas.height = Math.max(1, Math.round(ratio * clientHeight));
  }

  /** Begins a world. */
  begin(world) {
    this.world = world;
    this.camera = null;
    this.road = new RoadShape(world);
    this.shapes = world.vehicles.map((vehicle) => new VehicleShape(vehicle));
    this.own = world.vehicles.findIndex(({ name }) => name === world.seat);
  }

  index(name) {
    return this.world.vehicles.findIndex((vehicle) => vehicle.name === name);
  }

  clear() {
    this.context.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
    this.context.fillStyle = GRASS;
    this.context.fillRect(0, 0, ...this.size);
  }

  /** Draws the world from `shown` of the motion, the last frame, the free part of the screen [px] and seconds of wall time. */
  draw(shown, frame, area, seconds, elapsed) {
    this.clear();
    if (!this.world || !shown) return;
    const { context, own } = this;
    const isThere = (index) => !frame.absent?.[index];
    const me = shown.states[Math.max(own, 0)];
    this.camera ??= new Camera(this.world, me[2]);
    const partners = new Set((frame.proposals ?? []).filter(({ from, to }) => [from, to].includes(this.world.seat)).flatMap(({ from, to }) => [this.index(from), this.index(to)]));
    const others = shown.states.map((state, index) => (index !== own && isThere(index) && !this.world.vehicles[index].is_obstacle ? state : null));
    this.camera.follow(me, others, partners, area, elapsed);
    const pixel = 1 / this.camera.scale;
    const inWorld = () => {
      const [a, b, c, d, e, f] = this.camera.matrix().map((value) => this.ratio * value);
      context.setTransform(a, b, c, d, e, f);
    };
    const onScreen = () => context.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
    inWorld();
    this.road.draw(context, pixel);
    this.road.drawGoal(context, me, pixel);
    const bars = this.road.drawLights(context, shown.time, pixel, (point) => this.camera.place(point));
    onScreen();
    if (this.showsPlans) this.drawPlans(frame, isThere);
    inWorld();
    if (this.showsPlans) this.drawAsked(frame, pixel);
    shown.states.forEach((state, index) => isThere(index) && this.shapes[index].drawShadow(context, state, this.camera.turn));
    shown.states.forEach((state, index) => {
      if (!isThere(index)) return;
      const looks = { steering: shown.steering[index], brakes: shown.brakes?.[index] ?? frame.brakes?.[index], turn: frame.turn?.[index] };
      this.shapes[index].draw(context, state, { ...looks, isOwn: index === own, pixel, seconds, isStill: this.isStill });
    });
    onScreen();
    drawLamps(context, bars);
    this.drawLabels(shown, frame, area, isThere, partners);
  }

  drawPlans(frame, isThere) {
    const { context, camera, shapes } = this;
    const place = (points) => points.map((point) => camera.place(point));
    (frame.plans ?? []).forEach((points, index) => {
      if (!isThere(index) || index === this.own || !leadsAway(points, shapes[index].length_m)) return;
      drawBand(context, place(points), 0.5 * shapes[index].width_m * camera.scale, this.world.vehicles[index].colour);
    });
    for (const { from, to, points } of frame.proposals ?? []) {
      const colour = this.world.vehicles[this.index(from)]?.colour;
      drawDots(context, place(points ?? []), colour, to === this.world.seat);
    }
  }

  /** Outlines the requested positions of the own car. */
  drawAsked(frame, pixel) {
    const { context } = this;
    for (const { from, to, points } of frame.proposals ?? []) {
      if (to !== this.world.seat || !points || points.length < 3 || this.own < 0) continue;
      for (const share of ASKED_AT) {
        const at = Math.max(1, Math.round(share * (points.length - 1)));
        const [[x, y], [to_x, to_y]] = [points[at - 1], points[at]];
        const heading = Math.hypot(to_x - x, to_y - y) > 1e-3 ? Math.atan2(to_y - y, to_x - x) : frame.states[this.own][2];
        context.save();
        enterBody(context, [to_x, to_y, heading]);
        context.fillStyle = "rgb(255 255 255 / 0.2)";
        context.fill(this.shapes[this.own].outline);
        context.setLineDash([6 * pixel, 4 * pixel]);
        for (const [width, colour] of [[5, "#FFFFFF"], [2.4, safeColour(this.world.vehicles[this.index(from)]?.colour)]]) {
          context.lineWidth = width * pixel;
          context.strokeStyle = colour;
          context.stroke(this.shapes[this.own].outline);
        }
        context.restore();
      }
    }
  }

  /** The rectangle around a vehicle on the screen [px]. */
  bounds(state, index) {
    const [cos, sin] = [Math.cos(state[2]), Math.sin(state[2])];
    const corners = this.shapes[index].corners.map(([ahead, left]) => this.camera.place([state[0] + cos * ahead - sin * left, state[1] + sin * ahead + cos * left]));
    const [xs, ys] = [0, 1].map((axis) => corners.map((corner) => corner[axis]));
    return { left: Math.min(...xs), right: Math.max(...xs), top: Math.min(...ys), bottom: Math.max(...ys) };
  }

  drawLabels(shown, frame, area, isThere, partners) {
    const { own } = this;
    const { vehicles, seat } = this.world;
    const boxes = shown.states.map((state, index) => this.bounds(state, index));
    const asked = (frame.proposals ?? []).filter(({ to }) => to === seat && this.showsPlans).flatMap(({ points }) => points ?? []);
    const dots = asked.map((point) => this.camera.place(point)).map(([x, y]) => ({ left: x - 6, right: x + 6, top: y - 6, bottom: y + 6 }));
    const labels = new Labels(this.context, area, [...boxes.filter((_, index) => isThere(index)), ...dots]);
    // The person first, then partners, then the nearest vehicles.
    const away = (index) => (index === own ? -2 : partners.has(index) ? -1 : Math.hypot(...[0, 1].map((axis) => shown.states[index][axis] - shown.states[own][axis])));
    const order = vehicles.map((_, index) => index).filter((index) => isThere(index) && !vehicles[index].is_obstacle);
    order.sort((one, other) => away(one) - away(other));
    for (const index of order) {
      const { name, colour } = vehicles[index];
      const box = boxes[index];
      const isSeen = box.right > area.left && box.left < area.right && box.bottom > area.top && box.top < area.bottom;
      if (!isSeen) {
        const near = away(index) < 14 * this.world.car_m;
        if (near) labels.edge([0.5 * (box.left + box.right), 0.5 * (box.top + box.bottom)], name, colour);
        continue;
      }
      const lines = [{ text: index === own ? `you (${name})` : name }];
      if (this.showsPlans) lines.push(...this.thoughts(frame, name, seat));
      labels.draw(lines, box, { colour, isStrong: index === own }) || labels.draw(lines.slice(0, 1), box, { colour });
    }
  }

  /** The belief of a driver, and its acceptance of a request. */
  thoughts(frame, name, seat) {
    const words = [];
    for (const { of, about, nice, text } of frame.beliefs ?? []) {
      if (of !== name) continue;
      const line = about === seat && typeof text === "string" ? asYou(text, seat) : text ?? `takes ${about} for nice`;
      words.push({ text: line, ...(Number.isFinite(nice) ? { share: nice } : {}) });
    }
    for (const { to, share } of frame.proposals ?? [])
      if (to === name && Number.isFinite(share)) words.push({ text: to === seat ? "you do as asked" : "does as asked", share });
    return words.slice(0, 3);
  }
}
