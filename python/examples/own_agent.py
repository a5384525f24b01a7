"""A driver of one's own rules in a lane change, beside our negotiating planner, in the same twenty episodes."""

import gymnasium

import interplay

LEFT, IDLE, SLOWER = 0, 1, 4
env = gymnasium.make("interplay/LaneChange-v0", observation="Lane", action="DiscreteMeta")
names = env.unwrapped.observation_names["Lane"]
planned = gymnasium.make("interplay/LaneChange-v0")
planner = interplay.policy("negotiation").bind(planned)


def own_rules(observation):
    """Changes to the left lane where there is room, and lets the others go ahead before that."""
    seen = dict(zip(names, observation))
    if seen["left_leader_gap"] > 0.08 and seen["left_follower_gap"] > 0.15:
        return LEFT if seen["left_exists"] else IDLE
    return SLOWER if seen["left_exists"] and seen["speed"] > 0.4 else IDLE


for name, env, act in [("own rules", env, own_rules), ("negotiation", planned, lambda _: planner.act())]:
    endings, times_s = [], []
    for seed in range(20):
        (observation, info), _ = env.reset(seed=seed), planner.reset()
        while "ending" not in info:
            observation, reward, terminated, truncated, info = env.step(act(observation))
        endings.append(info["ending"])
        times_s.append(info["time_s"])
    print(f"{name:12}{endings.count('goal') / 20:4.0%} success, {sum(times_s) / 20:.1f} s on average")
