"""The tables that are printed of rows."""

from collections.abc import Iterable

from benchmarks.limits.rows import EXTRA, FOUND, SHARE, Row


def table_of_times(rows: list[Row]) -> None:
    """How many limits on time were kept, by command and limit; and which were not."""
    timed = [row for row in rows if row.memory_limit is None]
    if timed:
        print(f"{'command':21}{'limit':>6}{'runs':>6}{'kept':>6}{'with answer':>13}   most over, ms")
    for command, limit in dict.fromkeys((row.command, row.time_limit) for row in timed):
        members = [row for row in timed if (row.command, row.time_limit) == (command, limit)]
        worst = max(members, key=lambda row: row.over)
        shown = "killed" if worst.code is None else f"{worst.over * 1000:.0f}"
        counts = f"{len(members):>6}{_count(row.kept for row in members):>6}"
        counts += f"{_count(row.answered for row in members):>13}"
        print(f"{command:21}{limit:>4g} s{counts}   {shown}, {worst.task}")
    for row in rows:  # 2: a horizon is missing where the human has no plan alone
        if row.code not in (*FOUND, 4, None):
            print(f"exit {row.code}: {row.command}, {row.task}, {row.time_limit:g} s")
    for row in sorted((row for row in rows if not row.kept), key=lambda row: -row.beyond):
        over = f"{row.over * 1000:.0f} ms over, waited {row.waited * 1000:.0f} ms, exit {row.code}"
        print(f"not kept: {row.command}, {row.task}, {row.time_limit:g} s: {over}, {row.peak:.0f} MiB")


def table_of_memory(rows: list[Row]) -> None:
    """How far above its limit the memory was, by command."""
    confined = [row for row in rows if row.memory_limit is not None]
    if confined:
        print(f"\n{'command':21}{'runs':>6}{'with answer':>13}   highest peak, of the memory limit")
    for command in dict.fromkeys(row.command for row in confined):
        members = [row for row in confined if row.command == command]
        worst = max(members, key=lambda row: row.memory_over)
        shown = f"{worst.memory_over:+.0%} ({worst.peak:.0f} of {worst.memory_limit:.0f} MiB), {worst.task}"
        answered = _count(row.answered for row in members)
        print(f"{command:21}{len(members):>6}{answered:>13}   {shown}, exit {worst.code}")
        unanswered = ", ".join(row.task for row in members if not row.answered)
        if unanswered:
            print(f"{'':21}without: {unanswered}")


def summary(rows: list[Row]) -> int:
    """The last lines; 1 where a limit was not kept."""
    confined = [row for row in rows if row.memory_limit is not None]
    kept = _count(row.kept for row in rows)
    within = _count(row.memory_over <= SHARE for row in confined)
    print()
    if rows:
        longest = max(row.beyond + EXTRA for row in rows) * 1000
        print(
            f"time: kept {kept} of {len(rows)}, longest over 110 % of its limit {longest:.0f} ms, "
            f"highest peak {max(row.peak for row in rows):.0f} MiB"
        )
    if confined:
        worst = max(row.peak for row in confined)
        answered = _count(row.answered for row in confined)
        print(
            f"memory: within 110 % of the limit {within} of {len(confined)}, "
            f"highest peak {worst:.0f} MiB, with answer {answered}"
        )
    return int(kept < len(rows) or within < len(confined))


def _count(flags: Iterable[bool]) -> int:
    return sum(flags)
