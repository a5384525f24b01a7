"""The trajectory problem of `planners/src/trajectory/problem.rs` for CasADi and IPOPT.

Multiple shooting: states at t = 1...N and the inputs that are decided are unknowns, the bicycle is an equality between
them. A soft row c >= 0 gets a slack s >= 0 with c + s >= 0 and the cost linear*s + quadratic*s^2.

On a curved road the arc lengths beside the mass centre and the four corners are unknowns too (`curved_road.py`).

One non-linear programme is built for every shape of problem (how many vehicles, ellipses, known inputs); the numbers of a
problem are its parameters.
"""

import casadi as ca
import numpy as np

import curved_road

INF = np.inf


def bicycle(x, u, front_axle, rear_axle, step):
    """Eq. 6.1-6.4."""
    slip = ca.atan(rear_axle / (front_axle + rear_axle) * ca.tan(u[1]))
    return ca.vertcat(
        x[0] + step * x[3] * ca.cos(x[2] + slip),
        x[1] + step * x[3] * ca.sin(x[2] + slip),
        x[2] + step * x[3] * ca.sin(slip) / rear_axle,
        x[3] + step * u[0],
    )


def clearances(x, body, road, lane_end):
    """Eq. 6.7 in the road's frame: front right, front left, rear right, rear left corner inside its edge."""
    front, rear, half = body[0], body[1], body[2] / 2
    heading, right, left = road[0], road[1], road[2]
    across = -ca.sin(heading) * x[0] + ca.cos(heading) * x[1]
    sin, cos = ca.sin(x[2] - heading), ca.cos(x[2] - heading)
    if lane_end is not None:
        bumper = ca.cos(heading) * x[0] + ca.sin(heading) * x[1] + front
        end, height, taper = lane_end[0], lane_end[1], lane_end[2]
        right = right + height / 2 * (1 + ca.tanh((bumper - (end - 2 * taper)) / taper))
    return ca.vertcat(
        across + front * sin - half * cos - right,
        left - (across + front * sin + half * cos),
        across - rear * sin - half * cos - right,
        left - (across - rear * sin + half * cos),
    )


def corners(x, body):
    """Positions of the front right, front left, rear right and rear left corner."""
    sin, cos = ca.sin(x[2]), ca.cos(x[2])
    half = body[2] / 2
    places = [(body[0], -half), (body[0], half), (-body[1], -half), (-body[1], half)]
    return [ca.vertcat(x[0] + cos * a - sin * b, x[1] + sin * a + cos * b) for a, b in places]


def outside(position, centre, shape, heading):
    """d^2 - 1 of eq. 6.8."""
    dx, dy = position[0] - centre[0], position[1] - centre[1]
    sin, cos = ca.sin(heading), ca.cos(heading)
    return ((cos * dx + sin * dy) / shape[1]) ** 2 + ((-sin * dx + cos * dy) / shape[2]) ** 2 - 1


def distance_price(kind, numbers, omega):
    """What the Bayesian planner pays for the elliptical distance omega (eq. 7.19)."""
    if kind == "linear":
        return numbers[0] * omega
    attachment = (numbers[0] + omega) * numbers[1]
    return -attachment * numbers[2] / (attachment - numbers[2]) * omega**2


def in_axes(deviation, axes):
    """A deviation of states with its position along and across the axes (cos, sin)."""
    x, y, cos, sin = deviation[0], deviation[1], axes[0], axes[1]
    return ca.vertcat(cos * x + sin * y, cos * y - sin * x, deviation[2], deviation[3])


def axes_of(vehicle):
    """Cosine and sine of the heading of the axes in which a vehicle's tracking weights are diagonal."""
    heading = vehicle.get("weights_heading", 0.0)
    return [np.cos(heading), np.sin(heading)]


def shape_of(problem):
    """What decides the structure of the programme."""
    vehicles = tuple(
        (len(v.get("known_inputs", [])), len(v.get("keep_outs", [])), v.get("lane_end") is not None,
         tuple(next(iter(d["price"])) for d in v.get("distance_costs", [])),
         tuple(bound is not None for bound in v["mean_speed"]["bounds"]) if "mean_speed" in v else (False, False),
         curve_of(v))
        for v in problem["vehicles"]
    )
    pairs = tuple(tuple(s["pair"]) for s in problem.get("separations", []))
    return problem["horizon"], vehicles, pairs, problem.get("persuasion") is not None


def curve_of(vehicle):
    """Of a curved road: how many rows its tables have, how many stop lines there are, whether the goal is in road coordinates."""
    if "curve" not in vehicle:
        return None
    tables = [len(table) for table in tables_of(vehicle["curve"])]
    return *tables, len(vehicle.get("stop_lines", [])), "road_goal" in vehicle


def tables_of(curve):
    """Tables of the centre line, the right edge and the left edge."""
    return curved_road.line_table(curve), curved_road.edge_table(curve["right"]), curved_road.edge_table(curve["left"])


def stages_of(found, horizon):
    """What is given at t = 1...N, or once for all of them."""
    return found * horizon if len(found) == 1 else found


def headings_of(ellipse, horizon):
    """Directions of an ellipse at t = 1...N."""
    return ellipse.get("headings") or [ellipse["shape"][0]] * horizon


class Programme:
    """The non-linear programme of one shape."""

    ROAD_EDGE = (2e3, 2e3)
    #: Smooths the tip of a distance.
    TIP = 1e-4

    def __init__(self, shape):
        self.horizon, self.vehicles, self.pairs, self.has_persuasion = shape
        self.unknowns, self.parameters, self.rows = [], [], []
        self.cost = 0
        self.soft_rows = []
        #: Per vehicle and stage, how many arc lengths follow the state.
        self.arc_lengths = [[0] * self.horizon for _ in self.vehicles]
        step = self.parameter("step", 1)
        self.paths = [self.vehicle(i, *vehicle, step) for i, vehicle in enumerate(self.vehicles)]
        for j, (of, of_other) in enumerate(self.pairs):
            form, price = self.parameter(f"pair{j}", 3), self.parameter(f"pair{j}price", 2)
            headings = self.parameter(f"pair{j}headings", self.horizon)
            for t in range(self.horizon):
                own, other = self.paths[of][0][t + 1], self.paths[of_other][0][t + 1]
                self.soft(outside(own, other, form, headings[t]), price)
        if self.has_persuasion:
            self.persuade()
        self.equalities = ca.vertcat(*self.rows).numel()
        slacks = ca.SX.sym("slack", len(self.soft_rows))
        for j, (row, price) in enumerate(self.soft_rows):
            self.rows.append(row + slacks[j])
            self.cost += price[0] * slacks[j] + price[1] * slacks[j] ** 2
        p = ca.vertcat(*[symbol for _, symbol in self.parameters])
        path = ca.vertcat(*self.unknowns)
        self.soft_values = ca.Function("soft", [path, p], [ca.vertcat(*[row for row, _ in self.soft_rows])])
        prices = ca.vertcat(*[price[0] for _, price in self.soft_rows], *[price[1] for _, price in self.soft_rows])
        self.prices = ca.Function("prices", [p], [prices])
        rows = ca.vertcat(*self.rows)
        self.problem = {"x": ca.vertcat(path, slacks), "f": self.cost, "g": rows, "p": p}
        self.lbg = np.zeros(rows.numel())
        self.ubg = np.concatenate([np.zeros(self.equalities), np.full(len(self.soft_rows), INF)])
        self.solvers, self.tables, self.objective = {}, {}, None

    def parameter(self, name, *size):
        symbol = ca.SX.sym(name, *size)
        self.parameters.append((name, ca.vec(symbol)))
        return symbol

    def soft(self, row, price):
        self.soft_rows.append((row, price))

    def vehicle(self, i, known, ellipses, ends, prices, bounds, curve, step):
        n = self.horizon
        body, road = self.parameter(f"body{i}", 5), self.parameter(f"road{i}", 3)
        lane_end = self.parameter(f"lane_end{i}", 3) if ends else None
        start, before = self.parameter(f"start{i}", 4), self.parameter(f"before{i}", 2)
        given = self.parameter(f"given{i}", 2, known)
        weights, targets = self.parameter(f"weights{i}", 4), self.parameter(f"targets{i}", 4, n)
        axes = self.parameter(f"axes{i}", 2)
        comfort = self.parameter(f"comfort{i}", 2)
        in_road = curve is not None and curve[-1]
        road_rows = self.curve(i, body, weights, *curve) if curve else None
        states, inputs = [start], []
        previous = before
        for t in range(n):
            if t < known:
                u = given[:, t]
            else:
                u = ca.SX.sym(f"u{i}_{t}", 2)
                self.unknowns.append(u)
                self.cost += ca.dot(comfort, (u - previous) ** 2)
            x = ca.SX.sym(f"x{i}_{t + 1}", 4)
            self.unknowns.append(x)
            self.rows.append(bicycle(states[-1], u, body[3], body[4], step) - x)
            if not in_road:
                self.cost += ca.dot(weights, in_axes(x - targets[:, t], axes) ** 2)
            if curve:
                road_rows(t, x, t >= known)
            elif t >= known:
                inside = clearances(x, body, road, lane_end)
                for c in range(4):
                    self.soft(inside[c], self.ROAD_EDGE)
            states.append(x)
            inputs.append(u)
            previous = u
        for j in range(ellipses):
            centres = self.parameter(f"centres{i}_{j}", 2, n)
            form, price = self.parameter(f"form{i}_{j}", 3), self.parameter(f"price{i}_{j}", 2)
            headings = self.parameter(f"headings{i}_{j}", n)
            for t in range(n):
                self.soft(outside(states[t + 1], centres[:, t], form, headings[t]), price)
        for j, kind in enumerate(prices):
            centres, metrics = self.parameter(f"impressions{i}_{j}", 2, n), self.parameter(f"metrics{i}_{j}", 3, n)
            numbers = self.parameter(f"distance_price{i}_{j}", 1 if kind == "linear" else 3)
            for t in range(n):
                dx, dy = states[t + 1][0] - centres[0, t], states[t + 1][1] - centres[1, t]
                squared = metrics[0, t] * dx**2 + 2 * metrics[1, t] * dx * dy + metrics[2, t] * dy**2
                self.cost += distance_price(kind, numbers, ca.sqrt(squared + self.TIP**2))
        if any(bounds):
            self.mean_speed(i, states, bounds)
        return states, inputs

    def curve(self, i, body, weights, line_rows, right_rows, left_rows, stop_lines, in_road):
        """What adds the costs and rows of a curved road at a stage."""
        line = self.parameter(f"line{i}", 17, line_rows)
        edges = [self.parameter(f"right{i}", 8, right_rows), self.parameter(f"left{i}", 8, left_rows)]
        goal = self.parameter(f"goal{i}", 3) if in_road else None
        permitted = self.parameter(f"permitted{i}", self.horizon) if in_road else None
        slips = self.parameter(f"slips{i}", self.horizon) if in_road else None
        lines = [(self.parameter(f"stop{i}_{j}", 1), self.parameter(f"stop_price{i}_{j}", 2)) for j in range(stop_lines)]

        def beside(t, position):
            along = ca.SX.sym(f"s{i}_{t}_{self.arc_lengths[i][t]}")
            self.arc_lengths[i][t] += 1
            self.unknowns.append(along)
            equation, across, heading = curved_road.road_point(line, along, position)
            self.rows.append(equation)
            return along, across, heading

        def road_rows(t, x, is_decided):
            if in_road or lines:
                along, across, heading = beside(t, x[:2])
            if in_road:
                speed = ca.fmin(goal[2], permitted[t])
                error = ca.vertcat(along - goal[0], across - goal[1], x[2] - heading + slips[t], x[3] - speed)
                self.cost += ca.dot(weights, error**2)
            for place, price in lines:
                self.soft(place - body[0] - along, price)
            if not is_decided:
                return
            for c, corner in enumerate(corners(x, body)):
                corner_along, corner_across, _ = beside(t, corner)
                inside = corner_across - curved_road.edge(edges[c % 2], corner_along)
                self.soft(inside if c % 2 == 0 else -inside, self.ROAD_EDGE)

        return road_rows

    def mean_speed(self, i, states, bounds):
        """Eq. 8.14, 8.15: bounds on the mean of N + 1 speeds."""
        mean = sum(x[3] for x in states) / len(states)
        limits, price = self.parameter(f"mean{i}", sum(bounds)), self.parameter(f"mean_price{i}", 2)
        for j, sign in enumerate([1] * bounds[0] + [-1] * bounds[1]):
            self.soft(sign * (mean - limits[j]), price)

    def persuade(self):
        """Eq. 6.23, corrected: both norms squared."""
        n = self.horizon
        toward, away = self.parameter("toward", 2, n), self.parameter("away", 2, n)
        strength, price = self.parameter("strength", 1), self.parameter("persuasion_price", 2)
        value = 0
        for t in range(n):
            position = self.paths[0][0][t][:2]
            value += strength * ca.sumsqr(position - toward[:, t]) - ca.sumsqr(position - away[:, t])
        self.soft(-value, price)

    def numbers(self, problem):
        """The parameters of a problem."""
        n, found = self.horizon, {"step": [problem["step_s"]]}
        for i, v in enumerate(problem["vehicles"]):
            targets = v["targets"] * n if len(v["targets"]) == 1 else v["targets"] or np.zeros((n, 4))
            found |= {
                f"body{i}": v["body"], f"road{i}": v["road"], f"lane_end{i}": v.get("lane_end"),
                f"start{i}": v["start"], f"before{i}": v["previous_input"], f"given{i}": v.get("known_inputs", []),
                f"weights{i}": v["weights"], f"targets{i}": targets, f"comfort{i}": v["comfort"],
                f"axes{i}": axes_of(v),
            }
            if "curve" in v:
                # No arc length is compared with the first number of a table.
                tables = [np.where(np.isinf(table), 0.0, table) for table in tables_of(v["curve"])]
                found |= dict(zip([f"line{i}", f"right{i}", f"left{i}"], tables))
                goal = v.get("road_goal", {})
                found |= {f"goal{i}": goal.get("target"), f"permitted{i}": goal.get("permitted") or [1e9] * n,
                          f"slips{i}": goal.get("slips") or [0.0] * n}
            for j, stop in enumerate(v.get("stop_lines", [])):
                found |= {f"stop{i}_{j}": [stop["line_m"]], f"stop_price{i}_{j}": stop["penalty"]}
            for j, e in enumerate(v.get("keep_outs", [])):
                found |= {f"centres{i}_{j}": e["centres"], f"form{i}_{j}": e["shape"], f"price{i}_{j}": e["penalty"],
                          f"headings{i}_{j}": headings_of(e, n)}
            for j, d in enumerate(v.get("distance_costs", [])):
                found |= {f"impressions{i}_{j}": d["centres"], f"metrics{i}_{j}": stages_of(d["metrics"], n),
                          f"distance_price{i}_{j}": next(iter(d["price"].values()))}
            if "mean_speed" in v:
                mean = v["mean_speed"]
                found |= {f"mean{i}": [bound for bound in mean["bounds"] if bound is not None],
                          f"mean_price{i}": mean["penalty"]}
        for j, s in enumerate(problem.get("separations", [])):
            found |= {f"pair{j}": s["shape"], f"pair{j}price": s["penalty"], f"pair{j}headings": headings_of(s, n)}
        if self.has_persuasion:
            row = problem["persuasion"]
            found |= {"toward": row["toward"], "away": row["away"], "strength": [row["strength"]],
                      "persuasion_price": row["penalty"]}
        return np.concatenate([np.ravel(np.asarray(found[name], float)) for name, _ in self.parameters])

    def bounds(self, problem):
        """Boxes on inputs and speed; a vehicle that is too fast or slow now must come back only as fast as it can."""
        low, high = [], []
        for i, (v, (known, *_)) in enumerate(zip(problem["vehicles"], self.vehicles)):
            braking, accelerating, steering, slowest, fastest = v["limits"]
            for t in range(self.horizon):
                elapsed = problem["step_s"] * (t + 1)
                if t >= known:
                    low += [braking, -steering]
                    high += [accelerating, steering]
                free = t < known
                low += [-INF] * 3 + [-INF if free else min(slowest, v["start"][3] + accelerating * elapsed)]
                high += [INF] * 3 + [INF if free else max(fastest, v["start"][3] + braking * elapsed)]
                low += [-INF] * self.arc_lengths[i][t]
                high += [INF] * self.arc_lengths[i][t]
        slacks = len(self.soft_rows)
        return np.array(low + [0.0] * slacks), np.array(high + [INF] * slacks)

    def beginning(self, problem, guess):
        """Unknowns from inputs, made admissible as `Participant::admissible` does, and rolled out."""
        unknowns = []
        for i, v in enumerate(problem["vehicles"]):
            known, step = v.get("known_inputs", []), problem["step_s"]
            braking, accelerating, steering, slowest, fastest = v["limits"]
            x = np.array(v["start"])
            for t in range(self.horizon):
                if t < len(known):
                    u = np.array(known[t])
                else:
                    wanted = guess[i][t] if i < len(guess) and t < len(guess[i]) else (0.0, 0.0)
                    elapsed = step * (t + 1)
                    low = max(braking, (min(slowest, v["start"][3] + accelerating * elapsed) - x[3]) / step)
                    high = min(accelerating, (max(fastest, v["start"][3] + braking * elapsed) - x[3]) / step)
                    u = np.array([max(min(wanted[0], high), low), np.clip(wanted[1], -steering, steering)])
                    unknowns.append(u)
                x = np.array(bicycle(ca.DM(x), ca.DM(u), v["body"][3], v["body"][4], step)).ravel()
                unknowns.append(x)
                count = self.arc_lengths[i][t]
                if count:
                    places = self.places(v, x)
                    unknowns.append(places[1:] if count == 4 else places[:count])
        path = np.concatenate(unknowns)
        violations = np.maximum(0.0, -np.array(self.soft_values(path, self.numbers(problem))).ravel())
        return np.concatenate([path, violations])

    def places(self, vehicle, x):
        """Arc lengths beside the mass centre and beside the corners."""
        table = self.tables.setdefault(str(vehicle["curve"]["line"]), curved_road.line_table(vehicle["curve"]))
        around = [np.array(corner).ravel() for corner in corners(ca.DM(x), vehicle["body"])]
        return curved_road.project(table, [x[:2], *around])

    def cost_at(self, problem, inputs):
        """The cost of inputs."""
        if self.objective is None:
            self.objective = ca.Function("cost", [self.problem["x"], self.problem["p"]], [self.problem["f"]])
        return float(self.objective(self.beginning(problem, inputs), self.numbers(problem)))

    def penalty(self, problem, inputs):
        """What the violated rows with a linear weight cost: a row's price is steep, so a violation of 1e-7 shows."""
        path = self.beginning(problem, inputs)
        prices = np.array(self.prices(self.numbers(problem))).reshape(2, -1)
        slacks = path[len(path) - len(self.soft_rows):]
        return float(np.sum((prices[0] * slacks + prices[1] * slacks**2)[prices[0] > 0]))

    def inputs(self, problem, solution):
        """Per vehicle, the inputs in a solution."""
        at, found = 0, []
        for i, (v, (known, *_)) in enumerate(zip(problem["vehicles"], self.vehicles)):
            own = [list(u) for u in v.get("known_inputs", [])]
            for t in range(self.horizon):
                if t >= known:
                    own.append([float(solution[at]), float(solution[at + 1])])
                    at += 2
                at += 4 + self.arc_lengths[i][t]
            found.append(own)
        return found

    def solver(self, options):
        key = tuple(sorted(options.items()))
        if key not in self.solvers:
            self.solvers[key] = ca.nlpsol("ipopt", "ipopt", self.problem, options)
        return self.solvers[key]

    def solve(self, problem, guess, options):
        """IPOPT's outcome: status, cost, inputs, iterations and the time of its own work [ms]."""
        low, high = self.bounds(problem)
        solver = self.solver(options)
        answer = solver(x0=self.beginning(problem, guess), p=self.numbers(problem), lbx=low, ubx=high,
                        lbg=self.lbg, ubg=self.ubg)
        stats = solver.stats()
        return {
            "solved": bool(stats["success"]), "status": stats["return_status"], "cost": float(answer["f"]),
            "iterations": stats["iter_count"], "time_ms": 1e3 * stats["t_wall_total"],
            "processor_ms": 1e3 * stats["t_proc_total"],
            "inputs": self.inputs(problem, np.array(answer["x"]).ravel()),
        }


class Ipopt:
    """IPOPT with the programmes that it has met."""

    QUIET = {"print_time": 0, "record_time": True, "ipopt.print_level": 0, "ipopt.sb": "yes", "error_on_fail": False}
    #: From a guess.
    PLAIN = QUIET | {"ipopt.bound_relax_factor": 0.0, "ipopt.tol": 1e-8, "ipopt.max_iter": 1000}
    #: From a supposed optimum, without being pushed away from it first, to the last digits: at a tolerance of 1e-8 the
    #: barrier of some 200 rows still shows in the sixth.
    NEARBY = PLAIN | {"ipopt.tol": 1e-11, "ipopt.compl_inf_tol": 1e-10, "ipopt.mu_target": 0.0,
                      "ipopt.nlp_scaling_method": "none", "ipopt.acceptable_iter": 0, "ipopt.mu_init": 1e-6,
                      "ipopt.bound_push": 1e-9, "ipopt.bound_frac": 1e-9,
                      "ipopt.slack_bound_push": 1e-9, "ipopt.slack_bound_frac": 1e-9}

    def __init__(self):
        self.programmes = {}

    def programme(self, problem):
        shape = shape_of(problem)
        if shape not in self.programmes:
            self.programmes[shape] = Programme(shape)
        return self.programmes[shape]

    def solve(self, problem, guess, options):
        return self.programme(problem).solve(problem, guess, options)
