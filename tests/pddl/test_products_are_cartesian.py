"""A product of tables is every combination of their rows, however it is looked up."""

from itertools import combinations, product

from hypothesis import given
from hypothesis import strategies as st

from serendipity.pddl.grounding.product import Bindings, Product, combined


@st.composite
def tables(draw: st.DrawFn) -> list[Bindings]:
    """Up to four tables of up to two variables each, none of them empty."""
    found = []
    for number in range(draw(st.integers(0, 4))):
        width, height = draw(st.integers(0, 2)), draw(st.integers(1, 3))
        variables = tuple(f"?{number}{place}" for place in range(width))
        rows = [tuple(f"{variable[1:]}-{row}" for variable in variables) for row in range(height)]
        found.append(Bindings(variables, rows if width else [()]))
    return found


def enumerated(found: list[Bindings]) -> list[dict[str, str]]:
    names = [variable for table in found for variable in table.variables]
    rows = product(*(table.rows for table in found))
    return [dict(zip(names, (value for row in choice for value in row), strict=True)) for choice in rows]


@given(tables())
def test_bindings_are_all_combinations(found: list[Bindings]) -> None:
    bindings = Product(found)
    assert [*bindings] == enumerated(found)
    variables, rows = combined(found)
    assert [dict(zip(variables, row, strict=True)) for row in rows] == enumerated(found)
    assert bindings.size == len(enumerated(found))


@given(tables())
def test_a_part_is_found_again_in_the_whole(found: list[Bindings]) -> None:
    bindings = Product(found)
    variables = [variable for table in found for variable in table.variables]
    for count in range(3):
        for terms in combinations([*variables, "constant"], count):
            part = bindings.part(terms)
            small = [*zip(*(bindings.column(term, part) for term in terms), strict=True)] if terms else [()]
            assert len({*small}) == len(small)
            large = [small[place] for place in bindings.index(part, bindings.everything)]
            assert large == [tuple(b.get(term, term) for term in terms) for b in enumerated(found)]


@given(tables(), st.integers(1, 5))
def test_slices_are_the_whole_in_order(found: list[Bindings], most: int) -> None:
    slices = [*Product(found).slices(most)]
    assert all(part.size <= most for part in slices)
    assert [binding for part in slices for binding in part] == enumerated(found)


def test_an_empty_table_leaves_nothing() -> None:
    assert Product([Bindings(("?x",), [("a",), ("b",)]), Bindings(("?y",), [])]).size == 0
