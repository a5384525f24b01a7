"""A planner of one's own for Encounters 1: follow the car ahead, keep the lane, yield to others that come near the route.

One line of JSON in for each plan, one out; `interplay bench schema` describes the line that comes in.
"""

import json
import math
import sys


def own_rule(seen):
    own, pose, points = seen["own"], seen["own"]["pose"], seen["route"]["points"]
    speed = pose["speed_mps"]
    # Stop before the nearest point of the route where another is now, or will be while the own car comes there.
    gap = 1e3
    for other in seen["others"]:
        o, beside = other["pose"], 0.5 * (own["width_m"] + other["width_m"]) + 0.6
        for step in range(11):
            x = o["x_m"] + 0.4 * step * o["speed_mps"] * math.cos(o["heading_rad"])
            y = o["y_m"] + 0.4 * step * o["speed_mps"] * math.sin(o["heading_rad"])
            for place, (px, py, *_) in enumerate(points[2:40], 2):
                if math.hypot(px - x, py - y) < beside and abs(2.0 * place - 0.4 * step * speed) < 12.0:
                    gap = min(gap, 2.0 * place - own["reach_m"][0] - other["reach_m"][1] - 1.0)
    limit = points[min(len(points) - 1, 1 + int(speed))][5] or 50.0
    wanted = min(seen["goal"]["wanted_speed_mps"], limit, math.sqrt(2 * 2.0 * max(gap, 0.0)))
    acceleration = max(-6.0, min(1.5, wanted - speed))
    # Pure pursuit of the point some way ahead on the route.
    x, y, *_ = points[min(len(points) - 1, 2 + int(0.4 * speed))]
    ahead, angle = math.hypot(x - pose["x_m"], y - pose["y_m"]), math.atan2(y - pose["y_m"], x - pose["x_m"])
    wheelbase = own["reach_m"][2] + own["reach_m"][3]
    return [acceleration, math.atan(2.0 * wheelbase * math.sin(angle - pose["heading_rad"]) / max(ahead, 1.0))]


for line in sys.stdin:
    print(json.dumps({"input": own_rule(json.loads(line))}), flush=True)
