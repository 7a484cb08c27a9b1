"""What help may leave changed: for free, at a price, or not at all (semantics 12)."""

from collections.abc import Iterable
from dataclasses import dataclass
from fnmatch import fnmatchcase
from fractions import Fraction

from serendipity.model.errors import UsageError
from serendipity.model.numbers import exact
from serendipity.model.options import Options


@dataclass(frozen=True, slots=True)
class Leftovers:
    """What facts cost that are not left as without help: by patterns nothing, or a price."""

    free: tuple[str, ...]
    priced: tuple[tuple[str, Fraction], ...]

    def price(self, fact: str) -> Fraction | None:
        """Of a fact by its name, by the first pattern that fits, free ones first; None: it has to be kept."""
        if any(fnmatchcase(fact, pattern) for pattern in self.free):
            return Fraction(0)
        return next((price for pattern, price in self.priced if fnmatchcase(fact, pattern)), None)

    def prices(self, facts: Iterable[str]) -> list[Fraction | None]:
        """Of several."""
        return [self.price(fact) for fact in facts]


def leftovers(options: Options) -> Leftovers | None:
    """What options say of it; None where help may leave anything changed.

    Raises:
        UsageError: prices are not written as ``"dirty *=0.5, at cup *=2"``.
    """
    if options.leave_free is None and options.leave_price is None:
        return None
    priced = []
    for part in _parts(options.leave_price):
        pattern, equals, price = part.rpartition("=")
        if not equals or not pattern.strip():
            raise UsageError(f"leave_price: expected patterns such as dirty *=0.5, got {part!r:.50}")
        amount = exact(price.strip(), f"leave_price: {pattern.strip():.50}")
        if amount < 0:
            raise UsageError(f"leave_price: {pattern.strip():.50}: expected at least 0, got {price.strip()}")
        priced.append((pattern.strip(), amount))
    return Leftovers(tuple(_parts(options.leave_free)), tuple(priced))


def _parts(text: str | None) -> list[str]:
    return [] if text is None else [part.strip() for part in text.split(",")]
