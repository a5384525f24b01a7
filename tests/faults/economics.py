"""Buildings whose heat costs money: keys of controllers, prices, heat pumps, comfort and forecasts, of any size."""

import random

import edits
from target import RECORD, Commands, Target

PARENTS = ["building/economic-mpc"] * 6 + ["building/office-and-flat", "building/office-and-flat", "building/four-room-pid", "mixed/garage"]
PARENTS += ["building/epw-weather", "building/model-predictive", "building/iterative-free-nights", "building/concurrent-uncertain"]
PARENTS += ["building/distributed", "building/four-room-ilc", "building/fixed-warm-nights"]
KINDS = ["economic-mpc"] * 6 + ["model-predictive", "thermostat", "pid", "iterative-learning", "iterative", "concurrent", "distributed", "clairvoyant"]
# The bounds of each key; values beyond them are tried, too.
OF_CONTROLLERS = {
    "economic-mpc": {
        "horizon_h": (0.25, 48),
        "fine_h": (0, 48),
        "block_h": (0, 6),
        "discomfort_price": (0, 1e4),
        "margin_k": (0, 5),
        "emission_price_per_kg": (0, 10),
        "persistence_h": (0.1, 1000),
        "heat_noise_kw": (0.0001, 1000),
        "wall_noise_k": (0.0001, 100),
        "sensor_noise_k": (0.0001, 10),
        "learning_rate": (0, 1),
    },
    "model-predictive": {"horizon_h": (0.25, 48), "discomfort_linear": (0, 1e6), "discomfort_quadratic": (0, 1e6), "learning_rate": (0, 1)},
    "thermostat": {"dead_band_k": (0, 20), "power": (0, 1)},
    "pid": {"proportional_kw_per_k": (0, 1e3), "integral_kw_per_k_h": (0, 1e3), "derivative_kw_h_per_k": (0, 1e3)},
    "iterative": {
        "learning_rate": (0, 1),
        "confidence": (0.5, 0.999999),
        "decay": (0.001, 1),
        "initial_gain_kw_per_k": (0, 10),
        "model_error": (0, 2),
    },
    "concurrent": {
        "learning_rate": (0, 1),
        "gamma_q": (0, 100),
        "gamma_2": (0, 100),
        "confidence": (0.5, 0.999999),
        "discomfort_quadratic": (0, 1e6),
        "initial_gain_kw_per_k": (0, 10),
    },
    "distributed": {"tolerance_kw": (0, 10), "discomfort_quadratic": (0, 1e6), "gain_kw_per_k": (0, 10), "learning_rate": (0, 1), "loss": (0, 1)},
}
OTHERS = {
    "tariff.demand_per_kw": (0, 1e5),
    "setpoints.occupied_weight": (0, 1e6),
    "setpoints.other_weight": (0, 1e6),
    "setpoints.input_weight": (0, 1e6),
    "setpoints.band_k": (0, 100),
    "setpoints.other_c": (-50, 100),
    "setpoints.from_h": (0, 24),
    "setpoints.to_h": (0, 24),
    "building.initial_c": (-50, 100),
    "weather.climate.mean_c": (-60, 60),
    "weather.climate.daily_amplitude_k": (0, 50),
    "weather.climate.day_deviation_k": (0, 20),
    "weather.climate.storm_probability": (0, 1),
}
CHOICES = {
    "tariff.prices_per_kwh": ["[0.0]", "[-0.1]", "[1000]", "[0.3, -0.3]", "[0.1, 0.4, 0.2]", "[1e-300]", "[0.0, 1000.0]", "[-1000.0, 1000.0]", "[1e-9, 1e3]"],
    "tariff.emissions_kg_per_kwh": ["[]", "[0]", "[10]", "[0.4, 0.1]", "[0.0, 10.0, 0.0]", "[-1]"],
    "tariff.interval_s": ["60", "300", "900", "1800", "3600", "7200", "86400", "61"],
    "building.step_s": ["300", "600", "900", "1800", "3600", "7200", "1000"],
    "tariff.currency": ['""', '"€"', '"\\u009b31m"', '"\\u0000"', '"a b"', '"<b>"', '"NaN"'],
    "heat_pump.heating": ["[]", "[{ outdoor_c = 0, cop = 0.1 }]", "[{ outdoor_c = 0, cop = 50 }]", "[{ outdoor_c = 5, cop = 3 }, { outdoor_c = -5, cop = 2 }]",
        "[{ outdoor_c = 0, cop = 3 }, { outdoor_c = 0, cop = 2 }]", "[{ outdoor_c = 0, cop = 0.1 }, { outdoor_c = 1e-9, cop = 50 }]"],
    "heat_pump.cooling": ["[]", "[{ outdoor_c = 30, cop = 4 }]", "[{ outdoor_c = -100, cop = 50 }, { outdoor_c = 100, cop = 0.1 }]"],
    "setpoints.weigh_energy": ["true", "false"],
    "setpoints.occupied_c": ["[21.0]", "[21.0, 22.0]", "[-50]", "[100]", "[]", "[20, 21, 22, 23]"],
    "weather.forecast": ['{ kind = "exact" }', '{ kind = "persistence" }', '{ kind = "uncertain", level = "high" }', '{ kind = "uncertain", level = "low" }'],
    "controller.learn_forecast": ["true", "false"],
    "calendar.first_day": ['"2026-02-28"', '"2024-02-28"', '"2026-12-31"', '"2026-02-30"', '"0000-01-01"'],
}
# A list of zones takes the place of the parent's.
ZONES = """[[building.zone]]
name = "office"
capacity_kj_per_k = {}
heating_limit_kw = {}
cooling_limit_kw = {}
[[building.zone]]
name = "flat"
capacity_kj_per_k = 12000.0
heating_limit_kw = 8.0
cooling_limit_kw = 0.0
"""
BLOCKS = [
    ZONES.format(12000.0, 0.0, 0.0),
    ZONES.format(10.0, 6.0, 5.0),
    ZONES.format(1e6, 1e9, 1e9),
    ZONES.format(500.0, 1e-9, 1e-9),
    '[[schedule]]\nzones = ["office"]\nother_c = 17.0\nbase_kw = 0.2\n[[schedule.period]]\nfrom_h = 8.0\nto_h = 18.0\nwanted_c = 21.0\nband_k = 0.0\npeople_kw = 3.0\n',
    '[expect.building]\nenergy_cost_at_most = 100.0\ntotal_energy_cost_at_most = 1000.0\nregret_at_most = 100.0\n',
]


def _between(low: float, high: float, dice: random.Random) -> str:
    """A value within bounds, at them, or beyond."""
    within = low + (high - low) * dice.random() ** dice.choice([1, 1, 4, 12])
    value = dice.choice([within] * 24 + [low, high] * 5 + [-1.0, 2 * high])
    return f"{value:.4g}" if dice.random() < 0.99 else dice.choice(["nan", "inf", "1e-300", "1e308", "true"])


def _made(dice: random.Random) -> str:
    """A building that extends an authored one and states a few keys of its own."""
    kind = dice.choice(KINDS)
    lines = [f'extends = "{dice.choice(PARENTS)}"', f"iterations = {dice.choice([1, 1, 2, 2, 3])}", f'controller.kind = "{kind}"']
    keys = {f"controller.{key}": bounds for key, bounds in OF_CONTROLLERS.get(kind, {}).items()}
    for _ in range(dice.randint(1, 6)):
        among = dice.choice([keys or OTHERS, keys or OTHERS, OTHERS, CHOICES])
        key = dice.choice(sorted(among))
        value = dice.choice(CHOICES[key]) if key in CHOICES else _between(*among[key], dice)
        if not any(line.startswith(f"{key} ") for line in lines) and (key != "controller.learn_forecast" or kind == "economic-mpc"):
            lines.append(f"{key} = {value}")
    return "\n".join(lines) + "\n" + (dice.choice(BLOCKS) if dice.random() < 0.25 else "")


def _spoil(text: str, others: list[str], dice: random.Random) -> str:
    if dice.random() < 0.7:
        text = _made(dice)
    kind = dice.random()
    return edits.toml(text, others, dice) if kind < 0.1 else edits.values(text, others, dice) if kind < 0.2 else text


def _commands(text: str) -> Commands:
    run = ["run", "input.toml", *RECORD, "--series", "series.csv"]
    return ["check", "input.toml"], [run + ["--json"] * (len(text) % 2)]


def targets(_binary: str) -> dict[str, Target]:
    """Buildings."""
    dice = random.Random("seeds of economics")
    return {"economic": Target("toml", [_made(dice) for _ in range(40)], _spoil, _commands)}
