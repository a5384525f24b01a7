// Tests the parts of the page of `interplay play` that need no browser: the bicycle, the motion between frames, keys, camera.
//
//     node --test tests/browser/play_parts.mjs
//
// bicycle_cases.json holds what the simulation computed (app/play/tests/bicycle.rs): [{ body, limits, step_s, state, inputs: [[acceleration, steering], ...],
// states: [[x, y, heading, speed], ...] }], one state after each input.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";

import { limitInput, predict, steadySteering, step } from "../../app/play/page/bicycle.js";
import { Camera } from "../../app/play/page/camera.js";
import { KeyDriver } from "../../app/play/page/keys.js";
import { Motion } from "../../app/play/page/motion.js";

const body = { front_m: 0.21, rear_m: 0.19, width_m: 0.19, front_axle_m: 0.21, rear_axle_m: 0.19 };
const limits = { acceleration_min_mps2: -1, acceleration_max_mps2: 1, steering_max_rad: Math.PI / 3, speed_min_mps: 0, speed_max_mps: 1.5 };
const STEP_S = 0.1;

const isNear = (found, wanted, tolerance, words = "") => assert.ok(Math.abs(found - wanted) <= tolerance, `${words}: ${found}, not ${wanted}`);
const areNear = (found, wanted, tolerance, words = "") => wanted.forEach((value, index) => isNear(found[index], value, tolerance, `${words} ${index}`));

test("a straight drive is a sum of steps with the speeds at their beginnings", () => {
  let state = [1, 2, 0.3, 0.5];
  for (let tick = 0; tick < 8; tick++) state = step(body, state, [0.6, 0], STEP_S);
  const way = STEP_S * (8 * 0.5 + STEP_S * 0.6 * 28);
  areNear(state, [1 + way * Math.cos(0.3), 2 + way * Math.sin(0.3), 0.3, 0.5 + 8 * STEP_S * 0.6], 1e-12);
});

test("with a constant angle the positions are the corners of a regular polygon", () => {
  const [speed, steering, ticks] = [1.2, 0.25, 40];
  const slip = Math.atan((body.rear_axle_m / 0.4) * Math.tan(steering));
  const turn = (STEP_S * speed * Math.sin(slip)) / body.rear_axle_m;
  let state = [0, 0, 0, speed];
  for (let tick = 0; tick < ticks; tick++) state = step(body, state, [0, steering], STEP_S);
  // The sum of e^(i(slip + k turn)) over k is a geometric series.
  const share = (STEP_S * speed * Math.sin(0.5 * ticks * turn)) / Math.sin(0.5 * turn);
  const middle = slip + 0.5 * (ticks - 1) * turn;
  areNear(state, [share * Math.cos(middle), share * Math.sin(middle), ticks * turn, speed], 1e-9);
});

test("a step is the one of which the tests of the simulation know the numbers", () => {
  const beta = Math.atan((0.19 / 0.4) * Math.tan(0.6));
  const next = step(body, [1, -2, 0.7, 1.3], [-0.5, 0.6], 0.1);
  const wanted = [1 + 0.13 * Math.cos(0.7 + beta), -2 + 0.13 * Math.sin(0.7 + beta), 0.7 + ((0.13 * Math.tan(0.6)) / 0.4) * Math.cos(beta), 1.25];
  areNear(next, wanted, 1e-14);
});

test("inputs are cut off at the limits, and the speed stays within its own", () => {
  assert.deepEqual(limitInput(limits, [0, 0, 0, 1], [9, -9], STEP_S), [1, -limits.steering_max_rad]);
  isNear(limitInput(limits, [0, 0, 0, 1.46], [1, 0], STEP_S)[0], 0.4, 1e-12);
  isNear(limitInput(limits, [0, 0, 0, 0.05], [-1, 0], STEP_S)[0], -0.5, 1e-12);
  assert.equal(limitInput(limits, [0, 0, 0, 0], [-1, 0], STEP_S)[0], 0);
  assert.equal(limitInput(limits, [0, 0, 0, 1.8], [0, 0], STEP_S)[0], -1, "beyond the limit it comes back as fast as it can");
});

test("a prediction over whole steps is the simulation, and one within a step lies on the way", () => {
  const from = [0, 0, 0.1, 1];
  const input = [-0.7, 0.2];
  let exact = from;
  for (let tick = 0; tick < 5; tick++) exact = step(body, exact, limitInput(limits, exact, input, STEP_S), STEP_S);
  areNear(predict(body, limits, from, () => input, 5 * STEP_S, STEP_S), exact, 1e-12);
  const whole = step(body, from, input, STEP_S);
  areNear(predict(body, limits, from, () => input, 0.04, STEP_S), from.map((value, axis) => value + 0.4 * (whole[axis] - value)), 1e-12);
  areNear(predict(body, limits, from, () => input, 0, STEP_S), from, 0);
});

test("keys steer no harder than the brakes could stop", () => {
  assert.equal(steadySteering(body, limits, 0), 1);
  const share = steadySteering(body, limits, 1.25);
  const curvature = Math.tan(share * limits.steering_max_rad) / 0.4;
  isNear(1.25 ** 2 * curvature, 1, 1e-9);
});

test("pedals and wheel follow keys and return", () => {
  const keys = new KeyDriver();
  assert.ok(keys.set("ArrowUp", true) && keys.set("KeyA", true) && !keys.set("KeyP", true));
  const early = keys.advance(0.05);
  assert.ok(early.acceleration > 0 && early.acceleration < 0.5 && early.steering > 0 && early.isUsed);
  for (let count = 0; count < 20; count++) keys.advance(0.05, 0.3);
  assert.deepEqual([keys.acceleration, keys.steering], [1, 0.3], "as far as allowed, and no further");
  keys.set("Space", true);
  assert.equal(keys.advance(0.001).acceleration, -1, "Space brakes at once");
  ["ArrowUp", "KeyA", "Space"].forEach((code) => keys.set(code, false));
  for (let count = 0; count < 10; count++) keys.advance(0.05);
  assert.deepEqual([keys.acceleration, keys.steering], [0, 0]);
  keys.set("ArrowLeft", true);
  keys.set("ArrowRight", true);
  assert.equal(keys.advance(0.1).steering, 0, "both at once are none");
});

/** A server that drives two cars in real time and applies the last input at the beginning of every tick. */
function drive(motion, inputAt, { late = () => 0, ticks = 20 } = {}) {
  let states = [[0, 0, 0, 1], [1, 0.4, 0, 0.8]];
  const seen = [];
  let seq = 0;
  for (let tick = 0; tick <= ticks; tick++) {
    const arrives = tick * STEP_S + late(tick);
    const [acceleration, steering] = inputAt(tick * STEP_S);
    const inputs = [[acceleration, steering * limits.steering_max_rad], [-0.3, 0]];
    if (tick) states = states.map((state, index) => step(body, state, limitInput(limits, state, inputs[index], STEP_S), STEP_S));
    motion.take({ time_s: tick * STEP_S, real: 1, dilation: 1, paused: false, driven_by: "you", ack: seq, states, inputs }, arrives);
    for (let now = arrives; now < (tick + 1) * STEP_S + late(tick + 1) - 1e-9; now += 0.016) {
      const [acceleration, steering] = inputAt(now);
      motion.note(++seq, { acceleration, steering, assist: false }, now);
      seen.push({ now, ...motion.shown(now) });
    }
  }
  return seen;
}

const world = () => ({ seat: "a", step_s: STEP_S, car_m: 0.4, vehicles: ["a", "b"].map((name) => ({ name, body, limits, is_obstacle: false })) });

test("motion between frames is smooth, also when frames come late", () => {
  const jitter = (tick) => 0.02 * ((tick * 7) % 3);
  const seen = drive(new Motion(world()), (now) => [now > 0.55 ? -0.8 : 0, now > 1 ? 0.05 : 0], { late: jitter });
  for (let index = 1; index < seen.length; index++) {
    const [before, after] = [seen[index - 1], seen[index]];
    const elapsed = after.now - before.now;
    assert.ok(after.time >= before.time - 1e-9, "time never goes back");
    for (const vehicle of [0, 1]) {
      const moved = Math.hypot(...[0, 1].map((axis) => after.states[vehicle][axis] - before.states[vehicle][axis]));
      assert.ok(moved < 1.9 * elapsed + 0.004, `a jump of ${moved} m in ${elapsed} s at ${after.now}`);
    }
  }
});

test("the own car answers to an input before the server does", () => {
  const seen = drive(new Motion(world()), (now) => [0, now > 1.02 ? 0.1 : 0]);
  const first = seen.find(({ states }) => states[0][2] > 0.001);
  assert.ok(first.now - 1.02 < 0.04, `it turns ${first.now - 1.02} s after the input`);
});

test("nothing is shown far beyond the last frame, and a jump in time is one", () => {
  const motion = new Motion(world());
  const frame = { time_s: 1, real: 1, dilation: 1, paused: false, driven_by: "negotiation", ack: 0, states: [[0, 0, 0, 1], [1, 0, 0, 1]], inputs: [[0, 0], [0, 0]] };
  motion.take(frame, 10);
  isNear(motion.shown(10.05).states[0][0], 0.05, 1e-9);
  isNear(motion.shown(60).states[0][0], 0.15, 1e-9);
  motion.take({ ...frame, time_s: 0.2, states: [[-5, 0, 0, 1], [1, 0, 0, 1]] }, 61);
  isNear(motion.shown(61).states[0][0], -5, 1e-9);
  motion.take({ ...frame, time_s: 0.2, paused: true }, 62);
  isNear(motion.shown(70).states[0][0], 0, 0.001);
});

test("the camera keeps the own car in view, with its direction up", () => {
  const camera = new Camera({ car_m: 0.4 }, 0.5);
  const area = { left: 10, top: 60, right: 380, bottom: 700 };
  for (let tick = 0; tick < 300; tick++) {
    const own = [0.02 * tick * Math.cos(0.5), 0.02 * tick * Math.sin(0.5), 0.5, 1.2];
    const others = [[own[0] + (tick % 100) * 0.1, own[1] + 2, 0, 1], null];
    camera.follow(own, others, new Set([0]), area, 0.016);
    const [x, y] = camera.place(own);
    assert.ok(x > area.left && x < area.right && y > area.top && y < area.bottom, `${x} ${y}`);
  }
  const [from, to] = [[0, 0], [Math.cos(0.5), Math.sin(0.5)]].map((point) => camera.place(point));
  isNear(to[0] - from[0], 0, 1e-9);
  assert.ok(to[1] < from[1]);
});

test("the bicycle agrees with the simulation to 1 mm", () => {
  const cases = JSON.parse(readFileSync(new URL("bicycle_cases.json", import.meta.url), "utf8"));
  assert.ok(cases.length > 0);
  for (const [number, { body, limits, step_s, state, inputs, states }] of cases.entries()) {
    let found = state;
    inputs.forEach((input, tick) => {
      found = step(body, found, limitInput(limits, found, input, step_s), step_s);
      areNear(found, states[tick], 1e-3, `case ${number}, tick ${tick}, part`);
    });
  }
});
