"""Tasks to be played, in the paper's building."""

from pathlib import Path

from serendipity.scenarios.examples import DATA

DOMAIN = DATA / "usar/domain.pddl"
TAKE = "take medkit mk2 from the robot"


def with_third_kit(folder: Path, place: str, robot: str = "room4") -> Path:
    """Section III-C with another medkit, and perhaps the robot elsewhere."""
    text = (DATA / "usar/room2.pddl").read_text()
    for old, new in (
        ("mk1 mk2 - medkit", "mk1 mk2 mk3 - medkit"),
        ("(at mk2 room3)", f"(at mk2 room3) (at mk3 {place})"),
        ("(at robot room4)", f"(at robot {robot})"),
    ):
        assert old in text
        text = text.replace(old, new)
    (folder / "problem.pddl").write_text(text)
    return folder / "problem.pddl"


def two_goals(folder: Path) -> Path:
    """Triage at one end of the corridor, or at the other."""
    (folder / "goals.txt").write_text("1: conducted_triage commx room1\n1: conducted_triage commx room8\n")
    return folder / "goals.txt"
