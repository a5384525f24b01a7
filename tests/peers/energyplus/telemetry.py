"""Telemetry of the house: some weeks of heating by chance, a row every quarter of an hour, and the mapping of its columns."""

import csv
import datetime
import random

from engine import House

STEP_S = 900.0
HEAT_KW = 4.0
PEOPLE_KW = 0.2
# Beyond these temperatures chance does not decide [°C].
COLDEST_C, WARMEST_C = 18.0, 24.0

MAPPING = """# What the columns of `house.csv` are: a house in EnergyPlus, heated by chance.
walls = [["house", "outdoor"]]

[time]
column = "time"
format = "%Y-%m-%d %H:%M:%S"
step_s = 900.0

[[boundary]]
name = "outdoor"
temperature = "outdoor_c"
hold = "zero-order"

[[zone]]
name = "house"
temperature = "house_c"
heat = [
    { kind = "power", column = "heating_kw", unit = "kw" },
    { kind = "power", column = "people_kw", unit = "kw" },
]
solar = { column = "sun_w_per_m2", unit = "w-per-m2", hold = "zero-order" }

[identify]
# The radiator has no mass.
hidden = ["wall", "interior"]
"""


def write(folder, weather, start, days, window, seed=1):
    """Writes `house.csv` and its mapping `house.toml` into the folder; returns the path of the table."""
    chance = random.Random(seed)
    house = House(weather, start, days, 20.0, window)
    table = folder / "house.csv"
    moment = datetime.datetime.combine(start, datetime.time())
    heat_kw, steps_left = 0.0, 0
    with open(table, "w", newline="", encoding="utf-8") as file:
        rows = csv.writer(file)
        rows.writerow(["time", "house_c", "outdoor_c", "sun_w_per_m2", "heating_kw", "people_kw"])
        for _ in range(round(days * 86_400 / STEP_S)):
            zone_c = house.now["zone_c"]
            if steps_left == 0:
                heat_kw, steps_left = chance.choice([0.0, 0.0, 0.5, 0.5, 0.75, 1.0]) * HEAT_KW, chance.randint(2, 32)
            if zone_c < COLDEST_C:
                heat_kw, steps_left = HEAT_KW, 4
            if zone_c > WARMEST_C:
                heat_kw, steps_left = 0.0, 4
            steps_left -= 1
            measured = house.step(STEP_S, heat_kw, PEOPLE_KW)
            weather_now = [f"{measured['ambient_c']:.4f}", f"{measured['sun_w_per_m2']:.3f}"]
            rows.writerow([moment.strftime("%Y-%m-%d %H:%M:%S"), f"{zone_c:.4f}", *weather_now, heat_kw, PEOPLE_KW])
            moment += datetime.timedelta(seconds=STEP_S)
    house.close()
    (folder / "house.toml").write_text(MAPPING, encoding="utf-8")
    return table
