// The view of the world: the own car's first direction is up, the camera follows it and shows the vehicles that interact with it.

/** Least and greatest length of a car [px], and the least while a distant vehicle makes a request. */
const CAR_PX = { least: 34, greatest: 104, withPartners: 24 };
/** Vehicles within this many lengths of a car are shown with the own car, partners within the second number. */
const NEAR_CARS = 7;
const PARTNER_CARS = 16;
/** Space between a vehicle and the edge, in lengths of a car. */
const MARGIN_CARS = 1.1;
/** How far the view reaches ahead of the own car: by its motion [s at 1/10 scale], and at least [lengths of a car]. */
const AHEAD_S = 1.3;
const AHEAD_CARS = 3.2;
/** Time constants of place and scale [s]. */
const PLACE_S = 0.5;
const SCALE_S = 0.7;

export class Camera {
  constructor(world, heading) {
    this.car_m = world.car_m;
    this.turn = Math.PI / 2 - heading;
    this.offset = null;
    this.scale = null;
    this.own = [0, 0];
    this.area = { left: 0, top: 0, right: 1, bottom: 1 };
  }

  /** Right and up on the screen, in metres. */
  turned([x, y]) {
    const [cos, sin] = [Math.cos(this.turn), Math.sin(this.turn)];
    return [cos * x - sin * y, sin * x + cos * y];
  }

  /** Follows the own car for `elapsed` seconds of wall time. `area` is the part of the screen that nothing covers [px]. */
  follow(own, others, partners, area, elapsed) {
    this.area = area;
    const car = this.car_m;
    const here = this.turned(own);
    const ahead = Math.max(AHEAD_CARS * car, Math.abs(own[3]) * AHEAD_S * Math.sqrt(Math.max(car / 0.4, 1)));
    const direction = this.turned([Math.cos(own[2]), Math.sin(own[2])]);
    const points = [here, here.map((value, axis) => value + ahead * direction[axis]), here.map((value, axis) => value - car * direction[axis])];
    let hasPartners = false;
    others.forEach((state, index) => {
      if (!state) return;
      const away = Math.hypot(state[0] - own[0], state[1] - own[1]) / car;
      const isPartner = partners.has(index) && away < PARTNER_CARS;
      hasPartners ||= isPartner;
      if (away < NEAR_CARS || isPartner) points.push(this.turned(state));
    });
    const low = [0, 1].map((axis) => Math.min(...points.map((point) => point[axis])) - MARGIN_CARS * car);
    const high = [0, 1].map((axis) => Math.max(...points.map((point) => point[axis])) + MARGIN_CARS * car);
    const size = [area.right - area.left, area.bottom - area.top];
    const fit = Math.min(size[0] / (high[0] - low[0]), size[1] / (high[1] - low[1]));
    const least = (hasPartners ? CAR_PX.withPartners : CAR_PX.least) / car;
    const scale = Math.min(Math.max(fit, least), CAR_PX.greatest / car);
    // The own car always stays well within the area.
    const reach = size.map((part) => Math.max(0, (0.5 * part) / scale - 1.6 * car));
    const offset = [0, 1].map((axis) => Math.min(Math.max(0.5 * (low[axis] + high[axis]) - here[axis], -reach[axis]), reach[axis]));
    const blend = (old, wanted, constant) => (old === null ? wanted : old + (wanted - old) * (1 - Math.exp(-elapsed / constant)));
    this.scale = Math.exp(blend(this.scale === null ? null : Math.log(this.scale), Math.log(scale), SCALE_S));
    this.offset = offset.map((value, axis) => blend(this.offset ? this.offset[axis] : null, value, PLACE_S));
    this.own = here;
  }

  /** The six numbers of the canvas transform from metres of the world to pixels. */
  matrix() {
    const [cos, sin] = [this.scale * Math.cos(this.turn), this.scale * Math.sin(this.turn)];
    const middle = [0.5 * (this.area.left + this.area.right), 0.5 * (this.area.top + this.area.bottom)];
    const centre = this.own.map((value, axis) => value + this.offset[axis]);
    return [cos, -sin, -sin, -cos, middle[0] - this.scale * centre[0], middle[1] + this.scale * centre[1]];
  }

  /** The place of a position on the screen [px]. */
  place([x, y]) {
    const [a, b, c, d, e, f] = this.matrix();
    return [a * x + c * y + e, b * x + d * y + f];
  }
}
