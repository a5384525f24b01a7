// Game controllers: left stick steers, right trigger accelerates, left trigger brakes; buttons of the standard layout.

const DEAD = 0.12;
const BUTTONS = { 0: "go", 1: "handOver", 2: "rewind", 3: "restart", 4: "showPlans", 5: "assist", 8: "help", 9: "pause" };

const beyondDeadZone = (value) => (Math.abs(value) < DEAD ? 0 : (Math.sign(value) * (Math.abs(value) - DEAD)) / (1 - DEAD));

export class PadDriver {
  constructor() {
    this.pressed = new Set();
  }

  /** The shares of pedals and wheel; null without a controller. `act(name)` is called once for each press of a button. */
  read(act) {
    const pad = [...(navigator.getGamepads?.() ?? [])].find((pad) => pad?.connected && pad.mapping === "standard");
    if (!pad) return null;
    const value = (index) => pad.buttons[index]?.value ?? 0;
    for (const [index, name] of Object.entries(BUTTONS)) {
      const isDown = value(index) > 0.5;
      if (isDown && !this.pressed.has(index)) act(name);
      if (isDown) this.pressed.add(index);
      else this.pressed.delete(index);
    }
    const stick = beyondDeadZone(pad.axes[0] ?? 0);
    // Fine near the middle.
    const steering = -Math.sign(stick) * stick ** 2 + value(14) - value(15);
    const acceleration = Math.max(value(7), value(12)) - Math.max(value(6), value(13));
    const clamp = (share) => Math.min(Math.max(share, -1), 1);
    const isUsed = steering !== 0 || Math.abs(acceleration) > 0.02;
    return { acceleration: clamp(acceleration), steering: clamp(steering), isUsed };
  }
}
