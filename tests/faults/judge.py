"""What is wrong with what a command said or wrote, if anything."""

import pathlib
import re
import xml.etree.ElementTree

# Everything that a terminal may take for an order, but for tabs and ends of lines.
CONTROL = re.compile(r"[\x00-\x08\x0b-\x1f\x7f-\x9f]")
NO_NUMBER = re.compile(r"(?<![\w.\"`'/-])[+-]?(?:NaN|nan|inf|Infinity|infinity)(?![\w\"`'-])")
MOST_READ_BYTES = 3_000_000


def of_text(said: str) -> str | None:
    """Control characters."""
    found = CONTROL.search(said)
    return f"a control character, U+{ord(found[0]):04X}, is printed" if found else None


def of_results(ended: str, out: str) -> str | None:
    """Results that are no numbers."""
    found = NO_NUMBER.search(out) if ended in "01" else None
    return f"a result is {found[0]}" if found else None


def of_files(folder: pathlib.Path) -> str | None:
    """Pictures that are no pictures, and numbers in pictures, pages and tables that are none."""
    for file in [*folder.glob("page/*.svg"), *folder.glob("page/*.html"), *folder.glob("series.csv"), *folder.glob("all.csv"), *folder.glob("counts.csv")]:
        text = file.read_text("utf-8", "replace")[:MOST_READ_BYTES]
        if found := NO_NUMBER.search(text):
            return f"{file.name} has {found[0]}"
        if file.suffix == ".svg" and len(text) < MOST_READ_BYTES:
            try:
                xml.etree.ElementTree.fromstring(text)
            except xml.etree.ElementTree.ParseError as error:
                return f"{file.name} is not XML: {error.msg}"
    return None
