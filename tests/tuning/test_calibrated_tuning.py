from dataclasses import replace

import pytest
from recorded import SENSOR, recorded

from hostkit.errors import DesignError
from hostkit.filters import FILTERS
from hostkit.provenance import CalibrationRecord, CalibrationTerm
from hostkit.tuning import FixedParameter, TuningOptions, tune

TERMS = (
    CalibrationTerm(kind="gyro_bias", axis=0, value=0.01, standard_error=1e-4),
    CalibrationTerm(kind="gyro_scale", axis=0, value=0.02, standard_error=1e-3),
    CalibrationTerm(kind="accel_offset", axis=2, value=0.1, standard_error=1e-3),
)
RECORD = CalibrationRecord(gravity_m_s2=9.80665, poses=6, turns=5, terms=TERMS, recordings=())


def options(name: str, **changes) -> TuningOptions:
    return TuningOptions(
        filter=name,
        sensor=SENSOR,
        calibration=RECORD,
        resamples=0,
        held_out=False,
        iterations=3,
        **changes,
    )


@pytest.mark.parametrize("name", FILTERS.names())
def test_the_terms_of_a_calibration_stand_in_the_tuned_design(name: str) -> None:
    design = tune((recorded(duration_s=3.0),), options(name)).design
    wanted = FILTERS[name].calibrated(replace(design, parameters=()), TERMS).design.parameters
    found = {p.name: p.value for p in design.parameters}
    assert wanted
    assert {p.name: p.value for p in wanted}.items() <= found.items()
    assert design.calibration == RECORD
    FILTERS[name].lower(design)


def test_what_the_user_fixes_comes_before_the_calibration() -> None:
    fixed = (FixedParameter(name="gyro_bias", value=0.0),)
    design = tune((recorded(duration_s=3.0),), options("observer", fixed=fixed)).design
    assert design.parameter("gyro_bias_x_rad_s") == 0.0
    assert design.parameter("gyro_scale_x") == 0.02


def test_a_calibrated_parameter_is_not_searched_as_well() -> None:
    recording = recorded(duration_s=3.0)
    with pytest.raises(DesignError, match="gyro-scale is to be tuned, and the calibration has it"):
        tune((recording,), options("observer", free=("kt", "gyro_scale")))
