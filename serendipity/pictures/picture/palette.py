"""Colours that colour-blind people can tell apart (Okabe and Ito 2008), by what they stand for.

Nothing is told by colour alone: agents also differ in shape and letter, the former plan in
its dashes, the window in its label.
"""

from typing import Final

BLACK: Final = "#000000"
ORANGE: Final = "#E69F00"
SKY: Final = "#56B4E9"
GREEN: Final = "#009E73"
BLUE: Final = "#0072B2"
VERMILLION: Final = "#D55E00"
PURPLE: Final = "#CC79A7"

INK: Final = "#1f2328"
FAINT_INK: Final = "#57606a"
PAPER: Final = "#ffffff"
FLOOR: Final = "#f3f5f7"
CORRIDOR: Final = "#e4e8ec"
WALL: Final = "#8b949e"
WINDOW: Final = "#fbf3ad"  # yellow, let down with white
MEETING: Final = PURPLE
GOAL: Final = GREEN
FORMER: Final = "#6e7781"

HUMAN: Final = BLUE
ROBOTS: Final = (VERMILLION, GREEN, ORANGE, SKY, BLACK)


def agent_colours(agents: int, human: int) -> dict[int, str]:
    """The colour of each agent; robots beyond the fifth share colours, not letters."""
    robots = [i for i in range(agents) if i != human]
    return {human: HUMAN} | {agent: ROBOTS[n % len(ROBOTS)] for n, agent in enumerate(robots)}


def on(colour: str) -> str:
    """Black or white, whichever reads better on a colour (WCAG relative luminance)."""
    channels = [int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5)]
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in channels]
    luminance = 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]
    return PAPER if luminance < 0.25 else INK


def tint(colour: str, share: float = 0.16) -> str:
    """A colour let down with white."""
    channels = [int(colour[i : i + 2], 16) for i in (1, 3, 5)]
    return "#" + "".join(f"{round(255 - (255 - c) * share):02x}" for c in channels)
