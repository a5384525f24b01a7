// Positions of all vehicles between frames.
//
// A frame has the states at the end of a tick. All vehicles are shown at the same time, so that gaps are true: the own car is
// predicted from there by the inputs that the server has not acknowledged, the others by their last inputs. A time before the
// last frame is interpolated between the last two. Corrections by a new frame are faded in.

import { inputOfShares, limitInput, predict } from "./bicycle.js";

/** How much of a difference between the clocks a frame corrects. */
const CLOCK_GAIN = 0.2;
/** How fast corrections fade [s]. */
const FADE_S = 0.08;
/** Longest prediction beyond the last frame, in ticks; after it, the picture waits for the server. */
const MAX_AHEAD_TICKS = 1.5;
/** Inputs older than this are forgotten [s]. */
const KEPT_S = 5;

const turned = (angle) => Math.atan2(Math.sin(angle), Math.cos(angle));

export class Motion {
  constructor(world) {
    this.world = world;
    this.own = world.vehicles.findIndex(({ name }) => name === world.seat);
    this.before = null;
    this.last = null;
    this.sent = [];
    this.clock = { wall: 0, time: 0, rate: 0 };
    this.offsets = null;
  }

  /** Notes an input that was sent; `now` is wall time [s]. */
  note(seq, input, now) {
    this.sent.push({ seq, now, ...input });
    while (this.sent.length > 2 && this.sent[0].now < now - KEPT_S) this.sent.shift();
  }

  /** Takes a frame that arrived at wall time `now` [s]. */
  take(frame, now) {
    const { step_s } = this.world;
    const follows = this.last && Math.abs(frame.time_s - this.last.time_s - step_s) < 0.5 * step_s;
    const same = this.last && frame.time_s === this.last.time_s;
    const time = this.timeAt(now);
    const late = frame.time_s - time;
    const keeps = (follows || same) && Math.abs(late) < 2 * step_s;
    const shown = keeps ? this.posesAt(time, now) : null;
    if (!same) this.before = follows ? this.last : null;
    this.last = { ...frame, arrived: now };
    const rate = frame.paused ? 0 : (frame.real || 1) * Math.min(frame.dilation || 1, 1);
    this.clock = { wall: now, time: keeps && rate ? time + CLOCK_GAIN * late : frame.time_s, rate };
    this.offsets = null;
    if (shown) {
      const found = this.posesAt(this.timeAt(now), now);
      const away = (index) => shown[index].map((value, axis) => (axis === 2 ? turned(value - found[index][2]) : value - found[index][axis]));
      this.offsets = { now, by: found.map((_, index) => away(index)) };
    }
  }

  /** The time that is shown at wall time `now` [s]. */
  timeAt(now) {
    const time = this.clock.time + (now - this.clock.wall) * this.clock.rate;
    return this.last ? Math.min(time, this.last.time_s + MAX_AHEAD_TICKS * this.world.step_s) : time;
  }

  /** Whether the person drives. */
  drives() {
    return this.last?.driven_by === "you";
  }

  /** The last input that the server applied. */
  acknowledged() {
    return this.sent.findLast(({ seq }) => seq <= this.last.ack);
  }

  /** The input of the own car at a wall time, as the server will apply it. */
  ownInput(wall) {
    const { limits } = this.world.vehicles[this.own];
    const input = this.sent.findLast(({ seq, now }) => now <= wall || seq <= this.last.ack) ?? this.sent.at(-1);
    if (!input) return this.last.inputs[this.own];
    const [acceleration, steering] = inputOfShares(limits, input.acceleration, input.steering);
    if (!input.assist) return [acceleration, steering];
    // The server adds lane keeping: its last contribution is kept.
    const acked = this.acknowledged();
    const kept = this.last.inputs[this.own][1] - inputOfShares(limits, 0, acked?.steering ?? 0)[1];
    return [acceleration, kept + steering];
  }

  /** States at a time without the fading of corrections. */
  posesAt(time, now) {
    const { last, before, world } = this;
    const ahead = time - last.time_s;
    return last.states.map((state, index) => {
      if (ahead <= 0 && before) {
        const share = Math.max(0, 1 + ahead / world.step_s);
        const from = before.states[index];
        return from.map((value, axis) => value + share * (axis === 2 ? turned(state[2] - from[2]) : state[axis] - value));
      }
      const { body, limits, is_obstacle } = world.vehicles[index];
      if (ahead <= 0 || is_obstacle) return state;
      const input = limitInput(limits, state, last.inputs[index], world.step_s);
      const rate = this.clock.rate || 1;
      const isOwn = index === this.own && this.drives();
      const inputAt = isOwn ? (at) => this.ownInput(now - (ahead - at) / rate) : () => input;
      return predict(body, limits, state, inputAt, ahead, world.step_s, isOwn ? 4 : 1);
    });
  }

  /** Time, states and steering angles to draw at wall time `now` [s]. */
  shown(now) {
    if (!this.last) return null;
    const time = this.timeAt(now);
    const poses = this.posesAt(time, now);
    const share = this.offsets ? Math.exp(-(now - this.offsets.now) / FADE_S) : 0;
    const states = poses.map((pose, index) => (share < 0.01 ? pose : pose.map((value, axis) => value + share * this.offsets.by[index][axis])));
    const steering = this.last.inputs.map(([, angle]) => angle);
    if (this.drives() && this.own >= 0) {
      const { limits } = this.world.vehicles[this.own];
      steering[this.own] = limitInput(limits, states[this.own], this.ownInput(now), this.world.step_s)[1];
    }
    return { time, states, steering };
  }
}
