"""A script for merge-v0 of HighwayEnv with four lines changed: a network learns to merge."""

import gymnasium
import interplay
from stable_baselines3 import DQN

env = gymnasium.make("interplay/RampMerge-v0", action="DiscreteMeta")
model = DQN("MlpPolicy", env, learning_rate=5e-4, learning_starts=200, gamma=0.95, target_update_interval=50, seed=1)
model.learn(total_timesteps=6_000)

for episode in range(5):
    observation, info = env.reset(seed=episode)
    terminated = truncated = False
    total = 0.0
    while not (terminated or truncated):
        action, _ = model.predict(observation, deterministic=True)
        observation, reward, terminated, truncated, info = env.step(action)
        total += reward
    print(f"episode {episode}: return {total:.1f}, crashed {info['ending'] == 'contact'}")
