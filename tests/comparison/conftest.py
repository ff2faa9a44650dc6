import pytest
from flights import flight

from hostkit.recordings import Recording


@pytest.fixture(scope="session")
def flights() -> tuple[Recording, ...]:
    return tuple(flight(seed) for seed in (1, 2, 3))
