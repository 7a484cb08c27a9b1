from tests.execution.living import room2_fixture

__all__ = ["room2_fixture"]
