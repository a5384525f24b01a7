// The kinematic bicycle of the simulation, with the same explicit step, so that the page can predict the own car.
//
// A state is [x, y, heading, speed], an input is [acceleration, steering angle]. With the slip angle
// β = atan(L_r/L · tan δ): x⁺ = x + T v cos(θ + β), y⁺ = y + T v sin(θ + β), θ⁺ = θ + T v sin β / L_r, v⁺ = v + T a.

const clamp = (value, low, high) => Math.min(Math.max(value, low), high);

/** An input cut off at the limits; the speed stays within its limits for a step. */
export function limitInput(limits, state, [acceleration, steering], step_s) {
  const { acceleration_min_mps2, acceleration_max_mps2, steering_max_rad, speed_min_mps, speed_max_mps } = limits;
  const least = Math.max(acceleration_min_mps2, (speed_min_mps - state[3]) / step_s);
  const greatest = Math.min(acceleration_max_mps2, (speed_max_mps - state[3]) / step_s);
  // A vehicle beyond a limit of speed comes back as fast as its acceleration allows.
  const low = clamp(least, acceleration_min_mps2, acceleration_max_mps2);
  const high = clamp(greatest, acceleration_min_mps2, acceleration_max_mps2);
  return [clamp(acceleration, Math.min(low, high), high), clamp(steering, -steering_max_rad, steering_max_rad)];
}

/** The state after `step_s` with an input that is within the limits. */
export function step(body, [x, y, heading, speed], [acceleration, steering], step_s) {
  const { front_axle_m, rear_axle_m } = body;
  const slip = Math.atan((rear_axle_m / (front_axle_m + rear_axle_m)) * Math.tan(steering));
  return [
    x + step_s * speed * Math.cos(heading + slip),
    y + step_s * speed * Math.sin(heading + slip),
    heading + (step_s * speed * Math.sin(slip)) / rear_axle_m,
    speed + step_s * acceleration,
  ];
}

/**
 * The state after a time that may end within a step.
 *
 * `inputAt(time)` is the input wanted at a time from now on. Within a step the simulation moves with the speed and the heading
 * at its beginning, so parts of it are added up with these: a whole step with one input is exactly that of the simulation.
 */
export function predict(body, limits, state, inputAt, ahead_s, step_s, parts = 4) {
  let from = state;
  for (let begin = 0; begin < ahead_s - 1e-9; begin += step_s) {
    const whole = Math.min(step_s, ahead_s - begin);
    let next = from;
    for (let part = 0; part < parts; part++) {
      const input = limitInput(limits, from, inputAt(begin + ((part + 0.5) * whole) / parts), step_s);
      const moved = step(body, from, input, whole / parts);
      next = next.map((value, index) => value + moved[index] - from[index]);
    }
    from = next;
  }
  return from;
}

/** Shares of the strongest braking or acceleration and of the largest steering angle, as an input. */
export function inputOfShares(limits, acceleration, steering) {
  const strongest = acceleration < 0 ? -limits.acceleration_min_mps2 : limits.acceleration_max_mps2;
  return [acceleration * strongest, steering * limits.steering_max_rad];
}

/** The share of the largest steering angle that turns no harder than the brakes could stop: keys steer at most this much. */
export function steadySteering(body, limits, speed_mps) {
  const wheelbase_m = body.front_axle_m + body.rear_axle_m;
  const angle = Math.atan((wheelbase_m * Math.abs(limits.acceleration_min_mps2)) / Math.max(speed_mps ** 2, 1e-6));
  return Math.min(1, angle / limits.steering_max_rad);
}
