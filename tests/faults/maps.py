"""Maps and scenes of CommonRoad (XML)."""

import pathlib
import random
import re

import edits
from target import ROOT, RECORD, Commands, Target

# Interplay's drivers need wider lanes than a record.
DRIVERS = frozenset(["--ego", "--replace"])
# Scenes that are no part of the repository; inputs made of them are not kept.
REAL = [folder / "shared/data/commonroad" for folder in (ROOT.parent, ROOT.parent.parent)]
MOST_REAL_BYTES = 400_000
ELEMENT = re.compile(r"(?s)<(\w+)[^<>]*/>|<(\w+)[^<>]*>[^<]*</\2>")
BLOCK = re.compile(r"(?s)<(point|state|adjacentLeft|adjacentRight|lanelet|dynamicObstacle|obstacle|staticObstacle|planningProblem|trafficSign|trafficLight|intersection|goalState|initialState|shape|rectangle|stopLine)\b.*?</\1>")
ATTRIBUTE = re.compile(r'(\w+)="([^"]*)"')
TAG = re.compile(r"<(/?)(\w+)")
PIECES = ["<", ">", "</", "<!--", "-->", "<![CDATA[", "&", "&amp;", "&#0;", "&#x9b;", "&x;", '"', "\0", "é", "\x1b[31m", "<?xml?>", "]]>", "<a/>"]
PIECES += ['<!DOCTYPE a [<!ENTITY b "cc">]>', "<lanelet id='1'/>", "<point/>", " ", "\n"]
VALUES = ["", "0", "-1", "nan", "inf", "-inf", "1e308", "1e-300", "1e400", "0x10", "１", "abc", "1,5", "9223372036854775808", "4294967296", "\x9b", "é"]
VALUES += ["true", "2018b", "2020a", "0.0", "1e9", "-1e9", "100", "same", "opposite"]


def _element_value(text: str, dice: random.Random) -> str:
    """Another text in one of the innermost elements, or another value of an attribute."""
    places = list(re.finditer(r">([^<>\s][^<>]*)<", text)) if dice.random() < 0.6 else list(ATTRIBUTE.finditer(text))
    if not places:
        return text
    place = dice.choice(places)
    group = place.re.groups
    return text[: place.start(group)] + dice.choice(VALUES) + text[place.end(group) :]


def _moved(text: str, other: str, pattern: re.Pattern[str], dice: random.Random) -> str:
    """An element that is lost, doubled, moved, or one of another scene."""
    here = list(pattern.finditer(text))
    if not here:
        return text
    at, foreign = dice.choice(here), [found[0] for found in pattern.finditer(other)] or [""]
    made = dice.choice(["", at[0] * 2, dice.choice(here)[0], at[0] + dice.choice(foreign), dice.choice(foreign)])
    return text[: at.start()] + made + text[at.end() :]


def _tag(text: str, dice: random.Random) -> str:
    """Another name of an element, on one side or on both."""
    names = list(TAG.finditer(text))
    if not names:
        return text
    old, new = dice.choice(names), dice.choice(names)[2]
    if dice.random() < 0.3:
        return text[: old.start(2)] + new + text[old.end(2) :]
    return re.sub(rf"<(/?){old[2]}\b", rf"<\g<1>{new}", text, count=2)


def _spoil(text: str, others: list[str], dice: random.Random) -> str:
    """A scene with one to three mistakes."""
    for _ in range(dice.randint(1, 3)):
        kind, other = dice.random(), dice.choice(others)
        if kind < 0.35:
            text = edits.other_number(text, dice)
        elif kind < 0.5:
            text = _element_value(text, dice)
        elif kind < 0.75:
            text = _moved(text, other, dice.choice([BLOCK, BLOCK, ELEMENT]), dice)
        elif kind < 0.85:
            text = _tag(text, dice)
        elif kind < 0.95:
            text = edits.other_lines(text, other, dice)
        else:
            text = edits.other_piece(text, PIECES, dice)
    return text


def _commands(text: str) -> Commands:
    made = ["import", "input.xml", "--out", "made.toml"]
    made += [[], ["--ego", "human"], ["--replace", "all=human:tough"], ["--replace", "all"]][len(text) % 4]
    driven = ["run", "input.xml", *RECORD, "--export", "driven.xml"]
    return ["check", "input.xml"], [driven, ["check", "driven.xml"], made, ["check", "made.toml"], ["run", "made.toml", "--no-record"]]


def targets(_binary: str) -> dict[str, Target]:
    """Scenes of the repository, and real ones where they are there."""
    short = re.findall(r"(?ms)^```xml\n(.*?)^```", (ROOT / "docs/guide/commonroad.md").read_text("utf-8"))
    own = short * 2 + [file.read_text("utf-8") for file in sorted((ROOT / "tests/cases/commonroad").glob("*.xml"))]
    found = {"commonroad": Target("xml", own, _spoil, _commands, may_refuse=DRIVERS)}
    files = [file for folder in REAL for file in sorted(folder.glob("*.xml")) if file.stat().st_size < MOST_REAL_BYTES]
    if files:
        real = [pathlib.Path(file).read_text("utf-8") for file in files]
        found["real-scenes"] = Target("xml", real, _spoil, _commands, may_refuse=DRIVERS, keeps=False)
    return found
