// Touch controls: a stick for the left thumb to steer, two pedals for the right thumb.

import { element } from "./dom.js";

/** Movement of the thumb for the full angle [px]. */
const STICK_PX = 56;

export class TouchDriver {
  /** Builds the controls in `place`; `act("drive")` is called when one is touched. */
  constructor(place, act) {
    this.place = place;
    this.steering = 0;
    this.pedals = new Map();
    this.knob = element("span", { className: "knob" });
    const stick = element("div", { id: "stick", aria: { label: "Steer" } }, element("span", { className: "ways", textContent: "◀ ▶" }), element("span", { className: "what", textContent: "Steer" }), this.knob);
    this.follow(stick, {
      begin: (event) => {
        this.from = event.clientX;
        act("drive");
      },
      move: (event) => this.steer((this.from - event.clientX) / STICK_PX),
      end: () => this.steer(0),
    });
    const pedal = (id, words, share) => {
      const made = element("div", { id, className: "pedal", aria: { label: words } }, element("span", { textContent: words }));
      const set = (isDown) => {
        this.pedals.set(id, isDown ? share : 0);
        made.classList.toggle("down", isDown);
      };
      this.follow(made, { begin: () => (set(true), act("drive")), move: () => {}, end: () => set(false) });
      return made;
    };
    place.append(stick, pedal("brake", "Brake", -1), pedal("faster", "Go", 1));
    const coarse = matchMedia("(pointer: coarse)");
    const show = () => (place.hidden = false);
    if (coarse.matches) show();
    coarse.addEventListener?.("change", ({ matches }) => matches && show());
    window.addEventListener("touchstart", show, { once: true, passive: true });
  }

  get isShown() {
    return !this.place.hidden;
  }

  steer(share) {
    this.steering = Math.min(Math.max(share, -1), 1);
    this.knob.style.transform = `translateX(${(-this.steering * STICK_PX).toFixed(1)}px)`;
  }

  follow(control, { begin, move, end }) {
    let pointer = null;
    control.addEventListener("pointerdown", (event) => {
      event.preventDefault();
      pointer = event.pointerId;
      control.setPointerCapture(pointer);
      begin(event);
    });
    control.addEventListener("pointermove", (event) => event.pointerId === pointer && move(event));
    for (const name of ["pointerup", "pointercancel", "lostpointercapture"])
      control.addEventListener(name, (event) => {
        if (event.pointerId !== pointer) return;
        pointer = null;
        end();
      });
    control.addEventListener("contextmenu", (event) => event.preventDefault());
  }

  /** The shares of pedals and wheel; `mostSteering` is the share of the largest angle at the end of the stick. */
  read(mostSteering) {
    const acceleration = [...this.pedals.values()].reduce((sum, share) => (share < 0 ? share : sum || share), 0);
    const steering = Math.sign(this.steering) * this.steering ** 2 * mostSteering;
    return { acceleration, steering, isUsed: acceleration !== 0 || this.steering !== 0 };
  }
}
