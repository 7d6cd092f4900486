"""What the tests of verdicts give the report instead of measurements: results by hand, and plots that nobody draws."""

import pathlib
import sys
from unittest import mock

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "scripts"))
from report.results import Results  # noqa: E402  after its folder is known


def results(program, runs):
    """Results of one program: counters by the run's name."""
    made = Results("nowhere")
    made._read[program] = {"benchmarks": [{"name": name, **counters} for name, counters in runs.items()]}
    return made


def _axes():
    made = mock.MagicMock()
    made.get_xlim.return_value = made.get_ylim.return_value = (1, 2)
    return made


class NoPictures:
    def figure(self, columns=1, **_):
        return mock.MagicMock(), _axes() if columns == 1 else [_axes() for _ in range(columns)]

    def save(self, _figure, name, _alt, _n):
        return f"![{name}]"
