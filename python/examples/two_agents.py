"""Two agents at one intersection, with the interface of PettingZoo: each yields to the vehicle from its right."""

from interplay.parallel import parallel_env

FASTER, SLOWER = 3, 4
env = parallel_env("intersection/nice", ["ego", "crossing"], observation="Kinematics", action="DiscreteMeta")


def right_before_left(rows):
    """The other's position is relative to the agent, in the axes of the world; the heading turns it into the agent's."""
    (_, _, _, _, _, cos, sin), (presence, x, y, *_) = rows[:2]
    ahead, left = cos * x + sin * y, cos * y - sin * x
    return SLOWER if presence and ahead > 0.0 and left < 0.0 else FASTER


for seed in range(5):
    seen, infos = env.reset(seed=seed)
    returns, endings = dict.fromkeys(env.agents, 0.0), []
    while env.agents:
        seen, rewards, terminated, truncated, infos = env.step({name: right_before_left(seen[name]) for name in env.agents})
        for name, reward in rewards.items():
            returns[name] += reward
        endings += [(name, info["ending"], round(info["time_s"], 1)) for name, info in infos.items() if "ending" in info]
    print(f"seed {seed}: {endings}, returns {returns['ego']:.1f} and {returns['crossing']:.1f}")
