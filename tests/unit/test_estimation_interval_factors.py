"""Factors that make intervals cover, and the file that they ship in."""

import numpy as np
import pytest
from surface_jacobian import linearized

from shapewright.errors import EstimationError
from shapewright.estimation.determination.determine import determine
from shapewright.estimation.determination.factors import IntervalFactors, conformal_factor, write_factors
from shapewright.modeling import compile_model


def test_the_factor_covers_what_it_says_whatever_the_errors_are():
    rng = np.random.default_rng(0)
    for draw in (rng.standard_normal, rng.standard_cauchy, lambda n: rng.uniform(-1, 1, n)):
        scales = rng.uniform(0.1, 10.0, (2, 4000))
        errors = draw(8000).reshape(2, 4000) * scales
        factor = conformal_factor(errors[0], scales[0], np.ones(4000))
        assert (np.abs(errors[1]) <= factor * scales[1]).mean() == pytest.approx(0.9, abs=0.02)


def test_the_rank_counts_the_query_to_come():
    errors = np.arange(1.0, 10.0)
    ones = np.ones(9)
    assert conformal_factor(errors, ones, ones) == 9.0, "of 9 errors the largest covers 90 % of 10"
    assert conformal_factor(-errors, ones, 2 * ones, coverage=0.5) == 2.5
    with pytest.raises(EstimationError, match="at least 9 errors"):
        conformal_factor(errors[:8], ones[:8], ones[:8])
    with pytest.raises(EstimationError, match="positive"):
        conformal_factor(errors, 0 * ones, ones)
    with pytest.raises(EstimationError, match="between 0 and 1"):
        conformal_factor(errors, ones, ones, coverage=1.0)


@pytest.mark.parametrize("scale_known", [True, False])
def test_intervals_cover_the_truth_of_fits_to_noisy_surfaces(library_models, scale_known):
    """Least squares on one linearized model with Gaussian noise on the points; the factor is fitted on other noise."""
    compiled = compile_model(library_models["office_chair"])
    linear = linearized(compiled, compiled.random_values(np.random.default_rng(3), 1)[0], points=600)
    rng = np.random.default_rng(0)
    jacobian = linear.jacobian[:, :-1] if scale_known else linear.jacobian
    solve = np.linalg.pinv(jacobian, rcond=1e-9)
    noise = rng.normal(size=(600, len(jacobian))) * rng.uniform(1e-4, 3e-3, (600, 1))
    errors = noise @ solve.T
    residuals = np.abs(noise - errors @ jacobian.T).mean(axis=1)
    found = [
        determine(*linear.arguments(), mean_residual=residual, factor=1.0, scale_known=scale_known)
        for residual in residuals
    ]
    columns = [c for c in found[0].columns if found[0].statuses[c] == "determined"]
    rows = [found[0].columns.index(c) for c in columns]
    half_widths = np.array([one.half_widths[columns] for one in found])
    missed = np.abs(errors[:, rows])
    fitted, held_out = slice(0, 300), slice(300, 600)
    factor = conformal_factor(
        missed[fitted].reshape(-1),
        np.repeat(residuals[fitted], len(columns)),
        (half_widths[fitted] / residuals[fitted, None]).reshape(-1),
    )
    assert (missed[held_out] <= factor * half_widths[held_out]).mean() == pytest.approx(0.9, abs=0.025)
    assert factor < 0.2, "hundreds of points average the noise away"


def test_factors_are_found_by_version_then_by_name(tmp_path):
    file = tmp_path / "factors.json"
    write_factors(file, 1.5, {"table": ("abc", 0.8), "sword": ("def", 2.0)})
    factors = IntervalFactors.from_json(file.read_text())
    assert factors.of("abc", "table") == 0.8
    assert factors.of("def", "renamed") == 2.0
    assert factors.of("other", "table") == 0.8
    assert factors.of("other", "unknown") == 1.5


@pytest.mark.parametrize(
    "text", ["", "[]", '{"version": 2, "default": 1, "models": {}}', '{"version": 1, "default": -1, "models": {}}']
)
def test_other_files_are_refused(text):
    with pytest.raises(EstimationError):
        IntervalFactors.from_json(text)


def test_the_shipped_factors_can_be_read_and_are_of_shipped_models(library_models):
    shipped = IntervalFactors.shipped()
    assert shipped.default > 0
    assert set(shipped.by_name) <= set(library_models)
