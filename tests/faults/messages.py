"""What a command said, reduced to the kinds of its messages."""

import re

# A place that a message names: a file with its line, a line of a table, or a flag of the command line. `the flags` is a plan that
# `sweep` makes of its flags: its lines are nowhere to be seen, but each names its flag.
PLACE = re.compile(r"\[(?!the flags:)[^\[\]\n]+:\d+(:\d+)?\]|(?m:^(?:Error: )?[^:\s][^:\n]*:\d+:)|\blines? \d+|--[a-z]+")
QUOTED = re.compile(r"`[^`]*`|\"[^\"]*\"|'[^'\s][^']*'")
NUMBER = re.compile(r"[-+]?(?<![\w])(?:\d[\d,.]*(?:e[-+]?\d+)?|nan|inf)\b|\d+")
FRAME = re.compile(r"^[\s│·]*(?:[╰├]─+\s*)?")


def _texts(said: str) -> list[str]:
    """The sentences of all errors, each with its labels and its help, without the lines of files that they show."""
    texts, inside = [], False
    for line in said.splitlines():
        if "×" in line:
            texts.append(line.split("×", 1)[1])
            inside = True
        elif line.startswith(("error: ", "Error: ")) and line[7:].strip():
            texts.append(re.sub(r"^Error: [^:\s]+:[\d:]+", "", line))
        elif "╭─" in line:
            inside = False
        elif texts and re.match(r"^\s*(?:·.*[╰├]──|help:)", line):
            texts[-1] += " | " + FRAME.sub("", line)
            inside = "help:" in line
        elif inside and line.strip() and texts and re.match(r"^(?:\s*│|\s{8,})", line):
            texts[-1] += " " + FRAME.sub("", line)
        else:
            inside = False
    return texts


def kinds(said: str) -> set[str]:
    """The distinct messages, with `…` in place of everything quoted and `N` in place of every number."""
    found = set()
    for text in _texts(said):
        text = NUMBER.sub("N", QUOTED.sub("…", text))
        found.add(re.sub(r"\s+", " ", text).strip())
    return {text for text in found if not re.fullmatch(r"cannot use .*: N errors?", text)}


def first_line(said: str) -> str:
    """The first line of what was said, reduced in the same way."""
    line = next((line for line in said.splitlines() if line.strip()), "")
    return re.sub(r"\s+", " ", NUMBER.sub("N", QUOTED.sub("…", line))).strip()


def names_place(said: str) -> bool:
    """Whether a refusal says where: a file with its line, or a flag."""
    return PLACE.search(said) is not None
