"""A user's model predictive controller in CasADi drives the ego of a lane change; the others know its plans."""

import casadi as ca

import interplay

world = interplay.Simulation("lane-change/front-nice", external=["ego"])
seen = world.observe("ego")
least_mps2, most_mps2, steering_rad, most_mps = seen.limits
front_axle_m, rear_axle_m = seen.body_m[0, 3:]
opti, steps = ca.Opti(), seen.horizon_steps
x, u, now = opti.variable(4, steps + 1), opti.variable(2, steps), opti.parameter(4)
others = [opti.parameter(4, steps + 1) for _ in seen.vehicles[1:]]
slip = ca.atan(rear_axle_m / (front_axle_m + rear_axle_m) * ca.tan(u[1, :]))
speed, course = x[3, :-1], x[2, :-1] + slip
rates = ca.vertcat(speed * ca.cos(course), speed * ca.sin(course), speed * ca.sin(slip) / rear_axle_m, u[0, :])
opti.subject_to([x[:, 0] == now, x[:, 1:] == x[:, :-1] + seen.step_s * rates, opti.bounded(0, x[3, :], most_mps)])
opti.subject_to([opti.bounded(least_mps2, u[0, :], most_mps2), opti.bounded(-steering_rad, u[1, :], steering_rad)])
inside = [ca.fmax(0, 1 - ((x[0, :] - it[0, :]) / 0.75) ** 2 - ((x[1, :] - it[1, :]) / 0.35) ** 2) for it in others]
tracking, comfort = ca.sumsqr((x - seen.goal)[1:, :]), ca.sumsqr(ca.diff(u, 1, 1))
opti.minimize(tracking + comfort + 1e3 * sum(ca.sumsqr(depth) for depth in inside))
opti.solver("ipopt", {"print_time": False}, {"print_level": 0, "sb": "yes"})
while not world.is_over:
    seen = world.observe("ego")
    for parameter, value in zip([now, *others], [seen.state[0], *seen.prediction[1:].transpose(0, 2, 1)]):
        opti.set_value(parameter, value)
    plan = opti.solve()
    opti.set_initial([x == plan.value(x), u == plan.value(u)])  # the next descent begins at this plan
    world.apply_plan("ego", plan.value(u).T)
    world.step()
report = world.finish()
print(f"order at the end: {', '.join(report.order)}; {len(report.collisions)} contacts")
