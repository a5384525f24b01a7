"""Random mistakes in texts, tables and lists of flags. All of it is a function of the dice."""

import json
import random
import re

NUMBER = re.compile(r"(?<![\w.])-?\d+(?:\.\d+)?(?![\w.])")
QUOTED = re.compile(r'"[^"\n]*"')
KEY = re.compile(r"(?m)^(\w+)(?= = )")
NUMBERS = ["0", "0.0", "-1", "-0.0", "1e-9", "1e-300", "1e9", "1e308", "nan", "inf", "-inf", "0.5", "3", "64", "1000", "''", "[]", "true"]
PIECES = ["[", "]", "[[vehicle]]\n", "=", "'", '"', "\n", "{", "}", ",", "\t", "\0", "é", "extends = 'tower'\n", "duration_s = 2\n", "#"]
CELLS = ["", " ", "nan", "NaN", "inf", "-inf", "1e308", "-1e308", "1e-300", "-1", "0", "9999", "99.9", "1e6", "abc", '"', '"1', "1;5", "1,5"]
CELLS += ["\0", "é", "\udcff", "2026-02-30 00:00:00", "2026-01-05", "25:00", "7/32", "Monday", "-", "1" * 400, "0x10", "１"]
VALUES = ["1", "-1", "0", "nan", "inf", "1e308", "1e-300", "true", "''", '"nice"', "[]", "[1, 2]", "{}", "{ kind = 'human' }", "{ kind = 'idm' }"]
VALUES += ["", "=", "[", "1979-05-27", "abc", "a.b", "é", "\x1b[31m", "9223372036854775808", "\"\\u0000\"", "{ uniform = [1.0, 1.5] }"]
VALUES += ["{ range = [0.0, 1.0], count = 2 }", "{ normal = { mean = 1.0, sd = -1.0 } }", "{ log_uniform = [0.0, 1.0] }", "[1.0, 1.2]"]
OTHER_FLAGS = [["--planner", "idm"], ["--planner", "human"], ["--planner", "x"], ["--planner", "contingency"], ["--seed", "7"], ["--seed", "-1"]]
SWEEP_FLAGS = [["--planner", "idm"], ["--planner", "nash"], ["--style", "tough"], ["--style", "idm"], ["--style", "x"], ["--samples", "2"]]
SWEEP_FLAGS += [["--samples", "0"], ["--starts", "2"], ["--starts", "-1"], ["--shard", "1/2"], ["--shard", "3/2"], ["--shards", "2"]]
SWEEP_FLAGS += [["--keep", "failures"], ["--jobs", "0"], ["--scenario", "lane-keeping"], ["--scenario", "*"], ["--scenario", ""]]


def other_number(text: str, dice: random.Random) -> str:
    """One number of another size, or something else in its place."""
    numbers = list(NUMBER.finditer(text))
    if not numbers:
        return text
    number = dice.choice(numbers)
    scaled = f"{float(number[0]) * dice.choice([-1.0, 0.1, 0.5, 0.9, 1.1, 2.0, 10.0]):.6g}"
    return text[: number.start()] + (scaled if dice.random() < 0.8 else dice.choice(NUMBERS)) + text[number.end() :]


def _exchanged(text: str, other: str, pattern: re.Pattern[str], dice: random.Random) -> str:
    """One match of a pattern replaced by a match of another text."""
    here, there = list(pattern.finditer(text)), pattern.findall(other)
    if not here or not there:
        return text
    at = dice.choice(here)
    return text[: at.start()] + dice.choice(there) + text[at.end() :]


def other_lines(text: str, other: str, dice: random.Random) -> str:
    """A line that is lost, doubled, or moved, or one of another text."""
    lines = text.splitlines(keepends=True) or ["\n"]
    at = dice.randrange(len(lines))
    foreign = dice.choice(other.splitlines(keepends=True) or ["\n"])
    lines[at : at + 1] = dice.choice([[], [lines[at]] * 2, [lines[at], dice.choice(lines)], [lines[at], foreign]])
    return "".join(lines) or "\n"


def other_piece(text: str, pieces: list[str], dice: random.Random) -> str:
    """A piece at a random place, over none or some of what stands there."""
    at = dice.randrange(len(text) + 1)
    return text[:at] + dice.choice(pieces) + text[at + dice.choice([0, 0, 1, 5]) :]


def toml(text: str, others: list[str], dice: random.Random) -> str:
    """A TOML text with one or two mistakes."""
    for _ in range(dice.randint(1, 2)):
        kind, other = dice.random(), dice.choice(others)
        if kind < 0.6:
            text = other_number(text, dice)
        elif kind < 0.7:
            text = _exchanged(text, other, QUOTED, dice)
        elif kind < 0.75:
            text = _exchanged(text, other, KEY, dice)
        elif kind < 0.9:
            text = other_lines(text, other, dice)
        else:
            text = other_piece(text, PIECES, dice)
    return text


def values(text: str, others: list[str], dice: random.Random) -> str:
    """A TOML text in which one to four values are others, mostly of a size that may be accepted."""
    for _ in range(dice.choice([1, 1, 2, 3])):
        numbers = list(NUMBER.finditer(text))
        if numbers and dice.random() < 0.94:
            place = dice.choice(numbers)
            factor = dice.choice([-1.0, 0.0, 0.1, 0.5, 0.8, 0.9, 0.9, 0.97, 0.99, 0.999, 1.001, 1.01, 1.03, 1.1, 1.1, 1.25, 2.0, 4.0])
            text = text[: place.start()] + f"{float(place[0]) * factor:.6g}" + text[place.end() :]
        else:
            text = _exchanged(text, dice.choice([text, text, *others[:1]]), QUOTED, dice)
    return text


def variant(text: str, others: list[str], dice: random.Random) -> str:
    """A variant with mistakes, and often with a table of another scenario besides."""
    if dice.random() < 0.4:
        blocks = re.split(r"(?m)^(?=\[)", dice.choice(others))[1:]
        text += "\n" + dice.choice(blocks or [""])
    return toml(text, others, dice)


def table(text: str, dice: random.Random) -> str:
    """A table of comma-separated values with one to three mistakes in cells, rows, columns or bytes."""
    for _ in range(dice.randint(1, 3)):
        kind = dice.random()
        rows = text.split("\n")
        at = dice.randrange(min(len(rows), 12)) if dice.random() < 0.4 else dice.randrange(len(rows))
        cells = rows[at].split(",")
        cell = dice.randrange(len(cells))
        if kind < 0.35:
            cells[cell] = dice.choice(CELLS)
            rows[at] = ",".join(cells)
        elif kind < 0.5:
            rows[at] = other_number(rows[at], dice)
        elif kind < 0.7:
            rows[at : at + 1] = dice.choice([[], [rows[at]] * 2, [rows[at], dice.choice(rows)], [",".join(cells[:-1])], [rows[at] + ",1"]])
        elif kind < 0.8:
            rows = rows[: at + 1] if dice.random() < 0.5 else rows[:at] + rows[at + dice.randint(1, 30) :]
        elif kind < 0.88:
            value = dice.choice([None, "0", "", "1e9", "-40", "nan"])
            first = dice.choice([1, 8])
            rows[first:] = [_column(row, cell, value) for row in rows[first:]]
        elif kind < 0.94:
            rows = "\n".join(rows).replace(*dice.choice([(",", ";"), ("\n", "\r\n"), (".", ","), ("-", "/"), ("\n", "\n\n")])).split("\n")
        else:
            rows = other_piece("\n".join(rows), CELLS, dice).split("\n")
        text = "\n".join(rows)
    return text if dice.random() < 0.99 else "\ufeff" + text


def _column(row: str, at: int, value: str | None) -> str:
    """A row with another value in one column, or without the column."""
    cells = row.split(",")
    cells[at : at + 1] = [] if value is None else [value] if at < len(cells) and row else []
    return ",".join(cells)


def flags(text: str, paths: dict[str, list[tuple[str, str]]], scenarios: list[str], dice: random.Random) -> str:
    """Arguments as a JSON list: of `run` or `sweep`, with paths and values that authored scenarios have, or nearly."""
    words = json.loads(text) if dice.random() < 0.3 else [dice.choice(["run", "run", "sweep"]), dice.choice(scenarios)]
    for _ in range(dice.randint(1, 2)):
        family = words[1].split("/")[0] if dice.random() < 0.9 else dice.choice(list(paths))
        words += _flag(words, paths.get(family, paths["intersection"]), dice)
    return json.dumps(words)


def _flag(words: list[str], paths: list[tuple[str, str]], dice: random.Random) -> list[str]:
    """One more flag with its value."""
    others = SWEEP_FLAGS if words[0] == "sweep" else OTHER_FLAGS
    if dice.random() < 0.15:
        return dice.choice(others)
    path, value = dice.choice(paths)
    value = value if dice.random() < 0.3 else other_number(value, dice)
    if dice.random() < 0.3:
        path = dice.choice([path + ".x", path.rsplit(".", 1)[0], path.replace("_", "-"), path[:-1], "vehicle.*." + path.rsplit(".", 1)[-1]])
    if dice.random() < 0.4:
        value = dice.choice(VALUES)
    whole = f"{path}={value}" if dice.random() < 0.95 else dice.choice([path, value, "=", "", f"{path}=={value}", f"{path} = {value}"])
    name = dice.choice(["--set", "--set", "--vary", "--arm"]) if words[0] == "sweep" else "--set"
    return [name, whole.replace("\0", "")]
