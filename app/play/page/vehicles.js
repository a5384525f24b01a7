// Vehicles from above, drawn from the shapes of the animations: shadow, wheels that steer, body, lamps.

import { darker, safeColour, veiled } from "./dom.js";

const TYRE = "#17181A";
const TAIL_LIGHT = "#7A1A1C";
const BRAKE_LIGHT = "#FF2A2A";
const INDICATOR = "#FFE83A";
/** Half a period of an indicator [s]. */
const BLINK_S = 0.35;

/** A path through corners that are rounded with a radius. */
export function roundedPath(ring, radius = 0) {
  const path = new Path2D();
  const count = ring.length;
  if (!count) return path;
  ring.forEach((corner, index) => {
    const [before, after] = [ring[(index + count - 1) % count], ring[(index + 1) % count]];
    const [to, from] = [before, after].map((other) => Math.hypot(other[0] - corner[0], other[1] - corner[1]));
    const cut = Math.min(radius, 0.5 * to, 0.5 * from);
    const along = (other, length) => corner.map((value, axis) => value + (cut / Math.max(length, 1e-9)) * (other[axis] - value));
    if (index) path.lineTo(...along(before, to));
    else path.moveTo(...along(before, to));
    if (cut > 0) path.quadraticCurveTo(...corner, ...along(after, from));
  });
  path.closePath();
  return path;
}

/** The shapes of a vehicle, in metres ahead and to the left of its mass centre, prepared once. */
export class VehicleShape {
  constructor(vehicle) {
    const { body, colour, shape = [], shadow, wheels, lamps } = vehicle;
    this.width_m = body.width_m;
    this.length_m = body.front_m + body.rear_m;
    this.middle_m = 0.5 * (body.front_m - body.rear_m);
    this.colour = safeColour(colour);
    this.parts = shape.map(({ ring, radius, colour }) => ({ path: roundedPath(ring, radius), colour: safeColour(colour) }));
    this.shadow = shadow && roundedPath(shadow, 0.3 * body.width_m);
    this.wheels = (wheels?.rings ?? []).map((ring, index) => {
      const axle = wheels.axles[index];
      const own = ring.map(([x, y]) => [x - axle[0], y - axle[1]]);
      return { path: roundedPath(own, 0.045 * body.width_m), axle, isSteered: Boolean(wheels.steered[index]) };
    });
    const paths = (rings) => (rings ?? []).map((ring) => roundedPath(ring, 0.06 * body.width_m));
    this.lamps = lamps && { ...lamps, tail: paths(lamps.tail), brake: paths(lamps.brake), glow: lamps.brake ?? [] };
    const { front_m, rear_m, width_m } = body;
    const box = [[-rear_m, -0.5 * width_m], [front_m, -0.5 * width_m], [front_m, 0.5 * width_m], [-rear_m, 0.5 * width_m]];
    this.outline = roundedPath(box, 0.3 * width_m);
    this.corners = box;
  }

  /** Draws its shadow, which lies below all vehicles; `shift` is its offset in the body frame [m]. */
  drawShadow(context, state, turn) {
    if (!this.shadow) return;
    const off = 0.16 * this.width_m;
    // To the lower right of the screen for any heading.
    const angle = -Math.PI / 4 - turn - state[2];
    context.save();
    enterBody(context, state);
    context.translate(off * Math.cos(angle), off * Math.sin(angle));
    context.fillStyle = "rgb(27 29 32 / 0.35)";
    context.fill(this.shadow);
    context.restore();
  }

  /** Draws the vehicle. `pixel` is the size of a pixel in metres. */
  draw(context, state, { steering, brakes, turn, isOwn, pixel, seconds, isStill }) {
    context.save();
    enterBody(context, state);
    context.fillStyle = TYRE;
    for (const { path, axle, isSteered } of this.wheels) {
      context.save();
      context.translate(...axle);
      if (isSteered) context.rotate(steering);
      context.fill(path);
      context.restore();
    }
    for (const { path, colour } of this.parts) {
      context.fillStyle = colour;
      context.fill(path);
    }
    if (this.parts.length) {
      context.strokeStyle = darker(this.colour);
      context.lineWidth = Math.max(0.035 * this.width_m, pixel);
      context.stroke(this.parts[0].path);
    }
    if (isOwn) {
      context.strokeStyle = "#FFFFFF";
      context.lineWidth = Math.max(0.07 * this.width_m, 2.5 * pixel);
      context.stroke(this.outline);
    }
    this.drawLamps(context, { brakes, turn, seconds, isStill, pixel });
    context.restore();
  }

  drawLamps(context, { brakes, turn, seconds, isStill, pixel }) {
    if (!this.lamps) return;
    const radius = this.lamps.radius ?? 0.15 * this.width_m;
    const disc = ([x, y], size, colour) => {
      context.fillStyle = colour;
      context.beginPath();
      context.arc(x, y, size, 0, 2 * Math.PI);
      context.fill();
    };
    if (brakes)
      for (const ring of this.lamps.glow) {
        const middle = [0, 1].map((axis) => ring.reduce((sum, corner) => sum + corner[axis], 0) / Math.max(ring.length, 1));
        disc([middle[0] - 0.1 * this.width_m, middle[1]], 0.34 * this.width_m, veiled(BRAKE_LIGHT, 0.38));
      }
    context.fillStyle = brakes ? BRAKE_LIGHT : TAIL_LIGHT;
    (brakes ? this.lamps.brake : this.lamps.tail).forEach((path) => context.fill(path));
    if (turn && (isStill || Math.floor(seconds / BLINK_S) % 2 === 0)) {
      for (const place of this.lamps[`indicator_${turn}`] ?? []) {
        disc(place, 2 * radius, veiled(INDICATOR, 0.45));
        disc(place, Math.max(1.27 * radius, 3 * pixel), TYRE);
        disc(place, Math.max(radius, 2.4 * pixel), INDICATOR);
      }
    }
  }
}

/** Moves the origin of the drawing to a vehicle, ahead along x. */
export function enterBody(context, [x, y, heading]) {
  const [cos, sin] = [Math.cos(heading), Math.sin(heading)];
  context.transform(cos, sin, -sin, cos, x, y);
}
