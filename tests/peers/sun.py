"""The position of the sun and radiation on tilted planes, beside pvlib.

    pip install pvlib
    python3 tests/peers/sun.py [FILE.epw ...]

Positions are compared at 20,000 random places and moments from 1990 to 2060 with pvlib's algorithm of Reda and Andreas (NREL SPA), true
angles without refraction. Radiation is compared row by row with pvlib's Perez model over the rows of each file (every day of it), for
eight planes; without a file this part is skipped. Exits with 1 where a bound does not hold.
"""
import os
import subprocess
import sys

try:
    import numpy as np
    import pandas as pd
    import pvlib
except ImportError as error:
    print(f"skipped: {error}; pip install pvlib")
    sys.exit(0)

# INTERPLAY_WEATHER names the built example, which saves a start of cargo for each plane.
PROGRAM = os.environ.get("INTERPLAY_WEATHER", "").split() or [
    "cargo", "run", "--quiet", "--release", "-p", "interplay-building", "--example", "weather", "--"]
EPOCH = pd.Timestamp("2000-01-01T12:00:00Z")
POSITION_DEG = 0.01
PLANES = [(0, 90), (90, 90), (180, 90), (270, 90), (180, 35), (135, 60), (180, 0), (0, 150)]


def ours(arguments, text=None):
    run = subprocess.run(PROGRAM + arguments, input=text, capture_output=True, text=True, check=True)
    return np.array([[float(number) for number in line.split()] for line in run.stdout.splitlines()])


def moments(days):
    return pd.DatetimeIndex(EPOCH + pd.to_timedelta(np.asarray(days), unit="D"))


def angle(zenith, azimuth):
    z, a = np.radians(zenith), np.radians(azimuth)
    return np.stack([np.sin(z) * np.sin(a), np.sin(z) * np.cos(a), np.cos(z)])


def positions():
    random = np.random.default_rng(1)
    places, each = 200, 100
    apart, zeniths = [], []
    latitude = np.degrees(np.arcsin(random.uniform(-1, 1, places)))
    longitude = random.uniform(-180, 180, places)
    days = random.uniform(-3650, 22000, (places, each))
    text = "\n".join(f"{latitude[i]!r} {longitude[i]!r} {day!r}" for i in range(places) for day in days[i].tolist())
    found = ours(["sun"], text.replace("np.float64(", "").replace(")", "")).reshape(places, each, 2)
    for i in range(places):
        unixtime = np.array(moments(days[i]).as_unit("ns").asi8) / 1e9
        _, zenith, _, _, azimuth, _ = pvlib.spa.solar_position_numpy(
            unixtime, latitude[i], longitude[i], 0.0, 1013.25, 12.0, 69.0, 0.5667, 1)
        theirs, own = angle(zenith, azimuth), angle(found[i, :, 0], found[i, :, 1])
        across = np.linalg.norm(np.cross(theirs.T, own.T), axis=1)
        apart.append(np.degrees(np.arctan2(across, (theirs * own).sum(axis=0))))
        zeniths.append(np.abs(zenith - found[i, :, 0]))
    apart, zeniths = np.concatenate(apart), np.concatenate(zeniths)
    print(f"positions: {apart.size} moments, largest angle between both {apart.max():.4f} deg, "
          f"of zenith angles {zeniths.max():.4f} deg, mean {apart.mean():.4f} deg")
    return apart.max() <= POSITION_DEG


def radiation(file):
    with open(file, encoding="latin-1") as text:
        data, place = pvlib.iotools.read_epw(text)
    well = True
    dni, dhi, ghi = (data[name].to_numpy(dtype=float) for name in ("dni", "dhi", "ghi"))
    print(f"{place['city']}: year's sum on a plane while the sun is up, ours and pvlib's [kWh/m2], and the largest difference of an hour "
          "[W/m2]")
    when, south = None, None
    for facing, tilt in PLANES:
        found = ours(["planes", file, str(facing), str(tilt)])
        if when is None:
            when = moments(found[:, 0])
            position = pvlib.solarposition.get_solarposition(when, place["latitude"], place["longitude"], altitude=0.0)
            zenith, azimuth = position["zenith"].to_numpy(), position["azimuth"].to_numpy()
            extra = np.asarray(pvlib.irradiance.get_extra_radiation(when, solar_constant=1366.1, method="nrel"))
            airmass = pvlib.atmosphere.get_relative_airmass(zenith)
        total = np.asarray(pvlib.irradiance.get_total_irradiance(
            tilt, facing, zenith, azimuth, dni, ghi, dhi, dni_extra=extra, airmass=airmass, albedo=0.2, model="perez",
            model_perez="allsitescomposite1990")["poa_global"])
        # Below the horizon pvlib has no sky on a tilted plane; ours comes evenly from all of it.
        up = (zenith < 90.0) & ~np.isnan(total)
        gap = np.abs(total - found[:, 1])[up]
        sums = found[up, 1].sum() / 1000, total[up].sum() / 1000
        print(f"  facing {facing:3} tilt {tilt:3}: {sums[0]:8.1f} {sums[1]:8.1f}   {gap.max():.3f}")
        well &= abs(sums[0] / sums[1] - 1) < 1e-3 and gap.max() < 0.5
        if tilt == 90 and facing == (180 if place["latitude"] > 0 else 0):
            south = found[:, 1]
    months = data.index.month.to_numpy()
    aperture = ghi * (south.sum() / ghi.sum())
    ratios = [aperture[months == month].sum() / south[months == month].sum() for month in range(1, 13)]
    print(f"  a horizontal aperture with the same year's sum as a window to the equator gives {min(ratios):.2f} to "
          f"{max(ratios):.2f} times its sun in single months: it errs by a factor of {max(ratios) / min(ratios):.1f} over the year")
    closes = ghi - dhi - dni * np.maximum(np.cos(np.radians(zenith)), 0.0)
    print(f"  of its direct radiation {100 * dni[zenith >= 90].sum() / dni.sum():.1f} % come while the sun is down at the middle of the hour; "
          f"global radiation is missed by {np.sqrt((closes ** 2).mean()):.0f} W/m2 (root of the mean square)")
    return well


def main():
    well = positions()
    files = sys.argv[1:]
    if not files:
        print("radiation on planes: skipped, no weather file is named")
    for file in files:
        well &= radiation(file)
    print("within the bounds" if well else "NOT within the bounds")
    sys.exit(0 if well else 1)


if __name__ == "__main__":
    main()
