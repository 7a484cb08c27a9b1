"""Names of formats with their versions, as files have them: ``serendipity.result/1``."""


def schema_fault(found: object, expected: str) -> str | None:
    """The fault in the schema of a file, in one line; None without one."""
    if found == expected:
        return None
    kind, _, known = expected.rpartition("/")
    name, _, version = str(found).rpartition("/")
    if name == kind and version.isdecimal() and int(version[:9]) > int(known):
        return f"schema: '{kind}/{version:.9}' is newer than '{expected}', which is what this version reads"
    return f"schema: expected '{expected}', got {found!r:.50}"
