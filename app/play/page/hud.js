// Information beside the road: goal, drivers, requests, last events, speed and pedals.

import { asYou, button, element, keycap, swatch } from "./dom.js";

/** Display times of an event, a refusal and a hint [s of wall time]. */
const NEWS_S = 4;
const NOTICE_S = 4;
/** Speeds that differ by less than this share are called equal. */
const SPEED_SHARE = 0.06;
const LEVELS = { alarm: "⚠ ", warning: "! ", note: "" };

const by = (id) => document.getElementById(id);
const setText = (place, text) => place.textContent !== text && (place.textContent = text);

export class Hud {
  /** `act(name)` carries out the action of a button. */
  constructor(act) {
    this.act = act;
    this.news = null;
    this.notices = new Map();
    const buttons = [
      ["pause", "Pause", "M8 5v14M16 5v14", "Esc"],
      ["restart", "Start again", "M18.5 8A8 8 0 1 0 20 13M19 3v5.5h-5.5", "R"],
      ["rewind", "Back 5 seconds", "M12 6l-8 6 8 6zM20 6l-8 6 8 6z", "Backspace"],
      ["handOver", "Hand over to a planner, or take back", "M5 9h14v9H5zM12 9V5M9.5 13v1M14.5 13v1M2.5 12v3M21.5 12v3", "P"],
      ["showPlans", "Show or hide plans", "M2 12c5-8 15-8 20 0-5 8-15 8-20 0zM12 9.5a2.5 2.5 0 1 0 .01 0", "V"],
      ["help", "Help", "M8.5 9a3.5 3.5 0 1 1 5 3.2c-1 .5-1.5 1.2-1.5 2.3M12 18.6v.2", "?"],
      ["menu", "Menu", "M4 6h16M4 12h16M4 18h16", "M"],
    ];
    this.buttons = {};
    for (const [name, words, sign, key] of buttons) {
      const made = button({ words, sign, key, dataset: { act: name } }, () => {
        act(name);
        made.blur();
      });
      this.buttons[name] = made;
      by("buttons").append(made);
    }
    const rows = [[["↑", "↓"], "faster, slower"], [["←", "→"], "steer"], [["Space"], "brake hard"], [["Esc"], "pause"], [["?"], "all keys"]];
    by("keys").append(...rows.map(([caps, words]) => element("div", {}, element("span", {}, caps.map(keycap)), words)));
    const marks = [["band", "the plan of a driver"], ["dots", "what a driver asks for"]];
    by("marks").append(...marks.map(([kind, words]) => element("li", {}, element("span", { className: `mark ${kind}` }), words)));
  }

  /** Begins a world: sets the texts that do not change. */
  begin(world) {
    this.world = world;
    this.news = null;
    this.notices.clear();
    const own = world.vehicles.find(({ name }) => name === world.seat);
    document.body.classList.toggle("study", Boolean(world.study));
    setText(by("title"), world.study ? `Run ${world.study.done + 1} of ${world.study.of}` : world.title ?? world.scenario);
    by("seat").replaceChildren("You drive ", swatch(own?.colour ?? ""), ` ${world.seat}`);
    setText(by("goal"), world.goal?.text ?? "");
    setText(by("help"), world.study ? "" : world.help ?? "");
    const drivers = world.vehicles.filter(({ is_obstacle }) => !is_obstacle);
    this.rows = drivers.map((vehicle) => {
      const speed = element("span", { className: "speed" });
      const belief = element("span", { className: "belief" });
      const words = vehicle.name === world.seat ? "you" : world.study ? "" : vehicle.driver;
      const row = element("li", {}, swatch(vehicle.colour), element("b", { textContent: vehicle.name }), speed, element("span", { className: "driver", textContent: words }), belief);
      return { index: world.vehicles.indexOf(vehicle), name: vehicle.name, row, speed, belief };
    });
    by("legend").replaceChildren(...this.rows.map(({ row }) => row));
  }

  /** Shows a line for some seconds; the same name replaces it, and a time of Infinity keeps it until `unnotice`. */
  notice(name, text, now, kind = "", lasts = NOTICE_S) {
    this.notices.set(name, { text, kind, until: now + lasts });
    this.drawNotices(now);
  }

  unnotice(name, now) {
    if (this.notices.delete(name)) this.drawNotices(now);
  }

  drawNotices(now) {
    for (const [name, { until }] of this.notices) if (until < now) this.notices.delete(name);
    const lines = [...this.notices.values()];
    const key = JSON.stringify(lines.map(({ text, kind }) => [text, kind]));
    if (key === this.noticed) return;
    this.noticed = key;
    by("notices").replaceChildren(...lines.map(({ text, kind }) => element("p", { textContent: text, className: kind })));
  }

  /** Updates the texts from a frame. */
  take(frame, now) {
    const { seat, duration_s } = this.world;
    const rate = frame.real === 1 || !frame.real ? "" : frame.real < 1 ? `  slow motion ×${frame.real}` : `  time-lapse ×${frame.real}`;
    setText(by("clock"), `${frame.time_s.toFixed(1)} / ${duration_s.toFixed(0)} s${rate}`);
    const { study } = this.world;
    setText(by("asked"), study ? "" : this.request(frame));
    by("asked").classList.toggle("mine", (frame.proposals ?? []).some(({ to }) => to === seat));
    const ranks = ["note", "warning", "alarm"];
    for (const event of (study ? [] : frame.events) ?? []) {
      const rank = ranks.indexOf(event.level);
      const isKept = this.news && now < this.news.until && this.news.rank > rank;
      if (isKept) continue;
      const isMine = event.vehicle === seat;
      const words = [isMine ? `${seat} (you)` : event.vehicle, isMine ? event.text : asYou(event.text, seat)];
      this.news = { text: `${LEVELS[event.level] ?? ""}${words.filter(Boolean).join(" ")}`, level: event.level, rank, until: now + NEWS_S };
    }
    for (const { index, name, speed, belief } of this.rows) {
      setText(speed, frame.absent?.[index] ? "not here" : `${Math.abs(frame.states[index][3]).toFixed(1)} m/s`);
      const thoughts = ((study ? [] : frame.beliefs) ?? []).filter(({ of }) => of === name);
      const words = thoughts.map(({ about, nice, text }) => `${asYou(text ?? `takes ${about} for nice`, seat)}${Number.isFinite(nice) ? ` (${Math.round(100 * nice)} %)` : ""}`);
      setText(belief, words.join(", "));
    }
    if (frame.dilation > 0 && frame.dilation < 0.95 && !frame.paused)
      this.notice("dilation", `This computer is too slow for real time: time runs at ${Math.round(100 * frame.dilation)} %`, now, "warning", 1.5);
    if (frame.driven_by !== "you") this.notice("driver", `The planner “${frame.driven_by}” drives for you. Press P to drive again`, now, "", Infinity);
    else this.unnotice("driver", now);
    this.buttons.handOver.classList.toggle("on", frame.driven_by !== "you");
  }

  /** Requests with their acceptance; for the person, what to do. */
  request(frame) {
    const { seat } = this.world;
    const proposals = frame.proposals ?? [];
    const mine = proposals.find(({ to }) => to === seat);
    const one = mine ?? proposals.find(({ from }) => from === seat) ?? proposals[0];
    if (!one) return "";
    const followed = Number.isFinite(one.share) ? `${Math.round(100 * one.share)}\u00a0%` : "";
    if (!mine) {
      const answer = Number.isFinite(one.share) ? ` – ${one.to} ${one.share > 0.5 ? "does so" : "does not"} (${followed})` : "";
      return `${one.from === seat ? "you ask" : `${one.from} asks`} ${one.to} to follow the dots${answer}`;
    }
    const own = this.world.vehicles.findIndex(({ name }) => name === seat);
    return `${one.from} asks you to ${this.wish(one.points ?? [], frame.states[own])}: follow the dots, or do not: you decide${followed ? ` (you follow: ${followed})` : ""}`;
  }

  /** A proposal in terms of the pedals. */
  wish(points, [x, y, , speed]) {
    if (points.length < 2) return "make room";
    const path = [[x, y], ...points].map(([px, py]) => [px, py]);
    const length = path.slice(1).reduce((sum, point, index) => sum + Math.hypot(point[0] - path[index][0], point[1] - path[index][1]), 0);
    const wanted = length / (points.length * this.world.step_s);
    const least = SPEED_SHARE * Math.max(speed, 0.3);
    if (wanted < speed - least) return `slow down to ${wanted.toFixed(1)}\u00a0m/s`;
    return wanted > speed + least ? `speed up to ${wanted.toFixed(1)}\u00a0m/s` : `stay at ${speed.toFixed(1)}\u00a0m/s`;
  }

  /** Draws speed, pedals and wheel, and removes old notices. */
  draw(now, state, { acceleration, steering, assist }) {
    setText(by("speed"), `${Math.abs(state?.[3] ?? 0).toFixed(1)} m/s`);
    by("pedal").style.transform = `scaleX(${Math.abs(acceleration).toFixed(2)})`;
    by("pedal").className = acceleration < 0 ? "braking" : "";
    by("wheel").style.transform = `translateX(${(-50 * steering).toFixed(1)}%)`;
    by("wheel").className = assist ? "assisted" : "";
    const news = this.news && now < this.news.until ? this.news : null;
    setText(by("news"), news?.text ?? "");
    by("news").className = news?.level ?? "";
    this.drawNotices(now);
  }

  /** The uncovered part of the screen [px]. */
  freeArea() {
    const [width, height] = [window.innerWidth, window.innerHeight];
    const box = (id) => by(id).getBoundingClientRect();
    const beside = (id) => (getComputedStyle(by(id)).position === "fixed" && box(id).width > 0 && box(id).height > 200 ? box(id) : null);
    const [task, drivers] = [beside("task"), beside("drivers")];
    const top = Math.max(box("top").bottom, task ? 0 : box("task").bottom) + 6;
    const isWide = task && drivers && width > 900;
    return { left: isWide ? task.right + 8 : 8, right: isWide ? drivers.left - 8 : width - 8, top, bottom: Math.min(box("words").top, height) - 6 };
  }
}
