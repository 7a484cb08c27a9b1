"""Tables of cases as text."""

import re


def table(text: str) -> list[tuple[str, ...]]:
    """Rows of ``one | another``; a line that begins with a bar goes on with the row above."""
    lines = re.sub(r"\n\s*\| ", " | ", text.strip()).splitlines()
    return [tuple(cell.strip() for cell in line.split(" | ")) for line in lines]
