// The keyboard: driving by keys that are held, everything else by keys that are pressed once. Keys are identified by their position.

/** Simulated to wall time by the keys 1 to 9; 5 is normal. */
export const RATES = [0.25, 0.35, 0.5, 0.75, 1, 1.5, 2, 4, 8];

const HELD = {
  ArrowUp: "faster", KeyW: "faster", ArrowDown: "slower", KeyS: "slower", Space: "brake",
  ArrowLeft: "left", KeyA: "left", ArrowRight: "right", KeyD: "right",
};
const PRESSED = {
  KeyP: "handOver", KeyR: "restart", Backspace: "rewind", Escape: "pause", KeyN: "next", Tab: "changeSeat",
  KeyV: "showPlans", KeyK: "assist", KeyM: "menu", KeyE: "end", Enter: "go", F1: "help",
};
/** Shares per second by which pedals and wheel move while a key is held, and while they return. */
const PEDAL = { press: 4, release: 8, brake: 7 };
const WHEEL = { turn: 4, back: 7 };

const towards = (value, target, most) => value + Math.min(Math.max(target - value, -most), most);

/** Keys that are held, as shares of pedals and wheel. */
export class KeyDriver {
  constructor() {
    this.held = new Set();
    this.acceleration = 0;
    this.steering = 0;
  }

  /** Notes a key; returns whether it is a driving key. */
  set(code, isHeld) {
    if (!(code in HELD)) return false;
    if (isHeld) this.held.add(code);
    else this.held.delete(code);
    return true;
  }

  clear() {
    this.held.clear();
    this.acceleration = this.steering = 0;
  }

  /** Moves pedals and wheel by wall time [s]; `mostSteering` is the largest share that keys turn the wheel by. */
  advance(elapsed, mostSteering = 1) {
    const does = new Set([...this.held].map((code) => HELD[code]));
    const wanted = does.has("brake") || does.has("slower") ? -1 : does.has("faster") ? 1 : 0;
    if (does.has("brake")) this.acceleration = -1;
    // The opposite pedal releases a pedal at once.
    if (wanted * this.acceleration < 0) this.acceleration = 0;
    const speed = wanted === 0 ? PEDAL.release : wanted < 0 ? PEDAL.brake : PEDAL.press;
    this.acceleration = towards(this.acceleration, wanted, speed * elapsed);
    const turn = (does.has("left") ? 1 : 0) - (does.has("right") ? 1 : 0);
    if (turn * this.steering < 0) this.steering = 0;
    this.steering = towards(this.steering, turn * mostSteering, (turn ? WHEEL.turn * mostSteering : WHEEL.back) * elapsed);
    return { acceleration: this.acceleration, steering: this.steering, isUsed: does.size > 0 };
  }
}

/**
 * Listens to the keyboard. `drives()` tells whether driving keys count; `act(name, number)` carries out an action and returns
 * whether it was possible.
 */
export function listenToKeys(keys, drives, act) {
  const isOnControl = () => /^(BUTTON|INPUT|SELECT|A|SUMMARY)$/.test(document.activeElement?.tagName ?? "");
  window.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    // A focused button is used by keyboard.
    if (["Space", "Enter", "Tab"].includes(event.code) && (isOnControl() || event.shiftKey)) return;
    if (drives() && keys.set(event.code, true)) {
      event.preventDefault();
      if (!event.repeat) act("drive");
      return;
    }
    if (event.repeat) return;
    const digit = /^(?:Digit|Numpad)([1-9])$/.exec(event.code);
    const done = event.key === "?" ? act("help") : digit ? act("rate", RATES[digit[1] - 1]) : event.code in PRESSED && act(PRESSED[event.code]);
    if (done) event.preventDefault();
  });
  window.addEventListener("keyup", (event) => keys.set(event.code, false));
  window.addEventListener("blur", () => keys.clear());
}
