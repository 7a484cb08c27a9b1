"""JSON says what it was made of, on lines that people can read."""

import json
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from serendipity.model.json_text import json_text

scalars = (
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False, allow_infinity=False) | st.text()
)
values = st.recursive(
    scalars, lambda inner: st.lists(inner) | st.dictionaries(st.text(), inner), max_leaves=5
)


@given(st.dictionaries(st.text(), values, max_size=3))
def test_it_reads_as_it_was(value: dict[str, object]) -> None:
    assert json.loads(json_text(value)) == value


@pytest.mark.parametrize(
    ("value", "error"), [(math.nan, ValueError), ([-math.inf], ValueError), ({1}, TypeError)]
)
def test_what_is_no_json_is_not_written(value: object, error: type[Exception]) -> None:
    with pytest.raises(error):
        json_text({"a": value})
