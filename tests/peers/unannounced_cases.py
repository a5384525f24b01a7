"""Files for `unannounced.py`: intruders that stop, cut in, pull out or cross, and the drivers behind them.

`make` writes one file and returns its `Case`. Lengths are in m, times in s; `s` is the distance along a lane.
"""

import dataclasses
import json
import math
import random

KINDS = ["stops", "cut-ins", "pull-outs", "crossings"]
STYLES = ["nice", "considerate", "normal", "assertive", "tough"]
DRIVERS = [*STYLES, "conservative", "negotiation", "bayesian", "game", "contingency", "nash", "idm"]
STEP_S, PLAN_S, BRAKING_MPS2 = 0.1, 0.2, 6.4
#: Of each class: distances of front and rear from the mass centre, and width [m].
BODIES = {"car": (2.2, 2.3, 1.8), "van": (2.8, 3.2, 2.0), "bicycle": (0.9, 0.9, 0.65)}
#: A vehicle that gives way brakes at most this hard [m/s²].
GIVING_WAY_MPS2 = 3.0
#: Where leaders stop, those twice that leave no way round.
STOPS = ["one lane"] * 2 + ["two lanes, left taken"] * 2 + ["two lanes, left free", "street", "bend", "crossing"]
STREET_X_M, CROSSING_ARM_M, LANE_M = -300.0, 400.0, 3.5


@dataclasses.dataclass
class Case:
    """A file, and what the judgement needs to know of it."""

    kind: str
    driver: str
    name: str
    #: Whether the intruder follows a record; otherwise a script.
    record: bool = False
    note: str = ""
    #: The vehicles as written, and the records by name of the vehicle.
    lines: list = dataclasses.field(default_factory=list)
    tables: dict = dataclasses.field(default_factory=dict)
    #: The vehicles that are judged, by name: a style of humans or a kind.
    drivers: dict = dataclasses.field(default_factory=dict)
    followers: list = dataclasses.field(default_factory=list)
    classes: dict = dataclasses.field(default_factory=dict)
    #: When the intruder leaves the motion that it had.
    onset_s: float = 0.0
    #: When that shows, where its place says so and not its motion.
    shows_s: float | None = None
    #: Until when a leader stands at least.
    stands_until_s: float | None = None
    #: The line of the drivers' lane; without it that of the leader.
    line: object = None

    def add(self, name, start, driver, vehicle_class="car", goal=None):
        """Adds a vehicle: an intruder with its table `driver`, or one that is judged, with a name of `DRIVERS`."""
        entry = {"name": name, "class": vehicle_class, "start": start, "goal": goal or {"speed_mps": start["speed_mps"]}}
        if isinstance(driver, str):
            self.drivers[name] = driver
            driver = {"kind": "human", "style": driver} if driver in STYLES else {"kind": driver}
            entry["limits"] = {"acceleration_min_mps2": -BRAKING_MPS2}
        self.classes[name] = vehicle_class
        self.lines.append({**entry, "driver": driver})

    def text(self, road, duration_s):
        head = [f"# {self.note}", f"title = {toml(self.name)}", f"shows = {toml(self.note)}", 'conduct = "people"']
        head += [f"duration_s = {duration_s:.1f}", f"step_s = {STEP_S}", f"planning_period_s = {PLAN_S}", "horizon_steps = 40"]
        vehicles = "".join(f"    {toml(line)},\n" for line in self.lines)
        return "\n".join([*head, f"vehicle = [\n{vehicles}]", f"road = {toml(road)}", "[expect]", "no_collision = true", ""])


def toml(value):
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key} = {toml(below)}" for key, below in value.items()) + " }"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(map(toml, value)) + "]"
    return json.dumps(round(value, 4) if isinstance(value, float) else value, ensure_ascii=False)


# Roads: the line of the drivers' lane by distance, the table `road`, and where a vehicle starts on it.


def straight(x_m, y_m):
    return lambda s: (x_m + s, y_m, 0.0)


def bend(before_m, radius_m, angle, side):
    """A straight line, a turn to the left (`side` 1) or right (-1), and a straight line."""

    def at(s):
        turned = min(max((s - before_m) / radius_m, 0.0), angle)
        x, y = min(s, before_m) + radius_m * math.sin(turned), radius_m * (1 - math.cos(turned))
        rest = max(s - before_m - radius_m * angle, 0.0)
        return x + rest * math.cos(turned), side * (y + rest * math.sin(turned)), side * turned

    return at


def street(crossed_m=None):
    """A street with both directions, a bay for parking, and, where stated, a way across with a sign to give way."""
    ends = [STREET_X_M, 1500.0]
    lanes = [
        {"name": "east", "points": [[x, -1.75] for x in ends], "width_m": LANE_M, "left": {"lane": "west", "oncoming": True}},
        {"name": "west", "points": [[x, 1.75] for x in reversed(ends)], "width_m": LANE_M, "left": {"lane": "east", "oncoming": True}},
        {"name": "bay", "points": [[x, -4.75] for x in ends], "width_m": 2.5},
    ]
    if crossed_m is not None:
        way = {"width_m": LANE_M, "right_of_way": "yield", "successors": ["across"]}
        lanes = lanes[:2] + [
            {"name": "drive", "points": [[crossed_m, -120.0], [crossed_m, -4.0]], **way},
            {"name": "across", "points": [[crossed_m, -4.0], [crossed_m, 150.0]], "width_m": LANE_M},
        ]
    return {"kind": "network", "lane": lanes}


def dual():
    """Two lanes of a network in one direction."""
    right, left = ({"width_m": LANE_M, "points": [[STREET_X_M, y], [2500.0, y]]} for y in (-1.75, 1.75))
    return {"kind": "network", "lane": [{"name": "right", "left": "left", **right}, {"name": "left", "right": "right", **left}]}


def lanes(count):
    return {"kind": "lanes", "lane_count": count, "lane_width_m": LANE_M}


# Motion of intruders.


def motion(start_m, speed_mps, sections, duration_s):
    """Rows of time, distance and speed with sections of (time, speed, acceleration), as in a script."""
    rows, s, v = [], start_m, speed_mps
    for tick in range(round(duration_s / STEP_S) + 1):
        rows.append((tick * STEP_S, s, v))
        begun = [section for section in sections if tick * STEP_S >= section[0] - 1e-9]
        wanted, rate = begun[-1][1:] if begun else (speed_mps, 1.0)
        after = min(max(wanted, v - rate * STEP_S), v + rate * STEP_S)
        s, v = s + 0.5 * (v + after) * STEP_S, after
    return rows


def recorded(case, name, line, rows, sideways=None, vehicle_class="car"):
    """Adds a vehicle that follows a record along a line; `sideways` is when and for how long it moves how far to the left."""
    table, from_s, over_s, by_m = [], *(sideways or (0.0, 1.0, 0.0))
    for t, s, v in rows:
        share = min(max((t - from_s) / over_s, 0.0), 1.0)
        n, rate = 0.5 * by_m * (1 - math.cos(math.pi * share)), 0.5 * by_m * math.pi / over_s * math.sin(math.pi * share)
        x, y, heading = line(s)
        slope = math.atan2(rate, v) if v > 0.5 else 0.0
        table.append((t, x - n * math.sin(heading), y + n * math.cos(heading), heading + slope, math.hypot(v, rate) if v else 0.0))
    case.tables[name] = "time_s,x_m,y_m,heading_rad,speed_mps\n" + "".join("%.2f,%.4f,%.4f,%.5f,%.4f\n" % row for row in table)
    start = dict(zip(("x_m", "y_m", "heading_deg"), (table[0][1], table[0][2], math.degrees(table[0][3]))))
    driver = {"kind": "recorded", "file": f"{case.name}-{name}.csv"}
    case.add(name, {**start, "speed_mps": rows[0][2]}, driver, vehicle_class)


def cannot_give_way(rows, edge_m):
    """The first time at which a vehicle could stop before the edge only by braking harder than those that give way."""
    return next(t for t, s, v in rows if v * v > 2 * GIVING_WAY_MPS2 * max(edge_m - s, 0.0))


def scripted(case, name, start, sections, lateral=None, vehicle_class="car", goal=None):
    """Adds a vehicle with a script; `lateral` is when it moves to which lateral position."""
    script = [{"speed_mps": start["speed_mps"]}]
    script += [{"from_s": t, "speed_mps": speed, "acceleration_mps2": rate} for t, speed, rate in sections]
    script += [{"from_s": lateral[0], "lateral_m": lateral[1]}] if lateral else []
    script.sort(key=lambda order: order.get("from_s", 0.0))
    case.add(name, start, {"kind": "scripted", "script": script}, vehicle_class, goal)


def chain(case, rng, count, front_m, speed_mps, lane, goal_lane=None):
    """Adds followers whose first has its front at `front_m`, then at gaps of 1 to 3 s; the first is the ego."""
    front, rear, _ = BODIES["car"]
    for name in ["ego", "second", "third"][:count]:
        start = {"lane": lane, "along_m": front_m - front, "speed_mps": speed_mps}
        case.add(name, start, case.driver, goal={"speed_mps": speed_mps, **({"lane": goal_lane} if goal_lane else {})})
        case.followers.append(name)
        front_m -= front + rear + rng.uniform(1.0, 3.0) * speed_mps


# Kinds of files. Each returns the table `road` and the duration.


def stops(case, rng):
    place = rng.choice(STOPS)
    slowest, fastest = (12.0, 25.0) if "lane" in place else (8.0, 20.0 if place == "street" else 13.5)
    v, begins, braking = rng.uniform(slowest, fastest), round(rng.uniform(2.0, 6.0), 1), rng.uniform(3.0, 7.0)
    gap_s, count, record, goes_on = rng.uniform(1.0, 3.0), rng.choice([1, 1, 2, 3, 3]), case.record, rng.random() < 0.3
    at_m = 250.0
    if place == "crossing":
        at_m = CROSSING_ARM_M - rng.uniform(12.0, 40.0) - v * begins - v * v / (2 * braking)
        line, lane, end = straight(-CROSSING_ARM_M, -1.75), "west-in", "east-out"
        road = {"kind": "crossing", "arm_length_m": CROSSING_ARM_M}
    elif place == "bend":
        line = bend(at_m + v * begins * rng.uniform(0.3, 1.0), rng.uniform(100.0, 250.0), rng.uniform(0.4, 1.4), rng.choice([-1, 1]))
        points = [[round(number, 4) for number in line(5.0 * i)[:2]] for i in range(160)]
        road, lane, end = {"kind": "network", "lane": [{"name": "bend", "points": points, "width_m": LANE_M}]}, "bend", None
    elif place == "street":
        line, road, lane, end = straight(STREET_X_M, -1.75), street(), "east", None
    else:
        line, road, lane, end = straight(0.0, 1.75), lanes(1 if place == "one lane" else 2), 0, None
    stands = begins + v / braking
    case.onset_s, case.stands_until_s = begins, stands + 15.0
    sections = [(begins, 0.0, braking)] + ([(round(stands + 15.0, 1), v, 1.5)] if goes_on else [])
    duration = stands + 15.0 + (20.0 if goes_on else 0.0)
    if record:
        recorded(case, "leader", line, motion(at_m, v, sections, duration + 1.0))
    else:
        goal = {"speed_mps": v, **({"lane": end} if end else {})}
        scripted(case, "leader", {"lane": lane, "along_m": at_m, "speed_mps": v}, sections, goal=goal)
    chain(case, rng, count, at_m - BODIES["car"][1] - gap_s * v, v, lane, end)
    if place == "two lanes, left taken":
        beside_m = case.lines[1]["start"]["along_m"] - 2.0
        for i in range(-2, 3):
            case.add(f"beside{i + 2}", {"lane": 1, "along_m": beside_m + i * (4.5 + 1.5 * v), "speed_mps": v}, "normal")
    if place == "street" and rng.random() < 0.5:
        place += " with traffic"
        for i in range(4):
            start = {"lane": "west", "along_m": 1500.0 + STREET_X_M + 100.0 - v * begins + i * 3.0 * v, "speed_mps": v}
            case.add(f"oncoming{i}", start, "normal")
    case.note = f"{place}: the leader drives {v:.1f} m/s and brakes with {braking:.1f} m/s² at {begins} s, {gap_s:.2f} s ahead of {count}"
    return road, duration


def cut_ins(case, rng):
    place = rng.choice(["two lanes", "three lanes", "network"])
    v, begins, over = rng.uniform(10.0, 25.0), round(rng.uniform(1.5, 4.0), 1), rng.uniform(2.0, 4.0)
    slower, gap_m = rng.uniform(0.0, min(8.0, 0.5 * v)), rng.uniform(0.2, 1.0) * v
    side = 1 if place == "two lanes" or rng.random() < 0.5 else -1
    road = {"two lanes": lanes(2), "three lanes": lanes(3), "network": dual()}[place]
    own = (1 if place == "three lanes" else 0) if place != "network" else ("right" if side == 1 else "left")
    y = 1.75 + LANE_M * own if place != "network" else -1.75 * side
    origin = 0.0 if place != "network" else STREET_X_M
    brakes = [(round(begins + over, 1), (v - slower) * rng.uniform(0.3, 0.8), rng.uniform(1.0, 4.0))] if rng.random() < 0.5 else []
    front, rear, _ = BODIES["car"]
    ego_m = 200.0
    at_m = ego_m + front + gap_m + rear + slower * begins
    case.onset_s, case.line, duration = begins, straight(0.0, y), begins + 18.0
    if case.record or place == "network":
        rows = motion(at_m, v - slower, brakes, duration + 1.0)
        recorded(case, "intruder", straight(origin, y + LANE_M * side), rows, (begins, over, -LANE_M * side))
    else:
        scripted(case, "intruder", {"lane": own + side, "along_m": at_m, "speed_mps": v - slower}, brakes, (begins, y))
    chain(case, rng, rng.choice([1, 2]), ego_m + front, v, own)
    case.note = f"{place}: cuts in {gap_m:.1f} m ahead of {v:.1f} m/s, {slower:.1f} m/s slower, at {begins} s"
    return road, duration


def pull_outs(case, rng):
    place = rng.choice(["lane", "bay", "drive"])
    v, begins, lead_s = rng.uniform(8.0, 20.0 if place == "lane" else 13.5), round(rng.uniform(1.0, 3.0), 1), rng.uniform(1.5, 4.5)
    speed, rate, over = rng.uniform(4.0, 10.0), rng.uniform(1.0, 2.5), rng.uniform(2.0, 3.5)
    front, rear, _ = BODIES["car"]
    ego_m, duration = 200.0, begins + 22.0
    lead_s += 1.5 if place == "drive" else 0.0
    at_m = ego_m + front + v * (begins + lead_s) + rear
    case.onset_s, own = begins, 1 if place == "lane" else "east"
    origin, y = (0.0, 1.75 + LANE_M) if place == "lane" else (STREET_X_M, -1.75)
    case.line = straight(0.0, y)
    road = lanes(2) if place == "lane" else street(at_m + STREET_X_M if place == "drive" else None)
    if place == "drive":
        # From a drive across the lane; stands there, and goes on.
        pause, middle_m = rng.uniform(3.0, 7.0), rng.uniform(-3.0, -1.0)
        sections = [(begins, 2.5, 1.5), (begins + 2.2, 0.0, 2.0), (begins + 3.5 + pause, 6.0, 1.5)]
        way = motion(middle_m - 5.0, 0.0, sections, duration + 1.0)
        case.shows_s = cannot_give_way(way, -1.75 - 0.9 - front)
        recorded(case, "intruder", lambda s: (at_m + STREET_X_M, s, math.pi / 2), way)
    elif place == "bay" or case.record:
        by_m = LANE_M if place == "lane" else 3.0
        rows = motion(at_m, 0.0, [(begins, speed, rate)], duration + 1.0)
        recorded(case, "intruder", straight(origin, y - by_m), rows, (begins + 0.8, over, by_m))
    else:
        scripted(case, "intruder", {"lane": 0, "along_m": at_m, "speed_mps": 0.0}, [(begins, speed, rate)], (begins, y))
    chain(case, rng, rng.choice([1, 2]), ego_m + front, v, own)
    case.note = f"{place}: pulls out {lead_s:.1f} s ahead of {v:.1f} m/s at {begins} s"
    return road, duration


def crossings(case, rng):
    place, vehicle_class = rng.choice(["street", "crossing"]), rng.choice(["car", "car", "van", "bicycle"])
    v, across = rng.uniform(8.0, 13.5), rng.uniform(3.0, 6.0 if vehicle_class == "bicycle" else 8.0)
    later = rng.uniform(-0.3, 1.5)
    arrives = max(rng.uniform(4.0, 7.0), 12.0 / across + later)
    front, _, _ = BODIES[vehicle_class]
    edge_m, duration = -1.75 - 0.9 - front, arrives + 16.0
    y0 = edge_m - across * (arrives - later)
    rows = motion(y0, across, [], duration + 1.0)
    case.shows_s = case.onset_s = cannot_give_way(rows, edge_m)
    ego_front_m = 180.0 if place == "street" else CROSSING_ARM_M + 1.75 - BODIES[vehicle_class][2] / 2 - v * arrives
    x = 1.75 if place == "crossing" else STREET_X_M + ego_front_m + v * arrives + BODIES[vehicle_class][2] / 2
    case.line = straight(0.0, -1.75)
    if place == "street":
        own, goal, lane, end, lane_y = "east", None, "drive", "across", -120.0
        road = street(x)
    else:
        road = {"kind": "crossing", "arm_length_m": CROSSING_ARM_M}
        own, goal, lane, end, lane_y = "west-in", "east-out", "south-in", "north-out", -CROSSING_ARM_M
    if case.record:
        recorded(case, "intruder", lambda s: (x, s, math.pi / 2), rows, vehicle_class=vehicle_class)
    else:
        start = {"lane": lane, "along_m": y0 - lane_y, "speed_mps": across}
        scripted(case, "intruder", start, [], vehicle_class=vehicle_class, goal={"lane": end, "speed_mps": across})
    chain(case, rng, rng.choice([1, 2]), ego_front_m, v, own, goal)
    case.note = f"{place}: a {vehicle_class} crosses with {across:.1f} m/s, {later:.1f} s before a driver with {v:.1f} m/s"
    return road, duration


def make(kind, index, seed, folder):
    rng = random.Random(f"{seed} {kind} {index}")
    driver = DRIVERS[index % len(DRIVERS)]
    case = Case(kind, driver, f"{kind}-{index:04}-{driver}", record=(index // len(DRIVERS)) % 2 == 0)
    road, duration = {"stops": stops, "cut-ins": cut_ins, "pull-outs": pull_outs, "crossings": crossings}[kind](case, rng)
    case.note += ", by record" if case.tables else ", by script"
    for name, table in case.tables.items():
        (folder / f"{case.name}-{name}.csv").write_text(table)
    (folder / f"{case.name}.toml").write_text(case.text(road, duration))
    return case
