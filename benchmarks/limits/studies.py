"""What is measured: commands, and the limits that they get."""

from typing import NamedTuple

MODES = {
    "plan": "plan {task} --discount 0.9",
    "plan individual": "plan {task} --mode individual",
    "plan K=0": "plan {task} --discount 0.9 --window-weight 0",
    "plan communication": "plan {task} --discount 0.9 --mode communication --format json",
    "plan composite": "plan {task} --discount 0.9 --mode composite --horizon inf",
    "plan local": "plan {task} --discount 0.9 --human-model local",
    "plan observant": "plan {task} --discount 0.9 --human-model observant",
    "plan ties": "plan {task} --discount 0.9 --ties robust --max-ties 1000000",
    "plan goals": "plan {task} --discount 0.9 --goals {goals}",
    "plan assistance": "plan {alone} --mode assistance",
}
"""By what the table calls them; each runs where its words can be filled in."""

CERTIFICATES = {
    "verify": "verify {task} {result}",
    "verify individual": "verify {task} {individual_result}",
    "verify K=0": "verify {task} {free_window_result}",
    "verify communication": "verify {task} {communication_result}",
    "verify composite": "verify {task} {composite_result}",
    "verify local": "verify {task} {local_result}",
    "verify ties": "verify {task} {ties_result}",
    "verify goals": "verify {task} {goals_result}",
    "verify assistance": "verify {alone} {assistance_result}",
}

OTHERS = {
    "individual verify": "plan {task} --mode individual --verify",
    "composite verify": "plan {task} --discount 0.9 --mode composite --horizon inf --verify",
    "plan verify": "plan {task} --discount 0.9 --verify",
    "assistance robust": "plan {alone} --mode assistance --ties robust --format json",
    "check-task": "check-task {task}",
    "explain": "explain {task} --discount 0.9",
    "interruptions": "interruptions {task} --discount 0.9 --format json",
    "recognise": "recognise {task} --goals {goals}",
    "simulate": "simulate {task} {result}",
    "solve": "solve {task} --discount 0.9",
    "reproduce": "reproduce {suite} --modes serendipity --discounts 0.9",
}

COMMANDS = MODES | CERTIFICATES | OTHERS


class Study(NamedTuple):
    """What is measured, unless options say otherwise.

    Attributes:
        commands: by what the table calls them.
        limits: seconds.
        memory: MiB for the ten largest tasks; None for little, and all of them; 0 for none.
        stride: take every N-th task of each domain of the suite.
    """

    commands: dict[str, str]
    limits: str
    memory: float | None = 0
    stride: int = 1


STUDIES = {
    "plan": Study(MODES, "0.1,1"),
    "verify": Study(CERTIFICATES, "0.05,0.5,5"),
    "memory": Study(MODES | {"verify": CERTIFICATES["verify"]}, "", 300),
    "commands": Study(COMMANDS, "0.05,0.5,2", None, 8),
}
